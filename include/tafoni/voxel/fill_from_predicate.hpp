/// \file
/// Fills a grid of voxels from a question about points.
#ifndef TAFONI_VOXEL_FILL_FROM_PREDICATE_HPP
#define TAFONI_VOXEL_FILL_FROM_PREDICATE_HPP

#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/detail/fill_bricks.hpp>

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>

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
        brick_target<G> target(grid);
        std::array<std::size_t, 3> const size = target.size();
        up_rotation const rotation = target.rotation();
        std::size_t rock = 0;
        auto const to_coordinate = [](std::size_t x) { return static_cast<std::int32_t>(x); };
        for (std::size_t z = 0; z < size[2]; z += 32) {
            for (std::size_t y = 0; y < size[1]; y += 32) {
                for (std::size_t x = 0; x < size[0]; x += 32) {
                    brick_bits bits{};
                    for (std::size_t k = z; k < std::min(z + 32, size[2]); ++k) {
                        for (std::size_t j = y; j < std::min(y + 32, size[1]); ++j) {
                            for (std::size_t i = x; i < std::min(x + 32, size[0]); ++i) {
                                voxel const user = rotation.to_user({to_coordinate(i), to_coordinate(j), to_coordinate(k)}, size);
                                if (inside(frame.centre(user))) bits[i - x + 32 * (j - y)] |= std::uint32_t{1} << (k - z);
                            }
                        }
                    }
                    for (std::uint32_t const word : bits) rock += static_cast<std::size_t>(std::popcount(word));
                    target.put({to_coordinate(x), to_coordinate(y), to_coordinate(z)}, bits);
                }
            }
        }
        return rock;
    }
};

}  // namespace detail

/// `fill_from_predicate(grid, inside)`; see `detail::fill_from_predicate_fn`.
inline constexpr detail::fill_from_predicate_fn fill_from_predicate{};

}  // namespace tafoni

#endif
