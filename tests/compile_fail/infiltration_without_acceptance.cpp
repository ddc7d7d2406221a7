// expect: infiltration_policy
// expect: p\.acceptance\(l, d\)
#include <tafoni/percolation/concepts.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    double accept(tafoni::link_view const&, tafoni::vec3 const&) const { return 1; }
#else
    double acceptance(tafoni::link_view const&, tafoni::vec3 const&) const { return 1; }
#endif
};

static_assert(tafoni::infiltration_policy<mine>);
