/// \file
/// Which instructions the machine that we run on has for counting bits.
#ifndef TAFONI_VOXEL_DETAIL_KERNEL_SET_HPP
#define TAFONI_VOXEL_DETAIL_KERNEL_SET_HPP

#include <cstdint>

namespace tafoni::detail {

/// Sets of kernels, each at least as fast as the one before it. All count the same integers.
enum class kernel_set : std::uint8_t {
    portable,  ///< C++, for the flags that the host compiles with
    popcnt,    ///< x86-64 with POPCNT and BMI2 (2013 on)
    avx2,      ///< and with AVX2
    avx512     ///< x86-64 with AVX-512 F, BW and VPOPCNTDQ (2019 on)
};

/// Asked of the machine once, not of the compiler's flags.
[[nodiscard]] inline kernel_set best_kernel_set() noexcept {
#if defined(__x86_64__) && defined(__GNUC__)
    static kernel_set const best = [] {
        __builtin_cpu_init();
        if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
            __builtin_cpu_supports("avx512vpopcntdq")) {
            return kernel_set::avx512;
        }
        if (!__builtin_cpu_supports("popcnt") || !__builtin_cpu_supports("bmi2")) return kernel_set::portable;
        return __builtin_cpu_supports("avx2") ? kernel_set::avx2 : kernel_set::popcnt;
    }();
    return best;
#else
    return kernel_set::portable;
#endif
}

}  // namespace tafoni::detail

#endif
