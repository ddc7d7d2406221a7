// expect: scalar_field
// expect: operator\(\)
#include <tafoni/percolation/seepage.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    float operator()(tafoni::vec3 const&) const { return 0.5F; }
#else
    double operator()(tafoni::vec3 const&) const { return 0.5; }
#endif
};

auto const flow = tafoni::seepage{.resistance = mine{}};
