/// \file
/// Parallel loops whose blocks return something of their own size.
#ifndef TAFONI_DECOMPOSITION_DETAIL_COLLECT_BLOCKS_HPP
#define TAFONI_DECOMPOSITION_DETAIL_COLLECT_BLOCKS_HPP

#include <tafoni/core/executor.hpp>

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

/// Appends `from` to `to` and frees it.
template <class T>
void append_and_free(std::vector<T>& to, std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
    std::vector<T>().swap(from);
}

}  // namespace tafoni::detail

#endif
