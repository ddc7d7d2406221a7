/// \file
/// Balls around faces in small whole numbers, of which sixteen are told from a point at once.
#ifndef TAFONI_FLUID_DETAIL_FACE_BALLS_HPP
#define TAFONI_FLUID_DETAIL_FACE_BALLS_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace tafoni::detail {

/// Middle and radius in 1/80 of a cell; the middle of the cell is at 128. Rounded so that nothing is lost.
struct face_ball {
    std::uint8_t x = 0;
    std::uint8_t y = 0;
    std::uint8_t z = 0;
    std::uint8_t w = 0;

    static constexpr float unit = 80;
    static constexpr float most_w = 170;  ///< so that the sum with a probe's fits

    /// From lengths in cells, from the middle of the cell. What does not fit is a ball around everything.
    static face_ball around(float x, float y, float z, float radius) noexcept {
        float const a = x * unit + 128.5F;
        float const b = y * unit + 128.5F;
        float const c = z * unit + 128.5F;
        float const w = radius * unit + 1;
        if (!(a >= 0 && b >= 0 && c >= 0 && a < 256 && b < 256 && c < 256 && w < most_w)) return {128, 128, 128, 170};
        return {static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b), static_cast<std::uint8_t>(c), static_cast<std::uint8_t>(w)};
    }
};

/// The places of the bits that are set in a number below 16.
struct four_pack {
    std::array<std::uint32_t, 4> places{};
    std::size_t count = 0;
};
struct four_pack_table {
    std::array<four_pack, 16> of{};
    constexpr four_pack_table() {
        for (std::uint32_t bits = 0; bits < 16; ++bits) {
            for (std::uint32_t b = 0; b < 4; ++b) {
                if ((bits >> b & 1U) != 0) of[bits].places[of[bits].count++] = b;
            }
        }
    }
};
inline constexpr four_pack_table four_packs{};

/// Sixteen of them, by coordinate; those that are not filled are met by nothing of a radius below a cell.
struct alignas(64) ball_pack {
    static constexpr std::uint32_t count = 16;
    std::uint8_t x[count]{};
    std::uint8_t y[count]{};
    std::uint8_t z[count]{};
    std::uint8_t w[count]{};

    void put(std::size_t k, face_ball const& b) noexcept {
        x[k] = b.x;
        y[k] = b.y;
        z[k] = b.z;
        w[k] = b.w;
    }
};

/// A point in a cell that asks which balls are within a radius of it.
///
/// Of a difference no longer than W no component is longer than W, nor half the sum of two longer than 0.71 W: what
/// passes both lies in a body with 18 faces that is little larger than the ball.
class ball_probe {
public:
    /// As `face_ball::around`; |x|, |y|, |z| at most a half, the radius at most a cell.
    ball_probe(float x, float y, float z, float radius) noexcept {
        face_ball const at = face_ball::around(x, y, z, std::min(radius + 1 / face_ball::unit, 1.25F));
#if defined(__x86_64__)
        x_ = _mm_set1_epi8(static_cast<char>(at.x));
        y_ = _mm_set1_epi8(static_cast<char>(at.y));
        z_ = _mm_set1_epi8(static_cast<char>(at.z));
        w_ = _mm_set1_epi8(static_cast<char>(at.w));
#else
        at_ = at;
#endif
    }
    /// Adds the faces whose balls are met, and perhaps some that are narrowly missed, to `out` in their order; up to
    /// three places behind the last are overwritten. `faces` are those of the pack.
    void add_met(ball_pack const& b, std::uint32_t const* faces, std::uint32_t*& out) const noexcept {
        std::uint32_t const bits = meets(b);
        if (bits == 0) return;
        for (std::uint32_t k = 0; k < ball_pack::count; k += 4) {
            four_pack const& at = four_packs.of[bits >> k & 15U];
            for (std::size_t j = 0; j < 4; ++j) out[j] = faces[k + at.places[j]];
            out += at.count;
        }
    }

private:
    [[nodiscard]] std::uint32_t meets(ball_pack const& b) const noexcept {
#if defined(__x86_64__)
        auto const load = [](std::uint8_t const* from) { return _mm_load_si128(reinterpret_cast<__m128i const*>(from)); };
        auto const apart = [](__m128i p, __m128i q) { return _mm_or_si128(_mm_subs_epu8(p, q), _mm_subs_epu8(q, p)); };
        __m128i const dx = apart(load(b.x), x_);
        __m128i const dy = apart(load(b.y), y_);
        __m128i const dz = apart(load(b.z), z_);
        __m128i const w = _mm_add_epi8(load(b.w), w_);
        __m128i const one = _mm_max_epu8(_mm_max_epu8(dx, dy), dz);
        __m128i const two = _mm_max_epu8(_mm_max_epu8(_mm_avg_epu8(dx, dy), _mm_avg_epu8(dy, dz)), _mm_avg_epu8(dx, dz));
        __m128i const quarter = _mm_and_si128(_mm_srli_epi16(w, 2), _mm_set1_epi8(63));
        __m128i const least = _mm_and_si128(_mm_srli_epi16(w, 5), _mm_set1_epi8(7));
        __m128i const less = _mm_sub_epi8(_mm_sub_epi8(_mm_add_epi8(w, _mm_set1_epi8(1)), quarter), least);
        __m128i const over = _mm_or_si128(_mm_subs_epu8(one, w), _mm_subs_epu8(two, less));
        return static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_cmpeq_epi8(over, _mm_setzero_si128())));
#else
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < ball_pack::count; ++k) {
            int const w = b.w[k] + at_.w;
            int const x = std::abs(b.x[k] - at_.x);
            int const y = std::abs(b.y[k] - at_.y);
            int const z = std::abs(b.z[k] - at_.z);
            bool const met = std::max({x, y, z}) <= w && (std::max({x + y, y + z, x + z}) + 1) / 2 <= w - w / 4 - w / 32 + 1;
            bits |= static_cast<std::uint32_t>(met) << k;
        }
        return bits;
#endif
    }

#if defined(__x86_64__)
    __m128i x_, y_, z_, w_;
#else
    face_ball at_;
#endif
};

}  // namespace tafoni::detail

#endif
