// expect: rain_policy
// expect: r\.draw\(random\)
#include <tafoni/percolation/concepts.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    tafoni::vec3 fall(tafoni::stream&) const { return {0, 0, -1}; }
#else
    tafoni::vec3 draw(tafoni::stream&) const { return {0, 0, -1}; }
#endif
};

static_assert(tafoni::rain_policy<mine>);
