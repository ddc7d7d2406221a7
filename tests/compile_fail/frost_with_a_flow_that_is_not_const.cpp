// expect: flow_policy
// expect: weight
#include <tafoni/weathering/frost_wedging.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    double weight(tafoni::link_view const&, tafoni::link_view const&, tafoni::water const&) { return 1; }
#else
    double weight(tafoni::link_view const&, tafoni::link_view const&, tafoni::water const&) const { return 1; }
#endif
};

auto const frost = tafoni::frost_wedging{.flow = mine{}};
