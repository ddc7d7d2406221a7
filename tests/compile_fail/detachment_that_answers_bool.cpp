// expect: detachment_rule
// expect: same_as|return-type-requirement
#include <tafoni/rules/concepts.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    bool decide(tafoni::part const&, tafoni::part const&) const { return true; }
#else
    tafoni::falling decide(tafoni::part const&, tafoni::part const&) const { return tafoni::falling::first; }
#endif
};

static_assert(tafoni::detachment_rule<mine>);
