/// \file
/// What tells two grids apart, for checkpoints.
#ifndef TAFONI_WEATHERING_DETAIL_GRID_HASH_HPP
#define TAFONI_WEATHERING_DETAIL_GRID_HASH_HPP

#include <tafoni/voxel/sparse_grid.hpp>
#include <tafoni/weathering/detail/checkpoint_bytes.hpp>

#include <cstddef>
#include <cstdint>

namespace tafoni::detail {

/// A grid: frame, axes, border and every voxel. O(bricks).
[[nodiscard]] inline std::uint64_t grid_hash(sparse_grid const& grid) {
    number_hash h;
    grid_frame const& f = grid.user_frame();
    for (std::size_t d = 0; d < 3; ++d) {
        h.add(static_cast<std::uint64_t>(f.size[d]));
        h.add(f.spacing[static_cast<Eigen::Index>(d)]);
        h.add(f.origin[static_cast<Eigen::Index>(d)]);
        h.add(std::uint64_t{grid.rotation().axis[d]} * 2 + (grid.rotation().mirrored[d] ? 1 : 0));
    }
    for (border_kind const k : grid.border().sides) h.add(static_cast<std::uint64_t>(k));
    for (std::size_t b = 0; b < grid.brick_count(); ++b) {
        sparse_grid::brick const* const stored = grid.stored(b);
        if (stored == nullptr) {
            h.add(std::uint64_t{grid.is_rock_brick(b) ? 1u : 0u});
            continue;
        }
        for (std::size_t c = 0; c < 1024; ++c) h.add(std::uint64_t{stored->solid[c]} << 32 | stored->colluvium[c]);
    }
    return h.value();
}

}  // namespace tafoni::detail

#endif
