/// \file
/// Mean curvature of any mesh of triangles by any estimator.
#ifndef TAFONI_CURVATURE_ESTIMATE_CURVATURE_HPP
#define TAFONI_CURVATURE_ESTIMATE_CURVATURE_HPP

#include <tafoni/curvature/concepts.hpp>
#include <tafoni/curvature/tensor_fit.hpp>
#include <tafoni/geometry/triangle_surface.hpp>

#include <algorithm>
#include <vector>

namespace tafoni {

namespace detail {

struct estimate_curvature_fn {
    /// H per vertex, 1 / length unit, positive on ridges. O(vertices + faces) beside the estimator's own cost. Who
    /// estimates again and again may pass `room`, which keeps the estimator's scratch memory.
    /// \throws invalid_input  as `triangle_surface::copy_of`; `out_of_range` for a box longer than 2^200 or, but not a
    ///         point, shorter than 2^-200.
    template <polygon_mesh M, curvature_estimator Estimator = tensor_fit, executor E = inline_executor>
    [[nodiscard]] std::vector<double> operator()(M const& mesh, Estimator const& estimator = {}, E const& executor = {},
                                                 estimator_room* room = nullptr) const {
        triangle_surface const s = triangle_surface::copy_of(mesh);
        box3 box;
        for (vec3 const& p : s.positions) box.include(p);
        vec3 const e = s.positions.empty() ? vec3{0, 0, 0} : box.extent();
        double const extent = std::max({e[0], e[1], e[2]});
        if (!(extent <= 0x1p200 && (extent == 0 || extent >= 0x1p-200))) {
            fail<invalid_input>(errc::out_of_range, "estimate_curvature: the mesh is too large or too small: its box must be "
                                                    "between 2^-200 and 2^200 long",
                                {.kind = entity::vertex, .value = extent, .limit = 0x1p200});
        }
        vertex_rings const rings(s.positions.size(), s.triangles);
        std::vector<double> mean(s.positions.size());
        estimator(surface_view{.positions = s.positions, .triangles = s.triangles, .rings = &rings, .room = room}, mean, executor);
        return mean;
    }
};

}  // namespace detail

/// `estimate_curvature(mesh)`, `estimate_curvature(mesh, estimator, executor)`, `... executor, &room)`.
inline constexpr detail::estimate_curvature_fn estimate_curvature{};

}  // namespace tafoni

#endif
