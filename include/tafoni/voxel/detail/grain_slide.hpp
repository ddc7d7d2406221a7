/// \file
/// The way of one grain over a grid that stands still.
#ifndef TAFONI_VOXEL_DETAIL_GRAIN_SLIDE_HPP
#define TAFONI_VOXEL_DETAIL_GRAIN_SLIDE_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/voxel/detail/voxel_sort.hpp>
#include <tafoni/voxel/repose_rule.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace tafoni::detail {

/// A bijection that scatters 64 bits [Stafford 2011, mix 13].
[[nodiscard]] constexpr std::uint64_t scatter(std::uint64_t h) noexcept {
    h = (h ^ h >> 30) * 0xBF58476D1CE4E5B9ULL;
    h = (h ^ h >> 27) * 0x94D049BB133111EBULL;
    return h ^ h >> 31;
}

/// Answers where a grain goes next, from the solid voxels alone. Holds no state of the grid.
class grain_slide {
public:
    enum class step : std::uint8_t { rests, moves, leaves };

    grain_slide(sparse_grid const& grid, repose_rule const& rule, std::uint64_t seed, std::uint64_t number)
        : grid_(&grid), baseline_(rule.baseline), key_(scatter(scatter(seed + 0x9E3779B97F4A7C15ULL) ^ number)) {
        nx_ = static_cast<std::int32_t>(grid.size()[0]);
        ny_ = static_cast<std::int32_t>(grid.size()[1]);
        sides_ = grid.border().sides;
        vec3 const h = grid.spacing();
        pitch_ = {h[0], h[1]};
        square_ = pitch_[0] == pitch_[1];
        double const radians = rule.angle * 0x1.1df46a2529d39p-6;
        double const slope = elementary::sin(radians) / elementary::cos(radians);
        for (std::size_t axis = 0; axis < 2; ++axis) {
            for (int k = 1; k <= baseline_; ++k) {
                double const drop = k * pitch_[axis] * slope / h[2];
                // Roundings of the tangent must not take a voxel from 45 degrees, nor give one.
                double const n = k == baseline_ ? std::floor(drop * (1 + 1e-12)) : std::ceil(drop * (1 - 1e-12));
                limit_[axis][static_cast<std::size_t>(k)] =
                    rule.angle >= 90 ? sparse_grid::bottomless : n < 1 ? 1 : n < 1e9 ? static_cast<std::int32_t>(n) : 1000000000;
            }
        }
    }

    [[nodiscard]] int baseline() const noexcept { return baseline_; }
    [[nodiscard]] std::uint64_t grain_key(voxel start) const noexcept { return key_ ^ voxel_key(start); }

    /// Voxels of air from z downwards in a column of the grid or beyond its sides, z inside the grid. A side of
    /// rock or of more of the same is a wall; below an airy side the ground goes on where the bottom is rock.
    [[nodiscard]] std::int32_t depth(std::int32_t x, std::int32_t y, std::int32_t z) const noexcept {
        if (static_cast<std::uint32_t>(x) >= static_cast<std::uint32_t>(nx_) ||
            static_cast<std::uint32_t>(y) >= static_cast<std::uint32_t>(ny_)) {
            border_kind const beyond = x < 0 ? sides_[0] : x >= nx_ ? sides_[1] : y < 0 ? sides_[2] : sides_[3];
            if (beyond != border_kind::air) return 0;
            return sides_[4] == border_kind::rock ? z + 1 : sparse_grid::bottomless;
        }
        sparse_grid const& g = *grid_;
        std::size_t const column = sparse_grid::column_of({x, y, z});
        std::int32_t const start = z;
        while (z >= 0) {
            std::int32_t const in_word = z & 31;
            std::uint32_t const word = g.solid_word(g.brick_of({x, y, z}), column) << (31 - in_word);
            if (word != 0) return start - z + std::countl_zero(word);
            z -= in_word + 1;
        }
        return open_bottom() ? sparse_grid::bottomless : start + 1;
    }

