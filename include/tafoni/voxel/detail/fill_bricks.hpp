/// \file
/// Brick by brick, rock where rows say so: how every filling of a grid ends.
#ifndef TAFONI_VOXEL_DETAIL_FILL_BRICKS_HPP
#define TAFONI_VOXEL_DETAIL_FILL_BRICKS_HPP

#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/detail/row_crossings.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tafoni::detail {

/// Columns of 32 voxels, x + 32 y, bit z: rock where set.
using brick_bits = std::array<std::uint32_t, 1024>;

template <voxel_grid G>
[[nodiscard]] grid_frame frame_of(G const& grid) {
    using access = grid_access<G>;
    return {.size = access::size(grid), .spacing = access::spacing(grid), .origin = access::origin(grid)};
}

/// Where bricks of rock and air go: into any grid, voxel by voxel.
template <editable_voxel_grid G>
class brick_target {
public:
    explicit brick_target(G& grid) : grid_(grid), size_(grid_access<G>::size(grid)) {}

    [[nodiscard]] up_rotation rotation() const noexcept { return {}; }
    [[nodiscard]] std::array<std::size_t, 3> const& size() const noexcept { return size_; }

    void put_uniform(voxel low, bool rock) {
        for_each(low, [rock](std::size_t, std::size_t) { return rock; });
    }
    void put(voxel low, brick_bits const& bits) {
        for_each(low, [&bits](std::size_t column, std::size_t z) { return (bits[column] >> z & 1U) != 0; });
    }

private:
    template <class IsRock>
    void for_each(voxel low, IsRock const& is_rock) {
        std::array<std::size_t, 3> const at{static_cast<std::size_t>(low.x), static_cast<std::size_t>(low.y),
                                            static_cast<std::size_t>(low.z)};
        std::array<std::size_t, 3> n{};
        for (std::size_t d = 0; d < 3; ++d) n[d] = std::min<std::size_t>(32, size_[d] - at[d]);
        for (std::size_t z = 0; z < n[2]; ++z) {
            for (std::size_t y = 0; y < n[1]; ++y) {
                for (std::size_t x = 0; x < n[0]; ++x) {
                    grid_access<G>::set(grid_, at[0] + x, at[1] + y, at[2] + z,
                                        is_rock(x + 32 * y, z) ? voxel_state::rock : voxel_state::air);
                }
            }
        }
    }

    G& grid_;
    std::array<std::size_t, 3> size_;
};

/// Into the sparse grid, in its turned axes, word by word.
template <>
class brick_target<sparse_grid> {
public:
    explicit brick_target(sparse_grid& grid) : grid_(grid) {}

    [[nodiscard]] up_rotation rotation() const noexcept { return grid_.rotation(); }
    [[nodiscard]] std::array<std::size_t, 3> const& size() const noexcept { return grid_.size(); }

    void put_uniform(voxel low, bool rock) { grid_.fill_uniform(grid_.brick_of(low), rock); }
    void put(voxel low, brick_bits const& bits) {
        sparse_grid::brick brick;
        brick.solid = bits;
        grid_.assign_brick(grid_.brick_of(low), brick);
    }

private:
    sparse_grid& grid_;
};

/// Fills a grid voxel by voxel, brick by brick of 32^3 and along x first, with rock where is_rock(voxel in the
/// user's axes) is true. Returns the voxels of rock. O(voxels).
template <editable_voxel_grid G, class IsRock>
std::size_t fill_voxels(G& grid, IsRock const& is_rock) {
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
                            voxel const at{to_coordinate(i), to_coordinate(j), to_coordinate(k)};
                            if (is_rock(rotation.to_user(at, size))) bits[i - x + 32 * (j - y)] |= std::uint32_t{1} << (k - z);
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

/// Rock from which winding number on, for the voxels of a brick; this one: from 1 on, everywhere.
struct from_one {
    [[nodiscard]] bool is_uniform(voxel) const noexcept { return true; }
    [[nodiscard]] int uniform() const noexcept { return 1; }
    [[nodiscard]] int operator()(std::size_t, std::size_t) const noexcept { return 1; }
};

/// Fills a grid with the voxels whose winding number along `rows` reaches `least`: `least.is_uniform(low)`
/// is asked per brick, then `least.uniform()` or `least(column, z)`. Returns the voxels of rock.
/// O(voxels / 32 + crossings), and O(1) per brick whose columns no crossing meets.
template <class Target, class Least>
std::size_t fill_bricks(Target target, row_crossings const& rows, Least& least) {
    std::vector<std::uint64_t> const& keys = rows.keys();
    std::array<std::size_t, 3> const size = target.size();
    struct column {
        std::size_t next = 0;
        std::size_t end = 0;
        int winding = 0;
    };
    std::vector<column> columns(1024);
    std::size_t rock = 0;
    auto const to_coordinate = [](std::size_t x) { return static_cast<std::int32_t>(x); };
    for (std::size_t y = 0; y < size[1]; y += 32) {
        for (std::size_t x = 0; x < size[0]; x += 32) {
            std::size_t const nx = std::min<std::size_t>(32, size[0] - x);
            std::size_t const ny = std::min<std::size_t>(32, size[1] - y);
            bool empty = true;
            for (std::size_t v = 0; v < ny; ++v) {
                std::size_t const row = x + size[0] * (y + v);
                auto at = static_cast<std::size_t>(
                    std::lower_bound(keys.begin(), keys.end(), rows.key_of_row(row)) - keys.begin());
                for (std::size_t u = 0; u < nx; ++u) {
                    column& c = columns[u + 32 * v];
                    c = {at, at, 0};
                    while (c.end < keys.size() && rows.row_of(keys[c.end]) == row + u) ++c.end;
                    at = c.end;
                    empty = empty && c.next == c.end;
                }
            }
            for (std::size_t z = 0; z < size[2]; z += 32) {
                voxel const low{to_coordinate(x), to_coordinate(y), to_coordinate(z)};
                std::size_t const nz = std::min<std::size_t>(32, size[2] - z);
                bool const uniform = least.is_uniform(low);
                int const from = uniform ? least.uniform() : 0;
                if (empty && uniform) {
                    target.put_uniform(low, 0 >= from);
                    if (0 >= from) rock += nx * ny * nz;
                    continue;
                }
                brick_bits bits{};
                std::uint32_t const all = nz == 32 ? ~std::uint32_t{0} : (std::uint32_t{1} << nz) - 1;
                for (std::size_t v = 0; v < ny; ++v) {
                    for (std::size_t u = 0; u < nx; ++u) {
                        column& c = columns[u + 32 * v];
                        std::uint32_t& word = bits[u + 32 * v];
                        std::size_t k = 0;
                        while (k < nz) {
                            while (c.next < c.end && rows.first_of(keys[c.next]) <= z + k) {
                                c.winding += row_crossings::turn_of(keys[c.next++]);
                            }
                            std::size_t const stop =
                                c.next < c.end ? std::min(nz, rows.first_of(keys[c.next]) - z) : nz;
                            if (uniform) {
                                // Bits k .. stop - 1.
                                if (c.winding >= from) word |= (all >> (nz - stop)) & (~std::uint32_t{0} << k);
                                k = stop;
                                continue;
                            }
                            for (; k < stop; ++k) {
                                if (c.winding >= least(u + 32 * v, k)) word |= std::uint32_t{1} << k;
                            }
                        }
                        rock += static_cast<std::size_t>(std::popcount(word));
                    }
                }
                target.put(low, bits);
            }
        }
    }
    return rock;
}

}  // namespace tafoni::detail

#endif
