/// \file
/// The bubble of the paper: all that is nearer than a radius.
#ifndef TAFONI_VOXEL_SPHERE_BUBBLE_HPP
#define TAFONI_VOXEL_SPHERE_BUBBLE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/voxel/bubble.hpp>

namespace tafoni {

/// |offset| < radius  [Jones et al., section 4.2]. A radius of 7 holds 1365 voxels. Models `bubble_shape`.
struct sphere_bubble {
    double radius = 5;  ///< voxels, > 0, at most 48

    [[nodiscard]] bool contains(vec3 const& offset) const noexcept { return squared_length(offset) < radius * radius; }
    [[nodiscard]] double reach() const noexcept { return radius; }

    /// \throws invalid_input  if the radius is not in (0, 48].
    void validate() const { detail::require_range("sphere_bubble.radius", radius, 1e-9, 48); }
};

static_assert(bubble_shape<sphere_bubble>);

}  // namespace tafoni

#endif
