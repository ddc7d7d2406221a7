/// \file
/// Vertices that are held still because triangles cut each other where they moved.
#ifndef TAFONI_WEATHERING_DETAIL_HELD_VERTICES_HPP
#define TAFONI_WEATHERING_DETAIL_HELD_VERTICES_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/geometry/self_intersections.hpp>
#include <tafoni/geometry/triangle_surface.hpp>
#include <tafoni/weathering/curvature_checkpoint.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tafoni::detail {

using triangle_pair = std::array<std::uint32_t, 2>;

/// |H| of the vertices that are not held; `held` may be empty.
/// \throws invalid_input  `out_of_range` with the first vertex whose curvature is not finite. O(vertices).
[[nodiscard]] inline double largest_curvature(std::span<double const> h, std::span<unsigned char const> held) {
    double largest = 0;
    bool finite = true;
    for (double const x : h) {
        finite = finite && std::fabs(x) <= std::numeric_limits<double>::max();  // the maximum below passes over NaN
        largest = std::max(largest, std::fabs(x));
    }
    if (!finite) {
        auto const bad = std::find_if(h.begin(), h.end(), [](double x) { return !std::isfinite(x); });
        auto const v = static_cast<std::size_t>(bad - h.begin());
        fail<invalid_input>(errc::out_of_range, "curvature_run: the estimator's curvature at vertex " + std::to_string(v) +
                                                    " is not finite, got " + std::to_string(h[v]),
                            {.kind = entity::vertex, .index = v});
    }
    if (held.empty()) return largest;
    largest = 0;
    for (std::size_t v = 0; v < h.size(); ++v) largest = held[v] != 0 ? largest : std::max(largest, std::fabs(h[v]));
    return largest;
}

/// Those of `cuts`, pairs of triangles of `now`, that do not cut each other in `before`. O(n log n).
[[nodiscard]] inline std::vector<triangle_pair> cuts_since(curvature_state const& before, std::vector<triangle_pair> cuts,
                                                           triangle_surface const& now, std::span<vertex_index const> new_vertex) {
    std::vector<std::uint32_t> went(before.surface.positions.size(), 0);
    for (std::size_t v = 0; v < new_vertex.size(); ++v) went[before.new_vertex[v].value] = new_vertex[v].value;
    using corners = std::array<std::uint32_t, 3>;
    auto const ascending = [](std::array<corners, 2> two) {
        for (corners& c : two) std::sort(c.begin(), c.end());
        if (two[1] < two[0]) std::swap(two[0], two[1]);
        return two;
    };
    std::vector<std::array<corners, 2>> old;
    for (triangle_pair const& pair : self_intersections(before.surface.positions, before.surface.triangles)) {
        std::array<corners, 2> two{before.surface.triangles[pair[0]], before.surface.triangles[pair[1]]};
        for (corners& c : two) {
            for (std::uint32_t& v : c) v = went[v];
        }
        old.push_back(ascending(two));
    }
    std::sort(old.begin(), old.end());
    std::erase_if(cuts, [&](triangle_pair const& pair) {
        return std::binary_search(old.begin(), old.end(), ascending({now.triangles[pair[0]], now.triangles[pair[1]]}));
    });
    return cuts;
}

/// What is held in `before`, an earlier state, with what has become a corner of `cuts` since, pairs of triangles of `now`,
/// and what lies within `rings` edges of these. `new_vertex`: vertex of the input -> vertex now. `some_before`: some
/// triangles may have cut each other in `before`, which is no reason to hold them. O(rings * faces), or O(n log n) then.
[[nodiscard]] inline std::vector<unsigned char> held_around(std::vector<triangle_pair> cuts, std::uint64_t rings,
                                                            triangle_surface const& now, std::span<vertex_index const> new_vertex,
                                                            curvature_state const& before, bool some_before) {
    if (some_before) cuts = cuts_since(before, std::move(cuts), now, new_vertex);
    std::vector<unsigned char> marked(now.positions.size(), 0);
    for (triangle_pair const& pair : cuts) {
        for (std::uint32_t const f : pair) {
            for (std::uint32_t const v : now.triangles[f]) marked[v] = 1;
        }
    }
    for (std::uint64_t ring = 0; ring < rings; ++ring) {
        std::vector<unsigned char> wider = marked;
        for (auto const& t : now.triangles) {
            if (marked[t[0]] + marked[t[1]] + marked[t[2]] == 0) continue;
            for (std::uint32_t const v : t) wider[v] = 1;
        }
        marked = std::move(wider);
    }
    std::vector<unsigned char> held = before.held;
    held.resize(before.surface.positions.size(), 0);
    for (std::size_t v = 0; v < new_vertex.size(); ++v) {
        if (marked[new_vertex[v].value] != 0) held[before.new_vertex[v].value] = 1;
    }
    return held;
}

}  // namespace tafoni::detail

#endif
