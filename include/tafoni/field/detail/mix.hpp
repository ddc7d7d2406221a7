/// \file
/// A value between two others.
#ifndef TAFONI_FIELD_DETAIL_MIX_HPP
#define TAFONI_FIELD_DETAIL_MIX_HPP

namespace tafoni::detail {

/// a + t (b - a), exact at both ends and never outside of [a, b]: rounding alone could lead one ulp
/// beyond, and a resistance above 1 is an error. t in [0, 1]. O(1).
[[nodiscard]] constexpr double mix(double a, double b, double t) noexcept {
    double const v = a + t * (b - a);
    if (t >= 1 || (a < b ? v > b : v < b)) return b;
    return v;
}

}  // namespace tafoni::detail

#endif
