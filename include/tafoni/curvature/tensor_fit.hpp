/// \file
/// Mean curvature from the change of the normal over each triangle.
#ifndef TAFONI_CURVATURE_TENSOR_FIT_HPP
#define TAFONI_CURVATURE_TENSOR_FIT_HPP

#include <tafoni/curvature/concepts.hpp>
#include <tafoni/curvature/detail/corner_sums.hpp>
#include <tafoni/curvature/detail/face_sides.hpp>
#include <tafoni/curvature/vertex_normals.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace tafoni {

namespace detail {

/// The sum of values times weights, and of the weights.
struct weighted_mean {
    number_pair sums{0, 0};
};
inline void add_to(weighted_mean& at, number_pair const& corner) noexcept { at.sums += corner; }

/// Half the trace of the tensor that fits the normals' differences along the three sides of a triangle best.
///
/// Setting the gradient of the sum of |S e - d|^2 over the sides e to zero gives S M + M S = D + D^T with M the
/// sum of e e^T and D that of d e^T, so tr S = tr(M^-1 D); for three sides that sum to zero this is the
/// divergence of the normal interpolated over the triangle.
template <class T>
struct face_mean_curvature {
    T twice_mean{};
    three<T> area{};

    face_mean_curvature() = default;
    /// `da`, `db`: of the normals, as the sides of the positions. `scale`: how much it counts.
    face_mean_curvature(face_sides<T> const& t, three<T> const& da, three<T> const& db, T const& scale) noexcept {
        auto const valid = t.valid();
        T const area2 = lane_root(t.det);
        T const trace = (t.bb * dot(t.a, da) + t.aa * dot(t.b, db) - t.ab * (dot(t.a, db) + dot(t.b, da))) / t.det;
        twice_mean = valid ? trace : T{};
        three<T> const parts = t.corner_areas(area2, 1 / area2);
        area = where(valid, three<T>{scale * parts.x, scale * parts.y, scale * parts.z});
    }
    [[nodiscard]] number_pair corner(std::size_t k, std::size_t which) const noexcept {
        return both(twice_mean * area[k], area[k], which);
    }
    [[nodiscard]] face_mean_curvature<double> part(std::size_t which) const noexcept {
        face_mean_curvature<double> one;
        one.twice_mean = one_of(twice_mean, which);
        one.area = one_of(area, which);
        return one;
    }
};

struct face_mean_curvatures {
    surface_view const& surface;
    corner_differences normal;

    /// Normals at the border lean to one side: triangles there decide only where there are no others.
    [[nodiscard]] double scale(std::size_t f) const noexcept {
        auto const& [a, b, c] = surface.triangles[f];
        return surface.rings->is_border(a) || surface.rings->is_border(b) || surface.rings->is_border(c) ? 0x1p-40 : 1.0;
    }
    [[nodiscard]] auto of(std::size_t f) const noexcept {
        return face_mean_curvature<double>(sides_of(surface, f), normal.of(f, 1), normal.of(f, 2), scale(f));
    }
    [[nodiscard]] auto of(std::size_t f, std::size_t g) const noexcept {
        return face_mean_curvature<number_pair>(sides_of(surface, f, g), normal.of_two(f, g, 1), normal.of_two(f, g, 2),
                                                number_pair{scale(f), scale(g)});
    }
    [[nodiscard]] auto const& of(std::size_t, face_mean_curvature<double> const& m) const noexcept { return m; }
};

}  // namespace detail

/// The curvature tensor of each triangle fitted to the differences of its corners' normals, averaged at
/// the vertices by mixed Voronoi areas [Rusinkiewicz 2004, sections 3 and 4; the thesis's choice, 9.1].
///
/// Only the trace of the tensor is computed: the paper's turn into the vertex's frame does not change it.
/// Normals are those of `vertex_normals`. Works on non-manifold meshes and on open ones, where the border takes the mean
/// of the neighbours behind it; triangles with an angle below about 1e-10 do not count. Fast; on irregular meshes as noisy as every method of one ring: see the
/// table in curvature/README.md. Models `curvature_estimator`.
struct tensor_fit {
    /// O(vertices + faces); 41 bytes of scratch memory per vertex, or 25 and 48 per face with several threads.
    /// \throws invalid_input  `attribute_length` for other than one number per vertex, `bad_parameter` for other rings.
    template <executor E>
    void operator()(surface_view const& s, std::span<double> mean, E const& executor) const {
        detail::require_one_per_vertex("tensor_fit", s, mean.size());
        std::vector<vec3> normal(s.positions.size());
        vertex_normals(s, normal, executor);
        auto sums = detail::corner_scratch<detail::weighted_mean>(s, executor);
        detail::sum_corners(
            s, std::span<detail::weighted_mean>(sums), detail::weighted_mean{},
            detail::face_mean_curvatures{s, {normal, s.triangles}}, executor,
            [&](std::size_t v, detail::weighted_mean const& at) {
                mean[v] = at.sums[1] > 0 ? 0.5 * (at.sums[0] / at.sums[1]) : 0.0;
            });
        detail::fill_border(s, mean, executor);
    }
};

static_assert(curvature_estimator<tensor_fit>);

}  // namespace tafoni

#endif
