// expect: exchange_rule
// expect: r\.rate\(at\)
#include <tafoni/fluid/rain_particles.hpp>
#include <tafoni/weathering/hydraulic_run.hpp>

struct mine {
#ifndef TAFONI_TEST_MISTAKE
    double rate(tafoni::wash_point const&) const { return 1; }
#endif
};

void washed(tafoni::triangle_surface const& s) {
    tafoni::hydraulic_run run(s, tafoni::rain_particles({}, {}, {}), mine{});
    run.run(1);
}
