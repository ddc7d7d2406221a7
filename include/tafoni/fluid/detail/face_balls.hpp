/// \file
/// Balls around faces in small whole numbers, of which many are told from a point at once.
#ifndef TAFONI_FLUID_DETAIL_FACE_BALLS_HPP
#define TAFONI_FLUID_DETAIL_FACE_BALLS_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace tafoni::detail {

/// Middle and radius in 1/256 of a cell, from the middle of the cell, rounded so that nothing is lost.
struct face_ball {
    std::int16_t x = 0;
    std::int16_t y = 0;
    std::int16_t z = 0;
    std::int16_t w = 0;

    static constexpr float unit = 256;

    /// From lengths in cells. What does not fit is a ball around everything.
    static face_ball around(float x, float y, float z, float radius) noexcept {
        constexpr float most = 16000;
        float const w = std::ceil(radius * unit) + 1;
        if (!(std::fabs(x * unit) < most && std::fabs(y * unit) < most && std::fabs(z * unit) < most && w < most)) {
            return {0, 0, 0, 20000};
        }
        auto const near_to = [](float a) { return static_cast<std::int16_t>(std::floor(a * unit + 0.5F)); };
        return {near_to(x), near_to(y), near_to(z), static_cast<std::int16_t>(w)};
    }
};

/// The places of the bits that are set in a number below 16.
struct four_pack {
    alignas(16) std::uint32_t places[4]{};
    std::size_t count = 0;
};
struct four_pack_table {
    four_pack of[16]{};
    constexpr four_pack_table() {
        for (std::uint32_t bits = 0; bits < 16; ++bits) {
            for (std::uint32_t b = 0; b < 4; ++b) {
                if ((bits >> b & 1U) != 0) of[bits].places[of[bits].count++] = b;
            }
        }
    }
};
inline constexpr four_pack_table four_packs{};

/// Places of the balls that `at` meets, ascending; may name some that it narrowly misses. `out` has room for n + 3. O(n).
inline std::size_t touched_balls(face_ball const* balls, std::size_t n, face_ball const& at, std::uint32_t* out) noexcept {
    std::size_t count = 0;
    std::size_t k = 0;
#if defined(__x86_64__)
    auto const minus_w = static_cast<short>(-at.w);
    __m128i const here = _mm_setr_epi16(at.x, at.y, at.z, minus_w, at.x, at.y, at.z, minus_w);
    __m128i const last = _mm_setr_epi16(0, 0, 0, -1, 0, 0, 0, -1);
    for (; k + 4 <= n; k += 4) {
        auto const* const from = reinterpret_cast<__m128i_u const*>(balls + k);
        __m128i const a = _mm_sub_epi16(_mm_loadu_si128(from), here);
        __m128i const b = _mm_sub_epi16(_mm_loadu_si128(from + 1), here);
        // Pairs of sums x x + y y and z z - w w.
        __m128i const p = _mm_madd_epi16(a, _mm_sub_epi16(_mm_xor_si128(a, last), last));
        __m128i const q = _mm_madd_epi16(b, _mm_sub_epi16(_mm_xor_si128(b, last), last));
        __m128 const even = _mm_shuffle_ps(_mm_castsi128_ps(p), _mm_castsi128_ps(q), 0x88);
        __m128 const odd = _mm_shuffle_ps(_mm_castsi128_ps(p), _mm_castsi128_ps(q), 0xDD);
        __m128i const sum = _mm_add_epi32(_mm_castps_si128(even), _mm_castps_si128(odd));
        auto const out_of_reach = static_cast<std::size_t>(_mm_movemask_ps(_mm_castsi128_ps(_mm_cmpgt_epi32(sum, _mm_setzero_si128()))));
        auto const& pack = four_packs.of[out_of_reach ^ 15U];
        __m128i const places = _mm_add_epi32(_mm_load_si128(reinterpret_cast<__m128i const*>(pack.places)), _mm_set1_epi32(static_cast<int>(k)));
        _mm_storeu_si128(reinterpret_cast<__m128i_u*>(out + count), places);
        count += pack.count;
    }
#endif
    for (; k < n; ++k) {
        int const x = balls[k].x - at.x;
        int const y = balls[k].y - at.y;
        int const z = balls[k].z - at.z;
        int const w = balls[k].w + at.w;
        if (x * x + y * y + z * z <= w * w) out[count++] = static_cast<std::uint32_t>(k);
    }
    return count;
}

}  // namespace tafoni::detail

#endif
