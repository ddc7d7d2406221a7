/// \file
/// What a bubble is: the neighbourhood of a voxel whose share of air stands for curvature.
#ifndef TAFONI_VOXEL_BUBBLE_HPP
#define TAFONI_VOXEL_BUBBLE_HPP

#include <tafoni/core/vector.hpp>

#include <concepts>

namespace tafoni {

/// A set of voxels around a centre [Jones et al., sections 4.1 and 4.2].
///
/// `contains(offset)`: is the voxel at that offset from the centre inside? In voxels, z up, x and y along the
/// turned axes of the grid; asked at integers. `reach()`: nothing farther than this along an axis is inside;
/// voxels, 0 .. 48.
/// Laws: pure; nothing beyond the reach is inside; at least one voxel is.
/// Model: `struct mine { bool contains(vec3 const& o) const { return o.cwiseAbs().sum() < 4; }
///                       double reach() const { return 4; } };`
template <class S>
concept bubble_shape = requires(S const& s, vec3 const& offset) {
    { s.contains(offset) } -> std::same_as<bool>;
    { s.reach() } -> std::same_as<double>;
} && std::copy_constructible<S>;  // last: to ask it of any type converts it to a `bubble_stencil`, which asks here

}  // namespace tafoni

#endif
