/// \file
/// Counts what a mesh is made of and what is wrong with it, without refusing anything.
#ifndef TAFONI_GEOMETRY_INSPECT_MESH_HPP
#define TAFONI_GEOMETRY_INSPECT_MESH_HPP

#include <tafoni/geometry/detail/checked_mesh.hpp>
#include <tafoni/geometry/detail/edge_faults.hpp>
#include <tafoni/geometry/detail/split_fans.hpp>

namespace tafoni {

/// What `inspect_mesh` counted. Where `non_finite_vertices` or `bad_corners` is not 0, and for the edges
/// also where `degenerate_faces` is not 0, what comes after it is not counted and stays 0.
struct inspect_report {
    std::size_t vertices = 0;
    std::size_t faces = 0;
    std::size_t non_finite_vertices = 0;
    std::size_t bad_corners = 0;             ///< that name no vertex
    std::size_t polygons = 0;                ///< faces of more than three corners
    std::size_t triangles = 0;               ///< after cutting the polygons
    std::size_t unused_vertices = 0;         ///< that no face names
    std::size_t degenerate_faces = 0;        ///< fewer than three corners, or a vertex twice
    std::size_t edges = 0;
    std::size_t duplicate_faces = 0;         ///< with the outline of an earlier one
    std::size_t open_edges = 0;              ///< of one face
    std::size_t boundary_loops = 0;          ///< connected runs of open edges
    std::size_t crowded_edges = 0;           ///< of more than two faces
    std::size_t inconsistent_edges = 0;      ///< of two faces that run the same way
    std::size_t nonmanifold_vertices = 0;    ///< where several fans of faces touch
    std::size_t shells = 0;                  ///< sets of faces that hang together through edges
    bool orientable = true;                  ///< faces can be turned to agree along edges of two faces
    std::int64_t euler = 0;                  ///< used vertices - edges + faces

    /// Every edge joins two faces that run in opposite directions, and no face occurs twice.
    [[nodiscard]] bool closed() const noexcept {
        return faces > 0 && non_finite_vertices + bad_corners + degenerate_faces + duplicate_faces + open_edges +
                                    crowded_edges + inconsistent_edges == 0;
    }
};

/// Counts elements and faults. \throws invalid_input  size_overflow only. O(n log d), d edges at a vertex.
template <polygon_mesh M>
[[nodiscard]] inspect_report inspect_mesh(M const& mesh) {
    using access = mesh_access<M>;
    inspect_report r;
    r.vertices = access::vertex_count(mesh);
    r.faces = access::face_count(mesh);
    for (std::size_t v = 0; v < r.vertices; ++v) r.non_finite_vertices += is_finite(access::position(mesh, v)) ? 0U : 1U;
    for (std::size_t f = 0; f < r.faces; ++f) {
        std::size_t const n = access::face_size(mesh, f);
        for (std::size_t k = 0; k < n; ++k) r.bad_corners += access::corner(mesh, f, k) < r.vertices ? 0U : 1U;
    }
    if (r.non_finite_vertices + r.bad_corners > 0) return r;

    indexed_mesh copy = detail::checked_copy("inspect_mesh", mesh);
    std::vector<std::uint32_t> seen_in(r.vertices, face_index::none);
    for (std::uint32_t f = 0; f < r.faces; ++f) {
        auto const loop = copy.face(f);
        bool twice = false;
        for (std::uint32_t const v : loop) {
            twice = twice || seen_in[v] == f;
            seen_in[v] = f;
        }
        r.degenerate_faces += twice || loop.size() < 3 ? 1U : 0U;
        r.polygons += loop.size() > 3 ? 1U : 0U;
        r.triangles += loop.size() > 2 ? loop.size() - 2 : 0U;
    }
    for (std::uint32_t const f : seen_in) r.unused_vertices += f == face_index::none ? 1U : 0U;
    if (r.degenerate_faces > 0) return r;

    std::vector<std::uint32_t> across(copy.corners.size(), face_index::none);
    {
        detail::edge_table const edges(copy);
        detail::edge_faults const faults = detail::find_edge_faults(edges, r.vertices, across);
        r.duplicate_faces = detail::duplicate_faces(copy, edges).size();
        r.open_edges = faults.open.size();
        r.boundary_loops = faults.boundary_loops;
        r.crowded_edges = faults.crowded.size();
        r.inconsistent_edges = faults.same_way.size();
        r.orientable = !detail::cannot_be_oriented(copy, edges);
        detail::disjoint_sets shells(r.faces);
        edges.for_each_edge([&](std::uint32_t, std::span<detail::edge_table::side const> sides) {
            ++r.edges;
            for (auto const s : sides) shells.join(edges.face_of(sides[0].corner), edges.face_of(s.corner));
        });
        for (std::uint32_t f = 0; f < r.faces; ++f) r.shells += shells.root(f) == f ? 1U : 0U;
    }
    auto const old_of = detail::split_fans(copy, across);
    std::vector<std::uint8_t> split(r.vertices, 0);
    for (std::size_t v = r.vertices; v < old_of.size(); ++v) split[old_of[v]] = 1;
    for (std::uint8_t const s : split) r.nonmanifold_vertices += s;
    r.euler = static_cast<std::int64_t>(r.vertices - r.unused_vertices) - static_cast<std::int64_t>(r.edges) +
              static_cast<std::int64_t>(r.faces);
    return r;
}

}  // namespace tafoni

#endif
