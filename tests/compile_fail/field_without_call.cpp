// expect: scalar_field
// expect: f\(p\)
#include <tafoni/field/concepts.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    double at(tafoni::vec3 const& p) const { return p[2]; }
#else
    double operator()(tafoni::vec3 const& p) const { return p[2]; }
#endif
};

static_assert(tafoni::scalar_field<mine>);
