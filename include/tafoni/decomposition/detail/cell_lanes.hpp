/// \file
/// Doubles side by side, as many as the target's registers hold; every lane rounds like a scalar.
#ifndef TAFONI_DECOMPOSITION_DETAIL_CELL_LANES_HPP
#define TAFONI_DECOMPOSITION_DETAIL_CELL_LANES_HPP

#include <cstddef>

namespace tafoni::detail {

#if defined(__AVX__)
inline namespace avx {
inline constexpr std::size_t cell_lanes = 4;
#else
inline namespace baseline {
inline constexpr std::size_t cell_lanes = 2;
#endif

using lanes = double __attribute__((vector_size(8 * cell_lanes)));

[[nodiscard]] inline lanes load_lanes(double const* p) noexcept {
    lanes v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}

inline void store_lanes(double* p, lanes const& v) noexcept { __builtin_memcpy(p, &v, sizeof v); }

/// Squares of the distances from the interval [lo, hi].
[[nodiscard]] inline lanes gap2(double lo, double hi, lanes const& q) noexcept {
    lanes const below = lo - q;
    lanes const above = q - hi;
    lanes const most = below > above ? below : above;
    lanes const gap = most > 0 ? most : lanes{};
    return gap * gap;
}

}  // namespace baseline or avx
}  // namespace tafoni::detail

#endif
