/// \file
/// Gives every fan of faces its own copy of a vertex at which several of them touch.
#ifndef TAFONI_GEOMETRY_DETAIL_SPLIT_FANS_HPP
#define TAFONI_GEOMETRY_DETAIL_SPLIT_FANS_HPP

#include <tafoni/geometry/detail/edge_table.hpp>

#include <cstdint>
#include <limits>
#include <vector>

namespace tafoni::detail {

/// Renames corners so that the faces around each vertex hang together through paired sides.
///
/// `across` names for each side the one across its edge, or the largest number for none. The fan of a
/// vertex's lowest corner keeps the number; copies are appended by their lowest corner. Returns the old
/// vertex of every new one. O(corners).
inline std::vector<std::uint32_t> split_fans(indexed_mesh& mesh, std::vector<std::uint32_t> const& across) {
    constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    std::size_t const n = mesh.corners.size();
    std::vector<std::uint32_t> next(n);
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        for (std::size_t c = mesh.offsets[f]; c < mesh.offsets[f + 1]; ++c) {
            next[c] = static_cast<std::uint32_t>(c + 1 == mesh.offsets[f + 1] ? mesh.offsets[f] : c + 1);
        }
    }
    disjoint_sets fans(n);
    for (std::uint32_t c = 0; c < n; ++c) {
        if (across[c] == none || across[c] < c) continue;
        fans.join(c, next[across[c]]);
        fans.join(next[c], across[c]);
    }
    std::vector<std::uint32_t> old_of(mesh.vertex_count());
    for (std::uint32_t v = 0; v < old_of.size(); ++v) old_of[v] = v;
    std::vector<std::uint8_t> taken(mesh.vertex_count(), 0);
    std::vector<std::uint32_t> name(n, none);
    for (std::uint32_t c = 0; c < n; ++c) {
        std::uint32_t const v = mesh.corners[c];
        std::uint32_t const root = fans.root(c);
        if (root == c) {
            if (taken[v]) {
                name[c] = mesh.add_vertex(vec3{mesh.positions[v]}).value;
                old_of.push_back(v);
            } else {
                taken[v] = 1;
                name[c] = v;
            }
        } else {
            name[c] = name[root];
        }
    }
    mesh.corners = std::move(name);
    return old_of;
}

}  // namespace tafoni::detail

#endif
