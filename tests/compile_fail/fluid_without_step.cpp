// expect: particle_fluid
// expect: f\.step\(walls, x\)
#include <tafoni/fluid/concepts.hpp>

struct mine {
    std::size_t particle_count() const { return 0; }
    tafoni::vec3 position(std::size_t) const { return tafoni::vec3{0, 0, 0}; }
    tafoni::vec3 velocity(std::size_t) const { return tafoni::vec3{0, 0, 0}; }
    double reach() const { return 1; }
#ifndef TAFONI_TEST_MISTAKE
    double step(tafoni::fluid_boundary auto const&, tafoni::executor auto const&) { return 1; }
#endif
};

static_assert(tafoni::particle_fluid<mine>);
