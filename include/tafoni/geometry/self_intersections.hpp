/// \file
/// Which triangles of a solid cut each other, on request.
#ifndef TAFONI_GEOMETRY_SELF_INTERSECTIONS_HPP
#define TAFONI_GEOMETRY_SELF_INTERSECTIONS_HPP

#include <tafoni/core/run_context.hpp>
#include <tafoni/geometry/bvh.hpp>
#include <tafoni/geometry/detail/exact_sign.hpp>
#include <tafoni/geometry/solid.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace tafoni {

namespace detail {

using triangle_corners = std::array<vec3, 3>;

/// An axis along which the triangle is seen with area, or -1 when it has none. Exact.
[[nodiscard]] inline int seen_along(triangle_corners const& t) noexcept {
    for (int drop = 0; drop < 3; ++drop) {
        int const u = (drop + 1) % 3;
        int const v = (drop + 2) % 3;
        if (turn_sign(t[0][u], t[0][v], t[1][u], t[1][v], t[2][u], t[2][v]) != 0) return drop;
    }
    return -1;
}

/// Exact: do the segment p q and the triangle, both closed and in one plane, have a point in common?
[[nodiscard]] inline bool meets_in_plane(vec3 const& p, vec3 const& q, triangle_corners const& t, int drop) noexcept {
    int const u = (drop + 1) % 3;
    int const v = (drop + 2) % 3;
    auto const turn = [&](vec3 const& a, vec3 const& b, vec3 const& c) {
        return turn_sign(a[u], a[v], b[u], b[v], c[u], c[v]);
    };
    int const way = turn(t[0], t[1], t[2]);
    auto const holds = [&](vec3 const& x) {
        return way * turn(t[0], t[1], x) >= 0 && way * turn(t[1], t[2], x) >= 0 && way * turn(t[2], t[0], x) >= 0;
    };
    if (holds(p) || holds(q)) return true;
    auto const within = [&](vec3 const& a, vec3 const& b, vec3 const& x) {
        return std::min(a[u], b[u]) <= x[u] && x[u] <= std::max(a[u], b[u]) && std::min(a[v], b[v]) <= x[v] &&
               x[v] <= std::max(a[v], b[v]);
    };
    for (std::size_t k = 0; k < 3; ++k) {
        vec3 const& a = t[k];
        vec3 const& b = t[(k + 1) % 3];
        int const pa = turn(p, q, a);
        int const pb = turn(p, q, b);
        int const ap = turn(a, b, p);
        int const aq = turn(a, b, q);
        if (pa * pb < 0 && ap * aq < 0) return true;
        if ((pa == 0 && within(p, q, a)) || (pb == 0 && within(p, q, b))) return true;
    }
    return false;
}

/// Exact: do the closed segment p q and the closed triangle, seen with area along `drop`, have a point in common?
[[nodiscard]] inline bool meets(vec3 const& p, vec3 const& q, triangle_corners const& t, int drop) noexcept {
    int const sp = side_sign(t[0], t[1], t[2], p);
    int const sq = side_sign(t[0], t[1], t[2], q);
    if (sp * sq > 0) return false;
    if (sp == 0 && sq == 0) return meets_in_plane(p, q, t, drop);
    int const a = side_sign(p, q, t[0], t[1]);
    int const b = side_sign(p, q, t[1], t[2]);
    int const c = side_sign(p, q, t[2], t[0]);
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

/// Exact: have two triangles more in common than their shared corners and the side between them?
[[nodiscard]] inline bool cut_each_other(triangle_corners const& s, triangle_corners const& t) noexcept {
    int const drop_s = seen_along(s);
    int const drop_t = seen_along(t);
    std::array<int, 3> partner{-1, -1, -1};
    std::array<bool, 3> taken{};
    int shared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            if (partner[i] < 0 && !taken[j] && s[i] == t[j]) {
                partner[i] = static_cast<int>(j);
                taken[j] = true;
                ++shared;
            }
        }
    }
    if (shared == 3) return drop_s >= 0;
    if (shared == 2) {
        if (drop_s < 0 || drop_t < 0) return false;
        std::size_t const i = partner[0] < 0 ? 0U : partner[1] < 0 ? 1U : 2U;
        std::size_t const j = !taken[0] ? 0U : !taken[1] ? 1U : 2U;
        vec3 const& a = s[(i + 1) % 3];
        vec3 const& b = s[(i + 2) % 3];
        if (side_sign(s[0], s[1], s[2], t[j]) != 0) return false;
        int const u = (drop_s + 1) % 3;
        int const v = (drop_s + 2) % 3;
        return turn_sign(a[u], a[v], b[u], b[v], s[i][u], s[i][v]) *
                   turn_sign(a[u], a[v], b[u], b[v], t[j][u], t[j][v]) >
               0;
    }
    if (shared == 1) {
        // What they share beyond the corner reaches a side that lies opposite it.
        std::size_t const i = partner[0] >= 0 ? 0U : partner[1] >= 0 ? 1U : 2U;
        std::size_t const j = taken[0] ? 0U : taken[1] ? 1U : 2U;
        return (drop_t >= 0 && meets(s[(i + 1) % 3], s[(i + 2) % 3], t, drop_t)) ||
               (drop_s >= 0 && meets(t[(j + 1) % 3], t[(j + 2) % 3], s, drop_s));
    }
    for (std::size_t k = 0; k < 3; ++k) {
        if (drop_t >= 0 && meets(s[k], s[(k + 1) % 3], t, drop_t)) return true;
        if (drop_s >= 0 && meets(t[k], t[(k + 1) % 3], s, drop_s)) return true;
    }
    return false;
}

struct self_intersections_fn {
    /// Pairs (lower, higher) of triangles that have more in common than shared corners and sides, sorted.
    ///
    /// Touching counts; corners at the same place count as shared, whatever their numbers. Exact for
    /// sizes within 1e-90 .. 1e90, so the answer does not depend on compiler or order.
    /// O(n log n + pairs of overlapping boxes).
    [[nodiscard]] std::vector<std::array<std::uint32_t, 2>> operator()(solid const& s,
                                                                     run_context const& context = {}) const {
        return (*this)(s.positions, s.triangles, context);
    }

    /// The same of any triangles, open or closed.
    /// \throws invalid_input  as the constructor of `bvh`.
    [[nodiscard]] std::vector<std::array<std::uint32_t, 2>> operator()(
        std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles,
        run_context const& context = {}) const {
        bvh const tree(positions, triangles);
        std::vector<std::array<std::uint32_t, 2>> found;
        auto const corners = [&](std::uint32_t t) {
            auto const& v = triangles[t];
            return triangle_corners{positions[v[0]], positions[v[1]], positions[v[2]]};
        };
        std::size_t const n = triangles.size();
        for (std::uint32_t t = 0; t < n; ++t) {
            if (t % 4096 == 0) context.tick("self_intersections", static_cast<double>(t) / static_cast<double>(n));
            triangle_corners const own = corners(t);
            box3 box;
            for (vec3 const& p : own) box.include(p);
            std::size_t const first = found.size();
            tree.for_each_in(box, [&](std::uint32_t other) {
                if (other > t && cut_each_other(own, corners(other))) found.push_back({t, other});
            });
            std::sort(found.begin() + static_cast<std::ptrdiff_t>(first), found.end());
        }
        context.tick("self_intersections", 1);
        return found;
    }
};

}  // namespace detail

/// Lists the triangles that cut each other; see `detail::self_intersections_fn`.
inline constexpr detail::self_intersections_fn self_intersections{};

}  // namespace tafoni

#endif
