/// \file
/// A double with a bound on its error: the first stage of every exact sign.
#ifndef TAFONI_GEOMETRY_APPROX_HPP
#define TAFONI_GEOMETRY_APPROX_HPP

#include <cmath>
#include <cstdint>

namespace tafoni {

/// A value that lies within `error` of the exact one. Only for polynomials in lattice integers:
/// these neither overflow nor underflow.
struct approx {
    double value = 0;
    double error = 0;

    static constexpr double unit = 0x1p-53;  ///< relative error of one rounding

    constexpr approx() = default;
    constexpr approx(double v, double e) noexcept : value(v), error(e) {}
    explicit approx(std::int64_t v) noexcept
        : value(static_cast<double>(v)), error(v < (1LL << 53) && v > -(1LL << 53) ? 0 : unit * std::fabs(value)) {}

    /// -1 or 1; 0 when the sign is not certain. The margin covers the rounding of `error` itself.
    [[nodiscard]] int sign() const noexcept {
        double const margin = 1.0001 * error;
        return value > margin ? 1 : value < -margin ? -1 : 0;
    }

    friend approx operator+(approx a, approx b) noexcept {
        double const v = a.value + b.value;
        return {v, a.error + b.error + unit * std::fabs(v)};
    }
    friend approx operator-(approx a, approx b) noexcept {
        double const v = a.value - b.value;
        return {v, a.error + b.error + unit * std::fabs(v)};
    }
    friend approx operator-(approx a) noexcept { return {-a.value, a.error}; }
    friend approx operator*(approx a, approx b) noexcept {
        double const v = a.value * b.value;
        return {v, std::fabs(a.value) * b.error + (std::fabs(b.value) + b.error) * a.error + unit * std::fabs(v)};
    }
};

}  // namespace tafoni

#endif
