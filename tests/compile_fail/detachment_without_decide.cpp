// expect: detachment_rule
// expect: r\.decide\(a, b\)
#include <tafoni/rules/concepts.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    tafoni::falling falls(tafoni::part const&, tafoni::part const&) const { return tafoni::falling::first; }
#else
    tafoni::falling decide(tafoni::part const&, tafoni::part const&) const { return tafoni::falling::first; }
#endif
};

static_assert(tafoni::detachment_rule<mine>);
