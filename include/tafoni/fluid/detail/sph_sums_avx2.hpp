/// \file
/// The sums over neighbours for x86-64 with AVX2, compiled whatever the flags and chosen where the program runs.
#ifndef TAFONI_FLUID_DETAIL_SPH_SUMS_AVX2_HPP
#define TAFONI_FLUID_DETAIL_SPH_SUMS_AVX2_HPP

#include <tafoni/fluid/detail/sph_sums.hpp>

#if defined(__x86_64__) && !defined(__AVX__)
#define TAFONI_SPH_TARGET __attribute__((target("avx2")))
#define TAFONI_SPH_ISA isa_avx2
#define TAFONI_SPH_BYTES 32
#include <tafoni/fluid/detail/sph_sums.hpp>
#undef TAFONI_SPH_TARGET
#undef TAFONI_SPH_ISA
#undef TAFONI_SPH_BYTES
#endif

namespace tafoni::detail {

#ifdef __AVX__
namespace sph_built = isa_built_avx;
#else
namespace sph_built = isa_built;
#endif

/// Whether this machine runs the kernels of `isa_avx2` and the unit was not built for as wide vectors anyway.
[[nodiscard]] inline bool sph_has_avx2() noexcept {
#if defined(__x86_64__) && !defined(__AVX__)
    return __builtin_cpu_supports("avx2") != 0;
#else
    return false;
#endif
}

/// By the widest instructions that the machine has, or that `plain` leaves; the same bits with all of them.
template <class Scalar>
void sph_densities(sph_arrays<Scalar> const& a, std::size_t begin, std::size_t end, Scalar scale, bool avx2) noexcept {
#if defined(__x86_64__) && !defined(__AVX__)
    if (avx2) return isa_avx2::sum_densities(a, begin, end, scale);
#endif
    (void)avx2;
    sph_built::sum_densities(a, begin, end, scale);
}
template <class Scalar>
void sph_forces(sph_arrays<Scalar> const& a, std::size_t begin, std::size_t end, Scalar scale, Scalar viscous, bool avx2) noexcept {
#if defined(__x86_64__) && !defined(__AVX__)
    if (avx2) return isa_avx2::sum_forces(a, begin, end, scale, viscous);
#endif
    (void)avx2;
    sph_built::sum_forces(a, begin, end, scale, viscous);
}

}  // namespace tafoni::detail

#endif
