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
    __m256i const half =
        _mm256_add_epi32(_mm512_maskz_extracti64x4_epi64(0xF, v, 0), _mm512_maskz_extracti64x4_epi64(0xF, v, 1));
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

/// 16 rows of 32 bits in a vector.
struct narrow_rows {
    static constexpr std::size_t masks = 1;
    using row = std::uint32_t;
    static row const* around(air_rows const& r, brick_position p) noexcept { return r.narrow(p); }
    static int height(brick_position p) noexcept { return p & 15; }
    TAFONI_AVX512 static void add(__m512i& sum, row const* at, __m128i z, __m512i mask, __m512i) noexcept {
        __m512i const rows = _mm512_maskz_srl_epi32(0xFFFF, _mm512_loadu_si512(at), z);
        sum = _mm512_add_epi32(sum, _mm512_popcnt_epi32(_mm512_and_si512(rows, mask)));
    }
    TAFONI_AVX512 static std::uint32_t total(__m512i sum) noexcept { return sum_32(sum); }
};

/// 8 rows of 64 bits.
struct medium_rows {
    static constexpr std::size_t masks = 1;
    using row = std::uint64_t;
    static row const* around(air_rows const& r, brick_position p) noexcept { return r.medium(p); }
    static int height(brick_position p) noexcept { return p & 31; }
    TAFONI_AVX512 static void add(__m512i& sum, row const* at, __m128i z, __m512i mask, __m512i) noexcept {
        __m512i const rows = _mm512_maskz_srl_epi64(0xFF, _mm512_loadu_si512(at), z);
        sum = _mm512_add_epi64(sum, _mm512_popcnt_epi64(_mm512_and_si512(rows, mask)));
    }
    TAFONI_AVX512 static std::uint32_t total(__m512i sum) noexcept { return sum_64(sum); }
};

/// 8 rows of 128 bits.
struct wide_rows {
    static constexpr std::size_t masks = 2;
    using row = std::uint64_t;
    static row const* around(air_rows const& r, brick_position p) noexcept { return r.wide(p); }
    static int height(brick_position p) noexcept { return p & 31; }
    TAFONI_AVX512 static void add(__m512i& sum, row const* at, __m128i z, __m512i mask, __m512i mask_above) noexcept {
        __m512i const low = _mm512_loadu_si512(at);
        __m512i const high = _mm512_loadu_si512(at + air_rows::wide_plane);
        __m128i const up = _mm_sub_epi64(_mm_cvtsi32_si128(64), z);  // by 64: nothing is left
        __m512i const rows =
            _mm512_or_si512(_mm512_maskz_srl_epi64(0xFF, low, z), _mm512_maskz_sll_epi64(0xFF, high, up));
        __m512i const above = _mm512_maskz_srl_epi64(0xFF, high, z);
        sum = _mm512_add_epi64(sum, _mm512_popcnt_epi64(_mm512_and_si512(rows, mask)));
        sum = _mm512_add_epi64(sum, _mm512_popcnt_epi64(_mm512_and_si512(above, mask_above)));
    }
    TAFONI_AVX512 static std::uint32_t total(__m512i sum) noexcept { return sum_64(sum); }
};

/// Four voxels at a time, so that a mask is loaded once for all.
template <class Rows>
TAFONI_AVX512 inline void count_by_fours(count_task const& t) {
    stencil_words::block const* const blocks = t.bubble.blocks().data();
    auto const offsets = t.bubble.block_offsets();
    std::size_t const last = t.position.size() - 1;
    for (std::size_t i = 0; i <= last; i += 4) {
        typename Rows::row const* at[4];
        __m128i z[4];
        __m512i sum[4];
        for (std::size_t k = 0; k < 4; ++k) {
            brick_position const p = t.position[i + k <= last ? i + k : last];
            at[k] = Rows::around(t.rows, p);
            z[k] = _mm_cvtsi32_si128(Rows::height(p));
            sum[k] = _mm512_setzero_si512();
        }
        for (std::size_t b = 0; b < offsets.size(); ++b) {
            __m512i const mask = _mm512_load_si512(blocks + Rows::masks * b);
            __m512i const mask_above = _mm512_load_si512(blocks + Rows::masks * b + (Rows::masks - 1));
            Rows::add(sum[0], at[0] + offsets[b], z[0], mask, mask_above);
            Rows::add(sum[1], at[1] + offsets[b], z[1], mask, mask_above);
            Rows::add(sum[2], at[2] + offsets[b], z[2], mask, mask_above);
            Rows::add(sum[3], at[3] + offsets[b], z[3], mask, mask_above);
        }
        for (std::size_t k = 0; k < 4 && i + k <= last; ++k) t.solid[i + k] = Rows::total(sum[k]);
    }
}

TAFONI_AVX512 inline void count_solid(count_task const& t) {
    if (t.position.empty()) return;
    switch (t.bubble.kind()) {
        case stencil_words::layout::narrow: return count_by_fours<narrow_rows>(t);
        case stencil_words::layout::medium: return count_by_fours<medium_rows>(t);
        case stencil_words::layout::wide: return count_by_fours<wide_rows>(t);
    }
}

#undef TAFONI_AVX512

}  // namespace isa_avx512

}  // namespace tafoni::detail

#endif
