/// \file
/// A stretched bubble: overstates the curvature along its long axis.
#ifndef TAFONI_VOXEL_ELLIPSOID_BUBBLE_HPP
#define TAFONI_VOXEL_ELLIPSOID_BUBBLE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/voxel/bubble.hpp>

namespace tafoni {

/// (x/a)^2 + (y/b)^2 + (z/c)^2 < 1  [Jones et al., section 4.2, skewed estimates]. Models `bubble_shape`.
struct ellipsoid_bubble {
    vec3 semi_axes{4, 4, 8};  ///< a, b, c: voxels, each > 0, at most 48; c upwards

    [[nodiscard]] bool contains(vec3 const& offset) const noexcept {
        double const x = offset[0] / semi_axes[0];
        double const y = offset[1] / semi_axes[1];
        double const z = offset[2] / semi_axes[2];
        return x * x + y * y + z * z < 1;
    }
    [[nodiscard]] double reach() const noexcept { return semi_axes.maxCoeff(); }

    /// \throws invalid_input  if a semi-axis is not in (0, 48].
    void validate() const {
        detail::require_range("ellipsoid_bubble.semi_axes[0]", semi_axes[0], 1e-9, 48);
        detail::require_range("ellipsoid_bubble.semi_axes[1]", semi_axes[1], 1e-9, 48);
        detail::require_range("ellipsoid_bubble.semi_axes[2]", semi_axes[2], 1e-9, 48);
    }
};

static_assert(bubble_shape<ellipsoid_bubble>);

}  // namespace tafoni

#endif
