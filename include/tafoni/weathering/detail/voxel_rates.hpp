/// \file
/// The rate function, asked once for every number of air voxels that a bubble can hold.
#ifndef TAFONI_WEATHERING_DETAIL_VOXEL_RATES_HPP
#define TAFONI_WEATHERING_DETAIL_VOXEL_RATES_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/voxel/bubble_stencil.hpp>
#include <tafoni/weathering/voxel_report.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// Tables of f over the counts of each bubble, and of A f + B f for the phase that runs.
class voxel_rates {
public:
    /// Strong guarantee. O(voxels of the bubbles) questions.
    template <class Process>
    void read(Process const& process, curvature_measure measure) {
        std::vector<std::size_t> first;
        std::vector<double> spheroidal;
        std::vector<double> cavernous;
        for (bubble_stencil const& s : process.bubbles.stencils()) {
            first.push_back(spheroidal.size());
            double const size = s.size();
            for (std::uint32_t air = 0; air <= s.size(); ++air) {
                double const v = air / size;
                double const rock = (s.size() - air) / size;
                bool const shares = measure == curvature_measure::air_share;
                spheroidal.push_back(checked(process.rate, shares ? v : positive(v - rock)));
                cavernous.push_back(checked(process.rate, shares ? rock : positive(rock - v)));
            }
        }
        std::vector<double> both(spheroidal.size(), 0);
        first_ = std::move(first);
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
    [[nodiscard]] std::span<double const> spheroidal_table() const noexcept { return spheroidal_; }
    [[nodiscard]] std::span<double const> cavernous_table() const noexcept { return cavernous_; }

private:
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
    std::vector<double> spheroidal_{};
    std::vector<double> cavernous_{};
    std::vector<double> both_{};
    double a_ = 0;
    double b_ = 0;
};

}  // namespace tafoni::detail

#endif
