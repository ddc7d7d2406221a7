/// \file
/// Numbers side by side, as many as the target's registers hold; every lane rounds like a scalar.
#ifndef TAFONI_DECOMPOSITION_DETAIL_CELL_LANES_HPP
#define TAFONI_DECOMPOSITION_DETAIL_CELL_LANES_HPP

#include <cstddef>
#include <cstdint>

namespace tafoni::detail {

#if defined(__AVX__)
inline namespace avx {
inline constexpr std::size_t cell_lanes = 4;
#else
inline namespace baseline {
inline constexpr std::size_t cell_lanes = 2;
#endif
inline constexpr std::size_t float_lanes = 2 * cell_lanes;

using lanes = double __attribute__((vector_size(8 * cell_lanes)));
using float_vector = float __attribute__((vector_size(4 * float_lanes)));
using int_vector = std::int32_t __attribute__((vector_size(4 * float_lanes)));

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

[[nodiscard]] inline float_vector load_floats(float const* p) noexcept {
    float_vector v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}

/// Is any lane of a comparison's result set?
[[nodiscard]] inline bool any_lane(int_vector const& v) noexcept {
    std::uint64_t w[sizeof v / 8];
    __builtin_memcpy(w, &v, sizeof v);
    std::uint64_t any = 0;
    for (auto k : w) any |= k;
    return any != 0;
}

}  // namespace baseline or avx
}  // namespace tafoni::detail

#endif
