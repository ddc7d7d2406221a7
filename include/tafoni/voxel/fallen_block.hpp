/// \file
/// A piece of rock that has come off, as data.
#ifndef TAFONI_VOXEL_FALLEN_BLOCK_HPP
#define TAFONI_VOXEL_FALLEN_BLOCK_HPP

#include <tafoni/voxel/voxel.hpp>

#include <cstdint>
#include <vector>

namespace tafoni {

/// Voxels that hung together by their faces, uncut by joints, when they fell.
struct fallen_block {
    std::uint64_t step = 0;        ///< when
    std::vector<voxel> voxels{};   ///< turned axes, in voxel order, never empty

    friend bool operator==(fallen_block const&, fallen_block const&) = default;
};

}  // namespace tafoni

#endif
