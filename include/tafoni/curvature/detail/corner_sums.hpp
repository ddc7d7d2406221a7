/// \file
/// Sums over the triangles around every vertex, with one order of addition for every executor.
#ifndef TAFONI_CURVATURE_DETAIL_CORNER_SUMS_HPP
#define TAFONI_CURVATURE_DETAIL_CORNER_SUMS_HPP

#include <tafoni/curvature/concepts.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

inline constexpr std::size_t face_grain = 4096;
inline constexpr std::size_t vertex_grain = 2048;

/// `sums[v]` = sum over the corners at v, by ascending face, of what `face(f)` gives for the corner.
///
/// `face(f)` returns a value with `bool valid` and `Sum corner(k)`. One thread adds corners as the faces come;
/// several store the faces and gather: the same additions in the same order. O(faces).
template <class Sum, class Face, executor E>
void sum_corners(surface_view const& s, std::span<Sum> sums, Sum const& zero, Face const& face, E const& executor) {
    using face_value = decltype(face(std::size_t{}));
    if (executor.thread_count() <= 1) {
        std::fill(sums.begin(), sums.end(), zero);
        for (std::size_t f = 0; f < s.triangles.size(); ++f) {
            face_value const value = face(f);
            if (!value.valid) continue;
            for (std::size_t k = 0; k < 3; ++k) sums[s.triangles[f][k]] += value.corner(k);
        }
        return;
    }
    std::vector<face_value> values(s.triangles.size());
    executor.for_blocks(values.size(), face_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) values[f] = face(f);
    });
    executor.for_blocks(sums.size(), vertex_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            Sum sum = zero;
            for (auto const& c : s.rings->faces(v)) {
                if (values[c.face].valid) sum += values[c.face].corner(c.place);
            }
            sums[v] = sum;
        }
    });
}

/// What a border vertex takes where an estimator says nothing there; 0 without inner neighbours.
[[nodiscard]] inline double mean_of_inner_neighbors(surface_view const& s, std::span<double const> mean, std::size_t v) noexcept {
    double sum = 0;
    double inner = 0;
    for (std::uint32_t const w : s.rings->neighbors(v)) {
        if (s.rings->is_border(w)) continue;
        sum += mean[w];
        inner += 1;
    }
    return inner > 0 ? sum / inner : 0.0;
}

/// The sides of a triangle from corner 0 and what of them is not zero beyond rounding.
struct triangle_sides {
    vec3 a{0, 0, 0};    ///< corner 1 less corner 0
    vec3 b{0, 0, 0};    ///< corner 2 less corner 0
    double aa = 0;
    double bb = 0;
    double ab = 0;      ///< their products
    double det = 0;     ///< (2 area)^2
    bool valid = false; ///< three different corners, and the angle between a and b is no less than about 1e-10

    triangle_sides() = default;
    triangle_sides(surface_view const& s, std::size_t f) noexcept {
        auto const& t = s.triangles[f];
        vec3 const& p = s.positions[t[0]];
        a = vec3{s.positions[t[1]] - p};
        b = vec3{s.positions[t[2]] - p};
        aa = dot(a, a);
        bb = dot(b, b);
        ab = dot(a, b);
        det = squared_length(cross(a, b));
        valid = det > 1e-20 * (aa * bb) && t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    }
    /// Squared side opposite to corner 0.
    [[nodiscard]] double cc() const noexcept { return squared_length(b - a); }

    /// Parts of the area that belong to the three corners: Voronoi regions, or by halves and quarters where the
    /// triangle is obtuse, so that they add up to the area [Meyer et al. 2003, section 3.3].
    [[nodiscard]] std::array<double, 3> corner_areas() const noexcept {
        double const at_0 = ab;       // |a| |b| cos of the angle at corner 0
        double const at_1 = aa - ab;
        double const at_2 = bb - ab;
        double const area2 = std::sqrt(det);
        if (at_0 < 0) return {area2 / 4, area2 / 8, area2 / 8};
        if (at_1 < 0) return {area2 / 8, area2 / 4, area2 / 8};
        if (at_2 < 0) return {area2 / 8, area2 / 8, area2 / 4};
        double const unit = 0.125 / area2;
        double const c = aa - ab + (bb - ab);
        return {unit * (aa * at_2 + bb * at_1), unit * (aa * at_2 + c * at_0), unit * (bb * at_1 + c * at_0)};
    }
};

}  // namespace tafoni::detail

#endif
