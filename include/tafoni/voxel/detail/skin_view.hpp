/// \file
/// The records of the voxels of one brick that bubbles are counted for.
#ifndef TAFONI_VOXEL_DETAIL_SKIN_VIEW_HPP
#define TAFONI_VOXEL_DETAIL_SKIN_VIEW_HPP

#include <tafoni/voxel/voxel.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace tafoni::detail {

/// Place of a voxel in its brick: bit z of column x + 32 y, z + 32 (x + 32 y). The order of these is that of the
/// words of a brick's bits.
using brick_position = std::uint16_t;

[[nodiscard]] constexpr brick_position position_of(voxel v) noexcept {
    return static_cast<brick_position>((v.z & 31) | (v.x & 31) << 5 | (v.y & 31) << 10);
}
[[nodiscard]] constexpr voxel at_position(voxel brick_corner, brick_position p) noexcept {
    return {brick_corner.x + (p >> 5 & 31), brick_corner.y + (p >> 10), brick_corner.z + (p & 31)};
}

/// Views of equal length (`bubble` may be empty: all 0); record i belongs to the voxel at `position[i]`.
struct skin_view {
    std::span<brick_position const> position{};  ///< in any order, none twice; fastest where ascending
    std::span<std::uint16_t const> bubble{};     ///< the stencil of each
    std::span<std::uint32_t> air{};              ///< voxels of air in its bubble: written or updated

    [[nodiscard]] std::size_t bubble_of(std::size_t i) const noexcept { return bubble.empty() ? 0 : bubble[i]; }
};

}  // namespace tafoni::detail

#endif
