/// \file
/// The least bubble, and the least choice of bubbles, that satisfy their concepts.
#ifndef TAFONI_TESTING_BUBBLE_ARCHETYPES_HPP
#define TAFONI_TESTING_BUBBLE_ARCHETYPES_HPP

#include <tafoni/voxel/bubble_choice.hpp>

#include <cstddef>
#include <span>

namespace tafoni::archetypes {

/// A plate of 5 x 5 voxels, two voxels to one side. Copyable by construction only.
struct bubble {
    explicit bubble(int) {}
    bubble(bubble const&) = default;
    bubble& operator=(bubble const&) = delete;
    [[nodiscard]] bool contains(vec3 const& o) const { return o[0] == 2 && o[1] * o[1] < 9 && o[2] * o[2] < 9; }
    [[nodiscard]] double reach() const { return 2; }
};

/// That bubble everywhere.
struct bubble_choice {
    explicit bubble_choice(int) {}
    bubble_choice(bubble_choice const&) = default;
    bubble_choice& operator=(bubble_choice const&) = delete;
    [[nodiscard]] std::span<bubble_stencil const> stencils() const { return {&one_, 1}; }
    [[nodiscard]] std::size_t choose(vec3 const&) const { return 0; }

private:
    bubble_stencil one_ = bubble(1);
};

static_assert(tafoni::bubble_shape<bubble> && tafoni::bubble_choice<bubble_choice>);

}  // namespace tafoni::archetypes

#endif
