/// \file
/// The bits of one brick and of a margin around it, side by side.
#ifndef TAFONI_VOXEL_DETAIL_BRICK_WINDOW_HPP
#define TAFONI_VOXEL_DETAIL_BRICK_WINDOW_HPP

#include <tafoni/voxel/sparse_grid.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace tafoni::detail {

/// 32 KiB: rows along z of up to 64 voxels, so that whatever lies within 16 voxels of a brick's voxel is in
/// one word per column and in the first-level cache.
class brick_window {
public:
    static constexpr int widest = 16;

    /// O((32 + 2 margin)^2). `margin` in 0 .. `widest`.
    void gather(sparse_grid const& grid, voxel_plane plane, std::size_t brick, int margin) {
        margin_ = margin;
        voxel const low = grid.brick_corner(brick);
        auto const& bricks = grid.bricks();
        std::array<std::int32_t, 3> const at{low.x >> 5, low.y >> 5, low.z >> 5};
        std::array<std::uint32_t const*, 3> words{};
        std::array<plane_words, 3> buffers;  // left as it is: 12 KiB that are seldom needed
        for (int dy = -1; dy <= 1; ++dy) {
            for (int dx = -1; dx <= 1; ++dx) {
                if (margin == 0 && (dx != 0 || dy != 0)) continue;
                patch const p{.x_lo = dx < 0 ? 32 - margin : 0, .x_hi = dx > 0 ? margin : 32,
                              .y_lo = dy < 0 ? 32 - margin : 0, .y_hi = dy > 0 ? margin : 32};
                bool const beside = at[0] + dx < 0 || at[0] + dx >= bricks[0] || at[1] + dy < 0 ||
                                    at[1] + dy >= bricks[1];
                for (int dz = -1; dz <= 1; ++dz) {
                    bool const beyond = beside || at[2] + dz < 0 || at[2] + dz >= bricks[2];
                    auto const step = static_cast<std::ptrdiff_t>(bricks[0]);
                    auto const b = static_cast<std::ptrdiff_t>(brick) +
                                   dx + step * (dy + static_cast<std::ptrdiff_t>(bricks[1]) * dz);
                    auto const which = static_cast<std::size_t>(dz + 1);
                    words[which] = beyond ? none.data()
                                          : words_of(grid, plane, static_cast<std::size_t>(b), p, buffers[which]);
                }
                join(words, p, dx, dy);
            }
        }
        patch_border(grid, plane, low);
    }

    [[nodiscard]] int margin() const noexcept { return margin_; }
    /// Bit k is the voxel at height k - margin of the column (x, y), all relative to the brick's lowest voxel.
    [[nodiscard]] std::uint64_t row(int x, int y) const noexcept {
        return rows_[static_cast<std::size_t>(x + margin_ + 64 * (y + margin_))];
    }
    /// Row (x, y) is at x + margin + 64 (y + margin).
    [[nodiscard]] std::uint64_t const* rows() const noexcept { return rows_.data(); }

private:
    [[nodiscard]] std::uint64_t& row_at(int x, int y) noexcept {
        return rows_[static_cast<std::size_t>(x + margin_ + 64 * (y + margin_))];
    }
    [[nodiscard]] std::uint64_t row_mask() const noexcept { return ~std::uint64_t{0} >> (32 - 2 * margin_); }

    using plane_words = std::array<std::uint32_t, 1024>;

    /// The columns of a neighbouring brick that the window holds.
    struct patch {
        int x_lo, x_hi, y_lo, y_hi;
    };

    static constexpr plane_words none{};
    static constexpr plane_words all = [] {
        plane_words w{};
        w.fill(~std::uint32_t{0});
        return w;
    }();

    /// Words of a brick, where they are stored or, at least for the patch, in the buffer.
    static std::uint32_t const* words_of(sparse_grid const& grid, voxel_plane plane, std::size_t b, patch const& p,
                                         plane_words& buffer) {
        sparse_grid::brick const* const stored = grid.stored(b);
        if (stored != nullptr && plane == voxel_plane::solid) return stored->solid.data();
        if (stored != nullptr && plane == voxel_plane::colluvium) return stored->colluvium.data();
        if (stored == nullptr) {
            if (grid.is_air_brick(b) || plane == voxel_plane::colluvium) return none.data();
            if (grid.inside_word(b, 1023) == ~std::uint32_t{0}) return all.data();
        }
        for (int y = p.y_lo; y < p.y_hi; ++y) {
            for (int x = p.x_lo; x < p.x_hi; ++x) {
                auto const column = static_cast<std::size_t>(x + 32 * y);
                buffer[column] = grid.plane_word(plane, b, column);
            }
        }
        return buffer.data();
    }