    /// Lets the grain fall to what carries it; it stays where it stands on something.
    [[nodiscard]] step fall(voxel& p) const noexcept {
        if (p.z == 0) return open_bottom() ? step::leaves : step::rests;
        std::int32_t const n = depth(p.x, p.y, p.z - 1);
        if (n == 0) return step::rests;
        if (n == sparse_grid::bottomless) return step::leaves;
        p.z -= n;
        return step::moves;
    }

    /// From a place where it stands: to the steepest side, to the first column there that is deeper, and down in
    /// it; rests where no side is too steep. Every move lowers the grain by a voxel at least, for it ends in a
    /// column with a drop of 2 or more: so a grain makes fewer moves than the grid is high. O(4 L) columns.
    ///
    /// `wary` tells whether a deposit in any column within a baseline can change the answer. With a baseline of
    /// one and a single steepest side it cannot, but in the column that the grain goes to: deposits make others
    /// less steep only.
    [[nodiscard]] step slide(voxel& p, std::uint64_t grain, bool& wary) const noexcept {
        return baseline_ == 1 ? slide_one(p, grain, wary) : slide_far(p, grain, wary);
    }

    /// Whether a grain that lies at p would move. O(4 L) columns.
    [[nodiscard]] bool restless(voxel p) const noexcept {
        bool wary = false;
        return fall(p) != step::rests || slide(p, 0, wary) != step::rests;
    }

private:
    static constexpr std::array<std::array<std::int32_t, 2>, 4> sides_xy{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

    /// One of the bits of `sides`: the same whenever the same grain stands in the same voxel before the same choice.
    [[nodiscard]] static std::uint32_t choose(std::uint64_t grain, voxel p, std::uint32_t sides) noexcept {
        std::uint64_t const h = scatter(grain ^ scatter(voxel_key(p) + 0x9E3779B97F4A7C15ULL));
        std::uint64_t const ties = (sides & 1) + (sides >> 1 & 1) + (sides >> 2 & 1) + (sides >> 3);
        for (std::uint64_t skip = (h >> 32) * ties >> 32; skip > 0; --skip) sides &= sides - 1;
        return sides & (0U - sides);
    }

    /// Those of the four sides, as bits, that are too steep and as steep as any; without a branch where the
    /// pitch is the same along x and y.
    [[nodiscard]] std::uint32_t steepest_sides(std::array<std::int32_t, 4> const& n) const noexcept {
        std::int32_t const x_most = std::max(n[0], n[1]);
        std::int32_t const y_most = std::max(n[2], n[3]);
        std::uint32_t const x = (n[0] == x_most ? 1U : 0U) | (n[1] == x_most ? 2U : 0U);
        std::uint32_t const y = (n[2] == y_most ? 4U : 0U) | (n[3] == y_most ? 8U : 0U);
        if (square_) {
            std::uint32_t const both = (x_most >= y_most ? x : 0U) | (y_most >= x_most ? y : 0U);
            return std::max(x_most, y_most) > limit_[0][1] ? both : 0U;
        }
        double const x_slope = x_most > limit_[0][1] ? slope_of(x_most, 1, 0) : 0;
        double const y_slope = y_most > limit_[1][1] ? slope_of(y_most, 1, 1) : 0;
        return (x_slope > 0 && x_slope >= y_slope ? x : 0U) | (y_slope > 0 && y_slope >= x_slope ? y : 0U);
    }

    /// A baseline of one column: nearly always the four columns are in one brick and end in one word.
    [[nodiscard]] step slide_one(voxel& p, std::uint64_t grain, bool& wary) const noexcept {
        wary = false;
        std::array<std::int32_t, 4> n{};
        std::int32_t const in_x = p.x & 31;
        std::int32_t const in_y = p.y & 31;
        sparse_grid::brick const* const b = grid_->stored(grid_->brick_of(p));
        if (b != nullptr && in_x > 0 && in_x < 31 && in_y > 0 && in_y < 31 && p.x + 1 < nx_ && p.y + 1 < ny_) {
            std::uint32_t const* const words = b->solid.data() + sparse_grid::column_of(p);
            std::int32_t const shift = 31 - (p.z & 31);
            auto const drop = [&](std::uint32_t word, std::size_t d) {
                word <<= shift;
                return word != 0 ? std::countl_zero(word) : depth_below(p.x + sides_xy[d][0], p.y + sides_xy[d][1], p.z);
            };
            n = {drop(words[-1], 0), drop(words[1], 1), drop(words[-32], 2), drop(words[32], 3)};
        } else {
            for (std::size_t d = 0; d < 4; ++d) n[d] = depth(p.x + sides_xy[d][0], p.y + sides_xy[d][1], p.z);
        }
        std::uint32_t const steepest = steepest_sides(n);
        if (steepest == 0) return step::rests;
        wary = (steepest & (steepest - 1)) != 0;
        auto const d = static_cast<std::size_t>(std::countr_zero(wary ? choose(grain, p, steepest) : steepest));
        voxel const to{p.x + sides_xy[d][0], p.y + sides_xy[d][1], p.z - (n[d] - 1)};
        if (n[d] == sparse_grid::bottomless || to.x < 0 || to.y < 0 || to.x >= nx_ || to.y >= ny_) return step::leaves;
        p = to;
        return step::moves;
    }

    [[nodiscard]] step slide_far(voxel& p, std::uint64_t grain, bool& wary) const noexcept {
        wary = true;
        std::array<side, 4> sides{};
        double slope = 0;
        std::uint32_t steepest = 0;
        for (std::size_t d = 0; d < 4; ++d) {
            sides[d] = look(p, d);
            if (sides[d].slope == 0 || sides[d].slope < slope) continue;
            steepest = (sides[d].slope > slope ? 0U : steepest) | 1U << d;
            slope = sides[d].slope;
        }
        if (steepest == 0) return step::rests;
        side const& s = sides[static_cast<std::size_t>(std::countr_zero(choose(grain, p, steepest)))];
        if (s.leaves) return step::leaves;
        p = s.to;
        return step::moves;
    }

    /// `depth` where the column is inside the grid and its word at z is known to hold no more.
    [[nodiscard]] std::int32_t depth_below(std::int32_t x, std::int32_t y, std::int32_t z) const noexcept {
        std::int32_t const next = (z & ~31) - 1;
        if (next < 0) return open_bottom() ? sparse_grid::bottomless : z + 1;
        std::int32_t const n = depth(x, y, next);
        return n == sparse_grid::bottomless ? n : n + (z - next);
    }

    [[nodiscard]] double slope_of(std::int32_t n, int k, std::size_t axis) const noexcept {
        return n == sparse_grid::bottomless ? std::numeric_limits<double>::infinity()
                                            : static_cast<double>(n) / (k * pitch_[axis]);
    }

    struct side {
        double slope = 0;  ///< 1 / length of dz; 0 where not too steep
        voxel to{};
        bool leaves = false;
    };

    [[nodiscard]] side look(voxel p, std::size_t d) const noexcept {
        side out;
        std::size_t const axis = d / 2;
        bool found = false;
        for (std::int32_t k = 1; k <= baseline_; ++k) {
            std::int32_t const x = p.x + k * sides_xy[d][0];
            std::int32_t const y = p.y + k * sides_xy[d][1];
            std::int32_t const n = depth(x, y, p.z);
            if (n == 0) break;
            if (n >= 2 && !found) {
                found = true;
                bool const inside = x >= 0 && x < nx_ && y >= 0 && y < ny_;
                out.leaves = !inside || n == sparse_grid::bottomless;
                if (!out.leaves) out.to = {x, y, p.z - (n - 1)};
            }
            if (n > limit_[axis][static_cast<std::size_t>(k)]) {
                double const slope = slope_of(n, k, axis);
                if (slope > out.slope) out.slope = slope;
            }
        }
        return out;
    }
    [[nodiscard]] bool open_bottom() const noexcept { return sides_[4] == border_kind::air; }

    sparse_grid const* grid_;
    int baseline_;
    std::uint64_t key_;
    std::int32_t nx_ = 0;
    std::int32_t ny_ = 0;
    std::array<border_kind, 6> sides_{};
    std::array<double, 2> pitch_{};
    bool square_ = true;  ///< same pitch and limits along x and y
    std::array<std::array<std::int32_t, repose_rule::longest_baseline + 1>, 2> limit_{};
};

}  // namespace tafoni::detail

#endif
