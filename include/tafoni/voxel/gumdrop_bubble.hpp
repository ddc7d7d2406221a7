/// \file
/// A dome on a flat base: rock weathers to flat-bottomed, round-topped shapes.
#ifndef TAFONI_VOXEL_GUMDROP_BUBBLE_HPP
#define TAFONI_VOXEL_GUMDROP_BUBBLE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/voxel/bubble.hpp>

namespace tafoni {

/// A half sphere of `radius` above the centre, a cylinder of that radius and of depth `base` below it, flat side
/// down [Jones et al., Figure 11 shows the shape and gives no formula; this one is ours].
/// The default depth, 2/3 of the radius, puts equal volumes above and below the centre, so that level ground
/// counts as flat, as a wall does. Models `bubble_shape`.
struct gumdrop_bubble {
    double radius = 5;             ///< voxels, > 0, at most 48
    double base = 2 * radius / 3;  ///< voxels, >= 0, at most 48

    [[nodiscard]] bool contains(vec3 const& offset) const noexcept {
        double const across = offset[0] * offset[0] + offset[1] * offset[1];
        if (offset[2] >= 0) return across + offset[2] * offset[2] < radius * radius;
        return across < radius * radius && -offset[2] < base;
    }
    [[nodiscard]] double reach() const noexcept { return radius > base ? radius : base; }

    /// \throws invalid_input  if the radius is not in (0, 48] or the base not in [0, 48].
    void validate() const {
        detail::require_range("gumdrop_bubble.radius", radius, 1e-9, 48);
        detail::require_range("gumdrop_bubble.base", base, 0, 48);
    }
};

static_assert(bubble_shape<gumdrop_bubble>);

}  // namespace tafoni

#endif
