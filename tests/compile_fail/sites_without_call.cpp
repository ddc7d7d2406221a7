// expect: site_pattern
// expect: p\(s, seed\)
#include <tafoni/decomposition/sites.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    std::vector<tafoni::vec3> operator()(tafoni::solid const& s) const { return {s.bounds.centre()}; }
#else
    std::vector<tafoni::vec3> operator()(tafoni::solid const& s, std::uint64_t) const { return {s.bounds.centre()}; }
#endif
};

static_assert(tafoni::site_pattern<mine>);
