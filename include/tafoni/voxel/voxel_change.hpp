/// \file
/// What a process on voxels did to one of them.
#ifndef TAFONI_VOXEL_VOXEL_CHANGE_HPP
#define TAFONI_VOXEL_VOXEL_CHANGE_HPP

#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/voxel.hpp>

namespace tafoni {

/// Net effect of a process on a voxel; processes report each voxel at most once, before != after, in voxel order.
struct voxel_change {
    voxel at{};  ///< turned axes
    voxel_state before = voxel_state::air;
    voxel_state after = voxel_state::air;

    friend constexpr bool operator==(voxel_change const&, voxel_change const&) = default;
};

}  // namespace tafoni

#endif
