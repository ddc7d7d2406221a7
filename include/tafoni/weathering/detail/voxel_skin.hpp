/// \file
/// The skin of one brick: which voxels weather, and what is known of each.
#ifndef TAFONI_WEATHERING_DETAIL_VOXEL_SKIN_HPP
#define TAFONI_WEATHERING_DETAIL_VOXEL_SKIN_HPP

#include <tafoni/voxel/detail/brick_window.hpp>
#include <tafoni/voxel/detail/skin_view.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// Voxels of the skin of a brick, ascending by position, one array per property.
struct voxel_skin {
    std::vector<brick_position> position{};
    std::vector<std::uint16_t> bubble{};  ///< index of its stencil
    std::vector<std::uint32_t> air{};     ///< in its bubble, now
    std::vector<double> durability{};
    /// Decimation: per cent that are left. `left[now]` holds; a step writes the other and turns `now`.
    std::array<std::vector<double>, 2> left{};
    /// Voxels that weathered before something came to lie on them: they go on where they stopped.
    std::vector<brick_position> covered{};
    std::vector<double> covered_left{};
    unsigned now = 0;
    double clock = 0;  ///< time within the step that `left` belongs to; of events only, else 0

    [[nodiscard]] std::size_t size() const noexcept { return position.size(); }
    /// What is new is left to be written.
    void resize(std::size_t n) {
        position.resize(n);
        bubble.resize(n);
        air.resize(n);
        durability.resize(n);
        left[0].resize(n);
        left[1].resize(n);
    }
    /// Takes n records of another skin over, with what is left of them by `left_of`.
    void copy(voxel_skin const& from, std::vector<double> const& left_of, std::size_t first, std::size_t to,
              std::size_t n) noexcept {
        for (std::size_t i = 0; i < n; ++i) {
            position[to + i] = from.position[first + i];
            bubble[to + i] = from.bubble[first + i];
            air[to + i] = from.air[first + i];
            durability[to + i] = from.durability[first + i];
            left[0][to + i] = left_of[first + i];
        }
    }
    [[nodiscard]] skin_view view() noexcept { return {position, bubble, air}; }
    /// Index of a position, or size(). O(log size).
    [[nodiscard]] std::size_t find(brick_position p) const noexcept {
        auto const it = std::lower_bound(position.begin(), position.end(), p);
        return it != position.end() && *it == p ? static_cast<std::size_t>(it - position.begin()) : position.size();
    }
    [[nodiscard]] std::size_t bytes() const noexcept {
        return position.capacity() * 2 + bubble.capacity() * 2 + air.capacity() * 4 + covered.capacity() * 2 +
               (durability.capacity() + left[0].capacity() + left[1].capacity() + covered_left.capacity()) * 8;
    }
};

/// Bits of a brick, a word of heights per column.
using brick_bits = std::array<std::uint32_t, 1024>;

/// Solid voxels of a brick with air within `depth` (1 or 2) steps through faces. O(32^2) words.
inline void find_skin(sparse_grid const& grid, std::size_t brick, int depth, brick_window& window, brick_bits& out) {
    window.gather(grid, voxel_plane::solid, brick, depth);
    auto const near_air = [&](int x, int y) -> std::uint64_t {
        std::uint64_t const here = window.row(x, y);
        return here & ~(window.row(x - 1, y) & window.row(x + 1, y) & window.row(x, y - 1) & window.row(x, y + 1) &
                        (here >> 1) & (here << 1));
    };
    for (std::size_t c = 0; c < 1024; ++c) {
        auto const x = static_cast<int>(c & 31);
        auto const y = static_cast<int>(c >> 5);
        std::uint64_t bits = near_air(x, y);
        if (depth > 1) {
            bits |= bits >> 1 | bits << 1 | near_air(x - 1, y) | near_air(x + 1, y) | near_air(x, y - 1) |
                    near_air(x, y + 1);
            bits &= window.row(x, y);
        }
        out[c] = static_cast<std::uint32_t>(bits >> depth);
        if (out[c] != 0) out[c] &= grid.inside_word(brick, c);
    }
}

}  // namespace tafoni::detail

#endif
