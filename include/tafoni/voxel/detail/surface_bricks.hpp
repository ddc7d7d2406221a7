/// \file
/// Numbers the edges of a grid that a surface crosses, and walks the cells between them.
#ifndef TAFONI_VOXEL_DETAIL_SURFACE_BRICKS_HPP
#define TAFONI_VOXEL_DETAIL_SURFACE_BRICKS_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/voxel/detail/surface_cases.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace tafoni::detail {

/// Columns of 33 voxels over a block of 32^3 cells; what lies beyond the grid is air.
class cell_rows {
public:
    /// Rows of the cells whose lower corners are `low` .. `low` + 31; `low` is one below a brick. O(33^2).
    void gather(sparse_grid const& grid, voxel low) {
        auto const& bricks = grid.bricks();
        std::array<std::int32_t, 3> const at{(low.x + 1) >> 5, (low.y + 1) >> 5, (low.z + 1) >> 5};
        for (std::int32_t dy = -1; dy <= 0; ++dy) {
            for (std::int32_t dx = -1; dx <= 0; ++dx) {
                copy_column(grid, at, dx, dy, bricks);
            }
        }
    }

    /// Bit k is the voxel k above the lowest; x, y in 0 .. 32 from the lowest.
    [[nodiscard]] std::uint64_t solid(std::size_t x, std::size_t y) const noexcept { return solid_[x + 33 * y]; }
    [[nodiscard]] std::uint64_t rock(std::size_t x, std::size_t y) const noexcept { return rock_[x + 33 * y]; }

private:
    void copy_column(sparse_grid const& grid, std::array<std::int32_t, 3> const& at, std::int32_t dx, std::int32_t dy,
                     std::array<std::int32_t, 3> const& bricks) {
        std::int32_t const bx = at[0] + dx;
        std::int32_t const by = at[1] + dy;
        bool const beside = bx < 0 || bx >= bricks[0] || by < 0 || by >= bricks[1];
        auto const name = [&](std::int32_t bz) {
            return grid.brick_of({bx * sparse_grid::edge, by * sparse_grid::edge, bz * sparse_grid::edge});
        };
        bool const here = !beside && at[2] < bricks[2];
        bool const under = !beside && at[2] > 0;
        std::size_t const upper = here ? name(at[2]) : 0;
        std::size_t const lower = under ? name(at[2] - 1) : 0;
        std::size_t const y_lo = dy < 0 ? 31 : 0;
        std::size_t const x_lo = dx < 0 ? 31 : 0;
        for (std::size_t y = y_lo; y < 32; ++y) {
            for (std::size_t x = x_lo; x < 32; ++x) {
                std::size_t const column = x + 32 * y;
                std::uint64_t all = 0;
                std::uint64_t loose = 0;
                if (here) {
                    all = std::uint64_t{grid.solid_word(upper, column)} << 1;
                    loose = std::uint64_t{grid.colluvium_word(upper, column)} << 1;
                }
                if (under) {
                    all |= grid.solid_word(lower, column) >> 31;
                    loose |= grid.colluvium_word(lower, column) >> 31;
                }
                std::size_t const row = (dx < 0 ? 0 : x + 1) + 33 * (dy < 0 ? 0 : y + 1);
                solid_[row] = all;
                rock_[row] = all & ~loose;
            }
        }
    }

    std::array<std::uint64_t, 1089> solid_{};
    std::array<std::uint64_t, 1089> rock_{};
};

/// One block of cells with a boundary in it, and the numbers of the edges whose lower ends are its cells' lower corners.
struct surface_block {
    voxel low{};                                ///< lower corner of its lowest cell
    std::array<std::uint32_t, 3072> crossed{};  ///< column x + 32 y + 1024 axis, bit z
    std::array<std::uint16_t, 3072> before{};   ///< crossed edges of the same axis in earlier columns
    std::array<std::uint32_t, 3> first{};       ///< number of the first edge along each axis
    std::array<std::uint32_t, 3> edges{};
    std::array<std::size_t, 2> triangles{};     ///< of rock, of colluvium; from pass two on: their places
};

/// The triangles of one cell whose corners show solid and rock differently, sorted by what they bound.
struct split_case {
    split_case(unsigned solid_bits, unsigned rock_bits) : solid(surface_cases[solid_bits]), rock(surface_cases[rock_bits]) {
        for (unsigned r = 0; r < rock.count; ++r) {
            for (unsigned s = 0; s < solid.count; ++s) {
                if (rock.triangles[r] != solid.triangles[s]) continue;
                rock_shared |= 1U << r;
                solid_shared |= 1U << s;
            }
        }
    }
    [[nodiscard]] std::size_t colluvium_triangles() const noexcept {
        return static_cast<std::size_t>(solid.count + rock.count - 2 * std::popcount(rock_shared));
    }

    surface_case const& solid;
    surface_case const& rock;
    unsigned rock_shared = 0;   ///< triangles of rock that face air
    unsigned solid_shared = 0;  ///< the same among the triangles of solid
};

