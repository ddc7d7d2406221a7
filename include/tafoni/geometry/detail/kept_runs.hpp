/// \file
/// Leaving out a few of many.
#ifndef TAFONI_GEOMETRY_DETAIL_KEPT_RUNS_HPP
#define TAFONI_GEOMETRY_DETAIL_KEPT_RUNS_HPP

#include <tafoni/core/executor.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tafoni::detail {

/// `f(begin, end, to)` for the runs of 0 .. n - 1 between `gone`, which ascend; `to` is the number of `begin` without
/// them. Runs end at blocks of the executor. O(runs).
template <executor E, class F>
void for_kept_runs(std::size_t n, std::span<std::uint32_t const> gone, E const& threads, F const& f) {
    threads.for_blocks(n, 2048, [&](std::size_t begin, std::size_t end) {
        auto next = std::lower_bound(gone.begin(), gone.end(), begin);
        std::size_t to = begin - static_cast<std::size_t>(next - gone.begin());
        for (std::size_t at = begin; at < end; ++at, ++next) {
            std::size_t const stop = next == gone.end() ? end : std::min<std::size_t>(*next, end);
            if (stop > at) f(at, stop, to);
            to += stop - at;
            at = stop;
            if (at == end) break;
        }
    });
}

}  // namespace tafoni::detail

#endif
