/// \file
/// Points, boxes and rays against one triangle.
#ifndef TAFONI_GEOMETRY_DETAIL_TRIANGLE_QUERIES_HPP
#define TAFONI_GEOMETRY_DETAIL_TRIANGLE_QUERIES_HPP

#include <tafoni/core/vector.hpp>

#include <array>
#include <limits>
#include <utility>

namespace tafoni::detail {

[[nodiscard]] inline bool overlap(box3 const& a, box3 const& b) noexcept {
    return a.lo[0] <= b.hi[0] && b.lo[0] <= a.hi[0] && a.lo[1] <= b.hi[1] && b.lo[1] <= a.hi[1] &&
           a.lo[2] <= b.hi[2] && b.lo[2] <= a.hi[2];
}

[[nodiscard]] inline double squared_distance(box3 const& b, vec3 const& p) noexcept {
    double sum = 0;
    for (int a = 0; a < 3; ++a) {
        double const d = p[a] < b.lo[a] ? b.lo[a] - p[a] : p[a] > b.hi[a] ? p[a] - b.hi[a] : 0.0;
        sum += d * d;
    }
    return sum;
}

[[nodiscard]] inline vec3 nearest_on_segment(vec3 const& a, vec3 const& b, vec3 const& p) noexcept {
    vec3 const u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    vec3 const w{p[0] - a[0], p[1] - a[1], p[2] - a[2]};
    double const along = dot(u, w);
    double const whole = dot(u, u);
    if (!(along > 0)) return a;
    if (along >= whole) return b;
    double const t = along / whole;
    return vec3{a[0] + t * u[0], a[1] + t * u[1], a[2] + t * u[2]};
}

/// Inside the three planes through the sides the foot of the normal is nearest, else a point of a side;
/// triangles without area are their sides.
[[nodiscard]] inline vec3 nearest_on_triangle(vec3 const& a, vec3 const& b, vec3 const& c, vec3 const& p) noexcept {
    vec3 const u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    vec3 const v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    vec3 const w{p[0] - a[0], p[1] - a[1], p[2] - a[2]};
    vec3 const n = cross(u, v);
    double const nn = dot(n, n);
    if (nn > 0) {
        double const y = dot(cross(w, v), n);
        double const z = dot(cross(u, w), n);
        if (y >= 0 && z >= 0 && y + z <= nn) {
            double const s = y / nn;
            double const t = z / nn;
            return vec3{a[0] + s * u[0] + t * v[0], a[1] + s * u[1] + t * v[1], a[2] + s * u[2] + t * v[2]};
        }
    }
    std::array<vec3, 3> const feet{nearest_on_segment(a, b, p), nearest_on_segment(b, c, p),
                                   nearest_on_segment(c, a, p)};
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        double const d = squared_length(vec3{feet[i][0] - p[0], feet[i][1] - p[1], feet[i][2] - p[2]});
        if (d < least) {
            least = d;
            best = i;
        }
    }
    return feet[best];
}

/// A ray turned and sheared so that it runs along an axis: neighbouring triangles then judge a shared
/// edge by the same numbers, and none lets the ray through [Woop, Benthin and Wald 2013].
class sheared_ray {
public:
    sheared_ray(vec3 const& origin, vec3 const& direction) noexcept : origin_(origin), direction_(direction) {
        for (int a = 1; a < 3; ++a) {
            if (std::fabs(direction[a]) > std::fabs(direction[main_])) main_ = a;
        }
        u_ = (main_ + 1) % 3;
        v_ = (main_ + 2) % 3;
        shear_u_ = direction[u_] / direction[main_];
        shear_v_ = direction[v_] / direction[main_];
        inverse_ = 1 / direction[main_];
    }

    /// Where the ray enters the box, as a multiple of the direction; NaN when it misses. The
    /// interval is widened by its rounding, so that no triangle in the box is lost.
    [[nodiscard]] double entry(box3 const& b) const noexcept {
        double const none = std::numeric_limits<double>::quiet_NaN();
        double in = 0;
        double out = std::numeric_limits<double>::infinity();
        for (int a = 0; a < 3; ++a) {
            double const lo = b.lo[a] - origin_[a];
            double const hi = b.hi[a] - origin_[a];
            if (direction_[a] == 0) {
                if (lo > 0 || hi < 0) return none;
                continue;
            }
            double first = lo / direction_[a];
            double last = hi / direction_[a];
            if (last < first) std::swap(first, last);
            first -= 4e-15 * std::fabs(first);
            last += 4e-15 * std::fabs(last);
            if (first > in) in = first;
            if (last < out) out = last;
        }
        return in <= out ? in : none;
    }

    /// The multiple of the direction at which the ray meets the triangle, NaN when it does not.
    [[nodiscard]] double meet(vec3 const& a, vec3 const& b, vec3 const& c) const noexcept {
        double const none = std::numeric_limits<double>::quiet_NaN();
        auto const along = [&](vec3 const& p) { return p[main_] - origin_[main_]; };
        auto const flat = [&](vec3 const& p, int axis, double shear) {
            return (p[axis] - origin_[axis]) - shear * along(p);
        };
        double const ax = flat(a, u_, shear_u_), ay = flat(a, v_, shear_v_);
        double const bx = flat(b, u_, shear_u_), by = flat(b, v_, shear_v_);
        double const cx = flat(c, u_, shear_u_), cy = flat(c, v_, shear_v_);
        double const wa = cx * by - cy * bx;
        double const wb = ax * cy - ay * cx;
        double const wc = bx * ay - by * ax;
        if ((wa < 0 || wb < 0 || wc < 0) && (wa > 0 || wb > 0 || wc > 0)) return none;
        double const sum = wa + wb + wc;
        if (sum == 0) return none;
        return (wa / sum * along(a) + wb / sum * along(b) + wc / sum * along(c)) * inverse_;
    }

private:
    vec3 origin_;
    vec3 direction_;
    int main_ = 0;
    int u_ = 1;
    int v_ = 2;
    double shear_u_ = 0;
    double shear_v_ = 0;
    double inverse_ = 1;
};

}  // namespace tafoni::detail

#endif