/// Calls f(x, y, z, solid bits, rock bits) for every cell of a block with a boundary in it.
template <class F>
void for_boundary_cells(cell_rows const& rows, F const& f) {
    for (std::size_t y = 0; y < 32; ++y) {
        for (std::size_t x = 0; x < 32; ++x) {
            std::array<std::uint64_t, 4> const s{rows.solid(x, y), rows.solid(x + 1, y), rows.solid(x, y + 1), rows.solid(x + 1, y + 1)};
            std::array<std::uint64_t, 4> const r{rows.rock(x, y), rows.rock(x + 1, y), rows.rock(x, y + 1), rows.rock(x + 1, y + 1)};
            auto const boundary = [](std::array<std::uint64_t, 4> const& w) {
                std::uint64_t const some = w[0] | w[1] | w[2] | w[3];
                std::uint64_t const all = w[0] & w[1] & w[2] & w[3];
                return (some | some >> 1) & ~(all & all >> 1);
            };
            std::uint64_t left = (boundary(s) | boundary(r)) & 0xFFFFFFFFU;
            auto const corners = [](std::array<std::uint64_t, 4> const& w, int z) {
                auto const part = [&](std::size_t k) { return static_cast<unsigned>(w[k] >> z & 3U); };
                unsigned const both = part(0) | part(1) << 2 | part(2) << 4 | part(3) << 6;
                unsigned const low = (both & 1U) | (both >> 1 & 2U) | (both >> 2 & 4U) | (both >> 3 & 8U);
                unsigned const high = (both >> 1 & 1U) | (both >> 2 & 2U) | (both >> 3 & 4U) | (both >> 4 & 8U);
                return low | high << 4;
            };
            for (; left != 0; left &= left - 1) {
                int const z = std::countr_zero(left);
                f(x, y, z, corners(s, z), corners(r, z));
            }
        }
    }
}

/// All blocks of cells with a boundary in them, in order, and the numbers of their edges.
///
/// Depends on the grid only, not on the executor. Memory: 18 KiB per block, 4 bytes per 32^3 cells.
class surface_blocks {
public:
    template <executor E>
    surface_blocks(sparse_grid const& grid, E const& exec) {
        for (std::size_t d = 0; d < 3; ++d) count_[d] = grid.size()[d] / 32 + 1;
        table_.assign(count_[0] * count_[1] * count_[2], none);
        std::vector<std::size_t> candidates;
        for (std::size_t b = 0; b < table_.size(); ++b) {
            if (!uniform(grid, low_of(b))) candidates.push_back(b);
        }
        std::vector<std::unique_ptr<surface_block>> found(candidates.size());
        exec.for_blocks(candidates.size(), 4, [&](std::size_t begin, std::size_t end) {
            auto rows = std::make_unique<cell_rows>();
            for (std::size_t k = begin; k < end; ++k) {
                rows->gather(grid, low_of(candidates[k]));
                found[k] = number(*rows, low_of(candidates[k]));
            }
        });
        std::size_t edges = 0;
        for (std::size_t k = 0; k < found.size(); ++k) {
            if (!found[k]) continue;
            for (std::size_t a = 0; a < 3; ++a) {
                found[k]->first[a] = static_cast<std::uint32_t>(edges);
                edges += found[k]->edges[a];
            }
            require_indexable("extract_voxel_surface", edges);
            for (std::size_t m = 0; m < 2; ++m) {
                std::size_t const n = found[k]->triangles[m];
                found[k]->triangles[m] = triangles_[m];
                triangles_[m] += n;
                require_indexable("extract_voxel_surface", 3 * triangles_[m]);
            }
            table_[candidates[k]] = static_cast<std::uint32_t>(blocks_.size());
            blocks_.push_back(std::move(found[k]));
        }
        edges_ = edges;
    }

    [[nodiscard]] std::size_t edge_count() const noexcept { return edges_; }
    [[nodiscard]] std::size_t rock_triangles() const noexcept { return triangles_[0]; }
    [[nodiscard]] std::size_t colluvium_triangles() const noexcept { return triangles_[1]; }
    [[nodiscard]] std::vector<std::unique_ptr<surface_block>> const& blocks() const noexcept { return blocks_; }
    [[nodiscard]] std::size_t bytes() const noexcept {
        return table_.capacity() * sizeof(std::uint32_t) + blocks_.size() * sizeof(surface_block);
    }

