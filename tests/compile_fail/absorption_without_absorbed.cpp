// expect: absorption_rule
// expect: r\.absorbed\(l, w, s\)
#include <tafoni/rules/concepts.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    double drunk(tafoni::link_view const&, tafoni::water const&, tafoni::link_scale const&) const { return 0.1; }
#else
    double absorbed(tafoni::link_view const&, tafoni::water const&, tafoni::link_scale const&) const { return 0.1; }
#endif
};

static_assert(tafoni::absorption_rule<mine>);
