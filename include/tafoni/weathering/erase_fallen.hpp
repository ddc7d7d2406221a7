/// \file
/// What frost took away, taken out of a grid of voxels.
#ifndef TAFONI_WEATHERING_ERASE_FALLEN_HPP
#define TAFONI_WEATHERING_ERASE_FALLEN_HPP

#include <tafoni/decomposition/voxel_cells.hpp>
#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/detail/grid_checks.hpp>
#include <tafoni/weathering/frost_run.hpp>

#include <cstddef>

namespace tafoni {

namespace detail {

struct erase_fallen_fn {
    /// Rock of `grid` becomes air where the run's cells have fallen or were marked as air; whatever is not
    /// rock by now stays. The run walks cells made by `voxel_cells::from_grid`. Returns the number of voxels
    /// taken out: 0 the second time. O(cells).
    /// \throws invalid_input  `attribute_length` for a grid of another size; nothing is changed then.
    template <class Process, class Exposure, editable_voxel_grid G>
    std::size_t operator()(frost_run<voxel_cells, Process, Exposure> const& run, G& grid) const {
        using access = grid_access<G>;
        voxel_cells const& cells = run.network();
        require_same_size("erase_fallen", cells.grid().size, access::size(grid));
        std::size_t erased = 0;
        for (std::size_t c = 0; c < cells.cell_count(); ++c) {
            if (run.cell(cell_index{c}) != cell_state::air) continue;
            auto const v = cells.voxel_of(cell_index{c});
            if (access::state(grid, v[0], v[1], v[2]) != voxel_state::rock) continue;
            access::set(grid, v[0], v[1], v[2], voxel_state::air);
            ++erased;
        }
        return erased;
    }
};

}  // namespace detail

/// `erase_fallen(run, grid)`.
inline constexpr detail::erase_fallen_fn erase_fallen{};

}  // namespace tafoni

#endif
