/// \file
/// Counting kernels for x86-64 with AVX2, compiled whatever the flags and chosen where the program runs.
#ifndef TAFONI_VOXEL_DETAIL_COUNT_AIR_AVX2_HPP
#define TAFONI_VOXEL_DETAIL_COUNT_AIR_AVX2_HPP

#include <tafoni/voxel/detail/word_kernel.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <immintrin.h>

namespace tafoni::detail::isa_avx2 {

#define TAFONI_AVX2 __attribute__((target("avx2,bmi,bmi2,popcnt")))

/// Of each byte, by a table of 16 [Mula et al. 2018, Faster Population Counts Using AVX2 Instructions].
TAFONI_AVX2 inline __m256i bits_of_bytes(__m256i v) noexcept {
    __m256i const table = _mm256_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4,  //
                                           0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4);
    __m256i const nibble = _mm256_set1_epi8(15);
    __m256i const low = _mm256_shuffle_epi8(table, _mm256_and_si256(v, nibble));
    __m256i const high = _mm256_shuffle_epi8(table, _mm256_and_si256(_mm256_srli_epi16(v, 4), nibble));
    return _mm256_add_epi8(low, high);
}

/// 16 rows of 32 bits in two vectors.
struct narrow_rows {
    using row = std::uint32_t;
    static row const* around(air_rows const& r, brick_position p) noexcept { return r.narrow(p); }
    static int height(brick_position p) noexcept { return p & 15; }
    TAFONI_AVX2 static __m256i down(__m256i rows, __m128i z) noexcept { return _mm256_srl_epi32(rows, z); }
};

/// 8 rows of 64 bits.
struct medium_rows {
    using row = std::uint64_t;
    static row const* around(air_rows const& r, brick_position p) noexcept { return r.medium(p); }
    static int height(brick_position p) noexcept { return p & 31; }
    TAFONI_AVX2 static __m256i down(__m256i rows, __m128i z) noexcept { return _mm256_srl_epi64(rows, z); }
};

template <class Rows>
TAFONI_AVX2 inline void count_blocks(count_task const& t) {
    constexpr std::size_t half = 32 / sizeof(typename Rows::row);
    auto const blocks = t.bubble.blocks();
    auto const offsets = t.bubble.block_offsets();
    for (std::size_t i = 0; i < t.position.size(); ++i) {
        typename Rows::row const* const at = Rows::around(t.rows, t.position[i]);
        __m128i const z = _mm_cvtsi32_si128(Rows::height(t.position[i]));
        __m256i sum = _mm256_setzero_si256();
        for (std::size_t first = 0; first < blocks.size(); first += 15) {  // 15 * 2 * 8 bits fit a byte
            std::size_t const last = std::min(first + 15, blocks.size());
            __m256i bytes = _mm256_setzero_si256();
            for (std::size_t b = first; b < last; ++b) {
                auto const* const rows = reinterpret_cast<__m256i_u const*>(at + offsets[b]);
                auto const* const rows_2 = reinterpret_cast<__m256i_u const*>(at + offsets[b] + half);
                auto const* const mask = reinterpret_cast<__m256i const*>(&blocks[b]);
                __m256i const in = _mm256_and_si256(Rows::down(_mm256_loadu_si256(rows), z), _mm256_load_si256(mask));
                __m256i const in_2 =
                    _mm256_and_si256(Rows::down(_mm256_loadu_si256(rows_2), z), _mm256_load_si256(mask + 1));
                bytes = _mm256_add_epi8(bytes, _mm256_add_epi8(bits_of_bytes(in), bits_of_bytes(in_2)));
            }
            sum = _mm256_add_epi64(sum, _mm256_sad_epu8(bytes, _mm256_setzero_si256()));
        }
        __m128i const two = _mm_add_epi64(_mm256_castsi256_si128(sum), _mm256_extracti128_si256(sum, 1));
        t.solid[i] = static_cast<std::uint32_t>(_mm_cvtsi128_si64(_mm_add_epi64(two, _mm_unpackhi_epi64(two, two))));
    }
}

/// Wide bubbles by words: they wait for memory.
TAFONI_AVX2 inline void count_solid(count_task const& t) {
    switch (t.bubble.kind()) {
        case stencil_words::layout::narrow: return count_blocks<narrow_rows>(t);
        case stencil_words::layout::medium: return count_blocks<medium_rows>(t);
        case stencil_words::layout::wide: return word_kernel::count(t);
    }
}

#undef TAFONI_AVX2

}  // namespace tafoni::detail::isa_avx2

#endif
