/// \file
/// Counting the solid voxels in bubbles: the same integers from every instruction set.
#ifndef TAFONI_VOXEL_DETAIL_COUNT_AIR_HPP
#define TAFONI_VOXEL_DETAIL_COUNT_AIR_HPP

#include <tafoni/voxel/detail/kernel_set.hpp>
#include <tafoni/voxel/detail/word_kernel.hpp>

#if defined(__x86_64__) && defined(__GNUC__)
#include <tafoni/voxel/detail/count_air_avx2.hpp>
#include <tafoni/voxel/detail/count_air_x86.hpp>
#endif

namespace tafoni::detail {

/// Solid voxels in the bubble around each position. The layout's rows must have been gathered. `set` must be one that
/// the machine has. O(voxels * words of the bubble).
inline void count_solid(count_task const& t, kernel_set set = best_kernel_set()) {
#if defined(__x86_64__) && defined(__GNUC__)
    if (set == kernel_set::avx512) return isa_avx512::count_solid(t);
    if (set == kernel_set::avx2) return isa_avx2::count_solid(t);
    if (set != kernel_set::portable) return isa_popcnt::count_solid(t);
#endif
    static_cast<void>(set);
    word_kernel::count(t);
}

}  // namespace tafoni::detail

#endif
