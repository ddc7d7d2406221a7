/// \file
/// How long the edges of a surface are, and whether those that are too short may go.
#ifndef TAFONI_WEATHERING_DETAIL_EDGE_LENGTHS_HPP
#define TAFONI_WEATHERING_DETAIL_EDGE_LENGTHS_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/curvature/detail/corner_sums.hpp>
#include <tafoni/geometry/vertex_rings.hpp>
#include <tafoni/repair/detail/edge_collapser.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tafoni::detail {

struct edge_lengths {
    double mean = 0;  ///< each edge counted once; 0 without edges
    double shortest = std::numeric_limits<double>::infinity();
    std::vector<double> shortest_of_block{};  ///< by the block of its lower end
};

/// Sums over blocks of one size, so that they do not depend on threads. O(edges).
template <executor Executor>
[[nodiscard]] edge_lengths measure_edges(std::span<vec3 const> positions, vertex_rings const& rings, Executor const& threads) {
    struct edge_sum {
        double sum = 0;
        std::size_t edges = 0;
    };
    std::size_t const n = positions.size();
    std::vector<edge_sum> parts((n + vertex_grain - 1) / vertex_grain);
    edge_lengths all;
    all.shortest_of_block.assign(parts.size(), all.shortest);
    threads.for_blocks(n, vertex_grain, [&](std::size_t begin, std::size_t end) {
        edge_sum p;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t v = begin; v < end; ++v) {
            vec3 const at = positions[v];
            for (std::uint32_t const w : rings.neighbors(v)) {
                if (w < v) continue;
                double const l = length(positions[w] - at);
                p.sum += l;
                least = std::min(least, l);
                ++p.edges;
            }
        }
        parts[begin / vertex_grain] = p;
        all.shortest_of_block[begin / vertex_grain] = least;
    });
    edge_sum whole;
    for (edge_sum const& p : parts) {
        whole.sum += p.sum;
        whole.edges += p.edges;
    }
    for (double const l : all.shortest_of_block) all.shortest = std::min(all.shortest, l);
    all.mean = whole.edges > 0 ? whole.sum / static_cast<double>(whole.edges) : 0.0;
    return all;
}

/// All edges shorter than `limit`. O(vertices of the blocks that hold some).
[[nodiscard]] inline std::vector<short_edge> edges_below(edge_lengths const& edges, double limit,
                                                         std::span<vec3 const> positions, vertex_rings const& rings) {
    std::vector<short_edge> found;
    for (std::size_t b = 0; b < edges.shortest_of_block.size(); ++b) {
        if (!(edges.shortest_of_block[b] <= limit)) continue;  // squares are compared, which may round otherwise
        find_short_edges(positions, rings, limit * limit, b * vertex_grain, std::min((b + 1) * vertex_grain, positions.size()), found);
    }
    return found;
}

/// Whether one of `found` may be collapsed, none at a vertex that `fixed`, if not empty, flags.
[[nodiscard]] inline bool any_may_collapse(std::span<short_edge const> found, std::span<vec3 const> positions,
                                           std::span<std::array<std::uint32_t, 3> const> triangles, vertex_rings const& rings,
                                           std::span<unsigned char const> fixed = {}) {
    collapse_rules rules(positions, triangles, rings);
    return std::any_of(found.begin(), found.end(), [&](short_edge const& e) {
        return (fixed.empty() || (fixed[e.ends[0]] | fixed[e.ends[1]]) == 0) && rules.target(e.ends[0], e.ends[1]);
    });
}

}  // namespace tafoni::detail

#endif
