/// \file
/// The planes that the border of an open mesh runs in.
#ifndef TAFONI_WEATHERING_DETAIL_BORDER_PLANES_HPP
#define TAFONI_WEATHERING_DETAIL_BORDER_PLANES_HPP

#include <tafoni/core/vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace tafoni::detail {

/// The plane that a border runs in from a vertex on, as far as its next vertices tell.
struct border_run {
    std::size_t points = 0;  ///< that lie in it, the vertex too; 0: no plane
    bool straight = false;   ///< they lie in a line, and the plane is the likeliest through it
    vec3 across{0, 0, 0};    ///< unit normal of the plane

    /// Whether a point lies in the plane; `from` the vertex, `rounding` of coordinates.
    [[nodiscard]] bool holds(vec3 const& from, double rounding) const noexcept {
        return std::fabs(dot(across, from)) <= 1e-9 * length(from) + rounding;
    }
};

/// Through a line: the upright plane, or the one square to it where the surface itself stands more upright; for an upright
/// line the plane square to the surface. `along` and `normal` of any length. O(1).
[[nodiscard]] inline vec3 plane_through_line(vec3 const& along, vec3 const& normal) noexcept {
    vec3 const d = normalized(along);
    double const level = d[0] * d[0] + d[1] * d[1];
    if (level < 1e-12) return normalized(cross(d, normal));
    vec3 const upright = normalized(vec3{d[1], -d[0], 0});
    vec3 const other = cross(d, upright);
    return std::fabs(dot(upright, normal)) < std::fabs(dot(other, normal)) ? upright : other;
}

/// `way`: the border's vertices from a vertex on, less that vertex, which is the first; `normal` of the surface there.
/// Five points make a plane, three a line; none that the surface itself lies in. The answer turns with the mesh, but for
/// that a line has its plane by the z axis. O(points).
[[nodiscard]] inline border_run run_along(std::span<vec3 const> way, vec3 const& normal, double rounding) noexcept {
    border_run out;
    if (way.size() < 3 || !(squared_length(way[1]) > 0)) return out;
    vec3 last = way[1];
    std::size_t k = 2;
    for (; k < way.size(); ++k) {
        if (!(length(cross(last, way[k])) <= 1e-6 * length(last) * length(way[k])) || !(dot(last, way[k]) > 0)) break;
        last = way[k];
    }
    border_run const line{.points = k >= 3 ? k : 0, .straight = true, .across = plane_through_line(last, normal)};
    if (k == way.size()) return line;
    out.across = cross(last, way[k]);
    double best = length(out.across);
    double const flat = std::fabs(dot(out.across, normal)) / (best * length(normal));  // cosine of plane and surface
    if (!(flat <= 0.95)) return line;
    out.across = normalized(out.across);
    vec3 const turn{way[k] - way[k - 1]};
    bool bent = false;  // more than two straight sides, which lie in a plane whatever they are
    for (++k; k < way.size() && out.holds(way[k], rounding); ++k) {
        vec3 const edge{way[k] - way[k - 1]};
        bent = bent || length(cross(turn, edge)) > 1e-6 * length(turn) * length(edge);
        vec3 const wider = cross(last, way[k]);
        if (!(length(wider) > 2 * best)) continue;
        best = length(wider);
        out.across = normalized(wider);
    }
    if (!bent && flat > 0.5) return line;
    out.points = k;
    return k >= 5 ? out : line;
}

/// None, one or two planes that a border vertex stays in: `one` and `other` are its runs, `before` and `after` its
/// neighbours along them, less the vertex. Returns how many; their normals are in `across`.
[[nodiscard]] inline std::size_t planes_of(border_run const& one, border_run const& other, vec3 const& before, vec3 const& after,
                                           double rounding, std::array<vec3, 2>& across) noexcept {
    auto const both = [&](border_run const& r) { return r.points > 0 && r.holds(before, rounding) && r.holds(after, rounding); };
    border_run const* plane = nullptr;
    for (border_run const* r : {&one, &other}) {
        if (!r->straight && both(*r) && (plane == nullptr || r->points > plane->points)) plane = r;
    }
    if (plane == nullptr && one.points > 0 && other.points > 0) {
        across = {one.across, other.across};
        return length(cross(one.across, other.across)) > 1e-6 ? 2 : 1;
    }
    for (border_run const* r : {&one, &other}) {
        if (plane == nullptr && both(*r)) plane = r;
    }
    if (plane == nullptr) return 0;
    across[0] = plane->across;
    return 1;
}

}  // namespace tafoni::detail

#endif
