/// \file
/// How fast rock decays where a bubble finds a share c of air: the function f of the weathering rate.
#ifndef TAFONI_VOXEL_RATES_HPP
#define TAFONI_VOXEL_RATES_HPP

#include <tafoni/core/error.hpp>

#include <array>
#include <concepts>

namespace tafoni {

/// The rate of decay over a share c in [0, 1] of a bubble [Jones et al., Figure 5, lines 6 and 8].
///
/// Laws: pure; finite and >= 0 over [0, 1] (a run checks every value that it will use, and refuses others).
/// Model: `struct mine { double operator()(double c) const { return c > 0.5 ? 1.0 : 0.0; } };`
template <class F>
concept rate_function = std::copy_constructible<F> && requires(F const& f, double c) {
    { f(c) } -> std::same_as<double>;
};

/// scale c^3; with the default the f of all figures of the paper but one.
struct cubic_rate {
    static constexpr char const* name = "cubic_rate";
    double scale = 3;  ///< in [0, 1e6], dimensionless

    [[nodiscard]] double operator()(double c) const noexcept { return scale * (c * c * c); }
    [[nodiscard]] std::array<double, 1> parameters() const noexcept { return {scale}; }
    void validate() const { detail::require_range("cubic_rate.scale", scale, 0, 1e6); }
};

/// scale c: of both processes at once on plain shares the sum is constant [Figure 13, left].
struct linear_rate {
    static constexpr char const* name = "linear_rate";
    double scale = 1;  ///< in [0, 1e6], dimensionless

    [[nodiscard]] double operator()(double c) const noexcept { return scale * c; }
    [[nodiscard]] std::array<double, 1> parameters() const noexcept { return {scale}; }
    void validate() const { detail::require_range("linear_rate.scale", scale, 0, 1e6); }
};

/// scale c^4: takes what protrudes first [Figure 13, right].
struct quartic_rate {
    static constexpr char const* name = "quartic_rate";
    double scale = 3;  ///< in [0, 1e6], dimensionless

    [[nodiscard]] double operator()(double c) const noexcept { return scale * ((c * c) * (c * c)); }
    [[nodiscard]] std::array<double, 1> parameters() const noexcept { return {scale}; }
    void validate() const { detail::require_range("quartic_rate.scale", scale, 0, 1e6); }
};

/// Another rate, kept within [lowest, highest].
template <rate_function Base = cubic_rate>
struct clamped_rate {
    static constexpr char const* name = "clamped_rate";
    Base base{};
    double lowest = 0;   ///< in [0, 1e6]
    double highest = 1;  ///< in [lowest, 1e6]

    [[nodiscard]] double operator()(double c) const {
        double const rate = base(c);
        return rate < lowest ? lowest : rate > highest ? highest : rate;
    }
    [[nodiscard]] std::array<double, 2> parameters() const noexcept { return {lowest, highest}; }
    void validate() const {
        if constexpr (requires { base.validate(); }) base.validate();
        detail::require_range("clamped_rate.lowest", lowest, 0, 1e6);
        detail::require_range("clamped_rate.highest", highest, lowest, 1e6);
    }
};

static_assert(rate_function<cubic_rate> && rate_function<linear_rate> && rate_function<quartic_rate> &&
              rate_function<clamped_rate<>>);

}  // namespace tafoni

#endif
