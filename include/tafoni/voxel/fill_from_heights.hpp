/// \file
/// Fills a grid of voxels with the rock under a terrain.
#ifndef TAFONI_VOXEL_FILL_FROM_HEIGHTS_HPP
#define TAFONI_VOXEL_FILL_FROM_HEIGHTS_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/geometry/height_grid.hpp>
#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/detail/fill_bricks.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace tafoni {

/// How a terrain becomes a grid of its own.
struct terrain_grid_options {
    std::size_t resolution = 0;  ///< cubes along the longer horizontal side; 0: one per cell of its smaller edge
    double base = 0;             ///< rock below the lowest height, length unit, >= 0; 0: four voxels
    double headroom = 0;         ///< air above the highest height, length unit, >= 0; 0: one voxel
};

namespace detail {

/// Heights between the places where they were measured.
class height_lookup {
public:
    /// \throws invalid_input  `empty_input`, `attribute_length`, `bad_parameter`, `non_finite_vertex`.
    explicit height_lookup(height_grid const& g) : grid_(g) {
        char const* const who = "fill_from_heights";
        if (g.columns == 0 || g.rows == 0) fail<invalid_input>(errc::empty_input, std::string(who) + ": there are no heights");
        __extension__ using wide = unsigned __int128;
        auto const require_length = [&](char const* name, std::size_t got) {
            if (wide{got} == wide{g.columns} * g.rows) return;
            fail<invalid_input>(errc::attribute_length,
                                std::string(who) + ": " + name + " has " + std::to_string(got) + " entries for " +
                                    std::to_string(g.columns) + " x " + std::to_string(g.rows) + " cells",
                                {.kind = entity::attribute, .value = static_cast<double>(got)});
        };
        require_length("heights", g.heights.size());
        if (!g.missing.empty()) require_length("missing", g.missing.size());
        require_range("height_grid.cell_size_x", g.cell_size_x, std::numeric_limits<double>::min(), 1e100);
        require_range("height_grid.cell_size_y", g.cell_size_y, std::numeric_limits<double>::min(), 1e100);
        require_range("height_grid.lower_left_x", g.lower_left_x, -1e150, 1e150);
        require_range("height_grid.lower_left_y", g.lower_left_y, -1e150, 1e150);
        for (std::size_t i = 0; i < g.heights.size(); ++i) {
            if (!g.missing.empty() && g.missing[i] != 0) continue;
            if (!(std::fabs(g.heights[i]) < 1e150)) {
                fail<invalid_input>(errc::non_finite_vertex,
                                    std::string(who) + ": the height in row " + std::to_string(i / g.columns) +
                                        ", column " + std::to_string(i % g.columns) + " is " + number_text(g.heights[i]),
                                    {.kind = entity::vertex, .index = i, .value = g.heights[i]});
            }
            lowest_ = std::min(lowest_, g.heights[i]);
            highest_ = std::max(highest_, g.heights[i]);
        }
        double const shift = g.registration == grid_registration::corner ? 0.0 : -0.5;
        corner_ = {g.lower_left_x + shift * g.cell_size_x, g.lower_left_y + shift * g.cell_size_y};
    }

    [[nodiscard]] bool any() const noexcept { return lowest_ <= highest_; }
    [[nodiscard]] double lowest() const noexcept { return lowest_; }
    [[nodiscard]] double highest() const noexcept { return highest_; }
    [[nodiscard]] std::array<double, 2> const& corner() const noexcept { return corner_; }  ///< lower left, of the cells

