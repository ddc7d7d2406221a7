/// \file
/// Mean curvature from the change of the normal over each triangle.
#ifndef TAFONI_CURVATURE_TENSOR_FIT_HPP
#define TAFONI_CURVATURE_TENSOR_FIT_HPP

#include <tafoni/curvature/concepts.hpp>
#include <tafoni/curvature/detail/corner_sums.hpp>
#include <tafoni/curvature/vertex_normals.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace tafoni {

namespace detail {

struct weighted_mean {
    double sum = 0;
    double weight = 0;

    weighted_mean& operator+=(weighted_mean const& o) noexcept {
        sum += o.sum;
        weight += o.weight;
        return *this;
    }
};

/// Half the trace of the tensor that fits the normals' differences along the three sides of a triangle best.
///
/// Setting the gradient of the sum of |S e - d|^2 over the sides e to zero gives S M + M S = D + D^T with M the
/// sum of e e^T and D that of d e^T, so tr S = tr(M^-1 D); for three sides that sum to zero this is the
/// divergence of the normal interpolated over the triangle.
struct face_mean_curvature {
    double twice_mean = 0;
    std::array<double, 3> area{};

    [[nodiscard]] weighted_mean corner(std::size_t k) const noexcept { return {twice_mean * area[k], area[k]}; }
    [[nodiscard]] face_mean_curvature part() const noexcept { return *this; }
};

struct face_mean_curvatures {
    surface_view const& surface;
    std::span<vec3 const> normal;

    [[nodiscard]] face_mean_curvature face(std::size_t f) const noexcept {
        triangle_sides const t(surface, f);
        if (!t.valid) return {};
        auto const& corners = surface.triangles[f];
        vec3 const& n = normal[corners[0]];
        vec3 const da{normal[corners[1]] - n};
        vec3 const db{normal[corners[2]] - n};
        return {(t.bb * dot(t.a, da) + t.aa * dot(t.b, db) - t.ab * (dot(t.a, db) + dot(t.b, da))) / t.det,
                t.corner_areas()};
    }
    [[nodiscard]] face_mean_curvature const& face(std::size_t, face_mean_curvature const& m) const noexcept { return m; }
};

}  // namespace detail

/// The curvature tensor of each triangle fitted to the differences of its corners' normals, averaged at
/// the vertices by mixed Voronoi areas [Rusinkiewicz 2004, sections 3 and 4; the thesis's choice, 9.1].
///
/// Only the trace of the tensor is computed: the paper's turn into the vertex's frame does not change it.
/// Normals are those of `vertex_normals`. Works on open and non-manifold meshes; triangles with an angle
/// below about 1e-10 do not count. Fast; on irregular meshes as noisy as every method of one ring: see the
/// table in curvature/README.md. Models `curvature_estimator`.
struct tensor_fit {
    /// O(vertices + faces); 40 bytes of scratch memory per vertex, or 24 and 48 per face with several threads.
    template <executor E>
    void operator()(surface_view const& s, std::span<double> mean, E const& executor) const {
        std::vector<vec3> normal(s.positions.size());
        vertex_normals(s, normal, executor);
        auto sums = detail::corner_scratch<detail::weighted_mean>(s, executor);
        detail::sum_corners(
            s, std::span<detail::weighted_mean>(sums), detail::weighted_mean{}, detail::face_mean_curvatures{s, normal},
            executor, [&](std::size_t v, detail::weighted_mean const& at) {
                mean[v] = at.weight > 0 ? 0.5 * (at.sum / at.weight) : 0.0;
            });
    }
};

static_assert(curvature_estimator<tensor_fit>);

}  // namespace tafoni

#endif
