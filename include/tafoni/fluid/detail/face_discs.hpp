/// \file
/// Discs around faces, that a particle looks at four at a time.
#ifndef TAFONI_FLUID_DETAIL_FACE_DISCS_HPP
#define TAFONI_FLUID_DETAIL_FACE_DISCS_HPP

#include <tafoni/core/vector.hpp>

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

/// A circle that holds a face, rounded outwards, and how far towards two of its corners a point is: what most faces of a
/// cell are told apart from contacts by.
struct alignas(16) face_disc {
    float x = 0;  ///< middle, from the corner of the grid, in cells, as all of it
    float y = 0;
    float z = 0;
    float radius = 0;
    float nx = 0;  ///< normal, zero where the face has none
    float ny = 0;
    float nz = 0;
    float square = 0;  ///< of the radius
    float bx = 0;  ///< slope of the second corner's share, which is 1/3 in the middle, 1 at the corner, 0 at the opposite edge
    float by = 0;
    float bz = 0;
    float margin = std::numeric_limits<float>::infinity();  ///< what a share may be wrong by
    float cx = 0;  ///< slope of the third's
    float cy = 0;
    float cz = 0;
    float unused = 0;

    /// From three corners and their middle, and the middle in the grid. `blur`: what its numbers may be wrong by.
    static face_disc around(std::array<vec3, 4> const& abcm, std::array<float, 3> const& middle, double inverse, float blur) noexcept {
        auto const& [a, b, c, m] = abcm;
        vec3 const u{b - a};
        vec3 const v{c - a};
        vec3 const across = cross(u, v);
        vec3 const n = normalized(across);
        double const r = std::sqrt(std::max({squared_length(a - m), squared_length(b - m), squared_length(c - m)}));
        face_disc d;
        d.x = middle[0];
        d.y = middle[1];
        d.z = middle[2];
        d.radius = static_cast<float>(r * inverse) + blur;
        d.nx = static_cast<float>(n[0]);
        d.ny = static_cast<float>(n[1]);
        d.nz = static_cast<float>(n[2]);
        d.square = d.radius * d.radius;
        double const scale = 1 / (dot(across, across) * inverse);
        vec3 const second = cross(v, across);
        vec3 const third = cross(across, u);
        double steepest = 0;
        for (int k = 0; k < 3; ++k) steepest = std::max({steepest, std::fabs(scale * second[k]), std::fabs(scale * third[k])});
        if (!(scale < 1e30 && steepest < 1e30)) return d;
        d.margin = 8 * static_cast<float>(steepest) * (8 * blur + 2e-6F * (d.radius + 1)) + 1e-5F;
        d.bx = static_cast<float>(scale * second[0]);
        d.by = static_cast<float>(scale * second[1]);
        d.bz = static_cast<float>(scale * second[2]);
        d.cx = static_cast<float>(scale * third[0]);
        d.cy = static_cast<float>(scale * third[1]);
        d.cz = static_cast<float>(scale * third[2]);
        return d;
    }
};

/// What a particle sees of the discs of some faces.
struct disc_sights {
    static constexpr std::size_t most = 128;  ///< faces
    static constexpr std::size_t room = most + 8;

    std::size_t count = 0;
    std::array<std::uint32_t, room> faces;
    alignas(16) std::array<float, room> square;  ///< of the way to a face: no more than it is

    /// Looks from a place at the first `count` of `faces`; `visit(face)`, in their order, where the foot of the normal
    /// may meet one whose plane is within `limit`. O(count).
    template <class Visit>
    void look_over(face_disc const* discs, float x, float y, float z, float limit, Visit const& visit) {
        if (count == 0) return;
#if defined(__x86_64__)
        __m128 const sign = _mm_set1_ps(-0.0F);
        __m128 const top = _mm_set1_ps(limit);
        __m128 const third = _mm_set1_ps(1.0F / 3);
        for_each_four(discs, x, y, z, [&](std::size_t k, four_ways const& way, __m128 away, __m128 up, __m128, __m128 wide) {
            __m128 const flat = _mm_sub_ps(away, _mm_mul_ps(up, up));
            wide = _mm_add_ps(wide, _mm_mul_ps(_mm_set1_ps(1e-5F), away));
            four_ways b = load(discs, k, 8);
            four_ways c = load(discs, k, 12);
            __m128 const second = _mm_add_ps(dot(way, b), third);
            __m128 const last = _mm_add_ps(dot(way, c), third);
            __m128 const first = _mm_sub_ps(_mm_sub_ps(_mm_set1_ps(1), second), last);
            __m128 const least = _mm_add_ps(_mm_min_ps(_mm_min_ps(second, last), first), b.w);
            __m128 const inside = _mm_and_ps(_mm_cmpnlt_ps(least, _mm_setzero_ps()), _mm_cmple_ps(flat, wide));
            auto bits = static_cast<std::uint32_t>(_mm_movemask_ps(_mm_and_ps(_mm_cmple_ps(_mm_andnot_ps(sign, up), top), inside)));
            if (count - k < 4) bits &= (1U << (count - k)) - 1;
            for (; bits != 0; bits &= bits - 1) visit(faces[k + static_cast<std::size_t>(std::countr_zero(bits))]);
        });
#else
        for (std::size_t k = 0; k < count; ++k) {
            face_disc const& d = discs[faces[k]];
            float const a = x - d.x;
            float const b = y - d.y;
            float const c = z - d.z;
            float const away = a * a + b * b + c * c;
            float const up = a * d.nx + b * d.ny + c * d.nz;
            if (std::fabs(up) > limit || away - up * up > d.square + 1e-5F * away) continue;
            float const second = 1.0F / 3 + (a * d.bx + b * d.by + c * d.bz);
            float const last = 1.0F / 3 + (a * d.cx + b * d.cy + c * d.cz);
            if (std::min({second, last, 1 - second - last}) < -d.margin) continue;
            visit(faces[k]);
        }
#endif
    }

