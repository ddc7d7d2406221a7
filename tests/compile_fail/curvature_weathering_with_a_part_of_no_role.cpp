// expect: role
#include <tafoni/weathering/curvature_weathering.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    int anything = 0;
#else
    double operator()(tafoni::vec3 const&) const { return 2; }
#endif
};

auto const process = tafoni::curvature_weathering{.durability = mine{}};
