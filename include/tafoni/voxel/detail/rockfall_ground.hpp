/// \file
/// The voxels that are ground, as bits.
#ifndef TAFONI_VOXEL_DETAIL_ROCKFALL_GROUND_HPP
#define TAFONI_VOXEL_DETAIL_ROCKFALL_GROUND_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/voxel/rockfall_options.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tafoni::detail {

/// Sides follow from the place; what the user names takes 4 KiB for each brick that holds some.
class rockfall_ground {
public:
    rockfall_ground() = default;

    /// O(bricks), and O(rock voxels) where there is a predicate.
    template <executor Executor>
    rockfall_ground(sparse_grid const& grid, rockfall_options const& options, Executor const& threads) {
        for (std::size_t s = 0; s < 6; ++s) {
            bool const flip = grid.rotation().mirrored[s / 2];
            std::size_t const user = 2U * grid.rotation().axis[s / 2] + ((s % 2 == 1) != flip ? 1U : 0U);
            sides_[s] = options.sides[user] == ground_side::ground ||
                        (options.sides[user] == ground_side::by_border && s != 5 &&
                         grid.border().sides[s] != border_kind::air);
        }
        if (options.ground_where) {
            table_.assign(grid.brick_count(), 0);
            for (std::size_t b = 0; b < grid.brick_count(); ++b) {
                if (!grid.is_air_brick(b)) name_brick(b);
            }
            threads.for_blocks(grid.brick_count(), 1, [&](std::size_t from, std::size_t to) {
                for (std::size_t b = from; b < to; ++b) {
                    if (table_[b] == 0) continue;
                    for (std::size_t c = 0; c < 1024; ++c) bits_[table_[b] - 1][c] = asked(grid, options, b, c);
                }
            });
        }
        for (voxel const u : options.ground_voxels) {
            if (!grid.user_frame().contains(u)) continue;
            voxel const v = grid.from_user(u);
            if (table_.empty()) table_.assign(grid.brick_count(), 0);
            std::size_t const b = grid.brick_of(v);
            name_brick(b);
            bits_[table_[b] - 1][sparse_grid::column_of(v)] |= std::uint32_t{1} << (v.z & 31);
        }
    }

    /// False where a brick holds no ground for certain.
    [[nodiscard]] bool may_hold(sparse_grid const& grid, std::size_t brick) const noexcept {
        if (!table_.empty() && table_[brick] != 0) return true;
        voxel const low = grid.brick_corner(brick);
        std::array<std::int32_t, 3> const at{low.x >> 5, low.y >> 5, low.z >> 5};
        for (std::size_t s = 0; s < 6; ++s) {
            if (sides_[s] && at[s / 2] == (s % 2 == 0 ? 0 : grid.bricks()[s / 2] - 1)) return true;
        }
        return false;
    }
    /// False where neither a voxel nor one of its 26 neighbours is ground for certain. O(1).
    [[nodiscard]] bool may_touch(sparse_grid const& grid, voxel v) const noexcept {
        std::array<std::int32_t, 3> const at{v.x, v.y, v.z};
        for (std::size_t d = 0; d < 3; ++d) {
            if ((sides_[2 * d] && at[d] <= 1) ||
                (sides_[2 * d + 1] && at[d] + 2 >= static_cast<std::int32_t>(grid.size()[d])))
                return true;
        }
        if (table_.empty()) return false;
        for (int c = 0; c < 8; ++c) {
            voxel const w{v.x + (c & 1 ? 1 : -1), v.y + (c & 2 ? 1 : -1), v.z + (c & 4 ? 1 : -1)};
            if (!grid.contains(w) || table_[grid.brick_of(w)] != 0) return true;
        }
        return false;
    }
    /// The ground's bits of a column; bits beyond the grid may be set.
    [[nodiscard]] std::uint32_t word(sparse_grid const& grid, std::size_t brick, std::size_t column) const noexcept {
        voxel const low = grid.brick_corner(brick);
        std::array<std::size_t, 3> const& n = grid.size();
        std::size_t const x = static_cast<std::size_t>(low.x) + (column & 31);
        std::size_t const y = static_cast<std::size_t>(low.y) + (column >> 5);
        if ((sides_[0] && x == 0) || (sides_[1] && x + 1 == n[0]) || (sides_[2] && y == 0) ||
            (sides_[3] && y + 1 == n[1])) {
            return ~std::uint32_t{0};
        }
        std::uint32_t out = table_.empty() || table_[brick] == 0 ? 0 : bits_[table_[brick] - 1][column];
        if (sides_[4] && low.z == 0) out |= 1;
        if (sides_[5] && (low.z >> 5) + 1 == grid.bricks()[2]) out |= std::uint32_t{1} << ((n[2] - 1) & 31);
        return out;
    }
    [[nodiscard]] bool contains(sparse_grid const& grid, voxel v) const noexcept {
        return may_touch(grid, v) && (word(grid, grid.brick_of(v), sparse_grid::column_of(v)) >> (v.z & 31) & 1U) != 0;
    }
    /// Rock voxels that are ground. O(bricks).
    [[nodiscard]] std::size_t count(sparse_grid const& grid) const noexcept {
        std::size_t n = 0;
        for (std::size_t b = 0; b < grid.brick_count(); ++b) {
            if (grid.is_air_brick(b) || !may_hold(grid, b)) continue;
            for (std::size_t c = 0; c < 1024; ++c) {
                n += static_cast<std::size_t>(
                    std::popcount(grid.plane_word(voxel_plane::rock, b, c) & word(grid, b, c)));
            }
        }
        return n;
    }
    /// Bricks to the next side that is ground, to head for it; the height where no side is.
    [[nodiscard]] std::uint32_t distance(sparse_grid const& grid, std::size_t brick) const noexcept {
        voxel const low = grid.brick_corner(brick);
        std::array<std::int32_t, 3> const at{low.x >> 5, low.y >> 5, low.z >> 5};
        std::int32_t best = -1;
        for (std::size_t s = 0; s < 6; ++s) {
            if (!sides_[s]) continue;
            std::int32_t const d = s % 2 == 0 ? at[s / 2] : grid.bricks()[s / 2] - 1 - at[s / 2];
            if (best < 0 || d < best) best = d;
        }
        return static_cast<std::uint32_t>(best < 0 ? at[2] : best);
    }

private:
    void name_brick(std::size_t b) {
        if (table_[b] != 0) return;
        bits_.emplace_back();
        table_[b] = static_cast<std::uint32_t>(bits_.size());
    }
    static std::uint32_t asked(sparse_grid const& grid, rockfall_options const& options, std::size_t b, std::size_t c) {
        std::uint32_t out = 0;
        voxel const low = grid.brick_corner(b);
        for (std::uint32_t left = grid.plane_word(voxel_plane::rock, b, c); left != 0; left &= left - 1) {
            int const z = std::countr_zero(left);
            if (options.ground_where(grid.centre(low + voxel{static_cast<std::int32_t>(c & 31),
                                                             static_cast<std::int32_t>(c >> 5), z}))) {
                out |= std::uint32_t{1} << z;
            }
        }
        return out;
    }

    std::array<bool, 6> sides_{};  // turned axes
    std::vector<std::uint32_t> table_{};
    std::vector<std::array<std::uint32_t, 1024>> bits_{};
};

}  // namespace tafoni::detail

#endif