    /// Puts into `square` what the square of the way to a face is not below, and returns the least, of one or more. O(count).
    float bound_from_below(face_disc const* discs, float x, float y, float z) noexcept {
        // The last term is what the difference may have lost to rounding.
#if defined(__x86_64__)
        __m128 const zero = _mm_setzero_ps();
        __m128 least = _mm_set1_ps(std::numeric_limits<float>::max());
        for_each_four(discs, x, y, z, [&](std::size_t k, four_ways const&, __m128 away, __m128 up, __m128 radius, __m128) {
            up = _mm_mul_ps(up, up);
            __m128 flat = _mm_sqrt_ps(_mm_max_ps(_mm_sub_ps(away, up), zero));
            flat = _mm_max_ps(_mm_sub_ps(flat, radius), zero);
            __m128 const bound = _mm_sub_ps(_mm_add_ps(up, _mm_mul_ps(flat, flat)), _mm_mul_ps(_mm_set1_ps(1e-5F), away));
            _mm_store_ps(square.data() + k, bound);
            least = _mm_min_ps(least, bound);
        });
        alignas(16) std::array<float, 4> four;
        _mm_store_ps(four.data(), least);
        return std::min({four[0], four[1], four[2], four[3]});
#else
        float least = std::numeric_limits<float>::max();
        for (std::size_t k = 0; k < count; ++k) {
            face_disc const& d = discs[faces[k]];
            float const a = x - d.x;
            float const b = y - d.y;
            float const c = z - d.z;
            float const away = a * a + b * b + c * c;
            float const over = a * d.nx + b * d.ny + c * d.nz;
            float const up = over * over;
            float const flat = std::max(std::sqrt(std::max(away - up, 0.0F)) - d.radius, 0.0F);
            square[k] = up + flat * flat - 1e-5F * away;
            least = std::min(least, square[k]);
        }
        return least;
#endif
    }

#if defined(__x86_64__)
private:
    struct four_ways {
        __m128 x, y, z, w;
    };
    /// Four numbers from the n-th on of four faces' discs.
    [[nodiscard]] four_ways load(face_disc const* discs, std::size_t k, std::size_t n) const noexcept {
        four_ways out{_mm_load_ps(&discs[faces[k]].x + n), _mm_load_ps(&discs[faces[k + 1]].x + n), _mm_load_ps(&discs[faces[k + 2]].x + n),
                      _mm_load_ps(&discs[faces[k + 3]].x + n)};
        _MM_TRANSPOSE4_PS(out.x, out.y, out.z, out.w);
        return out;
    }
    [[nodiscard]] static __m128 dot(four_ways const& a, four_ways const& b) noexcept {
        return _mm_add_ps(_mm_add_ps(_mm_mul_ps(a.x, b.x), _mm_mul_ps(a.y, b.y)), _mm_mul_ps(a.z, b.z));
    }
    /// `f(k, way from the middle, its square, height over the plane, radius, its square)` for the faces from k on; the last
    /// four may repeat the last face.
    template <class F>
    void for_each_four(face_disc const* discs, float x, float y, float z, F const& f) {
        std::fill_n(faces.begin() + static_cast<std::ptrdiff_t>(count), 3, faces[count - 1]);
        for (std::size_t k = 0; k < count; k += 4) {
            four_ways const middle = load(discs, k, 0);
            four_ways const normal = load(discs, k, 4);
            four_ways const way{_mm_sub_ps(_mm_set1_ps(x), middle.x), _mm_sub_ps(_mm_set1_ps(y), middle.y), _mm_sub_ps(_mm_set1_ps(z), middle.z), middle.w};
            f(k, way, dot(way, way), dot(way, normal), middle.w, normal.w);
        }
    }
#endif
};

}  // namespace tafoni::detail

#endif
