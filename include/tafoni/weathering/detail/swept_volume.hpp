/// \file
/// The volume between a surface before and after its vertices moved.
#ifndef TAFONI_WEATHERING_DETAIL_SWEPT_VOLUME_HPP
#define TAFONI_WEATHERING_DETAIL_SWEPT_VOLUME_HPP

#include <tafoni/core/vector.hpp>
#include <tafoni/geometry/triangle_surface.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// 36 times the volume that a triangle sweeps by the way of one corner is this times that way; its corners go straight from
/// `was` to `now`. O(1).
[[nodiscard]] inline vec3 swept_areas(std::array<std::uint32_t, 3> const& t, std::span<vec3 const> was, std::span<vec3 const> now) noexcept {
    // Simpson's rule is exact: the area vector is quadratic in time.
    vec3 const b0{was[t[1]] - was[t[0]]};
    vec3 const c0{was[t[2]] - was[t[0]]};
    vec3 const b1{now[t[1]] - now[t[0]]};
    vec3 const c1{now[t[2]] - now[t[0]]};
    return cross(b0, c0) + cross(vec3{b0 + b1}, vec3{c0 + c1}) + cross(b1, c1);
}

/// The largest volume that a vertex of the surface sweeps per length of its way: a third of the triangles' area around it.
/// O(vertices + faces).
[[nodiscard]] inline double largest_sweep(triangle_surface const& s) {
    std::vector<double> around(s.positions.size(), 0.0);
    double largest = 0;
    for (auto const& t : s.triangles) {
        vec3 const& a = s.positions[t[0]];
        double const twice = length(cross(vec3{s.positions[t[1]] - a}, vec3{s.positions[t[2]] - a}));
        for (std::uint32_t const v : t) largest = std::max(largest, around[v] += twice);
    }
    return largest / 6;
}

}  // namespace tafoni::detail

#endif
