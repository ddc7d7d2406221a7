/// \file
/// How much air the bubbles of a brick's skin hold.
#ifndef TAFONI_WEATHERING_DETAIL_VOXEL_COUNT_HPP
#define TAFONI_WEATHERING_DETAIL_VOXEL_COUNT_HPP

#include <tafoni/voxel/bubble_stencil.hpp>
#include <tafoni/voxel/detail/brick_window.hpp>
#include <tafoni/weathering/detail/voxel_skin.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tafoni::detail {

/// Fills `skin.air`. O(size rows of the bubbles).
inline void count_skin(sparse_grid const& grid, std::size_t brick, std::span<bubble_stencil const> stencils,
                       brick_window& window, voxel_skin& skin) {
    voxel const corner = grid.brick_corner(brick);
    for (std::size_t s = 0; s < stencils.size(); ++s) {
        bubble_stencil const& stencil = stencils[s];
        int const reach = stencil.reach();
        bool gathered = false;
        for (std::size_t i = 0; i < skin.size(); ++i) {
            if (skin.bubble[i] != s) continue;
            if (!gathered && reach <= brick_window::widest) {
                window.gather(grid, voxel_plane::solid, brick, reach);
                gathered = true;
            }
            voxel const v = voxel_at_place({0, 0, 0}, skin.place[i]);
            std::uint32_t solid = 0;
            for (auto const& row : stencil.rows()) {
                if (reach <= brick_window::widest) {
                    int const shift = bubble_stencil::widest - reach;
                    std::uint64_t mask = row.bits[0] >> shift | row.bits[1] << (64 - shift);
                    solid += static_cast<std::uint32_t>(
                        std::popcount(window.row(v.x + row.dx, v.y + row.dy) & mask << v.z));
                } else {
                    for (int dz = -reach; dz <= reach; ++dz) {
                        auto const k = static_cast<unsigned>(dz + bubble_stencil::widest);
                        if ((row.bits[k / 64] >> (k % 64) & 1) == 0) continue;
                        if (grid.is_solid(corner + v + voxel{row.dx, row.dy, dz})) ++solid;
                    }
                }
            }
            skin.air[i] = stencil.size() - solid;
        }
    }
}

}  // namespace tafoni::detail

#endif
