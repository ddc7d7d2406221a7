// expect: flow_policy
// expect: same_as|return-type-requirement
#include <tafoni/percolation/concepts.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    float weight(tafoni::link_view const&, tafoni::link_view const&, tafoni::water const&) const { return 1; }
#else
    double weight(tafoni::link_view const&, tafoni::link_view const&, tafoni::water const&) const { return 1; }
#endif
};

static_assert(tafoni::flow_policy<mine>);
