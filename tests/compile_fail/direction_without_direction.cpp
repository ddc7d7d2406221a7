// expect: direction_policy
// expect: p\.direction\(at\)
#include <tafoni/curvature/displacement.hpp>

struct down {
#ifdef TAFONI_TEST_MISTAKE
    tafoni::vec3 way(tafoni::wear_point const&) const { return {0, 0, -1}; }
#else
    tafoni::vec3 direction(tafoni::wear_point const&) const { return {0, 0, -1}; }
#endif
};

static_assert(tafoni::direction_policy<down>);
