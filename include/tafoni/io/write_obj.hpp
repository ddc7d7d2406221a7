/// \file
/// Writes Wavefront OBJ; what is read back is equal bit for bit.
#ifndef TAFONI_IO_WRITE_OBJ_HPP
#define TAFONI_IO_WRITE_OBJ_HPP

#include <tafoni/geometry/concepts.hpp>
#include <tafoni/io/detail/format_number.hpp>
#include <tafoni/io/detail/require_writable.hpp>
#include <tafoni/io/detail/write_file.hpp>
#include <tafoni/io/mesh_file.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace tafoni {
namespace detail {

inline void require_groups(char const* who, std::vector<face_group> const& list, std::size_t faces, char const* what) {
    for (std::size_t k = 0; k < list.size(); ++k) {
        bool const ordered = k == 0 || list[k - 1].first_face < list[k].first_face;
        if (!ordered || list[k].first_face >= faces || list[k].name.find_first_of("\n\r") != std::string::npos) {
            fail<invalid_input>(errc::bad_parameter,
                                std::string(who) + ": " + what + " " + std::to_string(k) +
                                    " must start behind the one before, at one of the faces, and be named in one line",
                                {.kind = entity::attribute, .index = k});
        }
    }
}

/// Writes "keyword name" where a group starts at this face.
inline void append_group(std::string& out, std::vector<face_group> const& list, std::size_t& next, std::size_t face,
                         char const* keyword) {
    if (next == list.size() || list[next].first_face != face) return;
    out += keyword;
    if (!list[next].name.empty()) (out += ' ') += list[next].name;
    out += '\n';
    ++next;
}

}  // namespace detail

/// The mesh as the bytes of an OBJ: positions, texture coordinates, normals, objects, groups,
/// materials, and the vertex channels red, green, blue (alpha) as vertex colours, where none of a
/// vertex's is NaN. OBJ has no place for other channels; they are left out. O(vertices + corners).
/// \throws invalid_input  `non_finite_vertex`, `index_out_of_range`, `degenerate_face`, `attribute_length`, `bad_parameter`.
template <polygon_mesh M>
[[nodiscard]] std::string encode_obj(M const& mesh, mesh_attributes const& attributes = {}) {
    using access = mesh_access<M>;
    constexpr char const* who = "write_obj";
    std::size_t const corners = detail::require_writable(who, mesh, attributes);
    std::size_t const vertices = access::vertex_count(mesh);
    std::size_t const faces = access::face_count(mesh);
    detail::require_corner_list(who, attributes.corner_texture, corners, attributes.texture.size(), "corner_texture");
    detail::require_corner_list(who, attributes.corner_normals, corners, attributes.normals.size(), "corner_normals");
    detail::require_groups(who, attributes.objects, faces, "object");
    detail::require_groups(who, attributes.groups, faces, "group");
    detail::require_groups(who, attributes.materials, faces, "material");
    for (std::string const& library : attributes.material_libraries) {
        if (library.find_first_of("\n\r") == std::string::npos) continue;
        detail::fail<invalid_input>(errc::bad_parameter, std::string(who) + ": a material library must be named in one line",
                                    {.kind = entity::attribute});
    }
    for (std::size_t k = 0; k < attributes.normals.size(); ++k) {
        detail::require_finite_vertex("write_obj (normal)", attributes.normals[k], k);
    }
    for (std::size_t k = 0; k < attributes.texture.size(); ++k) {
        std::array<double, 2> const& t = attributes.texture[k];
        detail::require_finite_vertex("write_obj (texture coordinate)", vec3{t[0], t[1], 0}, k);
    }

    std::array<mesh_channel const*, 4> colour{};
    std::size_t colours = 0;
    for (char const* name : {"red", "green", "blue", "alpha"}) {
        colour[colours] = mesh_attributes::find(attributes.vertex_channels, name);
        if (colour[colours] == nullptr) break;
        ++colours;
    }
    if (colours < 3) colours = 0;

    std::string out;
    out.reserve(64 * vertices + 8 * corners);
    auto const row = [&](char const* keyword, auto const& values, std::size_t n) {
        out += keyword;
        for (std::size_t k = 0; k < n; ++k) {
            out += ' ';
            detail::append_number(out, values[static_cast<decltype(values.size())>(k)]);
        }
    };
    for (std::string const& library : attributes.material_libraries) out += "mtllib " + library + "\n";
    for (std::size_t v = 0; v < vertices; ++v) {
        row("v", access::position(mesh, v), 3);
        std::size_t shown = 0;
        while (shown < colours && std::isfinite(colour[shown]->values[v])) ++shown;
        if (shown < 3) shown = 0;
        for (std::size_t k = 0; k < shown; ++k) {
            out += ' ';
            detail::append_number(out, colour[k]->values[v]);
        }
        out += '\n';
    }
    for (std::array<double, 2> const& t : attributes.texture) {
        row("vt", t, 2);
        out += '\n';
    }
    for (vec3 const& n : attributes.normals) {
        row("vn", n, 3);
        out += '\n';
    }
    std::size_t object = 0;
    std::size_t group = 0;
    std::size_t material = 0;
    std::size_t corner = 0;
    for (std::size_t f = 0; f < faces; ++f) {
        detail::append_group(out, attributes.objects, object, f, "o");
        detail::append_group(out, attributes.groups, group, f, "g");
        detail::append_group(out, attributes.materials, material, f, "usemtl");
        out += 'f';
        for (std::size_t k = 0; k < access::face_size(mesh, f); ++k, ++corner) {
            out += ' ';
            detail::append_number(out, access::corner(mesh, f, k) + 1);
            std::uint32_t const t = attributes.corner_texture.empty() ? mesh_attributes::none : attributes.corner_texture[corner];
            std::uint32_t const n = attributes.corner_normals.empty() ? mesh_attributes::none : attributes.corner_normals[corner];
            if (t != mesh_attributes::none || n != mesh_attributes::none) out += '/';
            if (t != mesh_attributes::none) detail::append_number(out, std::uint64_t{t} + 1);
            if (n != mesh_attributes::none) {
                out += '/';
                detail::append_number(out, std::uint64_t{n} + 1);
            }
        }
        out += '\n';
    }
    return out;
}

/// Writes an OBJ file, atomically. \throws invalid_input  as above. \throws io_error  `write_failed`, `not_a_file`.
template <polygon_mesh M>
void write_obj(std::filesystem::path const& path, M const& mesh, mesh_attributes const& attributes = {}) {
    detail::write_file("write_obj", path, encode_obj(mesh, attributes));
}

}  // namespace tafoni

#endif
