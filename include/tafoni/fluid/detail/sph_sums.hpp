/// \file
/// Sums over neighbours in fixed lanes. Compiled for the flags of the unit; `sph_sums_avx2.hpp` compiles the same text
/// a second time for AVX2.
#ifndef TAFONI_SPH_TARGET
#ifdef TAFONI_FLUID_DETAIL_SPH_SUMS_HPP
#define TAFONI_SPH_SKIP
#else
#define TAFONI_FLUID_DETAIL_SPH_SUMS_HPP
#endif
#define TAFONI_SPH_TARGET
#define TAFONI_SPH_PLAIN
#ifdef __AVX__
#define TAFONI_SPH_ISA isa_built_avx
#define TAFONI_SPH_BYTES 32
#else
#define TAFONI_SPH_ISA isa_built
#define TAFONI_SPH_BYTES 16
#endif
#endif

#include <tafoni/fluid/detail/sph_lanes.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#ifndef TAFONI_SPH_SKIP
namespace tafoni::detail::TAFONI_SPH_ISA {

/// The machine's own vectors, of which one or two make up the lanes.
template <class Scalar>
struct vectors;
template <>
struct vectors<float> {
    using value = float __attribute__((vector_size(TAFONI_SPH_BYTES)));
    using word = std::int32_t;
    using mask = std::int32_t __attribute__((vector_size(TAFONI_SPH_BYTES)));
};
template <>
struct vectors<double> {
    using value = double __attribute__((vector_size(TAFONI_SPH_BYTES)));
    using word = std::int64_t;
    using mask = std::int64_t __attribute__((vector_size(TAFONI_SPH_BYTES)));
};

/// A vector at any address.
template <class Vector>
struct __attribute__((packed, may_alias)) loose {
    Vector lanes;
};

#define TAFONI_SPH_INLINE TAFONI_SPH_TARGET __attribute__((always_inline)) inline

template <class Scalar>
TAFONI_SPH_INLINE void load(Scalar const* from, typename vectors<Scalar>::value& to) noexcept {
    to = reinterpret_cast<loose<typename vectors<Scalar>::value> const*>(from)->lanes;
}
/// Keeps the lanes below `rest` of the vector `part`.
template <class Scalar>
TAFONI_SPH_INLINE void keep(std::size_t rest, std::size_t part, typename vectors<Scalar>::value& a) noexcept {
    using mask = typename vectors<Scalar>::mask;
    auto const* const words = sph_tails<typename vectors<Scalar>::word>.words + (sph_lane_count<Scalar> - rest) +
                              part * (TAFONI_SPH_BYTES / sizeof(Scalar));
    a = (typename vectors<Scalar>::value)((mask)a & reinterpret_cast<loose<mask> const*>(words)->lanes);
}
/// Square roots lane by lane, correctly rounded on every machine.
template <class Scalar>
TAFONI_SPH_INLINE void take_roots(typename vectors<Scalar>::value& a) noexcept {
#if defined(__x86_64__) && TAFONI_SPH_BYTES == 32
    if constexpr (sizeof(Scalar) == 4) {
        a = _mm256_sqrt_ps(a);
    } else {
        a = _mm256_sqrt_pd(a);
    }
#elif defined(__x86_64__)
    if constexpr (sizeof(Scalar) == 4) {
        a = _mm_sqrt_ps(a);
    } else {
        a = _mm_sqrt_pd(a);
    }
#else
    for (std::size_t k = 0; k < TAFONI_SPH_BYTES / sizeof(Scalar); ++k) a[k] = std::sqrt(a[k]);
#endif
}
/// Zero where negative.
template <class Scalar>
TAFONI_SPH_INLINE void cut(typename vectors<Scalar>::value& a) noexcept {
#if defined(__x86_64__) && TAFONI_SPH_BYTES == 32
    if constexpr (sizeof(Scalar) == 4) {
        a = _mm256_max_ps(a, _mm256_setzero_ps());
    } else {
        a = _mm256_max_pd(a, _mm256_setzero_pd());
    }
#elif defined(__x86_64__)
    if constexpr (sizeof(Scalar) == 4) {
        a = _mm_max_ps(a, _mm_setzero_ps());
    } else {
        a = _mm_max_pd(a, _mm_setzero_pd());
    }
#else
    for (std::size_t k = 0; k < TAFONI_SPH_BYTES / sizeof(Scalar); ++k) a[k] = a[k] > 0 ? a[k] : Scalar(0);
#endif
}

/// One particle in all lanes, and its sums. The cubic spline over its factor is (2 - q)^3 / 4 - (1 - q)^3, parts
/// below zero left out.
template <class Scalar>
struct summing {
    using value = typename vectors<Scalar>::value;
    static constexpr std::size_t width = TAFONI_SPH_BYTES / sizeof(Scalar);
    static constexpr std::size_t parts = 32 / TAFONI_SPH_BYTES;

    value x, y, z, u, v, w, density, pressure, viscous;
    value a[parts], b[parts], c[parts];

    TAFONI_SPH_INLINE void place(sph_arrays<Scalar> const& s, std::size_t i) noexcept {
        x = value{} + s.x[i];
        y = value{} + s.y[i];
        z = value{} + s.z[i];
        for (std::size_t p = 0; p < parts; ++p) a[p] = b[p] = c[p] = value{};
    }
    TAFONI_SPH_INLINE void move(sph_arrays<Scalar> const& s, std::size_t i) noexcept {
        u = value{} + s.u[i];
        v = value{} + s.v[i];
        w = value{} + s.w[i];
        density = value{} + s.density[i];
        pressure = value{} + s.pressure[i];
    }

