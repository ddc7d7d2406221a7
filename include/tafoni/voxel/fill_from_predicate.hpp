/// \file
/// Fills a grid of voxels from a question about points.
#ifndef TAFONI_VOXEL_FILL_FROM_PREDICATE_HPP
#define TAFONI_VOXEL_FILL_FROM_PREDICATE_HPP

#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/detail/fill_bricks.hpp>

#include <concepts>
#include <cstddef>

namespace tafoni {

namespace detail {

struct fill_from_predicate_fn {
    /// Rock where inside(centre of the voxel) is true, in the user's space; air elsewhere, whatever the grid
    /// held. Asked once per voxel, brick by brick of 32^3 and along x first. Returns the voxels of rock. O(voxels);
    /// a `sparse_grid` holds no more than the result in memory meanwhile.
    /// \throws invalid_input  as `grid_frame::validate`. Where `inside` throws, some bricks are filled already.
    template <editable_voxel_grid G, class Inside>
        requires std::predicate<Inside const&, vec3 const&>
    std::size_t operator()(G& grid, Inside const& inside) const {
        grid_frame const frame = frame_of(grid);
        frame.validate();
        return fill_voxels(grid, [&](voxel v) -> bool { return inside(frame.centre(v)); });
    }
};

}  // namespace detail

/// `fill_from_predicate(grid, inside)`; see `detail::fill_from_predicate_fn`.
inline constexpr detail::fill_from_predicate_fn fill_from_predicate{};

}  // namespace tafoni

#endif
