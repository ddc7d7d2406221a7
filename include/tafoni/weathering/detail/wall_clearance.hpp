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

/// A triangle that points are held against.
struct triangle_foot {
    explicit triangle_foot(triangle_corners const& t) noexcept : corner(t[0]) {
        vec3 const u{t[1] - t[0]};
        vec3 const v{t[2] - t[0]};
        normal = cross(u, v);
        square = squared_length(normal);
        across_v = cross(v, normal);
        across_u = cross(normal, u);
    }
    /// Square of the distance to p where p is over or under the triangle, else `most`. O(1).
    [[nodiscard]] double squared_gap(vec3 const& p, double most) const noexcept {
        vec3 const w{p - corner};
        double const y = dot(w, across_v);
        double const z = dot(w, across_u);
        if (!(y >= 0 && z >= 0 && y + z <= square && square > 0)) return most;
        double const high = dot(w, normal);
        return std::min(most, high * high / square);
    }
    vec3 corner;
    vec3 normal{0, 0, 0};
    vec3 across_v{0, 0, 0};
    vec3 across_u{0, 0, 0};
    double square = 0;
};

/// Square of the distance between two triangles, 0 where they cut each other. O(1).
[[nodiscard]] inline double squared_gap(triangle_corners const& s, triangle_corners const& t) noexcept {
    double least = squared_length(s[0] - t[0]);
    triangle_foot const on_s(s);
    triangle_foot const on_t(t);
    for (std::size_t k = 0; k < 3; ++k) {
        least = on_s.squared_gap(t[k], least);
        least = on_t.squared_gap(s[k], least);
        for (std::size_t j = 0; j < 3; ++j) least = std::min(least, squared_gap(s[k], s[(k + 1) % 3], t[j], t[(j + 1) % 3]));
    }
    box3 a;
    box3 b;
    for (vec3 const& p : s) a.include(p);
    for (vec3 const& p : t) b.include(p);
    return overlap(a, b) && cut_each_other(s, t) ? 0.0 : least;
}

/// Square of the distance between two triangles that share a corner, the first of each: of the side opposite it in either
/// from the other; 0 where they cut each other. As long as it is not 0 they have no more than the corner in common. O(1).
[[nodiscard]] inline double squared_gap_at_corner(triangle_corners const& s, triangle_corners const& t) noexcept {
    double least = squared_gap(s[1], s[2], t[1], t[2]);
    triangle_foot const on_s(s);
    triangle_foot const on_t(t);
    for (std::size_t k = 1; k < 3; ++k) {
        least = on_s.squared_gap(t[k], least);
        least = on_t.squared_gap(s[k], least);
        least = std::min(least, squared_gap(s[1], s[2], t[0], t[k]));
        least = std::min(least, squared_gap(t[1], t[2], s[0], s[k]));
    }
    auto const parts = [](triangle_foot const& a, triangle_corners const& b) {
        return (dot(a.normal, vec3{b[1] - b[0]}) > 0) != (dot(a.normal, vec3{b[2] - b[0]}) > 0);
    };
    return (parts(on_s, t) || parts(on_t, s)) && cut_each_other(s, t) ? 0.0 : least;
}

/// After so many looks that could be spared ways are given anew anyway.
inline constexpr std::uint32_t most_looks_spared = 10;

/// Whether one in twenty of the vertices that have been given a way has less than a quarter of it left. O(vertices).
[[nodiscard]] inline bool many_have_gone(std::span<double const> clear, std::span<double const> given) noexcept {
    std::size_t known = 0;
    std::size_t gone = 0;
    for (std::size_t v = 0; v < clear.size(); ++v) {
        if (clear[v] < 0) continue;
        ++known;
        if (clear[v] < 0.25 * given[v]) ++gone;
    }
    return 20 * gone > known;
}

/// Planes through the sides of a triangle, upright on it, and its own: they tell cheaply that others are far.
class triangle_planes {
public:
    explicit triangle_planes(triangle_corners const& t) noexcept : corners_(t) {
        across_[3] = cross(vec3{t[1] - t[0]}, vec3{t[2] - t[0]});
        for (std::size_t k = 0; k < 3; ++k) across_[k] = cross(vec3{t[(k + 1) % 3] - t[k]}, across_[3]);
        for (std::size_t k = 0; k < 4; ++k) square_[k] = squared_length(across_[k]);
    }
    /// Whether a plane shows that the hull of the points is no nearer than the root of `square`. O(points).
    [[nodiscard]] bool far_from(std::span<vec3 const> points, double square) const noexcept {
        for (std::size_t k = 0; k < 4; ++k) {
            double const enough = square * square_[k] * (1 + 1e-12);
            std::size_t over = 0;
            std::size_t under = 0;
            for (vec3 const& p : points) {
                double const high = dot(across_[k], vec3{p - corners_[k % 3]});
                if (!(high * high > enough)) break;
                ++(high > 0 ? over : under);
            }
            if (over == points.size() || (k == 3 && under == points.size())) return true;
        }
        return false;
    }

private:
    triangle_corners corners_;
    std::array<vec3, 4> across_{};
    std::array<double, 4> square_{};
};

