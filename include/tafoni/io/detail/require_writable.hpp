/// \file
/// What every writer checks before it writes a byte.
#ifndef TAFONI_IO_DETAIL_REQUIRE_WRITABLE_HPP
#define TAFONI_IO_DETAIL_REQUIRE_WRITABLE_HPP

#include <tafoni/geometry/concepts.hpp>
#include <tafoni/io/detail/ply_header.hpp>
#include <tafoni/io/detail/source_text.hpp>
#include <tafoni/io/mesh_file.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace tafoni::detail {

inline void require_finite_vertex(char const* who, vec3 const& p, std::size_t vertex) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(p[axis])) {
            fail<invalid_input>(errc::non_finite_vertex,
                                std::string(who) + ": expected finite coordinates, got " + number_text(p[axis]) +
                                    " in " + "xyz"[axis] + " of vertex " + std::to_string(vertex),
                                {.kind = entity::vertex, .index = vertex, .value = p[axis]});
        }
    }
}

/// Also refuses what float cannot hold once the origin is subtracted.
inline void require_float_vertex(char const* who, vec3 const& p, vec3 const& origin, std::size_t vertex) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(static_cast<float>(p[axis] - origin[axis]))) {
            fail<io_error>(errc::format_limit,
                           std::string(who) + ": coordinate " + number_text(p[axis]) + " of vertex " +
                               std::to_string(vertex) + " does not fit float",
                           {.kind = entity::vertex, .index = vertex, .value = p[axis], .limit = 3.4028234663852886e38});
        }
    }
}

inline void require_channels(char const* who, std::vector<mesh_channel> const& channels, std::size_t count,
                             char const* of) {
    auto const refuse = [&](errc code, mesh_channel const& c, std::string const& what, double value) {
        fail<invalid_input>(code, std::string(who) + ": " + of + " channel '" + c.name + "' " + what,
                            {.kind = entity::attribute, .value = value});
    };
    for (std::size_t k = 0; k < channels.size(); ++k) {
        mesh_channel const& c = channels[k];
        if (c.values.size() != count) {
            refuse(errc::attribute_length, c,
                   "has " + std::to_string(c.values.size()) + " values, expected " + std::to_string(count),
                   static_cast<double>(c.values.size()));
        }
        bool plain = !c.name.empty();
        for (char const ch : c.name) plain = plain && !is_space(ch);
        if (!plain) refuse(errc::bad_parameter, c, "needs a name without white space", 0);
        for (std::size_t other = 0; other < k; ++other) {
            if (channels[other].name == c.name) refuse(errc::bad_parameter, c, "is there twice", 0);
        }
        if (c.type == channel_type::float64) continue;
        for (double const v : c.values) {
            bool const fits = is_integer(c.type)
                                  ? v >= range_of(c.type).lo && v <= range_of(c.type).hi && v == std::floor(v)
                                  : !std::isfinite(v) || std::isfinite(static_cast<float>(v));
            if (!fits) refuse(errc::bad_parameter, c, "holds " + number_text(v) + ", which its type cannot", v);
        }
    }
}

inline void require_corner_list(char const* who, std::vector<std::uint32_t> const& list, std::size_t corners,
                                std::size_t limit, char const* what) {
    if (!list.empty() && list.size() != corners) {
        fail<invalid_input>(errc::attribute_length,
                            std::string(who) + ": " + what + " has " + std::to_string(list.size()) +
                                " entries, expected " + std::to_string(corners),
                            {.kind = entity::attribute});
    }
    for (std::size_t c = 0; c < list.size(); ++c) {
        if (list[c] != mesh_attributes::none && list[c] >= limit) {
            fail<invalid_input>(errc::index_out_of_range,
                                std::string(who) + ": " + what + " of corner " + std::to_string(c) + " is " +
                                    std::to_string(list[c]) + " of " + std::to_string(limit),
                                {.kind = entity::corner, .index = c, .value = double(list[c]), .limit = double(limit) - 1});
        }
    }
}

/// Checks the mesh and its channels; returns the number of corners. O(vertices + corners + values).
template <polygon_mesh M>
std::size_t require_writable(char const* who, M const& mesh, mesh_attributes const& attributes) {
    using access = mesh_access<M>;
    std::size_t const vertices = access::vertex_count(mesh);
    std::size_t const faces = access::face_count(mesh);
    for (std::size_t v = 0; v < vertices; ++v) require_finite_vertex(who, access::position(mesh, v), v);
    std::size_t corners = 0;
    for (std::size_t f = 0; f < faces; ++f) {
        std::size_t const n = access::face_size(mesh, f);
        if (n < 3) {
            fail<invalid_input>(errc::degenerate_face,
                                std::string(who) + ": face " + std::to_string(f) + " has " + std::to_string(n) +
                                    " corners, expected at least 3",
                                {.kind = entity::face, .index = f, .value = static_cast<double>(n), .limit = 3});
        }
        for (std::size_t k = 0; k < n; ++k) {
            std::uint64_t const v = access::corner(mesh, f, k);
            if (v >= vertices) {
                fail<invalid_input>(errc::index_out_of_range,
                                    std::string(who) + ": corner " + std::to_string(k) + " of face " + std::to_string(f) +
                                        " is vertex " + std::to_string(v) + " of " + std::to_string(vertices),
                                    {.kind = entity::face, .index = f, .value = static_cast<double>(v),
                                     .limit = static_cast<double>(vertices) - 1});
            }
        }
        corners += n;
    }
    require_channels(who, attributes.vertex_channels, vertices, "vertex");
    require_channels(who, attributes.face_channels, faces, "face");
    return corners;
}

}  // namespace tafoni::detail

#endif
