/// \file
/// Counting kernels for x86-64, compiled whatever the flags and chosen where the program runs.
#ifndef TAFONI_VOXEL_DETAIL_COUNT_AIR_X86_HPP
#define TAFONI_VOXEL_DETAIL_COUNT_AIR_X86_HPP

#include <tafoni/voxel/detail/word_kernel.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

#include <immintrin.h>

namespace tafoni::detail {

namespace isa_popcnt {

__attribute__((target("popcnt,bmi,bmi2"))) inline void count_solid(count_task const& t) { word_kernel::count(t); }

}  // namespace isa_popcnt

namespace isa_avx512 {

#define TAFONI_AVX512 __attribute__((target("avx512f,avx512bw,avx512vpopcntdq")))

// Forms with a mask of ones: g++ 12 warns of those without one (its bug 105593), and makes the same code of both.

TAFONI_AVX512 inline __m128i halves_32(__m512i v) noexcept {
    __m256i const half = _mm256_add_epi32(_mm512_maskz_extracti64x4_epi64(0xF, v, 0),
                                          _mm512_maskz_extracti64x4_epi64(0xF, v, 1));
    return _mm_add_epi32(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
}

/// Sum of 16 numbers of 32 bits.
TAFONI_AVX512 inline std::uint32_t sum_32(__m512i v) noexcept {
    __m128i const four = halves_32(v);
    __m128i const two = _mm_add_epi32(four, _mm_shuffle_epi32(four, 0x4E));
    return static_cast<std::uint32_t>(_mm_cvtsi128_si32(_mm_add_epi32(two, _mm_shuffle_epi32(two, 0xB1))));
}

/// Sum of 8 numbers of 64 bits that is below 2^32.
TAFONI_AVX512 inline std::uint32_t sum_64(__m512i v) noexcept {
    __m128i const two = halves_32(v);
    return static_cast<std::uint32_t>(_mm_cvtsi128_si32(_mm_add_epi32(two, _mm_shuffle_epi32(two, 0x4E))));
}

/// 16 rows at a time.
TAFONI_AVX512 inline void count_narrow(count_task const& t) {
    auto const blocks = t.bubble.blocks();
    auto const offsets = t.bubble.block_offsets();
    std::size_t const n = blocks.size();
    for (std::size_t i = 0; i < t.position.size(); ++i) {
        std::uint32_t const* const at = t.rows.narrow(t.position[i]);
        __m128i const z = _mm_cvtsi32_si128(t.position[i] & 15);
        __m512i sum = _mm512_setzero_si512();
        for (std::size_t b = 0; b < n; ++b) {
            __m512i const rows = _mm512_maskz_srl_epi32(0xFFFF, _mm512_loadu_si512(at + offsets[b]), z);
            __m512i const inside = _mm512_and_si512(rows, _mm512_load_si512(&blocks[b]));
            sum = _mm512_add_epi32(sum, _mm512_popcnt_epi32(inside));
        }
        t.solid[i] = sum_32(sum);
    }
}

/// 8 rows at a time.
TAFONI_AVX512 inline void count_medium(count_task const& t) {
    auto const blocks = t.bubble.blocks();
    auto const offsets = t.bubble.block_offsets();
    std::size_t const n = blocks.size();
    for (std::size_t i = 0; i < t.position.size(); ++i) {
        std::uint64_t const* const at = t.rows.medium(t.position[i]);
        __m128i const z = _mm_cvtsi32_si128(t.position[i] & 31);
        __m512i sum = _mm512_setzero_si512();
        for (std::size_t b = 0; b < n; ++b) {
            __m512i const rows = _mm512_maskz_srl_epi64(0xFF, _mm512_loadu_si512(at + offsets[b]), z);
            __m512i const inside = _mm512_and_si512(rows, _mm512_load_si512(&blocks[b]));
            sum = _mm512_add_epi64(sum, _mm512_popcnt_epi64(inside));
        }
        t.solid[i] = sum_64(sum);
    }
}

/// Of narrow and medium bubbles.
TAFONI_AVX512 inline void count_solid(count_task const& t) {
    t.bubble.kind() == stencil_words::layout::narrow ? count_narrow(t) : count_medium(t);
}

#undef TAFONI_AVX512

}  // namespace isa_avx512

}  // namespace tafoni::detail

#endif
