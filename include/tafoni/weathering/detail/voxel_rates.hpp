/// \file
/// The rate function, asked once for every number of air voxels that a bubble can hold.
#ifndef TAFONI_WEATHERING_DETAIL_VOXEL_RATES_HPP
#define TAFONI_WEATHERING_DETAIL_VOXEL_RATES_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/voxel/bubble_stencil.hpp>
#include <tafoni/weathering/voxel_options.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// What a bubble shows on flat rock: in the outermost layer at most, in the innermost layer of the skin at least.
struct flat_air {
    std::uint32_t least = 0;  ///< voxels of air
    std::uint32_t most = 0;

    /// Over the six directions of the axes. O(rows of the bubble x its reach).
    [[nodiscard]] static flat_air of(bubble_stencil const& bubble, int skin_depth) noexcept {
        std::array<std::array<std::uint32_t, 2>, 6> beyond{};  // by side, in the first layer and in the last
        for (bubble_stencil::row const& row : bubble.rows()) {
            for (int dz = -bubble.reach(); dz <= bubble.reach(); ++dz) {
                auto const k = static_cast<unsigned>(dz + bubble_stencil::widest);
                if ((row.bits[k / 64] >> (k % 64) & 1) == 0) continue;
                std::array<int, 6> const out{-row.dx, row.dx, -row.dy, row.dy, -dz, dz};
                for (std::size_t side = 0; side < 6; ++side) {
                    if (out[side] >= 1) ++beyond[side][0];
                    if (out[side] >= skin_depth) ++beyond[side][1];
                }
            }
        }
        flat_air flat{bubble.size(), 0};
        for (auto const& [bare, deep] : beyond) {
            flat.least = std::min(flat.least, deep);
            flat.most = std::max(flat.most, bare);
        }
        return flat;
    }
};

/// Tables of f over the counts of each bubble, and of A f + B f for the phase that runs.
class voxel_rates {
public:
    /// Strong guarantee. O(voxels of the bubbles) questions.
    template <class Process>
    void read(Process const& process, voxel_options const& options) {
        std::vector<std::size_t> first;
        std::vector<bubble_of> bubbles;
        std::vector<double> spheroidal;
        std::vector<double> cavernous;
        for (bubble_stencil const& s : process.bubbles.stencils()) {
            first.push_back(spheroidal.size());
            flat_air const flat = flat_air::of(s, options.skin_depth);
            bubbles.push_back({s.size(), flat});
            for (std::uint32_t air = 0; air <= s.size(); ++air) {
                auto const [c, hollow] = measured(options.measure, air, s.size(), flat);
                spheroidal.push_back(checked(process.rate, c));
                cavernous.push_back(checked(process.rate, hollow));
            }
        }
        std::vector<double> both(spheroidal.size(), 0);
        first_ = std::move(first);
        bubbles_ = std::move(bubbles);
        spheroidal_ = std::move(spheroidal);
        cavernous_ = std::move(cavernous);
        both_ = std::move(both);
        a_ = b_ = 0;
    }
    /// A and B of the phase that runs from now on. O(voxels of the bubbles) when they differ from before.
    void set(double a, double b) noexcept {
        if (a == a_ && b == b_) return;
        a_ = a;
        b_ = b;
        for (std::size_t i = 0; i < both_.size(); ++i) both_[i] = a * spheroidal_[i] + b * cavernous_[i];
    }
    /// Per cent per step at a durability of 1.
    [[nodiscard]] double at(std::size_t bubble, std::uint32_t air) const noexcept { return both_[first_[bubble] + air]; }
    [[nodiscard]] double spheroidal(std::size_t bubble, std::uint32_t air) const noexcept {
        return spheroidal_[first_[bubble] + air];
    }
    [[nodiscard]] double cavernous(std::size_t bubble, std::uint32_t air) const noexcept {
        return cavernous_[first_[bubble] + air];
    }
    /// What the air differs by from what flat rock shows, in [-1, 1].
    [[nodiscard]] double flat_excess(std::size_t bubble, std::uint32_t air) const noexcept {
        auto const [c, hollow] = measured(curvature_measure::flat_excess, air, bubbles_[bubble].size, bubbles_[bubble].flat);
        return c - hollow;
    }
    [[nodiscard]] std::span<double const> spheroidal_table() const noexcept { return spheroidal_; }
    [[nodiscard]] std::span<double const> cavernous_table() const noexcept { return cavernous_; }

private:
    struct bubble_of {
        std::uint32_t size = 0;
        flat_air flat{};
    };
    struct arguments {
        double spheroidal = 0;
        double cavernous = 0;
    };
    static arguments measured(curvature_measure measure, std::uint32_t air, std::uint32_t size,
                              flat_air const& flat) noexcept {
        double const v = air / static_cast<double>(size);
        double const rock = (size - air) / static_cast<double>(size);
        if (measure == curvature_measure::air_share) return {v, rock};
        if (measure == curvature_measure::signed_excess) return {positive(v - rock), positive(rock - v)};
        arguments out;
        if (air > flat.most) out.spheroidal = (air - flat.most) / static_cast<double>(size - flat.most);
        if (air < flat.least) out.cavernous = (flat.least - air) / static_cast<double>(flat.least);
        return out;
    }
    static double positive(double x) noexcept { return x > 0 ? x : 0; }
    template <class Rate>
    static double checked(Rate const& rate, double c) {
        double const r = rate(c);
        if (!(r >= 0 && r <= 1e300)) {
            fail<invalid_input>(errc::bad_parameter,
                                "voxel_weathering.rate: got " + number_text(r) + " at a share of " + number_text(c) +
                                    ", allowed [0, 1e+300]",
                                {.kind = entity::parameter, .value = r, .limit = r < 0 ? 0 : 1e300});
        }
        return r;
    }

    std::vector<std::size_t> first_{};  ///< entry of each bubble's count of 0
    std::vector<bubble_of> bubbles_{};
    std::vector<double> spheroidal_{};
    std::vector<double> cavernous_{};
    std::vector<double> both_{};
    double a_ = 0;
    double b_ = 0;
};

}  // namespace tafoni::detail

#endif
