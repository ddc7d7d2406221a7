/// \file
/// The skin of one brick: which voxels weather, and what is known of each.
#ifndef TAFONI_WEATHERING_DETAIL_VOXEL_SKIN_HPP
#define TAFONI_WEATHERING_DETAIL_VOXEL_SKIN_HPP

#include <tafoni/voxel/detail/brick_window.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tafoni::detail {

/// Place of a voxel in its brick: 32 column + height. Places ascend by column, then height.
[[nodiscard]] inline std::uint16_t place_in_brick(voxel v) noexcept {
    return static_cast<std::uint16_t>(sparse_grid::column_of(v) * 32 + static_cast<std::size_t>(v.z & 31));
}
[[nodiscard]] inline voxel voxel_at_place(voxel corner, std::uint16_t place) noexcept {
    return {corner.x + (place >> 5 & 31), corner.y + (place >> 10), corner.z + (place & 31)};
}

/// Voxels of the skin of a brick, ascending by place, one array per property.
struct voxel_skin {
    std::vector<std::uint16_t> place{};
    std::vector<std::uint16_t> bubble{};    ///< index of its stencil
    std::vector<std::uint32_t> air{};       ///< in its bubble, now
    std::vector<double> durability{};
    /// Decimation: what is left of it, per cent. One of the two is now, the other what a step is about to make it.
    std::array<std::vector<double>, 2> left{};
    /// Voxels that weathered before something came to lie on them: they go on where they stopped.
    std::vector<std::uint16_t> covered{};
    std::vector<double> covered_left{};

    [[nodiscard]] std::size_t size() const noexcept { return place.size(); }
    [[nodiscard]] bool empty() const noexcept { return place.empty() && covered.empty(); }
    void clear() noexcept {
        place.clear();
        bubble.clear();
        air.clear();
        durability.clear();
        left[0].clear();
        left[1].clear();
        covered.clear();
        covered_left.clear();
    }
    /// Index of a place, or size(). O(log size).
    [[nodiscard]] std::size_t find(std::uint16_t p) const noexcept {
        auto const it = std::lower_bound(place.begin(), place.end(), p);
        return it != place.end() && *it == p ? static_cast<std::size_t>(it - place.begin()) : place.size();
    }
};

using skin_words = std::array<std::uint32_t, 1024>;

/// Solid voxels of a brick with air within `depth` (1 or 2) steps through faces, a word of heights per column.
/// O(32^2) words.
inline void find_skin(sparse_grid const& grid, std::size_t brick, int depth, brick_window& window, skin_words& out) {
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
        out[c] = static_cast<std::uint32_t>(bits >> depth) & grid.inside_word(brick, c);
    }
}

}  // namespace tafoni::detail

#endif
