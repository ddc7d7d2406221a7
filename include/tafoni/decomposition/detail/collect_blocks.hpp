/// \file
/// Parallel loops whose blocks return something of their own size.
#ifndef TAFONI_DECOMPOSITION_DETAIL_COLLECT_BLOCKS_HPP
#define TAFONI_DECOMPOSITION_DETAIL_COLLECT_BLOCKS_HPP

#include <tafoni/core/executor.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tafoni::detail {

/// Runs work(begin, end, result) on blocks of n elements, one result per block, in block order.
/// The results depend on n and grain only.
template <class Result, class Executor, class Work>
[[nodiscard]] std::vector<Result> collect_blocks(std::size_t n, std::size_t grain, Executor const& threads,
                                                 Work const& work) {
    std::vector<Result> results(n / grain + (n % grain != 0 ? 1 : 0));
    threads.for_blocks(n, grain,
                       [&](std::size_t begin, std::size_t end) { work(begin, end, results[begin / grain]); });
    return results;
}

/// Copies the vectors that `part` picks out of the results into `to`, one behind the other, each element
/// changed by shift(element, block); frees them. `to` is reserved once, so memory peaks at both copies.
template <class T, class Result, class Executor, class Part, class Shift>
void gather_blocks(std::vector<Result>& results, Part const& part, std::vector<T>& to, Executor const& threads,
                   Shift const& shift) {
    std::vector<std::size_t> begin(results.size() + 1, to.size());
    for (std::size_t b = 0; b < results.size(); ++b) begin[b + 1] = begin[b] + part(results[b]).size();
    to.resize(begin.back());
    threads.for_blocks(results.size(), 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t b = first; b < last; ++b) {
            std::vector<T>& from = part(results[b]);
            for (std::size_t k = 0; k < from.size(); ++k) to[begin[b] + k] = shift(from[k], b);
            std::vector<T>().swap(from);
        }
    });
}

/// The elements of all blocks in the one order that `less` allows: equal elements must be alike. The
/// blocks are used up. O(n log n), the last merge on one thread.
template <class T, class Executor, class Less>
[[nodiscard]] std::vector<T> sorted_blocks(std::vector<std::vector<T>>& blocks, Executor const& threads, Less const& less) {
    std::vector<T> all;
    gather_blocks(blocks, [](std::vector<T>& b) -> auto& { return b; }, all, threads, [](T const& x, std::size_t) { return x; });
    if (all.size() < 4096) {
        std::sort(all.begin(), all.end(), less);
        return all;
    }
    constexpr std::size_t parts = 16;
    auto const at = [n = all.size()](std::size_t part) {
        return static_cast<std::ptrdiff_t>(n / parts * part + std::min(part, n % parts));
    };
    threads.for_blocks(parts, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) std::sort(all.begin() + at(k), all.begin() + at(k + 1), less);
    });
    std::vector<T> merged(all.size());
    for (std::size_t width = 1; width < parts; width *= 2) {
        threads.for_blocks(parts, 2 * width, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; k += 2 * width) {
                std::merge(all.begin() + at(k), all.begin() + at(k + width), all.begin() + at(k + width),
                           all.begin() + at(k + 2 * width), merged.begin() + at(k), less);
            }
        });
        all.swap(merged);
    }
    return all;
}

/// Appends `from` to `to` and frees it.
template <class T>
void append_and_free(std::vector<T>& to, std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
    std::vector<T>().swap(from);
}

}  // namespace tafoni::detail

#endif
