/// \file
/// The rock around a voxel as 8^3 bits, to be flooded in registers.
#ifndef TAFONI_VOXEL_DETAIL_ROCKFALL_BLOCK_HPP
#define TAFONI_VOXEL_DETAIL_ROCKFALL_BLOCK_HPP

#include <tafoni/voxel/sparse_grid.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace tafoni::detail {

/// Bit z + 8 x of layer y is voxel corner + (x, y, z).
struct rockfall_block {
    using layers = std::array<std::uint64_t, 8>;

    voxel corner{};
    layers rock{};
    std::array<layers, 3> cut{};  ///< bonds towards +x, +y, +z

    /// The voxels from 3 below `centre` to 4 above it along every axis, by word(brick, column). O(8^2).
    template <class Word>
    static rockfall_block around(sparse_grid const& grid, voxel centre, Word const& word) {
        rockfall_block out{.corner = centre - voxel{3, 3, 3}};
        out.rock = out.gather(grid, word);
        return out;
    }
    /// Bits of the block's place. O(8^2).
    template <class Word>
    [[nodiscard]] layers gather(sparse_grid const& grid, Word const& word) const {
        layers out{};
        auto const& bricks = grid.bricks();
        auto const layer = static_cast<std::size_t>(bricks[0]) * static_cast<std::size_t>(bricks[1]);
        std::int32_t const low_brick = corner.z >> 5;
        int const shift = corner.z & 31;
        for (std::int32_t y = 0; y < 8; ++y) {
            for (std::int32_t x = 0; x < 8; ++x) {
                voxel const foot{corner.x + x, corner.y + y, 0};
                if (!grid.contains(foot)) continue;
                std::size_t const column = sparse_grid::column_of(foot);
                std::size_t const bottom = grid.brick_of(foot);
                std::uint64_t bits = 0;
                if (low_brick >= 0) bits = word(bottom + layer * static_cast<std::size_t>(low_brick), column);
                if (shift > 24 && low_brick + 1 < bricks[2]) {
                    bits |= std::uint64_t{word(bottom + layer * static_cast<std::size_t>(low_brick + 1), column)} << 32;
                }
                out[static_cast<std::size_t>(y)] |= (bits >> shift & 0xFFU) << (8 * x);
            }
        }
        return out;
    }

    [[nodiscard]] bool has(layers const& in, voxel v) const noexcept {
        voxel const d = v - corner;
        return (in[static_cast<std::size_t>(d.y)] >> (d.z + 8 * d.x) & 1U) != 0;
    }
    /// What hangs together with a voxel within the block. O(longest way in the block).
    [[nodiscard]] layers flood(voxel from) const noexcept {
        constexpr std::uint64_t no_low = 0xFEFEFEFEFEFEFEFEU;
        constexpr std::uint64_t no_high = 0x7F7F7F7F7F7F7F7FU;
        layers seen{};
        voxel const d = from - corner;
        seen[static_cast<std::size_t>(d.y)] = std::uint64_t{1} << (d.z + 8 * d.x);
        for (bool again = true; again;) {
            again = false;
            std::uint64_t before = 0;
            for (std::size_t y = 0; y < 8; ++y) {
                std::uint64_t const f = seen[y];
                std::uint64_t const after = y < 7 ? seen[y + 1] & ~cut[1][y] : 0;
                std::uint64_t const along_x = (f & ~cut[0][y]) << 8 | (f >> 8 & ~cut[0][y]);
                std::uint64_t const along_z = ((f & ~cut[2][y]) << 1 & no_low) | (f >> 1 & no_high & ~cut[2][y]);
                std::uint64_t const next = (f | before | after | along_x | along_z) & rock[y];
                seen[y] = next;
                before = next & ~cut[1][y];
                again = again || next != f;
            }
        }
        return seen;
    }
    /// Whether a part of the block may go on outside.
    [[nodiscard]] static bool reaches_out(layers const& in) noexcept {
        constexpr std::uint64_t rim = 0xFF818181818181FFU;
        std::uint64_t out = in[0] | in[7];
        for (std::size_t y = 1; y < 7; ++y) out |= in[y] & rim;
        return out != 0;
    }
    /// Whether a joint cuts above or below some voxel of a part that does not reach out.
    [[nodiscard]] bool at_contact(layers const& in) const noexcept {
        std::uint64_t out = 0;
        for (std::size_t y = 0; y < 8; ++y) out |= in[y] & (cut[2][y] | cut[2][y] << 1);
        return out != 0;
    }
    template <class F>
    void for_voxels(layers const& in, F const& f) const {
        for (std::size_t y = 0; y < 8; ++y) {
            for (std::uint64_t left = in[y]; left != 0; left &= left - 1) {
                int const at = std::countr_zero(left);
                f(corner + voxel{at >> 3, static_cast<std::int32_t>(y), at & 7});
            }
        }
    }
};

}  // namespace tafoni::detail

#endif
