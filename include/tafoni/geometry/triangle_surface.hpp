/// \file
/// Triangles as flat arrays, open or closed: what the processes on meshes move.
#ifndef TAFONI_GEOMETRY_TRIANGLE_SURFACE_HPP
#define TAFONI_GEOMETRY_TRIANGLE_SURFACE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/geometry/concepts.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tafoni {

/// Positions and triangles, counter-clockwise seen from outside. Need not be closed or manifold. Models `triangle_mesh`.
struct triangle_surface {
    std::vector<vec3> positions{};
    std::vector<std::array<std::uint32_t, 3>> triangles{};

    /// A copy of any mesh of triangles; vertices and faces keep their numbers. O(vertices + faces).
    /// \throws invalid_input  `non_finite_vertex`, `index_out_of_range`, `size_overflow`; `unsupported` with the first
    ///         face that is no triangle: `triangulate` makes some of it.
    template <polygon_mesh M>
    static triangle_surface copy_of(M const& mesh) {
        using access = mesh_access<M>;
        triangle_surface s;
        std::size_t const n = access::vertex_count(mesh);
        std::size_t const f = access::face_count(mesh);
        detail::require_indexable("triangle_surface: vertices", n);
        detail::require_indexable("triangle_surface: faces", f);
        s.positions.reserve(n);
        for (std::size_t v = 0; v < n; ++v) s.positions.push_back(access::position(mesh, v));
        s.triangles.reserve(f);
        for (std::size_t t = 0; t < f; ++t) {
            if constexpr (!triangle_mesh<M>) {
                std::size_t const size = access::face_size(mesh, t);
                if (size != 3) {
                    detail::fail<invalid_input>(errc::unsupported,
                                                "triangle_surface: face " + std::to_string(t) + " has " +
                                                    std::to_string(size) + " corners; triangulate the mesh first",
                                                {.kind = entity::face, .index = t, .value = static_cast<double>(size),
                                                 .limit = 3});
                }
            }
            std::array<std::uint32_t, 3> corners{};
            for (std::size_t k = 0; k < 3; ++k) {
                std::uint64_t const c = access::corner(mesh, t, k);
                if (c >= n) {
                    detail::fail<invalid_input>(errc::index_out_of_range,
                                                "triangle_surface: face " + std::to_string(t) + " corner " +
                                                    std::to_string(k) + " is vertex " + std::to_string(c) + " of " +
                                                    std::to_string(n),
                                                {.kind = entity::face, .index = t, .value = static_cast<double>(c),
                                                 .limit = static_cast<double>(n)});
                }
                corners[k] = static_cast<std::uint32_t>(c);
            }
            s.triangles.push_back(corners);
        }
        s.validate();
        return s;
    }

    /// \throws invalid_input  `non_finite_vertex`, `index_out_of_range`. O(vertices + faces).
    void validate() const {
        for (std::size_t v = 0; v < positions.size(); ++v) {
            if (!is_finite(positions[v])) {
                detail::fail<invalid_input>(errc::non_finite_vertex,
                                            "triangle_surface: vertex " + std::to_string(v) + " is not finite",
                                            {.kind = entity::vertex, .index = v});
            }
        }
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            for (std::uint32_t const c : triangles[t]) {
                if (c >= positions.size()) {
                    detail::fail<invalid_input>(errc::index_out_of_range,
                                                "triangle_surface: face " + std::to_string(t) + " names vertex " +
                                                    std::to_string(c) + " of " + std::to_string(positions.size()),
                                                {.kind = entity::face, .index = t, .value = static_cast<double>(c),
                                                 .limit = static_cast<double>(positions.size())});
                }
            }
        }
    }

    /// Mean length of the triangles' sides, each triangle counting its three; 0 without triangles. O(faces), fixed order.
    [[nodiscard]] double mean_edge_length() const {
        double sum = 0;
        for (auto const& t : triangles) {
            sum += length(positions[t[1]] - positions[t[0]]);
            sum += length(positions[t[2]] - positions[t[1]]);
            sum += length(positions[t[0]] - positions[t[2]]);
        }
        return triangles.empty() ? 0.0 : sum / (3.0 * static_cast<double>(triangles.size()));
    }

    friend bool operator==(triangle_surface const&, triangle_surface const&) = default;
};

template <>
struct mesh_access<triangle_surface> {
    static constexpr std::size_t corners_per_face = 3;
    static std::size_t vertex_count(triangle_surface const& m) { return m.positions.size(); }
    static vec3 position(triangle_surface const& m, std::size_t v) { return m.positions[v]; }
    static std::size_t face_count(triangle_surface const& m) { return m.triangles.size(); }
    static std::size_t face_size(triangle_surface const&, std::size_t) { return 3; }
    static std::uint64_t corner(triangle_surface const& m, std::size_t f, std::size_t k) { return m.triangles[f][k]; }
};

static_assert(triangle_mesh<triangle_surface>);

}  // namespace tafoni

#endif
