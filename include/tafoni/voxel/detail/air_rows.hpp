/// \file
/// The solid voxels of a brick and around it as the counting kernels read them.
#ifndef TAFONI_VOXEL_DETAIL_AIR_ROWS_HPP
#define TAFONI_VOXEL_DETAIL_AIR_ROWS_HPP

#include <tafoni/voxel/detail/brick_window.hpp>
#include <tafoni/voxel/detail/skin_view.hpp>
#include <tafoni/voxel/detail/stencil_words.hpp>

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

    void gather_wide(sparse_grid const& grid, std::size_t brick, int margin) {
        wide_.resize(2 * wide_plane + 8);
        voxel const low = grid.brick_corner(brick);
        auto const& n = grid.size();
        auto const& bricks = grid.bricks();
        for (int y = -margin; y < 32 + margin; ++y) {
            for (int x = -margin; x < 32 + margin; ++x) {
                std::array<std::uint64_t, 2> row{};
                bool const beside =
                    static_cast<std::size_t>(low.x + x) >= n[0] || static_cast<std::size_t>(low.y + y) >= n[1];
                for (int dz = -2; dz <= 2; ++dz) {
                    if (beside || (low.z >> 5) + dz < 0 || (low.z >> 5) + dz >= bricks[2]) continue;
                    voxel const v{low.x + x, low.y + y, low.z + 32 * dz};
                    std::uint64_t const word = grid.solid_word(grid.brick_of(v), sparse_grid::column_of(v));
                    int const bit = 48 + 32 * dz;
                    if (bit < 64) row[0] |= bit < 0 ? word >> -bit : word << bit;
                    if (bit >= 48) row[1] |= bit < 64 ? word >> (64 - bit) : word << (bit - 64);
                }
                patch_wide(grid, low, x, y, beside, row);
                std::ptrdiff_t const at = (x + 48) + 128 * (y + 48);
                wide_[static_cast<std::size_t>(at)] = row[0];
                wide_[static_cast<std::size_t>(at + wide_plane)] = row[1];
            }
        }
    }
    /// What lies beyond the grid, as the border says.
    static void patch_wide(sparse_grid const& grid, voxel low, int x, int y, bool beside,
                           std::array<std::uint64_t, 2>& row) {
        auto const height = static_cast<std::int32_t>(grid.size()[2]);
        for (int z = -48; z < 80; ++z) {
            bool const within = low.z + z >= 0 && low.z + z < height;
            if (within && !beside) {
                z = height - low.z < 80 ? height - low.z - 1 : 79;
                continue;
            }
            if (!grid.is_solid({low.x + x, low.y + y, low.z + z})) continue;
            auto const k = static_cast<unsigned>(z + 48);
            row[k / 64] |= std::uint64_t{1} << (k % 64);
        }
    }

    brick_window window_{};
    std::vector<std::uint32_t> narrow_{};
    std::vector<std::uint64_t> medium_{};
    std::vector<std::uint64_t> wide_{};
};

}  // namespace tafoni::detail

#endif
