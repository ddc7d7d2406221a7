// expect: exposure_policy
// expect: e\.update\(n, cells, fallen, state, links, change\)
#include <tafoni/graph/exposure.hpp>

struct mine {
    struct state {};
    state start(auto const&, std::span<tafoni::cell_state const>, std::span<tafoni::link_state>) const { return {}; }
#ifndef TAFONI_TEST_MISTAKE
    void update(auto const&, std::span<tafoni::cell_state const>, std::span<tafoni::cell_index const>, state&,
                std::span<tafoni::link_state>, tafoni::exposure_change&) const {}
#endif
};

static_assert(tafoni::exposure_policy<mine>);
