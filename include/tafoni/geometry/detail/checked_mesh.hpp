/// \file
/// The door for every foreign mesh: reads it once, with 64-bit checks, into our own arrays.
#ifndef TAFONI_GEOMETRY_DETAIL_CHECKED_MESH_HPP
#define TAFONI_GEOMETRY_DETAIL_CHECKED_MESH_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/geometry/indexed_mesh.hpp>

#include <cmath>
#include <limits>
#include <string>

namespace tafoni::detail {

/// Throws `non_finite_vertex` for the first coordinate that is NaN or infinite. O(vertices).
template <polygon_mesh M>
void require_finite_vertices(char const* who, M const& mesh) {
    using access = mesh_access<M>;
    std::size_t const n = access::vertex_count(mesh);
    for (std::size_t v = 0; v < n; ++v) {
        vec3 const p = access::position(mesh, v);
        for (int axis = 0; axis < 3; ++axis) {
            if (std::isfinite(p[axis])) continue;
            fail<invalid_input>(errc::non_finite_vertex,
                                std::string(who) + ": vertex " + std::to_string(v) + " has " + "xyz"[axis] + " = " +
                                    number_text(p[axis]),
                                {.kind = entity::vertex, .index = v, .value = p[axis]});
        }
    }
}

/// Copies the mesh. Vertices are checked to be finite and corners to name a vertex, nothing else.
/// \throws invalid_input  non_finite_vertex, index_out_of_range (place: the face), size_overflow. O(n).
template <polygon_mesh M>
[[nodiscard]] indexed_mesh checked_copy(char const* who, M const& mesh) {
    using access = mesh_access<M>;
    std::size_t const vertices = access::vertex_count(mesh);
    std::size_t const faces = access::face_count(mesh);
    require_indexable(who, vertices);
    require_indexable(who, faces);
    require_finite_vertices(who, mesh);

    indexed_mesh copy;
    copy.positions.reserve(vertices);
    for (std::size_t v = 0; v < vertices; ++v) copy.positions.push_back(access::position(mesh, v));
    copy.offsets.reserve(faces + 1);
    copy.corners.reserve(3 * faces);
    for (std::size_t f = 0; f < faces; ++f) {
        std::size_t const n = access::face_size(mesh, f);
        for (std::size_t k = 0; k < n; ++k) {
            std::uint64_t const v = access::corner(mesh, f, k);
            if (v >= vertices) {
                fail<invalid_input>(errc::index_out_of_range,
                                    std::string(who) + ": corner " + std::to_string(k) + " of face " +
                                        std::to_string(f) + " names vertex " + std::to_string(v) + ", there are " +
                                        std::to_string(vertices),
                                    {.kind = entity::face,
                                     .index = f,
                                     .value = static_cast<double>(v),
                                     .limit = static_cast<double>(vertices) - 1});
            }
            copy.corners.push_back(static_cast<std::uint32_t>(v));
        }
        require_indexable(who, copy.corners.size());
        copy.offsets.push_back(copy.corners.size());
    }
    return copy;
}

/// Throws `degenerate_face` for the first face with fewer than three corners or a vertex twice. O(n).
inline void require_proper_faces(char const* who, indexed_mesh const& mesh) {
    std::vector<std::uint32_t> seen_in(mesh.vertex_count(), std::numeric_limits<std::uint32_t>::max());
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        auto const loop = mesh.face(f);
        if (loop.size() < 3) {
            fail<invalid_input>(errc::degenerate_face,
                                std::string(who) + ": face " + std::to_string(f) + " has " +
                                    std::to_string(loop.size()) + " corners, at least 3 are needed",
                                {.kind = entity::face,
                                 .index = f,
                                 .value = static_cast<double>(loop.size()),
                                 .limit = 3});
        }
        for (std::uint32_t const v : loop) {
            if (seen_in[v] == f) {
                fail<invalid_input>(errc::degenerate_face,
                                    std::string(who) + ": face " + std::to_string(f) + " has vertex " +
                                        std::to_string(v) + " twice",
                                    {.kind = entity::face, .index = f, .value = static_cast<double>(v)});
            }
            seen_in[v] = static_cast<std::uint32_t>(f);
        }
    }
}

}  // namespace tafoni::detail

#endif
