// expect: scalar_field
// expect: same_as|return-type-requirement
#include <tafoni/field/concepts.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    float operator()(tafoni::vec3 const&) const { return 0.5F; }
#else
    double operator()(tafoni::vec3 const&) const { return 0.5; }
#endif
};

static_assert(tafoni::scalar_field<mine>);
