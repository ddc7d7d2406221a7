/// \file
/// How often a closed surface goes around a point, as an exact whole number.
#ifndef TAFONI_GEOMETRY_WINDING_NUMBER_HPP
#define TAFONI_GEOMETRY_WINDING_NUMBER_HPP

#include <tafoni/geometry/detail/exact_sign.hpp>
#include <tafoni/geometry/solid.hpp>

#include <algorithm>

namespace tafoni {

namespace detail {

/// What one triangle adds to the winding number of p: the signed crossing of the ray from p along +z.
///
/// The triangle is seen along z; p counts as slightly shifted, so that of two triangles that share an
/// edge or a vertex under p exactly the right ones count. Exact; a point on the triangle counts as below it.
[[nodiscard]] inline int upward_crossing(vec3 const& a, vec3 const& b, vec3 const& c, vec3 const& p) noexcept {
    if (p[2] > a[2] && p[2] > b[2] && p[2] > c[2]) return 0;
    auto const edge = [&](vec3 const& u, vec3 const& v) {
        if (u[1] <= p[1] && p[1] < v[1]) return turn_sign(u[0], u[1], v[0], v[1], p[0], p[1]) > 0 ? 1 : 0;
        if (v[1] <= p[1] && p[1] < u[1]) return turn_sign(v[0], v[1], u[0], u[1], p[0], p[1]) > 0 ? -1 : 0;
        return 0;
    };
    int const ab = edge(a, b);
    int const bc = edge(b, c);
    int const turns = ab + bc + edge(c, a);
    if (turns == 0) return 0;
    if (p[2] < a[2] && p[2] < b[2] && p[2] < c[2]) return turns;
    return side_sign(a, b, c, p) * turns <= 0 ? turns : 0;
}

struct winding_number_fn {
    /// Times that the surface of `s` goes around `p`: 1 inside, 0 outside and in cavities, 2 where the solid
    /// overlaps itself, negative where it is inside out there.
    ///
    /// Exact for points off the surface (sizes within 1e-90 .. 1e90); points on it get one of the
    /// values of their two sides, always the same one. The number is that of the integral over solid
    /// angles [Jacobson et al. 2013], which for closed chains is whole. O(triangles); `bvh` is faster.
    [[nodiscard]] int operator()(solid const& s, vec3 const& p) const noexcept {
        if (!s.bounds.contains(p)) return 0;
        int sum = 0;
        for (auto const& t : s.triangles) {
            sum += upward_crossing(s.positions[t[0]], s.positions[t[1]], s.positions[t[2]], p);
        }
        return sum;
    }
};

}  // namespace detail

/// Winding number of a point; see `detail::winding_number_fn`.
inline constexpr detail::winding_number_fn winding_number{};

/// True where the winding number is positive. O(triangles).
[[nodiscard]] inline bool point_in_solid(solid const& s, vec3 const& p) noexcept { return winding_number(s, p) > 0; }

}  // namespace tafoni

#endif
