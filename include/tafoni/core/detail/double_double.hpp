/// \file
/// Unevaluated sums of two doubles, about 106 bits, by exact transformations [Dekker 1971].
#ifndef TAFONI_CORE_DETAIL_DOUBLE_DOUBLE_HPP
#define TAFONI_CORE_DETAIL_DOUBLE_DOUBLE_HPP

namespace tafoni::detail {

struct double_double {
    double high;
    double low;
};

/// a + b exactly.
[[nodiscard]] constexpr double_double two_sum(double a, double b) noexcept {
    double const s = a + b;
    double const t = s - a;
    return {s, (a - (s - t)) + (b - t)};
}

/// a + b exactly for |a| >= |b|.
[[nodiscard]] constexpr double_double fast_two_sum(double a, double b) noexcept {
    double const s = a + b;
    return {s, b - (s - a)};
}

/// a b exactly while nothing over- or underflows: |a|, |b| < 2^995, |a b| > 2^-960.
[[nodiscard]] constexpr double_double two_product(double a, double b) noexcept {
    double const ca = 134217729.0 * a;
    double const cb = 134217729.0 * b;
    double const ah = ca - (ca - a);
    double const bh = cb - (cb - b);
    double const al = a - ah;
    double const bl = b - bh;
    double const p = a * b;
    return {p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
}

[[nodiscard]] constexpr double_double add(double_double a, double_double b) noexcept {
    double_double const s = two_sum(a.high, b.high);
    return fast_two_sum(s.high, s.low + (a.low + b.low));
}

[[nodiscard]] constexpr double_double multiply(double_double a, double_double b) noexcept {
    double_double const p = two_product(a.high, b.high);
    return fast_two_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

[[nodiscard]] constexpr double_double divide(double_double a, double_double b) noexcept {
    double const q = a.high / b.high;
    double_double const p = multiply({q, 0}, b);
    double const rest = ((a.high - p.high) - p.low) + a.low;
    return fast_two_sum(q, rest / b.high);
}

}  // namespace tafoni::detail

#endif
