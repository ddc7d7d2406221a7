/// \file
/// Rows of samples as bits: which reach a threshold, and whether all are finite.
#ifndef TAFONI_VOXEL_DETAIL_NODE_BITS_HPP
#define TAFONI_VOXEL_DETAIL_NODE_BITS_HPP

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace tafoni::detail {

/// The least Sample that is not below `iso`, so that a row is compared without being converted.
template <class Sample>
[[nodiscard]] Sample node_threshold(double iso) noexcept {
    auto const rounded = static_cast<Sample>(iso);
    return static_cast<double>(rounded) < iso ? std::nextafter(rounded, std::numeric_limits<Sample>::infinity()) : rounded;
}

/// Bit b of the result: sample b of up to 64 reaches the threshold. `finite` falls to false, never rises. O(count).
template <class Sample>
[[nodiscard]] std::uint64_t node_bits(Sample const* samples, std::size_t count, double iso, bool& finite) noexcept {
    std::uint64_t bits = 0;
    std::size_t b = 0;
    if constexpr (std::is_floating_point_v<Sample> && sizeof(Sample) <= 8) {
        Sample const least = node_threshold<Sample>(iso);
        bool good = true;
#if defined(__SSE2__)
        if constexpr (std::is_same_v<Sample, double>) {
            __m128d const level = _mm_set1_pd(least);
            __m128d zero = _mm_setzero_pd();  // stays zero while v - v is: not for infinities and NaN
            for (; b + 4 <= count; b += 4) {
                __m128d const p = _mm_loadu_pd(samples + b);
                __m128d const q = _mm_loadu_pd(samples + b + 2);
                zero = _mm_or_pd(zero, _mm_or_pd(_mm_sub_pd(p, p), _mm_sub_pd(q, q)));
                auto const four = static_cast<unsigned>(_mm_movemask_pd(_mm_cmpge_pd(p, level)) |
                                                        _mm_movemask_pd(_mm_cmpge_pd(q, level)) << 2);
                bits |= std::uint64_t{four} << b;
            }
            good = _mm_movemask_pd(_mm_cmpeq_pd(zero, _mm_setzero_pd())) == 3;
        } else if constexpr (std::is_same_v<Sample, float>) {
            __m128 const level = _mm_set1_ps(least);
            __m128 zero = _mm_setzero_ps();
            for (; b + 8 <= count; b += 8) {
                __m128 const p = _mm_loadu_ps(samples + b);
                __m128 const q = _mm_loadu_ps(samples + b + 4);
                zero = _mm_or_ps(zero, _mm_or_ps(_mm_sub_ps(p, p), _mm_sub_ps(q, q)));
                auto const eight = static_cast<unsigned>(_mm_movemask_ps(_mm_cmpge_ps(p, level)) |
                                                         _mm_movemask_ps(_mm_cmpge_ps(q, level)) << 4);
                bits |= std::uint64_t{eight} << b;
            }
            good = _mm_movemask_ps(_mm_cmpeq_ps(zero, _mm_setzero_ps())) == 15;
        }
#endif
        for (; b < count; ++b) {
            good = good && samples[b] - samples[b] == Sample{0};
            bits |= std::uint64_t{samples[b] >= least} << b;
        }
        finite = finite && good;
    } else {
        for (; b < count; ++b) {
            auto const v = static_cast<double>(samples[b]);
            finite = finite && std::isfinite(v);
            bits |= std::uint64_t{v >= iso} << b;
        }
    }
    return bits;
}

}  // namespace tafoni::detail

#endif
