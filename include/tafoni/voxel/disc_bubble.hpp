/// \file
/// A flat bubble: sees the plan of the rock and little of what is above or below.
#ifndef TAFONI_VOXEL_DISC_BUBBLE_HPP
#define TAFONI_VOXEL_DISC_BUBBLE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/voxel/bubble.hpp>

namespace tafoni {

/// A flat upright cylinder: x^2 + y^2 < radius^2 and |z| < thickness / 2, so a thickness of 1 is one layer and of 3
/// is three [Jones et al., Figures 11 and 18]. Models `bubble_shape`.
struct disc_bubble {
    double radius = 5;     ///< voxels, > 0, at most 48
    double thickness = 1;  ///< voxels, > 0, at most 96

    [[nodiscard]] bool contains(vec3 const& offset) const noexcept {
        return offset[0] * offset[0] + offset[1] * offset[1] < radius * radius && 2 * std::fabs(offset[2]) < thickness;
    }
    [[nodiscard]] double reach() const noexcept { return radius > thickness / 2 ? radius : thickness / 2; }

    /// \throws invalid_input  if the radius is not in (0, 48] or the thickness not in (0, 96].
    void validate() const {
        detail::require_range("disc_bubble.radius", radius, 1e-9, 48);
        detail::require_range("disc_bubble.thickness", thickness, 1e-9, 96);
    }
};

static_assert(bubble_shape<disc_bubble>);

}  // namespace tafoni

#endif
