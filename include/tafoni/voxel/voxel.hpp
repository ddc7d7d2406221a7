/// \file
/// The name of one voxel of a grid.
#ifndef TAFONI_VOXEL_VOXEL_HPP
#define TAFONI_VOXEL_VOXEL_HPP

#include <compare>
#include <cstdint>

namespace tafoni {

/// Integer coordinates of a voxel; signed, so that neighbours beyond the border have names too.
/// Ordered like the memory of a grid: by z, then y, then x.
struct voxel {
    std::int32_t x = 0;
    std::int32_t y = 0;
    std::int32_t z = 0;

    friend constexpr bool operator==(voxel const&, voxel const&) = default;
    friend constexpr std::strong_ordering operator<=>(voxel const& a, voxel const& b) noexcept {
        if (auto const c = a.z <=> b.z; c != 0) return c;
        if (auto const c = a.y <=> b.y; c != 0) return c;
        return a.x <=> b.x;
    }
    friend constexpr voxel operator+(voxel a, voxel b) noexcept { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr voxel operator-(voxel a, voxel b) noexcept { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
};

}  // namespace tafoni

#endif
