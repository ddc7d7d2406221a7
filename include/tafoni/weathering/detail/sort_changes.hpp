/// \file
/// Changes of voxels in voxel order, on several threads.
#ifndef TAFONI_WEATHERING_DETAIL_SORT_CHANGES_HPP
#define TAFONI_WEATHERING_DETAIL_SORT_CHANGES_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/voxel/grid_frame.hpp>
#include <tafoni/voxel/voxel_change.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

namespace tafoni::detail {

/// Voxel order in one number, for voxels inside a grid.
[[nodiscard]] inline std::uint64_t order_of(voxel v) noexcept {
    static_assert(grid_frame::longest <= std::size_t{1} << 20);
    return static_cast<std::uint64_t>(v.z) << 40 | static_cast<std::uint64_t>(v.y) << 20 | static_cast<std::uint64_t>(v.x);
}
inline constexpr auto by_voxel = [](voxel_change const& a, voxel_change const& b) noexcept {
    return order_of(a.at) < order_of(b.at);
};

/// Sorts changes of different voxels: by height first, then every layer for itself. O(n log n + height).
template <executor Executor>
void sort_changes(std::vector<voxel_change>& changes, std::vector<voxel_change>& scratch, std::size_t height,
                  Executor const& threads) {
    if (changes.size() < 512 || height > 4096) {
        std::sort(changes.begin(), changes.end(), by_voxel);
        return;
    }
    std::vector<std::size_t> first(height + 1, 0);
    for (voxel_change const& c : changes) ++first[static_cast<std::size_t>(c.at.z) + 1];
    for (std::size_t z = 0; z < height; ++z) first[z + 1] += first[z];
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    scratch.resize(changes.size());
    for (voxel_change const& c : changes) scratch[next[static_cast<std::size_t>(c.at.z)]++] = c;
    changes.swap(scratch);
    threads.for_blocks(height, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t z = begin; z < end; ++z) {
            std::sort(changes.begin() + static_cast<std::ptrdiff_t>(first[z]),
                      changes.begin() + static_cast<std::ptrdiff_t>(first[z + 1]), by_voxel);
        }
    });
}

/// One entry for every voxel that anything happened to: first before, last after. The changes before `middle` and
/// those from it on are in voxel order. O(n).
inline void merge_changes(std::vector<voxel_change>& changes, std::size_t middle, std::vector<voxel_change>& scratch) {
    if (changes.size() == middle) return;
    auto const from = changes.begin() + static_cast<std::ptrdiff_t>(middle);
    scratch.clear();
    scratch.reserve(changes.size());
    std::merge(changes.begin(), from, from, changes.end(), std::back_inserter(scratch), by_voxel);
    std::size_t kept = 0;
    for (voxel_change const& c : scratch) {
        if (kept > 0 && changes[kept - 1].at == c.at) {
            changes[kept - 1].after = c.after;
        } else {
            changes[kept++] = c;
        }
    }
    changes.resize(kept);
}

}  // namespace tafoni::detail

#endif
