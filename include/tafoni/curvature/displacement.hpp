/// \file
/// Which way a vertex goes when the surface wears.
#ifndef TAFONI_CURVATURE_DISPLACEMENT_HPP
#define TAFONI_CURVATURE_DISPLACEMENT_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/vector.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>

namespace tafoni {

/// What a direction policy knows of a vertex.
struct wear_point {
    vec3 position{0, 0, 0};  ///< in the user's frame, as the Laplacian
    /// Mean of the neighbours less the vertex [thesis, equation 9.2], length unit. Where curvature weathers an open mesh:
    /// at its border of the neighbours along it, so that its outline stays.
    vec3 laplacian{0, 0, 0};
    vec3 normal{0, 0, 0};     ///< unit, out of the solid; zero where there is none
    double curvature = 0;     ///< mean curvature over the largest absolute value in the mesh, in [-1, 1]
};

/// The vector that a displacement of size d is multiplied with.
///
/// Laws: pure; finite; of length at most 1 (but for `laplacian_direction` as printed).
/// Model: `struct down { vec3 direction(wear_point const&) const { return {0, 0, -1}; } };`
template <class P>
concept direction_policy = std::copy_constructible<P> && requires(P const& p, wear_point const& at) {
    { p.direction(at) } -> std::same_as<vec3>;
};

/// How long the Laplacian is taken.
enum class laplacian_length {
    unit,       ///< of length 1, so that a displacement is as long as equation 9.5 says
    as_printed  ///< as equation 9.4 is printed: times the Laplacian itself, a length squared in all, so that the result
                ///< depends on the model's unit
};

/// Towards the mean of the neighbours: rounds, and evens out the triangles [thesis, 9.2]. Models `direction_policy`.
struct laplacian_direction {
    laplacian_length scale = laplacian_length::unit;

    /// Of length 1, or zero where the vertex is the mean of its neighbours; as printed in length units. O(1).
    [[nodiscard]] vec3 direction(wear_point const& at) const noexcept {
        return scale == laplacian_length::unit ? normalized(at.laplacian) : at.laplacian;
    }
};

/// Straight into the solid; keeps a mesh's uneven triangles uneven. Models `direction_policy`.
struct inward_normal {
    /// Of length 1, or zero where there is no normal. O(1).
    [[nodiscard]] vec3 direction(wear_point const& at) const noexcept {
        return vec3{-at.normal[0], -at.normal[1], -at.normal[2]};
    }
};

/// Inward normal where the surface is flat, Laplacian where it is bent most, in between in proportion
/// [thesis, 9.4]. Models `direction_policy`.
struct blended_direction {
    /// Of length at most 1, shorter where the two differ. O(1).
    [[nodiscard]] vec3 direction(wear_point const& at) const noexcept {
        double const t = std::min(std::fabs(at.curvature), 1.0);
        vec3 const l = normalized(at.laplacian);
        return vec3{t * l[0] - (1 - t) * at.normal[0], t * l[1] - (1 - t) * at.normal[1],
                    t * l[2] - (1 - t) * at.normal[2]};
    }
};

static_assert(direction_policy<laplacian_direction> && direction_policy<inward_normal> &&
              direction_policy<blended_direction>);

}  // namespace tafoni

#endif