    /// Bilinear between the centres of four cells that have heights, else that of the cell; -inf where it has none.
    [[nodiscard]] double operator()(double x, double y) const noexcept {
        double const u = (x - corner_[0]) / grid_.cell_size_x;
        double const v = (y - corner_[1]) / grid_.cell_size_y;
        auto const nx = static_cast<double>(grid_.columns);
        auto const ny = static_cast<double>(grid_.rows);
        if (!(u >= 0 && u < nx && v >= 0 && v < ny)) return none;
        double const own = at(std::floor(u), std::floor(v));
        if (own == none) return none;
        double const s = std::clamp(u - 0.5, 0.0, nx - 1);
        double const t = std::clamp(v - 0.5, 0.0, ny - 1);
        double const i = std::min(std::floor(s), std::max(nx - 2, 0.0));
        double const j = std::min(std::floor(t), std::max(ny - 2, 0.0));
        double const i1 = std::min(i + 1, nx - 1);
        double const j1 = std::min(j + 1, ny - 1);
        double const a = at(i, j);
        double const b = at(i1, j);
        double const c = at(i, j1);
        double const d = at(i1, j1);
        if (a == none || b == none || c == none || d == none) return own;
        double const below = a + (s - i) * (b - a);
        double const above = c + (s - i) * (d - c);
        return below + (t - j) * (above - below);
    }

private:
    static constexpr double none = -std::numeric_limits<double>::infinity();

    /// Columns from the west, rows from the south.
    [[nodiscard]] double at(double column, double row) const noexcept {
        auto const c = static_cast<std::size_t>(column);
        std::size_t const r = grid_.rows - 1 - static_cast<std::size_t>(row);
        return grid_.has_height(r, c) ? grid_.height(r, c) : none;
    }

    height_grid const& grid_;
    std::array<double, 2> corner_{};
    double lowest_ = std::numeric_limits<double>::infinity();
    double highest_ = -std::numeric_limits<double>::infinity();
};

struct fill_from_heights_fn {
    /// Rock where a voxel's centre lies below the terrain, in the user's x, y, z (z up); air above it, beyond its
    /// cells and over cells without a height. Heights are bilinear between the centres of cells; beside a cell
    /// without height, and in the outer half of outer cells, the nearest hold. Returns the voxels of rock.
    /// O(columns + bricks + voxels / 32) for a `sparse_grid` whose up is +z, O(voxels) for other grids.
    /// \throws invalid_input  as `grid_frame::validate`; `empty_input` without cells, `attribute_length`,
    ///         `bad_parameter`, `non_finite_vertex` for what is wrong with the heights. The grid is then as it was.
    template <editable_voxel_grid G>
    std::size_t operator()(G& grid, height_grid const& heights) const {
        grid_frame const frame = frame_of(grid);
        frame.validate();
        height_lookup const lookup(heights);
        // Voxels of rock in a column: those whose centre is below.
        std::vector<std::int32_t> tops(frame.size[0] * frame.size[1]);
        for (std::size_t j = 0; j < frame.size[1]; ++j) {
            for (std::size_t i = 0; i < frame.size[0]; ++i) {
                vec3 const p = frame.centre({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j), 0});
                double const h = std::ceil((lookup(p[0], p[1]) - p[2]) / frame.spacing[2]);
                tops[i + frame.size[0] * j] =
                    static_cast<std::int32_t>(std::clamp(h, 0.0, static_cast<double>(frame.size[2])));
            }
        }
        brick_target<G> target(grid);
        if (target.rotation().axis[2] != 2 || target.rotation().mirrored[2]) {
            return fill_voxels(grid, [&](voxel v) {
                return v.z < tops[static_cast<std::size_t>(v.x) + frame.size[0] * static_cast<std::size_t>(v.y)];
            });
        }
        return columns(target, tops);
    }

