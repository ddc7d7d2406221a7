// expect: executor
// expect: e\.for_blocks\(n, n, f\)
#include <tafoni/core/executor.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    void run(std::size_t n, std::size_t, auto const& f) const { f(0, n); }
    std::size_t thread_count() const { return 1; }
#else
    void for_blocks(std::size_t n, std::size_t, auto const& f) const { f(0, n); }
    std::size_t thread_count() const { return 1; }
#endif
};

static_assert(tafoni::executor<mine>);
