// expect: breakage_rule
// expect: r\.break_chance\(l\)
#include <tafoni/rules/concepts.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    double breaks(tafoni::link_view const&) const { return 0; }
#else
    double break_chance(tafoni::link_view const&) const { return 0; }
#endif
};

static_assert(tafoni::breakage_rule<mine>);
