/// \file
/// Writes binary STL; polygons are triangulated.
#ifndef TAFONI_IO_WRITE_STL_HPP
#define TAFONI_IO_WRITE_STL_HPP

#include <tafoni/geometry/concepts.hpp>
#include <tafoni/geometry/triangulate.hpp>
#include <tafoni/io/detail/format_number.hpp>
#include <tafoni/io/detail/require_writable.hpp>
#include <tafoni/io/detail/write_file.hpp>
#include <tafoni/io/mesh_file.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace tafoni {

struct write_stl_options {
    vec3 origin{0, 0, 0};  ///< subtracted, and recorded in the header, where `read_stl` finds it
};

/// The mesh as the bytes of a binary STL. Coordinates are rounded to float relative to the origin;
/// faces of more than three corners are cut by `triangulate`; the face channel "attribute", of type
/// uint16, becomes the attribute bytes. Normals are computed, zero for a triangle without area.
/// O(vertices + corners).
/// \throws invalid_input  `non_finite_vertex`, `index_out_of_range`, `degenerate_face`, `attribute_length`, `bad_parameter`.
/// \throws io_error       `format_limit` for more than 2^32 - 1 triangles or a coordinate beyond float.
template <polygon_mesh M>
[[nodiscard]] std::string encode_stl(M const& mesh, mesh_attributes const& attributes = {},
                                     write_stl_options const& options = {}) {
    using access = mesh_access<M>;
    constexpr char const* who = "write_stl";
    std::size_t const corners = detail::require_writable(who, mesh, attributes);
    detail::require_finite_vertex("write_stl (origin)", options.origin, 0);
    std::size_t const faces = access::face_count(mesh);
    std::uint64_t const triangles = corners - 2 * faces;
    if (triangles > 0xffffffffU) {
        detail::fail<io_error>(errc::format_limit,
                               std::string(who) + ": " + std::to_string(triangles) + " triangles, STL holds 4294967295");
    }
    vec3 const origin = detail::float_origin(options.origin);
    for (std::size_t v = 0; v < access::vertex_count(mesh); ++v) {
        detail::require_float_vertex(who, access::position(mesh, v), origin, v);
    }
    mesh_channel const* attribute = mesh_attributes::find(attributes.face_channels, "attribute");
    if (attribute != nullptr && attribute->type != channel_type::uint16) attribute = nullptr;

    std::string out;
    out.reserve(84 + 50 * triangles);
    if (options.origin == vec3{0, 0, 0}) {
        out = "binary STL";
    } else {
        detail::append_origin(out, origin);
    }
    out.resize(80, ' ');
    detail::append_little(out, std::uint32_t{0});
    std::uint32_t written = 0;
    std::vector<vec3> loop;
    for (std::size_t f = 0; f < faces; ++f) {
        loop.clear();
        for (std::size_t k = 0; k < access::face_size(mesh, f); ++k) {
            loop.push_back(access::position(mesh, static_cast<std::size_t>(access::corner(mesh, f, k))));
        }
        auto const triangle = [&](vec3 const& a, vec3 const& b, vec3 const& c) {
            // Of the rounded corners, so that a file that is read and written again is the same; without the sign
            // of zero, since a reader that welds corners can keep only one of two.
            std::array<vec3, 3> stored{a, b, c};
            for (vec3& p : stored) {
                for (int axis = 0; axis < 3; ++axis) p[axis] = detail::round_to_float(p[axis] - origin[axis]) + 0.0;
            }
            vec3 const u{stored[1][0] - stored[0][0], stored[1][1] - stored[0][1], stored[1][2] - stored[0][2]};
            vec3 const w{stored[2][0] - stored[0][0], stored[2][1] - stored[0][1], stored[2][2] - stored[0][2]};
            vec3 const normal = normalized(cross(u, w));
            for (int axis = 0; axis < 3; ++axis) detail::append_little(out, static_cast<float>(normal[axis]));
            for (vec3 const& p : stored) {
                for (int axis = 0; axis < 3; ++axis) detail::append_little(out, static_cast<float>(p[axis]));
            }
            detail::append_little(out, attribute == nullptr ? std::uint16_t{0}
                                                            : static_cast<std::uint16_t>(attribute->values[f]));
            ++written;
        };
        if (loop.size() == 3) {
            triangle(loop[0], loop[1], loop[2]);
        } else {
            for (auto const& t : triangulate(loop)) triangle(loop[t[0]], loop[t[1]], loop[t[2]]);
        }
    }
    std::string count;
    detail::append_little(count, written);
    std::copy(count.begin(), count.end(), out.begin() + 80);
    return out;
}

/// Writes a binary STL file, atomically. \throws invalid_input, io_error  as above, and `write_failed`, `not_a_file`.
template <polygon_mesh M>
void write_stl(std::filesystem::path const& path, M const& mesh, mesh_attributes const& attributes = {},
               write_stl_options const& options = {}) {
    detail::write_file("write_stl", path, encode_stl(mesh, attributes, options));
}

}  // namespace tafoni

#endif
