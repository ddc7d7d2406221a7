// expect: curvature_estimator
// expect: e\(s, mean, x\)
#include <tafoni/curvature/concepts.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    void estimate(tafoni::surface_view const&, std::span<double>, tafoni::executor auto const&) const {}
#else
    void operator()(tafoni::surface_view const&, std::span<double>, tafoni::executor auto const&) const {}
#endif
};

static_assert(tafoni::curvature_estimator<mine>);
