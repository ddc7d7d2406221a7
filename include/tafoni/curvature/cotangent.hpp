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
    struct kept {
        std::array<double, 3> area;
        std::array<double, 3> cot;
    };
    triangle_sides sides{};
    vec3 normal{0, 0, 0};
    std::array<double, 3> area{};
    std::array<double, 3> cot{};

    [[nodiscard]] kept part() const noexcept { return {area, cot}; }
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

struct faces_cotangents {
    surface_view const& surface;

    [[nodiscard]] face_cotangents face(std::size_t f) const noexcept {
        triangle_sides const t(surface, f);
        if (!t.valid) return {};
        double const inverse = 1 / std::sqrt(t.det);
        return {t, cross(t.a, t.b), t.corner_areas(),
                {t.ab * inverse, (t.aa - t.ab) * inverse, (t.bb - t.ab) * inverse}};
    }
    [[nodiscard]] face_cotangents face(std::size_t f, face_cotangents::kept const& k) const noexcept {
        face_cotangents out{.sides = {}, .area = k.area, .cot = k.cot};
        if (k.area[0] == 0 && k.area[1] == 0 && k.area[2] == 0) return out;
        auto const& t = surface.triangles[f];
        vec3 const& p = surface.positions[t[0]];
        out.sides.a = vec3{surface.positions[t[1]] - p};
        out.sides.b = vec3{surface.positions[t[2]] - p};
        out.normal = cross(out.sides.a, out.sides.b);
        return out;
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
    /// O(vertices + faces); 56 bytes of scratch memory per vertex, or 48 per face with several threads.
    template <executor E>
    void operator()(surface_view const& s, std::span<double> mean, E const& executor) const {
        auto sums = detail::corner_scratch<detail::laplacian_sum>(s, executor);
        detail::sum_corners(
            s, std::span<detail::laplacian_sum>(sums), detail::laplacian_sum{}, detail::faces_cotangents{s}, executor,
            [&](std::size_t v, detail::laplacian_sum const& sum) {
                double const scale = length(sum.normal) * sum.area;
                mean[v] = scale > 0 && !s.rings->is_border(v) ? 0.25 * (dot(sum.edges, sum.normal) / scale) : 0.0;
            });
        detail::fill_border(s, mean, executor);
    }
};

static_assert(curvature_estimator<cotangent>);

}  // namespace tafoni

#endif
