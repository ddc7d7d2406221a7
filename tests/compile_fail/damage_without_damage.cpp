// expect: damage_rule
// expect: r\.damage\(l, w, s\)
#include <tafoni/rules/concepts.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    double harm(tafoni::link_view const&, double, tafoni::link_scale const&) const { return 0; }
#else
    double damage(tafoni::link_view const&, double, tafoni::link_scale const&) const { return 0; }
#endif
};

static_assert(tafoni::damage_rule<mine>);
