/// \file
/// A bubble from a function of your own.
#ifndef TAFONI_VOXEL_PREDICATE_BUBBLE_HPP
#define TAFONI_VOXEL_PREDICATE_BUBBLE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/voxel/bubble.hpp>

#include <concepts>

namespace tafoni {

/// What the predicate answers, within a cube: `predicate_bubble{[](vec3 const& o) { ... }, 6.0}`.
/// Models `bubble_shape`.
template <class Inside>
    requires std::predicate<Inside const&, vec3 const&>
struct predicate_bubble {
    Inside inside;       ///< of an offset in voxels, z up; pure
    double within = 16;  ///< half the edge of the cube that is asked, voxels, 0 .. 48

    [[nodiscard]] bool contains(vec3 const& offset) const {
        return std::fabs(offset[0]) <= within && std::fabs(offset[1]) <= within && std::fabs(offset[2]) <= within &&
               static_cast<bool>(inside(offset));
    }
    [[nodiscard]] double reach() const noexcept { return within; }

    /// \throws invalid_input  if the cube is not within 0 .. 48.
    void validate() const { detail::require_range("predicate_bubble.within", within, 0, 48); }
};

template <class Inside>
predicate_bubble(Inside, double) -> predicate_bubble<Inside>;
template <class Inside>
predicate_bubble(Inside) -> predicate_bubble<Inside>;

static_assert(bubble_shape<predicate_bubble<bool (*)(vec3 const&)>>);

}  // namespace tafoni

#endif
