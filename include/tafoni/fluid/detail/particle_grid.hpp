/// \file
/// Particles in the cells of a regular grid, by counting sort.
#ifndef TAFONI_FLUID_DETAIL_PARTICLE_GRID_HPP
#define TAFONI_FLUID_DETAIL_PARTICLE_GRID_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/executor.hpp>
#include <tafoni/fluid/detail/sph_lanes.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tafoni::detail {

inline constexpr std::size_t particle_grain = 1024;

/// Sorts particles by cell, in a cell by their number, and says which stretches of the sorted order may hold those
/// within 2 of a point. Cells are 2 wide in y and z and a quarter of it in x, where the stretches are cut; wider
/// where particles are spread so far that there would be more than two million.
template <class Scalar>
class particle_grid {
public:
    static constexpr Scalar reach = 2;
    static constexpr std::uint32_t most_in_cell = 1024;  ///< of the least size

    /// O(particles + cells). \throws invalid_input  `size_overflow` where a cell holds more than about 1024 particles;
    /// in a fluid at rest it holds 2. `out_of_range` where the numbers end.
    template <executor E>
    void build(std::span<Scalar const> x, std::span<Scalar const> y, std::span<Scalar const> z, E const& threads) {
        std::size_t const n = x.size();
        lay_out(x, y, z);
        cell_.resize(n);
        threads.for_blocks(n, particle_grain, [&](std::size_t from, std::size_t to) {
            for (std::size_t i = from; i < to; ++i) {
                cell_[i] = static_cast<std::uint32_t>(place(0, x[i]) + size_[0] * (place(1, y[i]) + size_[1] * place(2, z[i])));
            }
        });
        begin_.assign(static_cast<std::size_t>(cells()) + 1, 0);
        for (std::uint32_t const c : cell_) ++begin_[c];
        std::uint32_t total = 0;
        for (std::size_t c = 0; c + 1 < begin_.size(); ++c) {
            std::uint32_t const here = begin_[c];
            if (here > most_) {
                fail<invalid_input>(errc::size_overflow,
                                    "sph: " + std::to_string(here) + " particles within one cell of 2 x 2 x 0.5 smoothing lengths, allowed " +
                                        std::to_string(most_) + "; the spacing is far too small for h, or they lie on one point",
                                    {.kind = entity::cell, .index = c, .value = static_cast<double>(here),
                                     .limit = static_cast<double>(most_)});
            }
            begin_[c] = total;
            total += here;
        }
        begin_.back() = total;
        order_.resize(n);
        at_.assign(begin_.begin(), begin_.end() - 1);
        for (std::size_t i = 0; i < n; ++i) order_[at_[cell_[i]]++] = static_cast<std::uint32_t>(i);
    }

    /// Sorted place -> number of the particle.
    [[nodiscard]] std::span<std::uint32_t const> order() const noexcept { return order_; }

    /// Where particles within 2 of a particle may be: rows of cells, cut to the cells within reach. O(1).
    void around(Scalar x, Scalar y, Scalar z, sph_spans& out) const noexcept {
        out.count = 0;
        auto const py = static_cast<std::int64_t>(place(1, y));
        auto const pz = static_cast<std::int64_t>(place(2, z));
        for (std::int64_t dz = -1; dz <= 1; ++dz) {
            if (pz + dz < 0 || pz + dz >= size_[2]) continue;
            Scalar const gap_z = gap(2, z, pz, dz);
            for (std::int64_t dy = -1; dy <= 1; ++dy) {
                if (py + dy < 0 || py + dy >= size_[1]) continue;
                Scalar const gap_y = gap(1, y, py, dy);
                Scalar const left = reach * reach - gap_y * gap_y - gap_z * gap_z;
                if (left < 0) continue;
                Scalar const half = std::sqrt(left) + slack_;
                std::int64_t const row = size_[0] * (py + dy + size_[1] * (pz + dz));
                auto const low = static_cast<std::size_t>(row + place(0, x - half));
                auto const high = static_cast<std::size_t>(row + place(0, x + half));
                if (begin_[low] < begin_[high + 1]) out.row[out.count++] = {begin_[low], begin_[high + 1]};
            }
        }
    }

private:
    static constexpr double most_cells = 2097152;

    void lay_out(std::span<Scalar const> x, std::span<Scalar const> y, std::span<Scalar const> z) {
        std::array<std::span<Scalar const>, 3> const all{x, y, z};
        std::array<Scalar, 3> extent{};
        for (std::size_t d = 0; d < 3; ++d) {
            Scalar low = std::numeric_limits<Scalar>::max();
            Scalar high = std::numeric_limits<Scalar>::lowest();
            for (Scalar const p : all[d]) {
                low = std::min(low, p);
                high = std::max(high, p);
            }
            if (all[d].empty()) low = high = 0;
            lo_[d] = low;
            extent[d] = high - low;
            if (std::isfinite(extent[d])) continue;
            fail<invalid_input>(errc::out_of_range, "sph: particles are farther apart than the scalar's numbers reach",
                                {.value = static_cast<double>(low), .limit = static_cast<double>(high)});
        }
        double scale = 1;
        std::array<double, 3> along{};
        for (;; scale *= 1.25) {
            for (std::size_t d = 0; d < 3; ++d) {
                cell_size_[d] = static_cast<Scalar>(reach * (d == 0 ? 0.25 : 1.0) * scale);
                inverse_[d] = 1 / cell_size_[d];
                along[d] = std::floor(static_cast<double>(extent[d]) * static_cast<double>(inverse_[d])) + 1;
            }
            if (along[0] * along[1] * along[2] <= most_cells) break;
        }
        for (std::size_t d = 0; d < 3; ++d) size_[d] = static_cast<std::int64_t>(along[d]);
        double const bound = std::min(static_cast<double>(most_in_cell) * scale * scale * scale, 4e9);
        most_ = static_cast<std::uint32_t>(bound);
        // What rounding may shift a place by, in any of the steps above.
        slack_ = 8 * std::numeric_limits<Scalar>::epsilon() * (std::max({extent[0], extent[1], extent[2]}) + 4 * cell_size_[1]);
    }
    [[nodiscard]] std::int64_t cells() const noexcept { return size_[0] * size_[1] * size_[2]; }
    [[nodiscard]] std::int64_t place(std::size_t d, Scalar p) const noexcept {
        auto const c = static_cast<std::int64_t>((p - lo_[d]) * inverse_[d]);
        return c < 0 ? 0 : c >= size_[d] ? size_[d] - 1 : c;
    }
    /// From a point in cell `here` to the row of cells beside it, no more than it is.
    [[nodiscard]] Scalar gap(std::size_t d, Scalar p, std::int64_t here, std::int64_t step) const noexcept {
        if (step == 0) return 0;
        Scalar const edge = static_cast<Scalar>(step < 0 ? here : here + 1) * cell_size_[d];
        Scalar const far = (step < 0 ? (p - lo_[d]) - edge : edge - (p - lo_[d])) - slack_;
        return far > 0 ? far : 0;
    }

    std::array<Scalar, 3> lo_{};
    std::array<Scalar, 3> cell_size_{};
    std::array<Scalar, 3> inverse_{};
    std::array<std::int64_t, 3> size_{};
    Scalar slack_ = 0;
    std::uint32_t most_ = most_in_cell;
    std::vector<std::uint32_t> cell_{};
    std::vector<std::uint32_t> begin_{};  ///< cell -> its first place in `order_`
    std::vector<std::uint32_t> at_{};
    std::vector<std::uint32_t> order_{};
};

}  // namespace tafoni::detail

#endif
