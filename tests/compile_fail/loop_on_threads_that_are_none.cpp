// expect: executor
// expect: e\.for_blocks\(n, n, f\)
#include <tafoni/decomposition/shard_complex.hpp>
#include <tafoni/graph/make_link_graph.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    void submit(auto const& f) const { f(); }
#else
    void for_blocks(std::size_t n, std::size_t, auto const& f) const { f(0, n); }
#endif
    std::size_t thread_count() const { return 1; }
};

tafoni::link_graph ask(tafoni::shard_complex const& shards) { return tafoni::make_link_graph(shards, {}, mine{}); }
