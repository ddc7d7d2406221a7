// expect: soaking_rule
// expect: r\.soak_chance\(l, w\)
#include <tafoni/rules/concepts.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    double chance(tafoni::link_view const&, tafoni::water const&) const { return 0; }
#else
    double soak_chance(tafoni::link_view const&, tafoni::water const&) const { return 0; }
#endif
};

static_assert(tafoni::soaking_rule<mine>);