    /// The block and its seven upper neighbours, null where they are empty; neighbour bits x, y, z.
    using neighbours = std::array<surface_block const*, 8>;
    [[nodiscard]] neighbours around(surface_block const& b) const noexcept {
        neighbours out{};
        std::array<std::size_t, 3> const at{static_cast<std::size_t>(b.low.x + 1) / 32,
                                            static_cast<std::size_t>(b.low.y + 1) / 32,
                                            static_cast<std::size_t>(b.low.z + 1) / 32};
        for (std::size_t n = 0; n < 8; ++n) {
            std::array<std::size_t, 3> const p{at[0] + (n & 1), at[1] + (n >> 1 & 1), at[2] + (n >> 2 & 1)};
            if (p[0] >= count_[0] || p[1] >= count_[1] || p[2] >= count_[2]) continue;
            std::uint32_t const slot = table_[p[0] + count_[0] * (p[1] + count_[1] * p[2])];
            out[n] = slot == none ? nullptr : blocks_[slot].get();
        }
        return out;
    }
    /// Number of edge e of the cell (x, y, z) of the block that `around` was asked for; it has to be crossed.
    [[nodiscard]] static std::uint32_t edge(neighbours const& near_blocks, std::size_t x, std::size_t y, std::size_t z, int e) noexcept {
        auto const low = static_cast<unsigned>(cell_edge_low(e));
        auto const axis = static_cast<std::size_t>(cell_edge_axis(e));
        x += low & 1U;
        y += low >> 1 & 1U;
        z += low >> 2 & 1U;
        surface_block const& b = *near_blocks[(x >> 5) | (y >> 5) << 1 | (z >> 5) << 2];
        std::size_t const column = (x & 31) + 32 * (y & 31) + 1024 * axis;
        std::uint32_t const below = b.crossed[column] & ((std::uint32_t{1} << (z & 31)) - 1);
        return b.first[axis] + b.before[column] + static_cast<std::uint32_t>(std::popcount(below));
    }

private:
    static constexpr std::uint32_t none = 0xFFFFFFFFU;

    [[nodiscard]] voxel low_of(std::size_t b) const noexcept {
        return {static_cast<std::int32_t>(b % count_[0]) * 32 - 1,
                static_cast<std::int32_t>(b / count_[0] % count_[1]) * 32 - 1,
                static_cast<std::int32_t>(b / (count_[0] * count_[1])) * 32 - 1};
    }

    /// Whether all bricks that the block of cells sees are air, or all rock.
    static bool uniform(sparse_grid const& grid, voxel low) {
        auto const& bricks = grid.bricks();
        auto const& size = grid.size();
        bool air = true;
        bool rock = true;
        for (std::int32_t n = 0; n < 8; ++n) {
            std::array<std::int32_t, 3> const at{((low.x + 1) >> 5) - (n & 1), ((low.y + 1) >> 5) - (n >> 1 & 1),
                                                 ((low.z + 1) >> 5) - (n >> 2 & 1)};
            bool beyond = false;
            bool whole = true;
            for (std::size_t d = 0; d < 3; ++d) {
                beyond = beyond || at[d] < 0 || at[d] >= bricks[d];
                whole = whole && static_cast<std::size_t>(at[d] + 1) * 32 <= size[d];
            }
            std::size_t const b = beyond ? 0 : grid.brick_of({at[0] * 32, at[1] * 32, at[2] * 32});
            air = air && (beyond || grid.is_air_brick(b));
            rock = rock && !beyond && whole && grid.is_rock_brick(b);
        }
        return air || rock;
    }

    static std::unique_ptr<surface_block> number(cell_rows const& rows, voxel low) {
        auto b = std::make_unique<surface_block>();
        b->low = low;
        std::array<std::uint32_t, 3> sum{};
        for (std::size_t y = 0; y < 32; ++y) {
            for (std::size_t x = 0; x < 32; ++x) {
                std::uint64_t const s = rows.solid(x, y);
                std::uint64_t const r = rows.rock(x, y);
                std::array<std::uint64_t, 3> const differ{(s ^ rows.solid(x + 1, y)) | (r ^ rows.rock(x + 1, y)),
                                                          (s ^ rows.solid(x, y + 1)) | (r ^ rows.rock(x, y + 1)),
                                                          (s ^ s >> 1) | (r ^ r >> 1)};
                for (std::size_t a = 0; a < 3; ++a) {
                    std::size_t const column = x + 32 * y + 1024 * a;
                    b->crossed[column] = static_cast<std::uint32_t>(differ[a]);
                    b->before[column] = static_cast<std::uint16_t>(sum[a]);
                    sum[a] += static_cast<std::uint32_t>(std::popcount(b->crossed[column]));
                }
            }
        }
        b->edges = sum;
        bool some = false;
        for_boundary_cells(rows, [&](std::size_t, std::size_t, int, unsigned solid, unsigned rock) {
            some = true;
            b->triangles[0] += surface_cases[rock].count;
            if (solid != rock) b->triangles[1] += split_case(solid, rock).colluvium_triangles();
        });
        if (!some) b.reset();
        return b;
    }

    std::array<std::size_t, 3> count_{};
    std::vector<std::uint32_t> table_{};
    std::vector<std::unique_ptr<surface_block>> blocks_{};
    std::array<std::size_t, 2> triangles_{};
    std::size_t edges_ = 0;
};

}  // namespace tafoni::detail

#endif
