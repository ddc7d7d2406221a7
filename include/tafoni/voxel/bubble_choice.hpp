/// \file
/// Which bubble a voxel is judged by.
#ifndef TAFONI_VOXEL_BUBBLE_CHOICE_HPP
#define TAFONI_VOXEL_BUBBLE_CHOICE_HPP

#include <tafoni/core/vector.hpp>
#include <tafoni/voxel/bubble_stencil.hpp>

#include <concepts>
#include <cstddef>
#include <span>

namespace tafoni {

/// Bubbles, and which of them stands at a point [Jones et al., sections 4.2 and 5].
///
/// `stencils()`: all bubbles, 1 .. 65536. `choose(p)`: an index into them; p in the user's space and length unit.
/// Laws: pure; `choose` is below the number of bubbles at every finite point.
/// Model: `struct mine { std::vector<bubble_stencil> b{sphere_bubble{3}, sphere_bubble{7}};
///                       std::span<bubble_stencil const> stencils() const { return b; }
///                       std::size_t choose(vec3 const& p) const { return p[2] > 0 ? 1 : 0; } };`
template <class C>
concept bubble_choice = std::copy_constructible<C> && requires(C const& c, vec3 const& p) {
    { c.stencils() } -> std::same_as<std::span<bubble_stencil const>>;
    { c.choose(p) } -> std::same_as<std::size_t>;
};

}  // namespace tafoni

#endif