    /// Three bricks, one above the other, into one word per column.
    void join(std::array<std::uint32_t const*, 3> const& words, patch const& p, int dx, int dy) noexcept {
        std::uint64_t const mask = row_mask();
        for (int y = p.y_lo; y < p.y_hi; ++y) {
            std::uint32_t const* const below = words[0] + 32 * y;
            std::uint32_t const* const here = words[1] + 32 * y;
            std::uint32_t const* const above = words[2] + 32 * y;
            std::uint64_t* const rows = &row_at(p.x_lo + 32 * dx, y + 32 * dy);
            if (margin_ == 0) {
                for (int x = p.x_lo; x < p.x_hi; ++x) rows[x - p.x_lo] = here[x];
                continue;
            }
            for (int x = p.x_lo; x < p.x_hi; ++x) {
                rows[x - p.x_lo] = ((std::uint64_t{below[x]} >> (32 - margin_)) | (std::uint64_t{here[x]} << margin_) |
                                    (std::uint64_t{above[x]} << (32 + margin_))) & mask;
            }
        }
    }

    /// What lies beyond the grid shows rock or goes on as the border says.
    void patch_border(sparse_grid const& grid, voxel_plane plane, voxel low) {
        auto const& n = grid.size();
        auto const& sides = grid.border().sides;
        if (std::all_of(sides.begin(), sides.end(), [](border_kind k) { return k == border_kind::air; })) return;
        std::array<std::int32_t, 3> const at{low.x, low.y, low.z};
        bool inside = true;
        for (std::size_t d = 0; d < 3; ++d) {
            inside = inside && at[d] - margin_ >= 0 && at[d] + 32 + margin_ <= static_cast<std::int32_t>(n[d]);
        }
        if (inside) return;
        int const first = std::max(0, margin_ - low.z);
        int const end = static_cast<int>(std::min<std::int64_t>(32 + 2 * margin_, static_cast<std::int64_t>(n[2]) - low.z + margin_));
        std::uint64_t const below = low_bits(first);
        std::uint64_t const above = row_mask() & ~low_bits(end);
        std::uint64_t const rock = plane == voxel_plane::colluvium ? 0 : ~std::uint64_t{0};
        auto const beyond = [&](border_kind kind, std::uint64_t row, int outermost, std::uint64_t where) {
            if (kind == border_kind::extend) return (row >> outermost & 1) != 0 ? where : 0;
            return kind == border_kind::rock ? rock & where : 0;
        };
        int const x_end = static_cast<int>(std::min<std::int64_t>(32 + margin_, static_cast<std::int64_t>(n[0]) - low.x));
        int const y_end = static_cast<int>(std::min<std::int64_t>(32 + margin_, static_cast<std::int64_t>(n[1]) - low.y));
        int const x_first = std::max(-margin_, -low.x);
        int const y_first = std::max(-margin_, -low.y);
        for (int y = y_first; y < y_end; ++y) {
            for (int x = x_first; x < x_end; ++x) {
                std::uint64_t& row = row_at(x, y);
                row |= beyond(sides[4], row, first, below) | beyond(sides[5], row, end - 1, above);
            }
        }
        // Rock below or above shows beside the grid too, whatever lies beyond the sides.
        std::uint64_t const ends = rock & ((sides[4] == border_kind::rock ? below : 0) | (sides[5] == border_kind::rock ? above : 0));
        for (int y = -margin_; y < 32 + margin_; ++y) {
            for (int x = -margin_; x < 32 + margin_; ++x) {
                bool const x_inside = x >= x_first && x < x_end;
                bool const y_inside = y >= y_first && y < y_end;
                if (x_inside && y_inside) continue;
                border_kind const over_x = x_inside ? border_kind::extend : sides[x < x_first ? 0 : 1];
                border_kind const over_y = y_inside ? border_kind::extend : sides[y < y_first ? 2 : 3];
                if (over_x == border_kind::rock || over_y == border_kind::rock) {
                    row_at(x, y) = rock & row_mask();
                } else if (over_x == border_kind::air || over_y == border_kind::air) {
                    row_at(x, y) = ends;
                } else {
                    row_at(x, y) = row_at(std::clamp(x, x_first, x_end - 1), std::clamp(y, y_first, y_end - 1));
                }
            }
        }
    }
    static std::uint64_t low_bits(int n) noexcept {
        return n >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << n) - 1;
    }

    std::array<std::uint64_t, 4096> rows_{};
    int margin_ = 0;
};

}  // namespace tafoni::detail

#endif
