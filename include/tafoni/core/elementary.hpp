/// \file
/// exp, log, pow, sin, cos and acos with the same bits on every machine.
#ifndef TAFONI_CORE_ELEMENTARY_HPP
#define TAFONI_CORE_ELEMENTARY_HPP

#include <tafoni/core/detail/double_double.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

/// Plain double arithmetic in a fixed order: equal bits wherever double is IEEE 754 and products are
/// not contracted (-ffp-contract=off). Every function is within 2 ulp of the true value, over its
/// whole range, and treats NaN, infinities and signed zeros as C's Annex F does. O(1).
namespace tafoni::elementary {

namespace detail {

using tafoni::detail::double_double;

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
inline constexpr double ln2_high = 0x1.62e42fefa3800p-1;  // 42 bits: k * ln2_high is exact
inline constexpr double ln2_low = 0x1.ef35793c76730p-45;
inline constexpr double ln2_rest = 0x1.f97b57a079a19p-103;

/// 2^k for k in [-1022, 1023].
[[nodiscard]] inline double power_of_two(int k) noexcept {
    return std::bit_cast<double>(static_cast<std::uint64_t>(k + 1023) << 52);
}

/// c[0] + x (c[1] + x (...)).
template <std::size_t N>
[[nodiscard]] double horner(double x, double const (&c)[N]) noexcept {
    double s = c[N - 1];
    for (std::size_t i = N - 1; i-- > 0;) s = s * x + c[i];
    return s;
}

/// exp(high + low) for |low| far below |high|; high in [-746, 710].
[[nodiscard]] inline double exp_sum(double high, double low) noexcept {
    double const k = std::floor(high * 0x1.71547652b82fep+0 + 0.5);
    double const r = (high - k * ln2_high) - (k * ln2_low - low);
    static constexpr double c[] = {1.0 / 2,       1.0 / 6,        1.0 / 24,        1.0 / 120,       1.0 / 720,       1.0 / 5040,
                                   1.0 / 40320,   1.0 / 362880,   1.0 / 3628800,   1.0 / 39916800,  1.0 / 479001600, 1.0 / 6227020800.0};
    double const e = 1 + (r + r * r * horner(r, c));
    int const n = static_cast<int>(k);
    return e * power_of_two(n / 2) * power_of_two(n - n / 2);
}

/// x = 2^k m with m in (0.70, 1.42); x positive and finite.
struct split_value {
    double m;
    double k;
};
[[nodiscard]] inline split_value split_exponent(double x) noexcept {
    int k = 0;
    if (x < 0x1p-1022) {
        x *= 0x1p54;
        k = -54;
    }
    std::uint64_t const bits = std::bit_cast<std::uint64_t>(x);
    k += static_cast<int>(bits >> 52) - 1023;
    double m = std::bit_cast<double>((bits & 0xFFFFFFFFFFFFFULL) | 0x3FF0000000000000ULL);
    if (m > 0x1.6a09e667f3bcdp+0) {
        m *= 0.5;
        ++k;
    }
    return {m, static_cast<double>(k)};
}

/// log(x) to about 2^-66 of its value: 2 atanh(s), s = (m - 1) / (m + 1), two terms kept in pairs.
[[nodiscard]] inline double_double log_pair(double x) noexcept {
    split_value const v = split_exponent(x);
    double_double const s = divide(double_double{v.m - 1, 0}, tafoni::detail::two_sum(v.m, 1));
    double_double const z = multiply(s, s);
    static constexpr double c[] = {1.0 / 7,  1.0 / 9,  1.0 / 11, 1.0 / 13, 1.0 / 15, 1.0 / 17,
                                   1.0 / 19, 1.0 / 21, 1.0 / 23, 1.0 / 25};
    double_double t = add(double_double{0.2, -0x1.999999999999ap-57}, multiply(z, double_double{horner(z.high, c), 0}));
    t = add(double_double{0x1.5555555555555p-2, 0x1.5555555555555p-56}, multiply(z, t));
    t = multiply(multiply(s, z), t);
    t = add(s, t);
    double_double const r{2 * t.high, 2 * t.low};
    double_double const shift = add(double_double{v.k * ln2_high, 0}, add(tafoni::detail::two_product(v.k, ln2_low), double_double{v.k * ln2_rest, 0}));
    return add(shift, r);
}

/// |x| = quadrant * pi/2 + (high + low), |high + low| <= pi/4; x finite [Payne, Hanek 1983].
struct reduced_angle {
    double high;
    double low;
    unsigned quadrant;
};
[[nodiscard]] inline reduced_angle reduce_angle(double x) noexcept {
    if (x <= 0x1.921fb54442d18p-1) return {x, 0, 0};
    // 2/pi in words of 64 bits behind the binary point, with one word of zeros in front of it.
    static constexpr std::uint64_t two_over_pi[] = {
        0,                      0xa2f9836e4e441529ULL, 0xfc2757d1f534ddc0ULL, 0xdb6295993c439041ULL, 0xfe5163abdebbc561ULL,
        0xb7246e3a424dd2e0ULL, 0x06492eea09d1921cULL, 0xfe1deb1cb129a73eULL, 0xe88235f52ebb4484ULL, 0xe99c7026b45f7e41ULL,
        0x3991d639835339f4ULL, 0x9c845f8bbdf9283bULL, 0x1ff897ffde05980fULL, 0xef2f118b5a0a6d1fULL, 0x6d367ecf27cb09b7ULL,
        0x4f463f669e5fea2dULL, 0x7527bac7ebe5f17bULL, 0x3d0739f78a5292eaULL, 0x6bfb5fb11f8d5d08ULL, 0x56033046fc7b6babULL,
        0xf0cfbc209af4361dULL};
    __extension__ using wide = unsigned __int128;
    std::uint64_t const bits = std::bit_cast<std::uint64_t>(x);
    std::uint64_t const m = (bits & 0xFFFFFFFFFFFFFULL) | 0x10000000000000ULL;
    // x = m 2^e. Bits of 2/pi that only add multiples of four quadrants are skipped.
    int const e = static_cast<int>(bits >> 52) - 1075;
    unsigned const first = static_cast<unsigned>(e - 2 + 64);
    unsigned const word = first / 64;
    unsigned const shift = first % 64;
    std::uint64_t w[3];
    for (unsigned i = 0; i < 3; ++i) {
        w[i] = two_over_pi[word + i] << shift;
        if (shift != 0) w[i] |= two_over_pi[word + i + 1] >> (64 - shift);
    }
    wide const p0 = wide{m} * w[2];
    wide const p1 = wide{m} * w[1] + (p0 >> 64);
    std::uint64_t const top = m * w[0] + static_cast<std::uint64_t>(p1 >> 64);
    auto quadrant = static_cast<unsigned>(top >> 62);
    wide fraction = ((wide{top} << 64) | static_cast<std::uint64_t>(p1)) << 2;
    fraction |= static_cast<std::uint64_t>(p0) >> 62;
    bool const beyond_half = static_cast<std::uint64_t>(fraction >> 127) != 0;
    if (beyond_half) {
        ++quadrant;
        fraction = ~fraction + 1;
    }
    if (fraction == 0) return {0, 0, quadrant % 4};
    auto const high_word = static_cast<std::uint64_t>(fraction >> 64);
    int const zeros = high_word != 0 ? std::countl_zero(high_word)
                                     : 64 + std::countl_zero(static_cast<std::uint64_t>(fraction));
    fraction <<= zeros;
    double const scale = power_of_two(-zeros) * (beyond_half ? -1.0 : 1.0);
    double const f_high = static_cast<double>(static_cast<std::uint64_t>(fraction >> 75)) * 0x1p-53 * scale;
    double const f_low = static_cast<double>(static_cast<std::uint64_t>((fraction << 53) >> 75)) * 0x1p-106 * scale;
    double_double const angle =
        multiply(double_double{f_high, f_low}, double_double{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54});
    return {angle.high, angle.low, quadrant % 4};
}

/// sin(high + low) for |high| <= pi/4.
[[nodiscard]] inline double sin_kernel(double high, double low) noexcept {
    static constexpr double c[] = {-1.0 / 6,          1.0 / 120,           -1.0 / 5040,           1.0 / 362880,
                                   -1.0 / 39916800.0, 1.0 / 6227020800.0,  -1.0 / 1307674368000.0, 1.0 / 355687428096000.0};
    double const z = high * high;
    return high + (low * (1 - 0.5 * z) + high * z * horner(z, c));
}

/// cos(high + low) for |high| <= pi/4.
[[nodiscard]] inline double cos_kernel(double high, double low) noexcept {
    static constexpr double c[] = {1.0 / 24,          -1.0 / 720,           1.0 / 40320,        -1.0 / 3628800,
                                   1.0 / 479001600.0, -1.0 / 87178291200.0, 1.0 / 20922789888000.0};
    double const z = high * high;
    double const half = 0.5 * z;
    double const lead = 1 - half;
    return lead + (((1 - lead) - half) + (z * z * horner(z, c) - high * low));
}

/// asin(x) - x for |x| <= 1/2, as x times the sum of the series from the second term.
[[nodiscard]] inline double asin_tail(double x) noexcept {
    double const z = x * x;
    // (2n)! / (4^n n!^2 (2n + 1)), n = 1 .. 25, by the recurrence of the binomials.
    static constexpr struct table {
        double c[25]{};
        constexpr table() {
            double binomial = 1;
            for (int n = 1; n <= 25; ++n) {
                binomial *= (2.0 * n - 1) / (2.0 * n);
                c[n - 1] = binomial / (2.0 * n + 1);
            }
        }
    } series{};
    return x * (z * horner(z, series.c));
}

}  // namespace detail

/// e^x; inf above 709.78, 0 below -745.13.
[[nodiscard]] inline double exp(double x) noexcept {
    if (x > 710) return detail::infinity;
    if (x < -746) return 0;
    if (x != x) return x;
    return detail::exp_sum(x, 0);
}

/// Natural logarithm; -inf at 0, NaN below.
[[nodiscard]] inline double log(double x) noexcept {
    if (!(x > 0)) return x == 0 ? -detail::infinity : detail::not_a_number;
    if (x == detail::infinity) return x;
    detail::split_value const v = detail::split_exponent(x);
    double const f = v.m - 1;
    double const s = f / (2 + f);
    double const z = s * s;
    static constexpr double c[] = {2.0 / 3,  2.0 / 5,  2.0 / 7,  2.0 / 9,  2.0 / 11, 2.0 / 13,
                                   2.0 / 15, 2.0 / 17, 2.0 / 19, 2.0 / 21, 2.0 / 23};
    // log(1 + f) = f - f^2/2 + s (f^2/2 + 2 z/3 + ...): the leading terms are exact or small.
    double const half = 0.5 * f * f;
    double const tail = s * (half + z * detail::horner(z, c));
    return v.k * detail::ln2_high - ((half - (tail + v.k * detail::ln2_low)) - f);
}

/// x^y as C's `pow`: x^0 = 1, 1^y = 1, NaN for negative x unless y is whole.
[[nodiscard]] inline double pow(double x, double y) noexcept {
    if (y == 0 || x == 1) return 1;
    if (x != x || y != y) return detail::not_a_number;
    double const size = std::fabs(x);
    if (std::fabs(y) == detail::infinity) {
        if (size == 1) return 1;
        return (size > 1) == (y > 0) ? detail::infinity : 0.0;
    }
    bool const whole = std::floor(y) == y;
    bool const odd = whole && std::fabs(y) < 0x1p53 && std::floor(y * 0.5) * 2 != y;
    double const sign = std::signbit(x) && odd ? -1.0 : 1.0;
    if (size == 0 || size == detail::infinity) return sign * ((size == 0) == (y > 0) ? 0.0 : detail::infinity);
    if (x < 0 && !whole) return detail::not_a_number;
    if (size == 1) return sign;
    detail::double_double const l = detail::log_pair(size);
    double const estimate = y * l.high;
    if (estimate > 710) return sign * detail::infinity;
    if (estimate < -746) return sign * 0.0;
    detail::double_double const p = tafoni::detail::two_product(y, l.high);
    return sign * detail::exp_sum(p.high, p.low + y * l.low);
}

/// Sine of x radians, for every finite x; NaN for infinities.
[[nodiscard]] inline double sin(double x) noexcept {
    if (!(std::fabs(x) < detail::infinity)) return detail::not_a_number;
    if (std::fabs(x) < 0x1p-27) return x;
    detail::reduced_angle const a = detail::reduce_angle(std::fabs(x));
    double const s = a.quadrant % 2 == 0 ? detail::sin_kernel(a.high, a.low) : detail::cos_kernel(a.high, a.low);
    return (a.quadrant >= 2) != (x < 0) ? -s : s;
}

/// Cosine of x radians, for every finite x; NaN for infinities.
[[nodiscard]] inline double cos(double x) noexcept {
    if (!(std::fabs(x) < detail::infinity)) return detail::not_a_number;
    detail::reduced_angle const a = detail::reduce_angle(std::fabs(x));
    double const c = a.quadrant % 2 == 0 ? detail::cos_kernel(a.high, a.low) : detail::sin_kernel(a.high, a.low);
    return a.quadrant == 1 || a.quadrant == 2 ? -c : c;
}

/// Arc cosine in [0, pi]; NaN outside [-1, 1].
[[nodiscard]] inline double acos(double x) noexcept {
    static constexpr double half_pi = 0x1.921fb54442d18p+0;
    static constexpr double half_pi_low = 0x1.1a62633145c07p-54;
    if (!(x >= -1 && x <= 1)) return detail::not_a_number;
    if (std::fabs(x) <= 0.5) return half_pi - (x - (half_pi_low - detail::asin_tail(x)));
    double const s = std::sqrt((1 - std::fabs(x)) * 0.5);
    double const angle = s + detail::asin_tail(s);
    return x > 0 ? 2 * angle : 2 * (half_pi - (angle - half_pi_low));
}

}  // namespace tafoni::elementary

#endif
