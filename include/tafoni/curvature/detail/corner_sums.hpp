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
#include <memory>
#include <span>
#include <vector>

namespace tafoni::detail {

inline constexpr std::size_t face_grain = 4096;
inline constexpr std::size_t vertex_grain = 2048;

/// `finish(v, sum)` for every vertex, with the sum over the corners at v, by ascending face, of what a face gives.
///
/// `source.face(f)` has `Sum corner(k)`, zeros for a triangle without area, and `part()`, what is kept of it in
/// between; `source.face(f, part)` gives it again. One thread adds corners as the faces come, in `sums` (one entry per
/// vertex; of several threads none); several keep the parts and gather: the same additions in the same order. O(faces).
template <class Sum, class Source, executor E, class Finish>
void sum_corners(surface_view const& s, std::span<Sum> sums, Sum const& zero, Source const& source, E const& executor,
                 Finish const& finish) {
    std::size_t const faces = s.triangles.size();
    std::size_t const vertices = s.positions.size();
    if (executor.thread_count() <= 1) {
        std::fill(sums.begin(), sums.end(), zero);
        for (std::size_t f = 0; f < faces; ++f) {
            auto const face = source.face(f);
            for (std::size_t k = 0; k < 3; ++k) sums[s.triangles[f][k]] += face.corner(k);
        }
        for (std::size_t v = 0; v < vertices; ++v) finish(v, sums[v]);
        return;
    }
    // Not initialised: the threads that write the parts first also have their pages made.
    auto const parts = std::make_unique_for_overwrite<decltype(source.face(0).part())[]>(faces);
    executor.for_blocks(faces, face_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) parts[f] = source.face(f).part();
    });
    executor.for_blocks(vertices, vertex_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            Sum sum = zero;
            for (auto const& c : s.rings->faces(v)) sum += source.face(c.face, parts[c.face]).corner(c.place);
            finish(v, sum);
        }
    });
}

/// Scratch for `sum_corners`.
template <class Sum, executor E>
[[nodiscard]] std::vector<Sum> corner_scratch(surface_view const& s, E const& executor) {
    return std::vector<Sum>(executor.thread_count() <= 1 ? s.positions.size() : 0);
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

/// `mean_of_inner_neighbors` at every border vertex. O(vertices).
template <executor E>
void fill_border(surface_view const& s, std::span<double> mean, E const& executor) {
    executor.for_blocks(mean.size(), vertex_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            if (s.rings->is_border(v)) mean[v] = mean_of_inner_neighbors(s, mean, v);
        }
    });
}

/// The sides of a triangle from corner 0 and what of them is not zero beyond rounding.
struct triangle_sides {
    vec3 a{0, 0, 0};    ///< corner 1 less corner 0
    vec3 b{0, 0, 0};    ///< corner 2 less corner 0
    double aa = 0;
    double bb = 0;
    double ab = 0;      ///< their products
    double det = 0;     ///< (2 area)^2
    /// Three different corners, the angle between a and b is no less than about 1e-10, and the sides are no shorter
    /// than about 1e-70: weights by 1 / side^4 are finite.
    bool valid = false;

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
        valid = aa * bb > 1e-280 && det > 1e-20 * (aa * bb) && t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
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
