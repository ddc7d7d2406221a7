/// \file
/// The solid voxels of a brick and around it as the counting kernels read them.
#ifndef TAFONI_VOXEL_DETAIL_AIR_ROWS_HPP
#define TAFONI_VOXEL_DETAIL_AIR_ROWS_HPP

#include <tafoni/voxel/detail/brick_window.hpp>
#include <tafoni/voxel/detail/skin_view.hpp>
#include <tafoni/voxel/detail/stencil_words.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tafoni::detail {

/// Rows of bits along z around a brick, in the three layouts of `stencil_words`. About 100 KiB of scratch for a
/// thread, and 256 KiB more once a bubble reaches beyond 16 voxels.
class air_rows {
public:
    /// Makes ready for bubbles that reach `margin` at most. O((32 + 2 margin)^2).
    void gather(sparse_grid const& grid, std::size_t brick, int margin, stencil_words::layout kind) {
        if (kind == stencil_words::layout::wide) return gather_wide(grid, brick, margin);
        window_.gather(grid, voxel_plane::solid, brick, margin);
        kind == stencil_words::layout::narrow ? split() : align();
    }

    /// Bits from height 16 (z / 16) - 8 up of the columns around a voxel, 64 to a row of columns.
    [[nodiscard]] std::uint32_t const* narrow(brick_position p) const noexcept {
        return narrow_.data() + (p >> 4 & 1) * layer + column(p);
    }
    /// Bits from height -16 up.
    [[nodiscard]] std::uint64_t const* medium(brick_position p) const noexcept { return medium_.data() + column(p); }
    /// Bits from height -48 up, 128 columns to a row; those from height 16 up lie `wide_plane` words further.
    [[nodiscard]] std::uint64_t const* wide(brick_position p) const noexcept {
        return wide_.data() + ((p >> 5 & 31) + 48) + 128 * ((p >> 10) + 48);
    }
    static constexpr std::ptrdiff_t wide_plane = 128 * 128;

private:
    static constexpr std::ptrdiff_t layer = 4096 + 16;  // a vector may begin at the last column and look beyond

    [[nodiscard]] std::ptrdiff_t column(brick_position p) const noexcept {
        return ((p >> 5 & 31) + window_.margin()) + 64 * ((p >> 10) + window_.margin());
    }

    void split() {
        narrow_.resize(2 * layer);
        int const m = window_.margin();
        int const wide = 32 + 2 * m;
        int const up = m < 8 ? 8 - m : 0;
        int const down = m < 8 ? 0 : m - 8;
        std::uint64_t const* const rows = window_.rows();
        std::uint32_t* const low = narrow_.data();
        std::uint32_t* const high = low + layer;
        for (int y = 0; y < wide; ++y) {
            for (int k = 64 * y; k < 64 * y + wide; ++k) {
                low[k] = static_cast<std::uint32_t>(rows[k] << up >> down);
                high[k] = static_cast<std::uint32_t>(rows[k] << up >> down >> 16);
            }
        }
    }
    void align() {
        medium_.resize(4096 + 8);
        int const m = window_.margin();
        int const wide = 32 + 2 * m;
        for (int y = 0; y < wide; ++y) {
            for (int k = 64 * y; k < 64 * y + wide; ++k) {
                medium_[static_cast<std::size_t>(k)] = window_.rows()[k] << (16 - m);
            }
        }
    }

    using wide_row = std::array<std::uint64_t, 2>;

    void gather_wide(sparse_grid const& grid, std::size_t brick, int margin) {
        wide_.resize(2 * wide_plane + 8);
        voxel const low = grid.brick_corner(brick);
        for (int y = -margin; y < 32 + margin; ++y) {
            for (int x = -margin; x < 32 + margin; ++x) {
                wide_row const row = bits_of_column(grid, {low.x + x, low.y + y, low.z});
                std::ptrdiff_t const at = (x + 48) + 128 * (y + 48);
                wide_[static_cast<std::size_t>(at)] = row[0];
                wide_[static_cast<std::size_t>(at + wide_plane)] = row[1];
            }
        }
    }

    /// From 48 below `low` up, beyond the grid as the border says.
    static wide_row bits_of_column(sparse_grid const& grid, voxel low) noexcept {
        voxel nearest{low.x, low.y, low.z};
        bool const beside = !grid.contains(nearest);
        border_kind const aside = beside ? grid.step_inside(nearest) : border_kind::extend;
        wide_row const solid = aside == border_kind::extend ? bits_inside(grid, nearest) : wide_row{};
        auto const height = static_cast<std::int32_t>(grid.size()[2]);
        int const first = std::max(0, 48 - low.z);           // bits from here ...
        int const end = std::min(128, height - low.z + 48);  // ... to here are within the height of the grid
        wide_row out = aside == border_kind::rock ? ones(first, end) : solid;
        auto const beyond = [&](border_kind side, int from, int to, int outermost) {
            if (from >= to) return;
            bool const rock = side == border_kind::rock || aside == border_kind::rock;
            bool const extended = side == border_kind::extend && aside == border_kind::extend;
            auto const k = static_cast<unsigned>(outermost);
            if (!rock && !(extended && (solid[k / 64] >> (k % 64) & 1) != 0)) return;
            wide_row const more = ones(from, to);
            out[0] |= more[0];
            out[1] |= more[1];
        };
        beyond(grid.border().sides[4], 0, first, first);
        beyond(grid.border().sides[5], end, 128, end - 1);
        return out;
    }
    /// Of a column inside the grid.
    static wide_row bits_inside(sparse_grid const& grid, voxel low) noexcept {
        wide_row row{};
        std::size_t const column = sparse_grid::column_of(low);
        auto const& bricks = grid.bricks();
        for (int dz = -2; dz <= 2; ++dz) {
            if ((low.z >> 5) + dz < 0 || (low.z >> 5) + dz >= bricks[2]) continue;
            std::uint64_t const word = grid.solid_word(grid.brick_of({low.x, low.y, low.z + 32 * dz}), column);
            int const bit = 48 + 32 * dz;
            if (bit < 64) row[0] |= bit < 0 ? word >> -bit : word << bit;
            if (bit >= 48) row[1] |= bit < 64 ? word >> (64 - bit) : word << (bit - 64);
        }
        return row;
    }
    /// Bits from .. to - 1 of 128.
    static wide_row ones(int from, int to) noexcept {
        auto const below = [](int n) { return n <= 0 ? 0 : n >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << n) - 1; };
        return {below(to) & ~below(from), below(to - 64) & ~below(from - 64)};
    }

    brick_window window_{};
    std::vector<std::uint32_t> narrow_{};
    std::vector<std::uint64_t> medium_{};
    std::vector<std::uint64_t> wide_{};
};

}  // namespace tafoni::detail

#endif
