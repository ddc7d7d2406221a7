/// \file
/// One bubble everywhere.
#ifndef TAFONI_VOXEL_SINGLE_BUBBLE_HPP
#define TAFONI_VOXEL_SINGLE_BUBBLE_HPP

#include <tafoni/voxel/bubble_choice.hpp>
#include <tafoni/voxel/sphere_bubble.hpp>

#include <cstddef>
#include <span>

namespace tafoni {

/// `single_bubble{sphere_bubble{.radius = 7}}`. Models `bubble_choice`.
struct single_bubble {
    bubble_stencil bubble = sphere_bubble{};  ///< any shape converts to it

    [[nodiscard]] std::span<bubble_stencil const> stencils() const noexcept { return {&bubble, 1}; }
    [[nodiscard]] std::size_t choose(vec3 const&) const noexcept { return 0; }
};

static_assert(bubble_choice<single_bubble>);

}  // namespace tafoni

#endif
