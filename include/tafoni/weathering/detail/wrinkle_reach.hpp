/// \file
/// The vertices around a path that hang together with it.
#ifndef TAFONI_WEATHERING_DETAIL_WRINKLE_REACH_HPP
#define TAFONI_WEATHERING_DETAIL_WRINKLE_REACH_HPP

#include <tafoni/core/index.hpp>
#include <tafoni/geometry/triangle_surface.hpp>
#include <tafoni/geometry/vertex_rings.hpp>

#include <algorithm>
#include <cstddef>
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

/// Vertices nearer than `radius` to an edge of the path that hang together with that edge through such vertices,
/// ascending, with the least such distance: the other side of a thin wall stays as it is, and where a path turns back
/// or crosses itself the nearer part counts. A path of one vertex is a point.
/// O(vertices + sum over the path's edges of the vertices near it).
[[nodiscard]] inline std::vector<reached_vertex> reach_of_path(triangle_surface const& s, vertex_rings const& rings,
                                                               std::span<vertex_index const> path, double radius) {
    std::vector<reached_vertex> found;
    std::vector<double> least(s.positions.size(), -1);
    std::vector<std::uint32_t> last(s.positions.size(), vertex_index::none);  // edge of the path that it was asked about
    std::vector<std::uint32_t> front;
    std::size_t const edges = path.size() > 1 ? path.size() - 1 : path.size();
    for (std::size_t e = 0; e < edges; ++e) {
        std::uint32_t const a = path[e].value;
        std::uint32_t const b = path[std::min(e + 1, path.size() - 1)].value;
        front.clear();
        auto const ask = [&](std::uint32_t v) {
            if (last[v] == e) return;
            last[v] = static_cast<std::uint32_t>(e);
            double const d = distance_to_segment(s.positions[v], s.positions[a], s.positions[b]);
            if (!(d < radius)) return;
            front.push_back(v);
            if (least[v] < 0) found.push_back({.vertex = v});
            if (least[v] < 0 || d < least[v]) least[v] = d;
        };
        ask(a);
        for (std::size_t k = 0; k < front.size(); ++k) {
            for (std::uint32_t const w : rings.neighbors(front[k])) ask(w);
        }
    }
    for (reached_vertex& f : found) f.distance = least[f.vertex];
    std::sort(found.begin(), found.end(), [](reached_vertex const& x, reached_vertex const& y) { return x.vertex < y.vertex; });
    return found;
}

}  // namespace tafoni::detail

#endif