    TAFONI_SPH_INLINE void add_kernel(sph_arrays<Scalar> const& s, std::size_t k, std::size_t rest, std::size_t part) noexcept {
        value dx, dy, dz;
        load<Scalar>(s.x + k + part * width, dx);
        load<Scalar>(s.y + k + part * width, dy);
        load<Scalar>(s.z + k + part * width, dz);
        dx = x - dx;
        dy = y - dy;
        dz = z - dz;
        value q = dx * dx + dy * dy + dz * dz;
        take_roots<Scalar>(q);
        value wide = Scalar(2) - q;
        value slim = Scalar(1) - q;
        cut<Scalar>(wide);
        cut<Scalar>(slim);
        value kernel = Scalar(0.25) * (wide * wide * wide) - slim * slim * slim;
        keep<Scalar>(rest, part, kernel);
        a[part] += kernel;
    }

    TAFONI_SPH_INLINE void add_force(sph_arrays<Scalar> const& s, std::size_t k, std::size_t rest, std::size_t part) noexcept {
        value dx, dy, dz, du, dv, dw, rho, p;
        load<Scalar>(s.x + k + part * width, dx);
        load<Scalar>(s.y + k + part * width, dy);
        load<Scalar>(s.z + k + part * width, dz);
        load<Scalar>(s.u + k + part * width, du);
        load<Scalar>(s.v + k + part * width, dv);
        load<Scalar>(s.w + k + part * width, dw);
        load<Scalar>(s.density + k + part * width, rho);
        load<Scalar>(s.pressure + k + part * width, p);
        dx = x - dx;
        dy = y - dy;
        dz = z - dz;
        value const square = dx * dx + dy * dy + dz * dz;
        value q = square;
        take_roots<Scalar>(q);
        value wide = Scalar(2) - q;
        value slim = Scalar(1) - q;
        cut<Scalar>(wide);
        cut<Scalar>(slim);
        value slope = Scalar(3) * (slim * slim) - Scalar(0.75) * (wide * wide);  // 0 at q = 0
        keep<Scalar>(rest, part, slope);
        value const along = dx * (u - du) + dy * (v - dv) + dz * (w - dw);
        value const both = (density + rho) * (square + Scalar(0.01));
        value const push = (pressure + p) * both - viscous * along;
        value const f = slope * push / ((q + Scalar(1e-18)) * both);
        a[part] += f * dx;
        b[part] += f * dy;
        c[part] += f * dz;
    }

    /// In the order of the lanes.
    TAFONI_SPH_INLINE void total(value const (&sum)[parts], Scalar scale, Scalar& out) const noexcept {
        Scalar t = 0;
        for (std::size_t p = 0; p < parts; ++p) {
            for (std::size_t k = 0; k < width; ++k) t += sum[p][k];
        }
        out = scale * t;
    }
};

/// scale x sum of the kernel for particles begin .. end - 1. O(particles in the spans).
template <class Scalar>
TAFONI_SPH_TARGET inline void sum_densities(sph_arrays<Scalar> const& s, std::size_t begin, std::size_t end, Scalar scale) noexcept {
    constexpr std::size_t lanes = sph_lane_count<Scalar>;
    summing<Scalar> at;
    for (std::size_t i = begin; i < end; ++i) {
        at.place(s, i);
        sph_spans const& spans = s.spans[i];
        for (std::uint32_t r = 0; r < spans.count; ++r) {
            std::size_t const stop = spans.row[r].end;
            for (std::size_t k = spans.row[r].begin; k < stop; k += lanes) {
                std::size_t const rest = stop - k < lanes ? stop - k : lanes;
                at.add_kernel(s, k, rest, 0);
                if constexpr (at.parts == 2) {
                    if (rest > at.width) at.add_kernel(s, k, rest, 1);
                }
            }
        }
        at.total(at.a, scale, s.density[i]);
    }
}

/// Accelerations by pressure and viscosity: -scale sum (P_i + P_j - viscous v.d / ((rho_i + rho_j)(d^2 + 0.01))) W'(q) d / q,
/// which is antisymmetric in i and j to the last bit. O(particles in the spans).
template <class Scalar>
TAFONI_SPH_TARGET inline void sum_forces(sph_arrays<Scalar> const& s, std::size_t begin, std::size_t end, Scalar scale,
                                         Scalar viscous) noexcept {
    constexpr std::size_t lanes = sph_lane_count<Scalar>;
    summing<Scalar> at;
    at.viscous = typename vectors<Scalar>::value{} + viscous;
    for (std::size_t i = begin; i < end; ++i) {
        at.place(s, i);
        at.move(s, i);
        sph_spans const& spans = s.spans[i];
        for (std::uint32_t r = 0; r < spans.count; ++r) {
            std::size_t const stop = spans.row[r].end;
            for (std::size_t k = spans.row[r].begin; k < stop; k += lanes) {
                std::size_t const rest = stop - k < lanes ? stop - k : lanes;
                at.add_force(s, k, rest, 0);
                if constexpr (at.parts == 2) {
                    if (rest > at.width) at.add_force(s, k, rest, 1);
                }
            }
        }
        at.total(at.a, -scale, s.ax[i]);
        at.total(at.b, -scale, s.ay[i]);
        at.total(at.c, -scale, s.az[i]);
    }
}

#undef TAFONI_SPH_INLINE

}  // namespace tafoni::detail::TAFONI_SPH_ISA
#endif

#ifdef TAFONI_SPH_PLAIN
#undef TAFONI_SPH_TARGET
#undef TAFONI_SPH_ISA
#undef TAFONI_SPH_BYTES
#undef TAFONI_SPH_PLAIN
#endif
#undef TAFONI_SPH_SKIP