/// Gives vertices a way that is theirs to go: 0.45 of the distance from the triangles at the vertex to the nearest that
/// share no corner with them, and to the nearest of those that share one, away from it. Whatever vertices do with their
/// ways, and whenever they were given them since the last time all were taken back, two such triangles do not meet: of
/// the distances at which ways were given take the largest; from then on both have gone 0.45 of it at most. Those that
/// cut each other stay. Keeps its memory.
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
        double const drift = follow(s);
        threads.for_blocks(asked_.size(), 64, [&](std::size_t from, std::size_t to) {
            for (std::size_t k = from; k < to; ++k) gap_[asked_[k]] = gap(s, asked_[k], look, drift);
        });
        for (std::uint32_t const v : wanted) {
            if (!(clear[v] < 0)) continue;
            double least = look;
            for (auto const& c : s.rings.faces(v)) least = std::min(least, gap_[c.face]);
            clear[v] = share * least;
        }
    }

private:
    /// Brings the tree up to date where vertices have gone far, and tells how far they are from where it has them.
    [[nodiscard]] double follow(moving_surface const& s) {
        double farthest = 0;
        if (known_) {
            for (std::size_t v = 0; v < placed_.size(); ++v) farthest = std::max(farthest, squared_length(s.positions[v] - placed_[v]));
            farthest = std::sqrt(farthest);
            if (farthest <= 0.1 * edge_) return farthest;
            known_ = false;
            tree_.refit(s.positions, s.triangles);
        } else {
            tree_ = bvh(s.positions, s.triangles);
            edge_ = 0;
            for (auto const& t : s.triangles) edge_ += length(s.positions[t[0]] - s.positions[t[1]]);
            edge_ /= static_cast<double>(s.triangles.size());
        }
        placed_.assign(s.positions.begin(), s.positions.end());
        known_ = true;
        return 0;
    }
    [[nodiscard]] static triangle_corners corners(moving_surface const& s, std::uint32_t f) noexcept {
        auto const& t = s.triangles[f];
        return {s.positions[t[0]], s.positions[t[1]], s.positions[t[2]]};
    }
    /// At most `look`. Looks around in steps, since the nearest is seldom farther than the next ring of triangles.
    [[nodiscard]] double gap(moving_surface const& s, std::uint32_t f, double look, double drift) const {
        triangle_corners const own = corners(s, f);
        box3 box;
        for (vec3 const& p : own) box.include(p);
        triangle_planes const planes(own);
        vec3 const wide = box.extent();
        double least = look * look;
        double far = std::min(look, 0.5 * std::max({wide[0], wide[1], wide[2]}));
        for (bool first = true;; first = false) {
            box3 around = box;
            for (int d = 0; d < 3; ++d) {
                around.lo[d] -= far + drift;
                around.hi[d] += far + drift;
            }
            tree_.for_each_in(around, [&](std::uint32_t g) { least = squared_gap_below(own, box, planes, corners(s, g), least, first); });
            if (far >= look || least <= far * far) return std::sqrt(least);
            far = std::min(2 * far, std::sqrt(least) * (1 + 1e-12));
            if (!(far > 0)) far = look;
        }
    }
    /// `least` where it is not below that. Triangles at a corner are near in the first look already.
    [[nodiscard]] static double squared_gap_below(triangle_corners const& own, box3 const& box, triangle_planes const& planes,
                                                  triangle_corners const& other, double least, bool corner_too) noexcept {
        std::size_t shared = 0;
        std::size_t mine = 0;
        std::size_t its = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                if (own[i][0] != other[j][0] || own[i][1] != other[j][1] || own[i][2] != other[j][2]) continue;
                ++shared;
                mine = i;
                its = j;
            }
        }
        if (shared > 1 || (shared == 1 && !corner_too)) return least;
        if (shared == 1) {
            triangle_corners const a{own[mine], own[(mine + 1) % 3], own[(mine + 2) % 3]};
            triangle_corners const b{other[its], other[(its + 1) % 3], other[(its + 2) % 3]};
            bool const far = planes.far_from(std::span(b).last(2), least) && triangle_planes(b).far_from(std::span(a).last(2), least);
            return far ? least : std::min(least, squared_gap_at_corner(a, b));
        }
        box3 there;
        for (vec3 const& p : other) there.include(p);
        double between = 0;
        for (int d = 0; d < 3; ++d) {
            double const apart = std::max({there.lo[d] - box.hi[d], box.lo[d] - there.hi[d], 0.0});
            between += apart * apart;
        }
        if (between >= least || planes.far_from(other, least) || triangle_planes(other).far_from(own, least)) return least;
        return std::min(least, squared_gap(own, other));
    }

    bvh tree_{};
    bool known_ = false;
    double edge_ = 0;             ///< mean first side of the triangles when the tree was built, length unit
    std::vector<vec3> placed_{};  ///< where the tree has the vertices
    std::vector<std::uint32_t> asked_{};
    std::vector<double> gap_{};
};

}  // namespace tafoni::detail

#endif
