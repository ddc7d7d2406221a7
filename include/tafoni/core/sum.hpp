/// \file
/// Sums whose bits do not depend on threads or compilers.
#ifndef TAFONI_CORE_SUM_HPP
#define TAFONI_CORE_SUM_HPP

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace tafoni {

/// Sum of term(i), i in [begin, end), pairwise over fixed halves; error grows with log n. O(n).
template <class Term>
[[nodiscard]] double pairwise_sum(std::size_t begin, std::size_t end, Term const& term) {
    std::size_t const n = end - begin;
    if (n <= 32) {
        double s = 0;
        for (std::size_t i = begin; i < end; ++i) s += term(i);
        return s;
    }
    std::size_t const mid = begin + n / 2;
    double const left = pairwise_sum(begin, mid, term);
    return left + pairwise_sum(mid, end, term);
}

/// Whole units of 2^-52 of a total, so that sums are order-free and never drift.
/// `part` in [0, total], `total` > 0. Rounds to nearest.
[[nodiscard]] inline std::int64_t to_fixed(double part, double total) noexcept {
    return static_cast<std::int64_t>(std::floor(part / total * 0x1p52 + 0.5));
}

/// Back to the unit of `total`.
[[nodiscard]] inline double from_fixed(std::int64_t units, double total) noexcept {
    return static_cast<double>(units) * 0x1p-52 * total;
}

}  // namespace tafoni

#endif
