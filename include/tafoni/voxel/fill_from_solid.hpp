/// \file
/// Fills a grid of voxels with a closed solid.
#ifndef TAFONI_VOXEL_FILL_FROM_SOLID_HPP
#define TAFONI_VOXEL_FILL_FROM_SOLID_HPP

#include <tafoni/geometry/solid.hpp>
#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/detail/fill_bricks.hpp>

#include <cstddef>
#include <vector>

namespace tafoni {

namespace detail {

struct fill_from_solid_fn {
    /// Rock where the winding number of a voxel's centre is positive, so that cavities are air and shells that
    /// overlap are one rock; air elsewhere, whatever the grid held. Returns the voxels of rock.
    ///
    /// Centres on the surface fall to one of its sides; same bits everywhere. O(crossings log crossings) plus
    /// O(voxels / 32) for a `sparse_grid`, O(voxels) for other grids.
    /// \throws invalid_input  as `grid_frame::validate`; `out_of_range` for a solid 2^38 voxels away. The
    ///         grid is then as it was.
    template <editable_voxel_grid G>
    std::size_t operator()(G& grid, solid const& body) const {
        grid_frame const frame = frame_of(grid);
        frame.validate();
        brick_target<G> target(grid);
        row_crossings rows("fill_from_solid", frame, row_axes::along_up(target.rotation()));
        std::vector<row_crossings::corner> corners;
        corners.reserve(body.positions.size());
        for (vec3 const& p : body.positions) corners.push_back(rows.place(p));
        for (auto const& t : body.triangles) rows.add({corners[t[0]], corners[t[1]], corners[t[2]]});
        rows.sort();
        from_one least;
        return fill_bricks(target, rows, least);
    }
};

}  // namespace detail

/// `fill_from_solid(grid, solid)`; see `detail::fill_from_solid_fn`.
inline constexpr detail::fill_from_solid_fn fill_from_solid{};

}  // namespace tafoni

#endif
