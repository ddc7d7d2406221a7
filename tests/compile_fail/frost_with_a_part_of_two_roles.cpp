// expect: several roles
#include <tafoni/weathering/frost_wedging.hpp>

struct mine {
    double weight(tafoni::link_view const&, tafoni::link_view const&, tafoni::water const&) const { return 1; }
#ifdef TAFONI_TEST_MISTAKE
    tafoni::vec3 draw(tafoni::stream&) const { return {0, 0, -1}; }
#endif
};

auto const frost = tafoni::frost_wedging{.flow = mine{}};
