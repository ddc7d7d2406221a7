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
#ifdef __AVX2__
#define TAFONI_SPH_ISA isa_built_avx2
#else
#define TAFONI_SPH_ISA isa_built
#endif
#define TAFONI_SPH_PLAIN
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

/// Square roots lane by lane, correctly rounded on every machine.
template <class Scalar>
TAFONI_SPH_TARGET __attribute__((always_inline)) inline void take_roots(typename sph_lanes<Scalar>::value& a) noexcept {
#if defined(__x86_64__)
    if constexpr (sizeof(Scalar) == 4) {
        auto* const half = reinterpret_cast<__m128*>(&a);
        half[0] = _mm_sqrt_ps(half[0]);
        half[1] = _mm_sqrt_ps(half[1]);
    } else {
        auto* const half = reinterpret_cast<__m128d*>(&a);
        half[0] = _mm_sqrt_pd(half[0]);
        half[1] = _mm_sqrt_pd(half[1]);
    }
#else
    for (std::size_t k = 0; k < sph_lanes<Scalar>::count; ++k) a[k] = std::sqrt(a[k]);
#endif
}

/// scale x sum of (2 - q)^3 / 4 - (1 - q)^3, parts below zero left out: the cubic spline without its factor.
/// Particles begin .. end - 1. O(particles in the spans).
template <class Scalar>
TAFONI_SPH_TARGET inline void sum_densities(sph_arrays<Scalar> const& a, std::size_t begin, std::size_t end, Scalar scale) noexcept {
    using lanes = sph_lanes<Scalar>;
    using value = typename lanes::value;
    using mask = typename lanes::mask;
    using loose = sph_loose<value>;
    using loose_mask = sph_loose<mask>;
    constexpr std::size_t width = lanes::count;
    for (std::size_t i = begin; i < end; ++i) {
        value const x = value{} + a.x[i];
        value const y = value{} + a.y[i];
        value const z = value{} + a.z[i];
        value sum{};
        sph_spans const& near_by = a.spans[i];
        for (std::uint32_t r = 0; r < near_by.count; ++r) {
            std::size_t const stop = near_by.row[r].end;
            for (std::size_t k = near_by.row[r].begin; k < stop; k += width) {
                std::size_t const rest = stop - k < width ? stop - k : width;
                mask const in = reinterpret_cast<loose_mask const*>(sph_tails<Scalar>.words + (width - rest))->lanes;
                value const dx = x - reinterpret_cast<loose const*>(a.x + k)->lanes;
                value const dy = y - reinterpret_cast<loose const*>(a.y + k)->lanes;
                value const dz = z - reinterpret_cast<loose const*>(a.z + k)->lanes;
                value q = dx * dx + dy * dy + dz * dz;
                take_roots<Scalar>(q);
                value wide = Scalar(2) - q;
                value slim = Scalar(1) - q;
                wide = (value)((mask)wide & (wide > value{}));
                slim = (value)((mask)slim & (slim > value{}));
                value const kernel = Scalar(0.25) * (wide * wide * wide) - slim * slim * slim;
                sum += (value)((mask)kernel & in);
            }
        }
        Scalar total = 0;
        for (std::size_t k = 0; k < width; ++k) total += sum[k];
        a.density[i] = scale * total;
    }
}

/// Accelerations by pressure and viscosity: -scale sum (P_i + P_j - viscous v.d / ((rho_i + rho_j)(d^2 + 0.01))) W'(q) d / q,
/// which is antisymmetric in i and j to the last bit. O(particles in the spans).
template <class Scalar>
TAFONI_SPH_TARGET inline void sum_forces(sph_arrays<Scalar> const& a, std::size_t begin, std::size_t end, Scalar scale,
                                         Scalar viscous) noexcept {
    using lanes = sph_lanes<Scalar>;
    using value = typename lanes::value;
    using mask = typename lanes::mask;
    using loose = sph_loose<value>;
    using loose_mask = sph_loose<mask>;
    constexpr std::size_t width = lanes::count;
    for (std::size_t i = begin; i < end; ++i) {
        value const x = value{} + a.x[i];
        value const y = value{} + a.y[i];
        value const z = value{} + a.z[i];
        value const u = value{} + a.u[i];
        value const v = value{} + a.v[i];
        value const w = value{} + a.w[i];
        value const density = value{} + a.density[i];
        value const pressure = value{} + a.pressure[i];
        value ax{};
        value ay{};
        value az{};
        sph_spans const& near_by = a.spans[i];
        for (std::uint32_t r = 0; r < near_by.count; ++r) {
            std::size_t const stop = near_by.row[r].end;
            for (std::size_t k = near_by.row[r].begin; k < stop; k += width) {
                std::size_t const rest = stop - k < width ? stop - k : width;
                mask const in = reinterpret_cast<loose_mask const*>(sph_tails<Scalar>.words + (width - rest))->lanes;
                value const dx = x - reinterpret_cast<loose const*>(a.x + k)->lanes;
                value const dy = y - reinterpret_cast<loose const*>(a.y + k)->lanes;
                value const dz = z - reinterpret_cast<loose const*>(a.z + k)->lanes;
                value const square = dx * dx + dy * dy + dz * dz;
                value q = square;
                take_roots<Scalar>(q);
                value wide = Scalar(2) - q;
                value slim = Scalar(1) - q;
                wide = (value)((mask)wide & (wide > value{}));
                slim = (value)((mask)slim & (slim > value{}));
                value slope = Scalar(3) * (slim * slim) - Scalar(0.75) * (wide * wide);  // 0 at q = 0
                slope = (value)((mask)slope & in);
                value const along = dx * (u - reinterpret_cast<loose const*>(a.u + k)->lanes) +
                                    dy * (v - reinterpret_cast<loose const*>(a.v + k)->lanes) +
                                    dz * (w - reinterpret_cast<loose const*>(a.w + k)->lanes);
                value const both = (density + reinterpret_cast<loose const*>(a.density + k)->lanes) * (square + Scalar(0.01));
                value const push = (pressure + reinterpret_cast<loose const*>(a.pressure + k)->lanes) * both - viscous * along;
                value const f = slope * push / ((q + Scalar(1e-18)) * both);
                ax += f * dx;
                ay += f * dy;
                az += f * dz;
            }
        }
        Scalar tx = 0;
        Scalar ty = 0;
        Scalar tz = 0;
        for (std::size_t k = 0; k < width; ++k) {
            tx += ax[k];
            ty += ay[k];
            tz += az[k];
        }
        a.ax[i] = -scale * tx;
        a.ay[i] = -scale * ty;
        a.az[i] = -scale * tz;
    }
}

}  // namespace tafoni::detail::TAFONI_SPH_ISA
#endif

#ifdef TAFONI_SPH_PLAIN
#undef TAFONI_SPH_TARGET
#undef TAFONI_SPH_ISA
#undef TAFONI_SPH_PLAIN
#endif
#undef TAFONI_SPH_SKIP
