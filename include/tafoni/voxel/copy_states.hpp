/// \file
/// Every voxel of one grid into another.
#ifndef TAFONI_VOXEL_COPY_STATES_HPP
#define TAFONI_VOXEL_COPY_STATES_HPP

#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/detail/brick_rows.hpp>
#include <tafoni/voxel/detail/grid_checks.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace tafoni {

namespace detail {

struct copy_states_fn {
    /// Afterwards `to` answers what `from` does, voxel by voxel in the axes of both users; spacing, origin,
    /// border and up axis of `to` stay as they are. Brings the result of a run back into a grid of one's own.
    /// O(voxels); quickest from and to a `sparse_grid`.
    /// \throws invalid_input  `attribute_length` when the sizes differ; nothing is changed then. Also `out_of_range`
    ///         where `from` answers a state that is none; what comes before is copied then.
    template <voxel_grid From, editable_voxel_grid To>
    void operator()(From const& from, To& to) const {
        auto const n = grid_access<From>::size(from);
        require_same_size("copy_states", n, grid_access<To>::size(to));
        if constexpr (std::is_same_v<To, sparse_grid>) {
            for (std::size_t b = 0; b < to.brick_count(); ++b) {
                sparse_grid::brick bits{};
                read_brick(from, brick_rows(to.rotation(), to.size(), to.brick_corner(b)), bits);
                to.assign_brick(b, bits);
            }
        } else if constexpr (std::is_same_v<From, sparse_grid>) {
            for (std::size_t b = 0; b < from.brick_count(); ++b) {
                sparse_grid::brick uniform{};
                sparse_grid::brick const* bits = from.stored(b);
                if (bits == nullptr) {
                    if (from.is_rock_brick(b)) uniform.solid.fill(~std::uint32_t{0});
                    bits = &uniform;
                }
                write_brick(*bits, brick_rows(from.rotation(), from.size(), from.brick_corner(b)), to);
            }
        } else {
            for (std::size_t k = 0; k < n[2]; ++k) {
                for (std::size_t j = 0; j < n[1]; ++j) {
                    for (std::size_t i = 0; i < n[0]; ++i) {
                        voxel_state const s = grid_access<From>::state(from, i, j, k);
                        require_state(static_cast<std::uint8_t>(s), i, j, k);
                        grid_access<To>::set(to, i, j, k, s);
                    }
                }
            }
        }
    }
};

}  // namespace detail

/// `copy_states(from, to)`.
inline constexpr detail::copy_states_fn copy_states{};

}  // namespace tafoni

#endif
