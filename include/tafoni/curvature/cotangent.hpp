/// \file
/// Mean curvature from the cotangent Laplacian.
#ifndef TAFONI_CURVATURE_COTANGENT_HPP
#define TAFONI_CURVATURE_COTANGENT_HPP

#include <tafoni/curvature/concepts.hpp>
#include <tafoni/curvature/detail/corner_sums.hpp>
#include <tafoni/curvature/detail/face_sides.hpp>

#include <array>
#include <cstddef>
#include <span>

namespace tafoni {

namespace detail {

/// Sums over the corners at a vertex, in one line of cache: of (cot + cot) (x_i - x_j), of area normals, of areas.
struct alignas(64) laplacian_sum {
    std::array<number_pair, 4> of{};

    [[nodiscard]] vec3 edges() const noexcept { return vec3{of[0][0], of[0][1], of[1][0]}; }
    [[nodiscard]] vec3 normal() const noexcept { return vec3{of[1][1], of[2][0], of[2][1]}; }
    [[nodiscard]] double area() const noexcept { return of[3][0]; }
};
[[gnu::always_inline]] inline void add_to(laplacian_sum& at, laplacian_sum const& corner) noexcept {
    for (std::size_t k = 0; k < 4; ++k) at.of[k] += corner.of[k];
}

/// What the corners of a triangle weigh.
template <class T>
struct corner_weights {
    three<T> area{};
    three<T> cot{};
};

template <class T>
struct face_cotangents {
    three<T> a{};
    three<T> b{};
    three<T> normal{};
    corner_weights<T> weights{};

    [[gnu::always_inline]] explicit face_cotangents(face_sides<T> const& t) noexcept : a(t.a), b(t.b) {
        T const area2 = lane_root(t.det);
        T const inverse = 1 / area2;
        auto const valid = t.valid();
        weights = {where(valid, t.corner_areas(area2, inverse)),
                   where(valid, three<T>{t.ab * inverse, (t.aa - t.ab) * inverse, (t.bb - t.ab) * inverse})};
        normal = where(valid, t.normal);
    }
    [[nodiscard, gnu::always_inline]] laplacian_sum corner(std::size_t k, std::size_t which) const noexcept {
        // Side a leads from corner 0 to 1 and lies opposite to corner 2, b from 0 to 2 opposite to 1.
        three<T> const& cot = weights.cot;
        auto const along = [&](T const& p, T const& q) __attribute__((always_inline)) {
            return k == 0 ? -(cot.z * p) - cot.y * q : k == 1 ? cot.z * p - cot.x * (q - p) : cot.y * q + cot.x * (q - p);
        };
        T const x = along(a.x, b.x);
        T const y = along(a.y, b.y);
        T const z = along(a.z, b.z);
        return {{both(x, y, which), both(z, normal.x, which), both(normal.y, normal.z, which),
                 both(weights.area[k], T{}, which)}};
    }
};

struct faces_cotangents {
    surface_view const& surface;

    [[nodiscard, gnu::always_inline]] auto of(std::size_t f) const noexcept { return face_cotangents<double>(sides_of(surface, f)); }
    [[nodiscard, gnu::always_inline]] auto of(std::size_t f, std::size_t g) const noexcept {
        return face_cotangents<number_pair>(sides_of(surface, f, g));
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
    /// O(vertices + faces); 64 bytes of scratch memory per vertex, with several threads and 4 per face and thread.
    /// \throws invalid_input  `attribute_length` for other than one number per vertex, `bad_parameter` for other rings.
    template <executor E>
    void operator()(surface_view const& s, std::span<double> mean, E const& executor) const {
        detail::require_one_per_vertex("cotangent", s, mean.size());
        detail::with_room(s, [&](estimator_room& room) {
            estimator_room::array<detail::laplacian_sum> const sums(room, s.positions.size());
            detail::sum_corners(
                s, detail::corner_shares(s, room, executor), std::span<detail::laplacian_sum>(sums), detail::laplacian_sum{}, detail::faces_cotangents{s}, executor,
                [&](std::size_t v, detail::laplacian_sum const& sum) {
                    vec3 const normal = sum.normal();
                    double const scale = length(normal) * sum.area();
                    mean[v] = scale > 0 && !s.rings->is_border(v) ? 0.25 * (dot(sum.edges(), normal) / scale) : 0.0;
                });
        });
        detail::fill_border(s, mean, executor);
    }
};

static_assert(curvature_estimator<cotangent>);

}  // namespace tafoni

#endif