    /// Cubes over the whole terrain as a grid that weathers at once: sides go on as their outermost voxels do,
    /// the bottom stands on rock, the top is open. \throws invalid_input  also for a terrain all of whose
    /// heights are missing (`empty_input`) and for options out of range.
    [[nodiscard]] sparse_grid operator()(height_grid const& heights, terrain_grid_options const& options = {}) const {
        height_lookup const lookup(heights);
        if (!lookup.any()) fail<invalid_input>(errc::empty_input, "fill_from_heights: every height is missing");
        require_range("terrain_grid_options.base", options.base, 0, 1e100);
        require_range("terrain_grid_options.headroom", options.headroom, 0, 1e100);
        double const width = static_cast<double>(heights.columns) * heights.cell_size_x;
        double const depth = static_cast<double>(heights.rows) * heights.cell_size_y;
        double const edge = options.resolution == 0 ? std::min(heights.cell_size_x, heights.cell_size_y)
                                                    : std::max(width, depth) / static_cast<double>(options.resolution);
        double const below = options.base > 0 ? std::ceil(options.base / edge) : 4;
        double const above = options.headroom > 0 ? std::ceil(options.headroom / edge) : 1;
        // The quotient's rounding must not add a layer.
        auto const covering = [edge](double length) { return std::max(1.0, std::ceil(length / edge * (1 - 0x1p-40))); };
        std::array<double, 3> const n{covering(width), covering(depth),
                                      below + std::ceil((lookup.highest() - lookup.lowest()) / edge) + above};
        grid_frame frame{.spacing = {edge, edge, edge},
                         .origin = {lookup.corner()[0] - 0.5 * (n[0] * edge - width),
                                    lookup.corner()[1] - 0.5 * (n[1] * edge - depth), lookup.lowest() - below * edge}};
        for (std::size_t d = 0; d < 3; ++d) {
            require_range("fill_from_heights: voxels along an axis", n[d], 1, static_cast<double>(grid_frame::longest));
            frame.size[d] = static_cast<std::size_t>(n[d]);
        }
        sparse_grid grid(frame, up_axis::plus_z,
                         {{border_kind::extend, border_kind::extend, border_kind::extend, border_kind::extend,
                           border_kind::rock, border_kind::air}});
        (*this)(grid, heights);
        return grid;
    }

private:
    template <class Target>
    static std::size_t columns(Target& target, std::vector<std::int32_t> const& tops) {
        std::array<std::size_t, 3> const size = target.size();
        auto const to_coordinate = [](std::size_t x) { return static_cast<std::int32_t>(x); };
        std::size_t rock = 0;
        for (std::size_t y = 0; y < size[1]; y += 32) {
            for (std::size_t x = 0; x < size[0]; x += 32) {
                std::size_t const nx = std::min<std::size_t>(32, size[0] - x);
                std::size_t const ny = std::min<std::size_t>(32, size[1] - y);
                std::int32_t lowest = std::numeric_limits<std::int32_t>::max();
                std::int32_t highest = 0;
                for (std::size_t v = 0; v < ny; ++v) {
                    for (std::size_t u = 0; u < nx; ++u) {
                        std::int32_t const top = tops[x + u + size[0] * (y + v)];
                        lowest = std::min(lowest, top);
                        highest = std::max(highest, top);
                        rock += static_cast<std::size_t>(top);
                    }
                }
                for (std::size_t z = 0; z < size[2]; z += 32) {
                    voxel const low{to_coordinate(x), to_coordinate(y), to_coordinate(z)};
                    std::int32_t const end = to_coordinate(std::min(z + 32, size[2]));
                    if (highest <= low.z || lowest >= end) {
                        target.put_uniform(low, lowest >= end);
                        continue;
                    }
                    brick_bits bits{};
                    for (std::size_t v = 0; v < ny; ++v) {
                        for (std::size_t u = 0; u < nx; ++u) {
                            std::int32_t const n = std::clamp(tops[x + u + size[0] * (y + v)], low.z, end) - low.z;
                            bits[u + 32 * v] = n == 32 ? ~std::uint32_t{0} : (std::uint32_t{1} << n) - 1;
                        }
                    }
                    target.put(low, bits);
                }
            }
        }
        return rock;
    }
};

}  // namespace detail

/// `fill_from_heights(grid, heights)` or `fill_from_heights(heights, options)`, which makes the grid.
inline constexpr detail::fill_from_heights_fn fill_from_heights{};

}  // namespace tafoni

#endif
