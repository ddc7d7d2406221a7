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
    bool valid = false;

    face_mean_curvature() = default;
    face_mean_curvature(surface_view const& s, std::span<vec3 const> normal, std::size_t f) noexcept {
        triangle_sides const t(s, f);
        valid = t.valid;
        if (!valid) return;
        auto const& corners = s.triangles[f];
        vec3 const& n = normal[corners[0]];
        vec3 const da{normal[corners[1]] - n};
        vec3 const db{normal[corners[2]] - n};
        twice_mean = (t.bb * dot(t.a, da) + t.aa * dot(t.b, db) - t.ab * (dot(t.a, db) + dot(t.b, da))) / t.det;
        area = t.corner_areas();
    }
    [[nodiscard]] weighted_mean corner(std::size_t k) const noexcept { return {twice_mean * area[k], area[k]}; }
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
    /// O(vertices + faces); 40 bytes of scratch memory per vertex, and 100 per face with several threads.
    template <executor E>
    void operator()(surface_view const& s, std::span<double> mean, E const& executor) const {
        std::vector<vec3> normal(s.positions.size());
        vertex_normals(s, normal, executor);
        std::vector<detail::weighted_mean> sums(s.positions.size());
        detail::sum_corners(
            s, std::span<detail::weighted_mean>(sums), detail::weighted_mean{},
            [&](std::size_t f) { return detail::face_mean_curvature(s, normal, f); }, executor);
        for (std::size_t v = 0; v < mean.size(); ++v) mean[v] = sums[v].weight > 0 ? 0.5 * (sums[v].sum / sums[v].weight) : 0.0;
    }
};

static_assert(curvature_estimator<tensor_fit>);

}  // namespace tafoni

#endif
