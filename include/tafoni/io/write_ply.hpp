/// \file
/// Writes PLY with numbers per vertex and per face.
#ifndef TAFONI_IO_WRITE_PLY_HPP
#define TAFONI_IO_WRITE_PLY_HPP

#include <tafoni/geometry/concepts.hpp>
#include <tafoni/io/detail/format_number.hpp>
#include <tafoni/io/detail/require_writable.hpp>
#include <tafoni/io/detail/write_file.hpp>
#include <tafoni/io/mesh_file.hpp>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <string>
#include <vector>

namespace tafoni {

struct write_ply_options {
    ply_encoding encoding = ply_encoding::little_endian;
    coordinate_type coordinates = coordinate_type::float64;
    vec3 origin{0, 0, 0};  ///< for float32: subtracted, and recorded in a comment that `read_ply` adds back
};

namespace detail {

/// Appends numbers in one encoding of PLY.
struct ply_sink {
    std::string& out;
    ply_encoding encoding;

    template <class Number>
    void operator()(Number value) const {
        if (encoding == ply_encoding::ascii) {
            if (!out.empty() && out.back() != '\n') out += ' ';
            append_number(out, value);
            return;
        }
        append_little(out, value);
        if (encoding == ply_encoding::big_endian) std::reverse(out.end() - sizeof(Number), out.end());
    }
    void end_record() const {
        if (encoding == ply_encoding::ascii) out += '\n';
    }
};

inline void append_properties(std::string& out, std::vector<mesh_channel> const& channels) {
    static constexpr char const* types[] = {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"};
    for (mesh_channel const& c : channels) {
        ((((out += "property ") += types[static_cast<std::size_t>(c.type)]) += ' ') += c.name) += '\n';
    }
}

inline void require_free_names(std::vector<mesh_channel> const& channels, std::initializer_list<std::string_view> taken) {
    for (mesh_channel const& c : channels) {
        if (std::find(taken.begin(), taken.end(), c.name) != taken.end()) {
            fail<invalid_input>(errc::bad_parameter, "write_ply: the name '" + c.name + "' is taken by the mesh itself",
                                {.kind = entity::attribute});
        }
    }
}

}  // namespace detail

/// The mesh as the bytes of a PLY: positions, faces, and every channel as a property of its type.
/// What is indexed per corner (normals, texture coordinates) has no place in PLY and is left out.
/// O(vertices + corners + values).
/// \throws invalid_input  `non_finite_vertex`, `index_out_of_range`, `degenerate_face`, `attribute_length`, `bad_parameter`.
/// \throws io_error       `format_limit` where float32 cannot hold a coordinate.
template <polygon_mesh M>
[[nodiscard]] std::string encode_ply(M const& mesh, mesh_attributes const& attributes = {},
                                     write_ply_options const& options = {}) {
    using access = mesh_access<M>;
    std::size_t const corners = detail::require_writable("write_ply", mesh, attributes);
    detail::require_free_names(attributes.vertex_channels, {"x", "y", "z"});
    detail::require_free_names(attributes.face_channels, {"vertex_indices", "vertex_index"});
    detail::require_finite_vertex("write_ply (origin)", options.origin, 0);
    std::size_t const vertices = access::vertex_count(mesh);
    std::size_t const faces = access::face_count(mesh);
    detail::require_indexable("write_ply", vertices);
    bool const single = options.coordinates == coordinate_type::float32;
    vec3 const origin = single ? detail::float_origin(options.origin) : vec3{0, 0, 0};
    std::size_t largest = 0;
    for (std::size_t f = 0; f < faces; ++f) largest = std::max(largest, access::face_size(mesh, f));

    std::string out = "ply\nformat ";
    out += options.encoding == ply_encoding::ascii           ? "ascii"
           : options.encoding == ply_encoding::little_endian ? "binary_little_endian"
                                                             : "binary_big_endian";
    out += " 1.0\n";
    if (!(origin == vec3{0, 0, 0})) {
        out += "comment ";
        detail::append_origin(out, origin);
        out += '\n';
    }
    out += "element vertex " + std::to_string(vertices) + "\n";
    for (char const* axis : {"x\n", "y\n", "z\n"}) (out += single ? "property float " : "property double ") += axis;
    detail::append_properties(out, attributes.vertex_channels);
    out += "element face " + std::to_string(faces) + "\nproperty list ";
    out += largest < 256 ? "uchar " : "uint ";
    bool const unsigned_indices = vertices > 0x80000000U;
    out += unsigned_indices ? "uint vertex_indices\n" : "int vertex_indices\n";
    detail::append_properties(out, attributes.face_channels);
    out += "end_header\n";
    out.reserve(out.size() + vertices * (24 + 8 * attributes.vertex_channels.size()) + 4 * corners + 4 * faces +
                8 * faces * attributes.face_channels.size());

    detail::ply_sink const sink{out, options.encoding};
    auto const append_channels = [&](std::vector<mesh_channel> const& channels, std::size_t i) {
        for (mesh_channel const& c : channels) detail::as_type(c.type, c.values[i], sink);
        sink.end_record();
    };
    for (std::size_t v = 0; v < vertices; ++v) {
        vec3 const p = access::position(mesh, v);
        if (single) detail::require_float_vertex("write_ply", p, origin, v);
        for (int axis = 0; axis < 3; ++axis) {
            if (single) {
                sink(static_cast<float>(p[axis] - origin[axis]));
            } else {
                sink(p[axis]);
            }
        }
        append_channels(attributes.vertex_channels, v);
    }
    for (std::size_t f = 0; f < faces; ++f) {
        std::size_t const n = access::face_size(mesh, f);
        if (largest < 256) {
            sink(static_cast<std::uint8_t>(n));
        } else {
            sink(static_cast<std::uint32_t>(n));
        }
        for (std::size_t k = 0; k < n; ++k) sink(static_cast<std::uint32_t>(access::corner(mesh, f, k)));
        append_channels(attributes.face_channels, f);
    }
    return out;
}

/// Writes a PLY file, atomically. \throws invalid_input, io_error  as above, and `write_failed`, `not_a_file`.
template <polygon_mesh M>
void write_ply(std::filesystem::path const& path, M const& mesh, mesh_attributes const& attributes = {},
               write_ply_options const& options = {}) {
    detail::write_file("write_ply", path, encode_ply(mesh, attributes, options));
}

}  // namespace tafoni

#endif
