/// \file
/// Where parallel loops run: on the calling thread, on our pool, or on the host's own threads.
#ifndef TAFONI_CORE_EXECUTOR_HPP
#define TAFONI_CORE_EXECUTOR_HPP

#include <concepts>
#include <cstddef>

namespace tafoni {

namespace detail {
struct block_archetype {
    void operator()(std::size_t begin, std::size_t end) const;
};
}  // namespace detail

/// Runs the blocks of a loop.
///
/// Laws: `for_blocks(n, grain, f)` calls f(b, min(b + grain, n)) exactly once for b = 0, grain,
/// 2 grain, ... < n, in any order and on any thread, and returns when all have returned. When
/// calls throw, one exception reaches the caller: that of the lowest b. `thread_count()` >= 1 is a
/// hint for sizing scratch memory; no result may depend on it.
/// Model: `struct mine { void for_blocks(std::size_t n, std::size_t grain, auto const& f) const;
///                      std::size_t thread_count() const; };`
template <class E>
concept executor = requires(E const& e, std::size_t n, detail::block_archetype const& f) {
    { e.for_blocks(n, n, f) } -> std::same_as<void>;
    { e.thread_count() } -> std::same_as<std::size_t>;
};

/// Runs every block on the calling thread, in order. The default everywhere.
struct inline_executor {
    template <class F>
    void for_blocks(std::size_t n, std::size_t grain, F const& f) const {
        if (grain == 0) grain = 1;
        for (std::size_t b = 0; b < n; b += grain) f(b, n - b < grain ? n : b + grain);
    }
    [[nodiscard]] std::size_t thread_count() const noexcept { return 1; }
};

static_assert(executor<inline_executor>);

}  // namespace tafoni

#endif
