/// \file
/// The vertices around a path that hang together with it.
#ifndef TAFONI_WEATHERING_DETAIL_WRINKLE_REACH_HPP
#define TAFONI_WEATHERING_DETAIL_WRINKLE_REACH_HPP

#include <tafoni/core/index.hpp>
#include <tafoni/geometry/triangle_surface.hpp>
#include <tafoni/geometry/vertex_rings.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

struct reached_vertex {
    std::uint32_t vertex = 0;
    double distance = 0;  ///< to the polyline through the path's vertices
};

[[nodiscard]] inline double distance_to_segment(vec3 const& p, vec3 const& a, vec3 const& b) noexcept {
    vec3 const d{b - a};
    vec3 const e{p - a};
    double const l = squared_length(d);
    double const t = l > 0 ? std::clamp(dot(e, d) / l, 0.0, 1.0) : 0.0;
    return length(vec3{e[0] - t * d[0], e[1] - t * d[1], e[2] - t * d[2]});
}

/// Vertices nearer than `radius` to the path that hang together with it through such vertices, ascending: the other
/// side of a thin wall stays as it is. O(vertices of the region x path vertices near them).
[[nodiscard]] inline std::vector<reached_vertex> reach_of_path(triangle_surface const& s, vertex_rings const& rings,
                                                               std::span<vertex_index const> path, double radius) {
    // Sections of the path within a ball of two radii about a vertex are found by the length along the path.
    std::vector<reached_vertex> found;
    std::vector<std::uint32_t> nearest(s.positions.size(), vertex_index::none);  // place on the path
    std::vector<double> distance(s.positions.size(), -1);
    auto const measure = [&](std::uint32_t v, std::size_t from) {
        // Down the path from the neighbour's place in both directions, as long as it comes nearer or may.
        double best = length(s.positions[v] - s.positions[path[from].value]);
        std::size_t place = from;
        auto const look = [&](std::size_t k) {
            double const d = k + 1 < path.size()
                                 ? distance_to_segment(s.positions[v], s.positions[path[k].value], s.positions[path[k + 1].value])
                                 : length(s.positions[v] - s.positions[path[k].value]);
            if (d < best) {
                best = d;
                place = k;
            }
            return d <= best + radius;
        };
        for (std::size_t k = from; k < path.size() && look(k); ++k) {}
        for (std::size_t k = from; k-- > 0 && look(k);) {}
        distance[v] = best;
        nearest[v] = static_cast<std::uint32_t>(place);
    };
    std::vector<std::uint32_t> front;
    for (std::size_t k = 0; k < path.size(); ++k) {
        std::uint32_t const v = path[k].value;
        if (distance[v] >= 0) continue;
        distance[v] = 0;
        nearest[v] = static_cast<std::uint32_t>(k);
        front.push_back(v);
    }
    for (std::size_t k = 0; k < front.size(); ++k) {
        std::uint32_t const v = front[k];
        found.push_back({v, distance[v]});
        for (std::uint32_t const w : rings.neighbors(v)) {
            if (distance[w] >= 0) continue;
            measure(w, nearest[v]);
            if (distance[w] < radius) front.push_back(w);
        }
    }
    std::sort(found.begin(), found.end(), [](reached_vertex const& a, reached_vertex const& b) { return a.vertex < b.vertex; });
    return found;
}

}  // namespace tafoni::detail

#endif
