/// \file
/// Volumes under loops, and how often a surface made of loops wraps around a point.
#ifndef TAFONI_DECOMPOSITION_DETAIL_LOOP_MEASURE_HPP
#define TAFONI_DECOMPOSITION_DETAIL_LOOP_MEASURE_HPP

#include <tafoni/core/vector.hpp>

#include <cmath>
#include <cstddef>

namespace tafoni::detail {

/// Twice the area vector of a loop, its turn giving the direction. O(corners).
template <class Loop, class Places>
[[nodiscard]] vec3 doubled_area(Loop const& loop, Places const& places) {
    vec3 const o = places(loop[0]);
    vec3 sum{0, 0, 0};
    vec3 u{0, 0, 0};
    for (std::size_t k = 1; k < loop.size(); ++k) {
        vec3 const p = places(loop[k]);
        vec3 const v{p[0] - o[0], p[1] - o[1], p[2] - o[2]};
        vec3 const c = cross(u, v);
        sum = vec3{sum[0] + c[0], sum[1] + c[1], sum[2] + c[2]};
        u = v;
    }
    return sum;
}

/// Volume and first moment of cones from a reference point over loops, by the divergence theorem.
struct cone_sum {
    double six_volumes = 0;
    vec3 moment{0, 0, 0};  ///< 24 times

    /// Adds `sign` times the cone from `apex` over a loop. O(corners).
    template <class Loop, class Places>
    void add(Loop const& loop, Places const& places, vec3 const& apex, double sign) {
        auto const at = [&](std::size_t k) {
            vec3 const p = places(loop[k]);
            return vec3{p[0] - apex[0], p[1] - apex[1], p[2] - apex[2]};
        };
        vec3 const o = at(0);
        vec3 a = at(1);
        for (std::size_t k = 2; k < loop.size(); ++k) {
            vec3 const b = at(k);
            double const six = sign * dot(o, cross(a, b));
            six_volumes += six;
            for (int x = 0; x < 3; ++x) moment[x] += six * (o[x] + a[x] + b[x]);
            a = b;
        }
    }

    void add(cone_sum const& o) noexcept {
        six_volumes += o.six_volumes;
        for (int x = 0; x < 3; ++x) moment[x] += o.moment[x];
    }
};

/// What a loop adds to the number of times that a closed surface wraps around x: 1, 0 or -1 for a
/// simple loop, +1 where its front faces up and it lies above x. Shared edges are judged alike from
/// both sides, so the sum over a closed surface is a true winding number but within rounding of it. O(corners).
template <class Loop, class Places>
[[nodiscard]] int winding_above(Loop const& loop, Places const& places, vec3 const& x) {
    int turns = 0;
    vec3 a = places(loop[loop.size() - 1]);
    for (std::size_t k = 0; k < loop.size(); ++k) {
        vec3 const b = places(loop[k]);
        if ((a[1] > x[1]) != (b[1] > x[1])) {
            vec3 const& low = a[1] < b[1] ? a : b;
            vec3 const& high = a[1] < b[1] ? b : a;
            double const at = low[0] + (x[1] - low[1]) / (high[1] - low[1]) * (high[0] - low[0]);
            if (at > x[0]) turns += b[1] > a[1] ? 1 : -1;
        }
        a = b;
    }
    if (turns == 0) return 0;
    vec3 const n = doubled_area(loop, places);
    vec3 const o = places(loop[0]);
    double const height = o[2] - (n[0] * (x[0] - o[0]) + n[1] * (x[1] - o[1])) / n[2];
    return height > x[2] ? turns : 0;
}

}  // namespace tafoni::detail

#endif
