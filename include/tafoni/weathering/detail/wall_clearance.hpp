/// \file
/// How far the vertices of a surface may go before triangles that are no neighbours could meet.
#ifndef TAFONI_WEATHERING_DETAIL_WALL_CLEARANCE_HPP
#define TAFONI_WEATHERING_DETAIL_WALL_CLEARANCE_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/geometry/bvh.hpp>
#include <tafoni/geometry/detail/triangle_queries.hpp>
#include <tafoni/geometry/self_intersections.hpp>
#include <tafoni/weathering/detail/sound_moves.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// Square of the distance between two segments; of two points of them where rounding decides. O(1).
[[nodiscard]] inline double squared_gap(vec3 const& a, vec3 const& b, vec3 const& c, vec3 const& d) noexcept {
    vec3 const u{b - a};
    vec3 const v{d - c};
    vec3 const r{a - c};
    double const uu = squared_length(u);
    double const vv = squared_length(v);
    double const uv = dot(u, v);
    double const ur = dot(u, r);
    double const vr = dot(v, r);
    double const area = uu * vv - uv * uv;
    double s = area > 0 ? std::clamp((uv * vr - ur * vv) / area, 0.0, 1.0) : 0.0;
    double t = vv > 0 ? (uv * s + vr) / vv : 0.0;
    if (!(t >= 0 && t <= 1)) {
        t = t < 0 ? 0.0 : 1.0;
        s = uu > 0 ? std::clamp((uv * t - ur) / uu, 0.0, 1.0) : 0.0;
    }
    vec3 const way{r[0] + s * u[0] - t * v[0], r[1] + s * u[1] - t * v[1], r[2] + s * u[2] - t * v[2]};
    return squared_length(way);
}

/// Square of the distance between two triangles, 0 where they cut each other. O(1).
[[nodiscard]] inline double squared_gap(triangle_corners const& s, triangle_corners const& t) noexcept {
    double least = squared_length(s[0] - t[0]);
    for (std::size_t k = 0; k < 3; ++k) {
        least = std::min(least, squared_length(t[k] - nearest_on_triangle(s[0], s[1], s[2], t[k])));
        least = std::min(least, squared_length(s[k] - nearest_on_triangle(t[0], t[1], t[2], s[k])));
        for (std::size_t j = 0; j < 3; ++j) least = std::min(least, squared_gap(s[k], s[(k + 1) % 3], t[j], t[(j + 1) % 3]));
    }
    box3 a;
    box3 b;
    for (vec3 const& p : s) a.include(p);
    for (vec3 const& p : t) b.include(p);
    return overlap(a, b) && cut_each_other(s, t) ? 0.0 : least;
}

/// Gives vertices a way that is theirs to go: 0.45 of the distance from the triangles at the vertex to the nearest that
/// share no corner with them. Whatever vertices do with their ways, and whenever they were given them since the last
/// time all were taken back, two such triangles do not meet; those that cut each other stay. Keeps its memory.
class wall_clearance {
public:
    static constexpr double share = 0.45;

    /// Triangles are others from now on.
    void forget() noexcept { known_ = false; }

    /// Fills `clear` where it is below 0 for the vertices that are `wanted`, with no more than share x `look`.
    /// O(faces + n log n where n triangles are at such vertices, and triangles within `look` of them).
    /// \throws what the allocator throws; `clear` is as it was then.
    template <executor E>
    void find(moving_surface const& s, std::span<std::uint32_t const> wanted, double look, std::span<double> clear, E const& threads) {
        gap_.assign(s.triangles.size(), -1.0);
        asked_.clear();
        for (std::uint32_t const v : wanted) {
            if (!(clear[v] < 0)) continue;
            for (auto const& c : s.rings.faces(v)) {
                if (gap_[c.face] < 0) asked_.push_back(c.face);
                gap_[c.face] = 0;
            }
        }
        if (asked_.empty()) return;
        if (known_) {
            tree_.refit(s.positions, s.triangles);
        } else {
            tree_ = bvh(s.positions, s.triangles);
            known_ = true;
        }
        threads.for_blocks(asked_.size(), 64, [&](std::size_t from, std::size_t to) {
            for (std::size_t k = from; k < to; ++k) gap_[asked_[k]] = gap(s, asked_[k], look);
        });
        for (std::uint32_t const v : wanted) {
            if (!(clear[v] < 0)) continue;
            double least = look;
            for (auto const& c : s.rings.faces(v)) least = std::min(least, gap_[c.face]);
            clear[v] = share * least;
        }
    }

private:
    [[nodiscard]] static triangle_corners corners(moving_surface const& s, std::uint32_t f) noexcept {
        auto const& t = s.triangles[f];
        return {s.positions[t[0]], s.positions[t[1]], s.positions[t[2]]};
    }
    [[nodiscard]] double gap(moving_surface const& s, std::uint32_t f, double look) const {
        triangle_corners const own = corners(s, f);
        box3 box;
        for (vec3 const& p : own) box.include(p);
        for (int d = 0; d < 3; ++d) {
            box.lo[d] -= look;
            box.hi[d] += look;
        }
        double least = look * look;
        tree_.for_each_in(box, [&](std::uint32_t g) {
            triangle_corners const other = corners(s, g);
            for (vec3 const& p : own) {
                for (vec3 const& q : other) {
                    if (p[0] == q[0] && p[1] == q[1] && p[2] == q[2]) return;
                }
            }
            least = std::min(least, squared_gap(own, other));
        });
        return std::sqrt(least);
    }

    bvh tree_{};
    bool known_ = false;
    std::vector<std::uint32_t> asked_{};
    std::vector<double> gap_{};
};

}  // namespace tafoni::detail

#endif
