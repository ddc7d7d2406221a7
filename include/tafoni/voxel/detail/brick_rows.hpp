/// \file
/// Bricks of bits from and to grids of the user's, in the order of the user's memory.
#ifndef TAFONI_VOXEL_DETAIL_BRICK_ROWS_HPP
#define TAFONI_VOXEL_DETAIL_BRICK_ROWS_HPP

#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/detail/grid_checks.hpp>
#include <tafoni/voxel/grid_frame.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace tafoni::detail {

template <class G>
concept grid_of_bytes = voxel_grid<G> && requires(G const& g) {
    { grid_access<G>::bytes(g) } -> std::convertible_to<std::span<std::uint8_t const>>;
};

/// The part of a turned grid that one brick of 32^3 covers, seen row by row along the user's x.
class brick_rows {
public:
    using states = std::array<std::uint8_t, 32>;

    /// One row: where it starts in the user's grid, and its voxels in the brick. Voxel t of the row, in the
    /// turned direction, is at user x = x[0] + t or, mirrored, x[0] + length - 1 - t.
    struct row {
        std::array<std::size_t, 3> user{};   ///< the lowest user x, y, z
        std::array<std::int32_t, 3> turned{};  ///< voxel t = 0, relative to the brick's corner
    };

    brick_rows(up_rotation const& turn, std::array<std::size_t, 3> const& size, voxel low) noexcept {
        std::array<std::int32_t, 3> const at{low.x, low.y, low.z};
        for (std::size_t k = 0; k < 3; ++k) {
            std::size_t const a = turn.axis[k];
            auto const begin = static_cast<std::size_t>(at[k]);
            turned_[a] = k;
            mirrored_[a] = turn.mirrored[k];
            many_[a] = std::min<std::size_t>(32, size[k] - begin);
            low_[a] = turn.mirrored[k] ? size[k] - begin - many_[a] : begin;
        }
    }

    /// The turned axis along which the rows run.
    [[nodiscard]] std::size_t along() const noexcept { return turned_[0]; }
    [[nodiscard]] bool mirrored() const noexcept { return mirrored_[0]; }
    [[nodiscard]] std::size_t length() const noexcept { return many_[0]; }

    /// Visits the rows in the order of the user's memory.
    template <class Visit>
    void for_each(Visit const& visit) const {
        for (std::size_t k = 0; k < many_[2]; ++k) {
            for (std::size_t j = 0; j < many_[1]; ++j) {
                row r{.user = {low_[0], low_[1] + j, low_[2] + k}};
                r.turned[turned_[1]] = static_cast<std::int32_t>(mirrored_[1] ? many_[1] - 1 - j : j);
                r.turned[turned_[2]] = static_cast<std::int32_t>(mirrored_[2] ? many_[2] - 1 - k : k);
                visit(r);
            }
        }
    }

private:
    std::array<std::size_t, 3> turned_{};  ///< by the user's axes
    std::array<bool, 3> mirrored_{};
    std::array<std::size_t, 3> many_{};
    std::array<std::size_t, 3> low_{};
};

/// ORs the states of a row into the bits of a brick. O(32).
template <class Brick>
void put_row(Brick& brick, brick_rows const& rows, brick_rows::row const& r, brick_rows::states const& states) {
    auto const column = static_cast<std::size_t>(r.turned[0] + 32 * r.turned[1]);
    if (rows.along() == 2) {
        std::uint32_t solid = 0;
        std::uint32_t loose = 0;
        for (unsigned t = 0; t < 32; ++t) {
            solid |= static_cast<std::uint32_t>(states[t] != 0) << t;
            loose |= static_cast<std::uint32_t>(states[t] == 2) << t;
        }
        brick.solid[column] = solid;
        brick.colluvium[column] = loose;
        return;
    }
    auto const z = static_cast<unsigned>(r.turned[2]);
    std::uint32_t* const solid = brick.solid.data() + column;
    std::uint32_t* const loose = brick.colluvium.data() + column;
    if (rows.along() == 0) {
        for (std::size_t t = 0; t < 32; ++t) {
            solid[t] |= static_cast<std::uint32_t>(states[t] != 0) << z;
            loose[t] |= static_cast<std::uint32_t>(states[t] == 2) << z;
        }
        return;
    }
    for (std::size_t t = 0; t < 32; ++t) {
        solid[32 * t] |= static_cast<std::uint32_t>(states[t] != 0) << z;
        loose[32 * t] |= static_cast<std::uint32_t>(states[t] == 2) << z;
    }
}

/// Names the first voxel of a row whose state is none, where there is one.
inline void require_row(brick_rows const& rows, brick_rows::row const& r, brick_rows::states const& states) {
    std::uint64_t wrong = 0;  // eight bytes at once: a bit beyond the second, or both
    for (std::size_t t = 0; t < states.size(); t += 8) {
        std::uint64_t eight = 0;
        std::memcpy(&eight, states.data() + t, 8);
        wrong |= (eight & 0xFCFCFCFCFCFCFCFCU) | (eight & eight >> 1 & 0x0101010101010101U);
    }
    if (wrong == 0) return;
    std::size_t const n = rows.length();
    for (std::size_t i = 0; i < n; ++i) require_state(states[rows.mirrored() ? n - 1 - i : i], r.user[0] + i, r.user[1], r.user[2]);
}

/// Fills a brick of nothing but air from any grid. O(32^3).
/// \throws invalid_input  `attribute_length` for `bytes` of another length, `out_of_range` for a state that is none.
template <class G, class Brick>
void read_brick(G const& grid, brick_rows const& rows, Brick& out) {
    using access = grid_access<G>;
    std::size_t const n = rows.length();
    brick_rows::states states{};
    if constexpr (grid_of_bytes<G>) {
        std::span<std::uint8_t const> const bytes = access::bytes(grid);
        auto const size = access::size(grid);
        require_bytes(size, bytes);
        rows.for_each([&](brick_rows::row const& r) {
            std::uint8_t const* const first = bytes.data() + (r.user[0] + size[0] * (r.user[1] + size[1] * r.user[2]));
            if (rows.mirrored()) {
                std::reverse_copy(first, first + n, states.begin());
            } else {
                std::copy(first, first + n, states.begin());
            }
            require_row(rows, r, states);
            put_row(out, rows, r, states);
        });
    } else {
        rows.for_each([&](brick_rows::row const& r) {
            for (std::size_t i = 0; i < n; ++i) {
                voxel_state const s = access::state(grid, r.user[0] + i, r.user[1], r.user[2]);
                states[rows.mirrored() ? n - 1 - i : i] = static_cast<std::uint8_t>(s);
            }
            require_row(rows, r, states);
            put_row(out, rows, r, states);
        });
    }
}

/// Writes a brick into any grid. O(32^3).
template <class Brick, class G>
void write_brick(Brick const& brick, brick_rows const& rows, G& grid) {
    std::size_t const n = rows.length();
    rows.for_each([&](brick_rows::row const& r) {
        for (std::size_t i = 0; i < n; ++i) {
            auto at = r.turned;
            at[rows.along()] = static_cast<std::int32_t>(rows.mirrored() ? n - 1 - i : i);
            auto const column = static_cast<std::size_t>(at[0] + 32 * at[1]);
            auto const z = static_cast<unsigned>(at[2]);
            auto const solid = brick.solid[column] >> z & 1U;
            auto const loose = brick.colluvium[column] >> z & 1U;
            grid_access<G>::set(grid, r.user[0] + i, r.user[1], r.user[2], static_cast<voxel_state>(solid + loose));
        }
    });
}

}  // namespace tafoni::detail

#endif
