/// \file
/// The neighbours of a border vertex along the border.
#ifndef TAFONI_WEATHERING_DETAIL_BORDER_NEIGHBORS_HPP
#define TAFONI_WEATHERING_DETAIL_BORDER_NEIGHBORS_HPP

#include <tafoni/geometry/vertex_rings.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// Neighbours of `v` by an edge of one triangle, ascending; at least one at a border vertex. Their mean lies where the
/// border leads: a terrain that wears by it keeps its outline, where the mean of all neighbours would eat it from its
/// borders inwards. O(k log k) for k triangles at the vertex; `scratch` holds the answer.
[[nodiscard]] inline std::span<std::uint32_t const> neighbors_along_border(
    vertex_rings const& rings, std::span<std::array<std::uint32_t, 3> const> triangles, std::size_t v,
    std::vector<std::uint32_t>& scratch) {
    scratch.clear();
    for (auto const& c : rings.faces(v)) {
        scratch.push_back(triangles[c.face][(c.place + 1) % 3]);
        scratch.push_back(triangles[c.face][(c.place + 2) % 3]);
    }
    std::sort(scratch.begin(), scratch.end());
    std::size_t kept = 0;
    for (std::size_t k = 0; k < scratch.size();) {
        std::size_t e = k + 1;
        while (e < scratch.size() && scratch[e] == scratch[k]) ++e;
        if (e - k == 1) scratch[kept++] = scratch[k];
        k = e;
    }
    return {scratch.data(), kept};
}

}  // namespace tafoni::detail

#endif
