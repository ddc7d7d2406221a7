/// \file
/// Mean curvature from the cotangent Laplacian.
#ifndef TAFONI_CURVATURE_COTANGENT_HPP
#define TAFONI_CURVATURE_COTANGENT_HPP

#include <tafoni/curvature/concepts.hpp>
#include <tafoni/curvature/detail/corner_sums.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace tafoni {

namespace detail {

struct laplacian_sum {
    vec3 edges{0, 0, 0};   ///< sum of (cot + cot) (x_i - x_j)
    vec3 normal{0, 0, 0};  ///< sum of area normals
    double area = 0;

    laplacian_sum& operator+=(laplacian_sum const& o) noexcept {
        for (int d = 0; d < 3; ++d) edges[d] += o.edges[d];
        for (int d = 0; d < 3; ++d) normal[d] += o.normal[d];
        area += o.area;
        return *this;
    }
};

struct face_cotangents {
    triangle_sides sides{};
    vec3 normal{0, 0, 0};
    std::array<double, 3> area{};
    std::array<double, 3> cot{};
    bool valid = false;

    face_cotangents() = default;
    face_cotangents(surface_view const& s, std::size_t f) noexcept : sides(s, f) {
        valid = sides.valid;
        if (!valid) return;
        normal = cross(sides.a, sides.b);
        double const inverse = 1 / std::sqrt(sides.det);
        cot = {sides.ab * inverse, (sides.aa - sides.ab) * inverse, (sides.bb - sides.ab) * inverse};
        area = sides.corner_areas();
    }
    [[nodiscard]] laplacian_sum corner(std::size_t k) const noexcept {
        // Side a leads from corner 0 to 1 and lies opposite to corner 2, b from 0 to 2 opposite to 1.
        vec3 const& a = sides.a;
        vec3 const& b = sides.b;
        laplacian_sum r{.edges = vec3{0, 0, 0}, .normal = normal, .area = area[k]};
        for (int d = 0; d < 3; ++d) {
            double const c = b[d] - a[d];
            r.edges[d] = k == 0   ? -(cot[2] * a[d]) - cot[1] * b[d]
                         : k == 1 ? cot[2] * a[d] - cot[0] * c
                                  : cot[1] * b[d] + cot[0] * c;
        }
        return r;
    }
};

}  // namespace detail

/// H = 1/(4 A) n . sum over neighbours of (cot alpha + cot beta)(x_i - x_j), A the mixed Voronoi area
/// [Meyer et al. 2003, equations 5 and 8], n the area-weighted normal, so that noise within the surface
/// does not count as curvature.
///
/// Exact for linear functions; on regular meshes of order 2, at vertices of five or seven neighbours it keeps a
/// small error that refinement does not remove. At the border of an open mesh the mean of the inner
/// neighbours' values, or 0. Models `curvature_estimator`.
struct cotangent {
    /// O(vertices + faces); 56 bytes of scratch memory per vertex, and 180 per face with several threads.
    template <executor E>
    void operator()(surface_view const& s, std::span<double> mean, E const& executor) const {
        std::vector<detail::laplacian_sum> sums(s.positions.size());
        detail::sum_corners(
            s, std::span<detail::laplacian_sum>(sums), detail::laplacian_sum{},
            [&](std::size_t f) { return detail::face_cotangents(s, f); }, executor);
        for (std::size_t v = 0; v < mean.size(); ++v) {
            detail::laplacian_sum const& sum = sums[v];
            double const scale = length(sum.normal) * sum.area;
            mean[v] = scale > 0 && !s.rings->is_border(v) ? 0.25 * (dot(sum.edges, sum.normal) / scale) : 0.0;
        }
        for (std::size_t v = 0; v < mean.size(); ++v) {
            if (s.rings->is_border(v)) mean[v] = detail::mean_of_inner_neighbors(s, mean, v);
        }
    }
};

static_assert(curvature_estimator<cotangent>);

}  // namespace tafoni

#endif
