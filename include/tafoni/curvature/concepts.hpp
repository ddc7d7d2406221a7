/// \file
/// Estimators of mean curvature on triangle meshes.
#ifndef TAFONI_CURVATURE_CONCEPTS_HPP
#define TAFONI_CURVATURE_CONCEPTS_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/curvature/estimator_room.hpp>
#include <tafoni/geometry/vertex_rings.hpp>

#include <array>
#include <concepts>
#include <cstdint>
#include <span>

namespace tafoni {

/// A mesh as an estimator sees it: views of arrays that outlive the call.
struct surface_view {
    std::span<vec3 const> positions{};
    std::span<std::array<std::uint32_t, 3> const> triangles{};  ///< counter-clockwise seen from outside
    vertex_rings const* rings = nullptr;                        ///< of these triangles; never null
    estimator_room* room = nullptr;                             ///< where scratch memory is kept; null: it is not kept
};

/// Mean curvature H = (k1 + k2) / 2 at every vertex, in 1 / length unit.
///
/// Laws: negative in hollows, positive on ridges, 1 / R on a sphere of radius R whose triangles face out;
/// finite for every input, 0 at vertices without a triangle of positive area; `mean` has one entry per
/// vertex and every entry is written; pure, and equal for every executor; scaling the mesh by s scales
/// the result by 1 / s.
/// Model: `struct flat { void operator()(surface_view const&, std::span<double> mean, executor auto const&) const {
///             std::fill(mean.begin(), mean.end(), 0.0); } };`
template <class E>
concept curvature_estimator =
    std::copy_constructible<E> &&
    requires(E const& e, surface_view const& s, std::span<double> mean, inline_executor const& x) {
        { e(s, mean, x) } -> std::same_as<void>;
    };

}  // namespace tafoni

#endif
