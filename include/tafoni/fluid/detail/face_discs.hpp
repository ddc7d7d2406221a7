/// \file
/// Discs around faces, that a particle looks at four at a time.
#ifndef TAFONI_FLUID_DETAIL_FACE_DISCS_HPP
#define TAFONI_FLUID_DETAIL_FACE_DISCS_HPP

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace tafoni::detail {

/// A circle that holds a face, rounded outwards: what most faces of a cell are told apart from contacts by.
struct face_disc {
    float x, y, z;     ///< from the corner of the grid, in cells, as all of it
    float radius;
    float nx, ny, nz;  ///< normal, zero where the face has none
    float square;      ///< of the radius
};

/// What a particle sees of the discs of some faces.
struct disc_sights {
    static constexpr std::size_t most = 128;  ///< faces
    static constexpr std::size_t room = most + 8;

    std::size_t count = 0;
    std::array<std::uint32_t, room> faces;
    alignas(16) std::array<float, room> square;  ///< distance from the middle
    alignas(16) std::array<float, room> over;    ///< height over the plane
    alignas(16) std::array<float, room> radius;
    float nearest = std::numeric_limits<float>::max();  ///< of `square`

    /// Looks from a place at the first `count` of `faces`; `visit(face)`, in their order, where the foot of the normal
    /// may meet one whose plane is within `limit`. O(count).
    template <class Visit>
    void look(face_disc const* discs, float x, float y, float z, float limit, Visit const& visit) {
        nearest = std::numeric_limits<float>::max();
        if (count == 0) return;
        std::fill_n(faces.begin() + static_cast<std::ptrdiff_t>(count), 3, faces[count - 1]);
#if defined(__x86_64__)
        __m128 const here = _mm_setr_ps(x, y, z, 0);
        __m128 const sign = _mm_set1_ps(-0.0F);
        __m128 const top = _mm_set1_ps(limit);
        __m128 least = _mm_set1_ps(nearest);
        for (std::size_t k = 0; k < count; k += 4) {
            float const* const f0 = &discs[faces[k]].x;
            float const* const f1 = &discs[faces[k + 1]].x;
            float const* const f2 = &discs[faces[k + 2]].x;
            float const* const f3 = &discs[faces[k + 3]].x;
            __m128 a = _mm_sub_ps(here, _mm_loadu_ps(f0));
            __m128 b = _mm_sub_ps(here, _mm_loadu_ps(f1));
            __m128 c = _mm_sub_ps(here, _mm_loadu_ps(f2));
            __m128 d = _mm_sub_ps(here, _mm_loadu_ps(f3));
            _MM_TRANSPOSE4_PS(a, b, c, d);
            __m128 u = _mm_loadu_ps(f0 + 4);
            __m128 v = _mm_loadu_ps(f1 + 4);
            __m128 w = _mm_loadu_ps(f2 + 4);
            __m128 s = _mm_loadu_ps(f3 + 4);
            _MM_TRANSPOSE4_PS(u, v, w, s);
            __m128 const far = _mm_add_ps(_mm_add_ps(_mm_mul_ps(a, a), _mm_mul_ps(b, b)), _mm_mul_ps(c, c));
            __m128 const up = _mm_add_ps(_mm_add_ps(_mm_mul_ps(a, u), _mm_mul_ps(b, v)), _mm_mul_ps(c, w));
            _mm_store_ps(square.data() + k, far);
            _mm_store_ps(over.data() + k, up);
            _mm_store_ps(radius.data() + k, _mm_xor_ps(d, sign));
            least = _mm_min_ps(least, far);
            __m128 const flat = _mm_sub_ps(far, _mm_mul_ps(up, up));
            __m128 const wide = _mm_add_ps(s, _mm_mul_ps(_mm_set1_ps(1e-5F), far));
            auto bits = static_cast<std::uint32_t>(
                _mm_movemask_ps(_mm_and_ps(_mm_cmple_ps(_mm_andnot_ps(sign, up), top), _mm_cmple_ps(flat, wide))));
            if (count - k < 4) bits &= (1U << (count - k)) - 1;
            for (; bits != 0; bits &= bits - 1) visit(faces[k + static_cast<std::size_t>(std::countr_zero(bits))]);
        }
        alignas(16) std::array<float, 4> four;
        _mm_store_ps(four.data(), least);
        nearest = std::min({four[0], four[1], four[2], four[3]});
#else
        for (std::size_t k = 0; k < count; ++k) {
            face_disc const& d = discs[faces[k]];
            float const a = x - d.x;
            float const b = y - d.y;
            float const c = z - d.z;
            square[k] = a * a + b * b + c * c;
            over[k] = a * d.nx + b * d.ny + c * d.nz;
            radius[k] = d.radius;
            nearest = std::min(nearest, square[k]);
            if (std::fabs(over[k]) > limit || square[k] - over[k] * over[k] > d.square + 1e-5F * square[k]) continue;
            visit(faces[k]);
        }
#endif
    }

    /// Puts into `square` what the square of the way to the face is not below, and returns the least. Once after
    /// `look`, with a face or more. O(count).
    float bound_from_below() noexcept {
        // The last term is what the difference may have lost to rounding.
#if defined(__x86_64__)
        __m128 const zero = _mm_setzero_ps();
        __m128 least = _mm_set1_ps(std::numeric_limits<float>::max());
        for (std::size_t k = 0; k < count; k += 4) {
            __m128 const far = _mm_load_ps(square.data() + k);
            __m128 up = _mm_load_ps(over.data() + k);
            up = _mm_mul_ps(up, up);
            __m128 flat = _mm_sqrt_ps(_mm_max_ps(_mm_sub_ps(far, up), zero));
            flat = _mm_max_ps(_mm_sub_ps(flat, _mm_load_ps(radius.data() + k)), zero);
            __m128 const bound = _mm_sub_ps(_mm_add_ps(up, _mm_mul_ps(flat, flat)), _mm_mul_ps(_mm_set1_ps(1e-5F), far));
            _mm_store_ps(square.data() + k, bound);
            least = _mm_min_ps(least, bound);
        }
        alignas(16) std::array<float, 4> four;
        _mm_store_ps(four.data(), least);
        return std::min({four[0], four[1], four[2], four[3]});
#else
        float least = std::numeric_limits<float>::max();
        for (std::size_t k = 0; k < count; ++k) {
            float const up = over[k] * over[k];
            float const flat = std::max(std::sqrt(std::max(square[k] - up, 0.0F)) - radius[k], 0.0F);
            square[k] = up + flat * flat - 1e-5F * square[k];
            least = std::min(least, square[k]);
        }
        return least;
#endif
    }
};

}  // namespace tafoni::detail

#endif
