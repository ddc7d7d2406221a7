// expect: fluid_boundary
// expect: b\.for_each_contact\(p, radius, visit\)
#include <tafoni/core/executor.hpp>
#include <tafoni/fluid/rain_particles.hpp>

struct walls {
#ifndef TAFONI_TEST_MISTAKE
    template <class Visit>
    void for_each_contact(tafoni::vec3 const&, double, Visit const&) const {}
#endif
};

static_assert(tafoni::fluid_boundary<walls>);
