/// \file
/// Colluvium: grains that slide and fall until they lie, and move again when what carries them goes.
#ifndef TAFONI_VOXEL_COLLUVIUM_HPP
#define TAFONI_VOXEL_COLLUVIUM_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/voxel/detail/settle_pass.hpp>
#include <tafoni/voxel/repose_rule.hpp>
#include <tafoni/voxel/sparse_grid.hpp>
#include <tafoni/voxel/voxel_change.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni {

/// What settling did, in grains. Colluvium in the grid has grown by released - `left`, exactly.
struct settle_report {
    std::size_t deposited = 0;  ///< released grains that came to rest in the grid
    std::size_t left = 0;       ///< grains that left through an airy side: released ones and old colluvium
    std::size_t moved = 0;      ///< times that colluvium moved again, those that left by it included

    friend constexpr bool operator==(settle_report const&, settle_report const&) = default;
};

/// Brings loose grains to rest [Jones et al., section 4.2, Fig. 5, lines 22 to 35].
///
/// Each grain of `released` (a voxel that is air by now), in voxel order, falls while the voxel below is air;
/// where it stands it moves to the steepest of the four sides that are too steep by `repose_rule`, and again;
/// then its voxel turns to colluvium. Equally steep sides: one of them by a hash of (seed, step, the voxel
/// that the grain came from, the voxel where it stands). Going in voxel order, no grain finds its own voxel
/// taken: any grain that comes down into a voxel was released above it.
///
/// `opened` are all voxels that became air since the last call. Colluvium which that left without support or too
/// steep moves again, also from within a stack, and so on in waves, each in voxel order, until none does: if every
/// grain lay by the rule before the voxels were opened, every grain does now, whatever carries it (colluvium with
/// colluvium above it too). A voxel of colluvium in `opened` is looked at itself; to settle a grid of
/// unknown history pass all of its colluvium. Every move takes a grain down, so it ends.
///
/// Sides of the grid that are air let grains leave; those of rock or `extend` are walls, below them a floor.
/// `changes` receives the net changes, each voxel once, in voxel order. Bricks are stored as grains need them and
/// never compacted.
struct settle_fn {
    /// O(moves x 4 baseline x (height of the drops / 32 + 1) + changes log changes).
    /// \throws invalid_input  `bad_parameter` by the rule; `out_of_range` for a voxel outside the grid, `bad_count` for
    ///         a released voxel that is named twice or is not air.
    /// Whatever is thrown, also by the executor or where memory runs out: the grid and `changes` are as they were.
    template <executor Executor = inline_executor>
    settle_report operator()(sparse_grid& grid, std::span<voxel const> released, std::span<voxel const> opened,
                             repose_rule const& rule, std::uint64_t seed, std::uint64_t step,
                             Executor const& executor, std::vector<voxel_change>& changes) const {
        rule.validate();
        std::vector<voxel> copy;
        std::span<voxel const> const grains = detail::checked_grains(grid, released, opened, copy);
        detail::settle_pass pass(grid, detail::grain_slide(grid, rule, seed, step));
        std::size_t const told = changes.size();
        try {
            settle_report report;
            report.left = pass.release(grains, executor);
            report.deposited = grains.size() - report.left;
            pass.resettle(opened, executor, report.moved, report.left);
            pass.net_changes(changes);
            return report;
        } catch (...) {
            pass.undo();
            changes.resize(told);
            throw;
        }
    }
};

/// `settle(grid, released, opened, rule, seed, step, executor, changes)`; see `settle_fn`.
inline constexpr settle_fn settle{};

}  // namespace tafoni

#endif
