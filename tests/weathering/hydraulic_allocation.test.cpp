#include "reliability/failing_new.hpp"
#include "support/curved_surfaces.hpp"

#include <tafoni/fluid/sph.hpp>
#include <tafoni/weathering/hydraulic_run.hpp>

#include <catch2/catch.hpp>

using namespace tafoni;
using namespace tafoni_test;

TEST_CASE("when memory runs out at any point of an iteration under water, whole iterations stay and the run goes on") {
    triangle_surface ground = parametric(
                                  9, 9, false, false, 0, [](double u, double v) { return vec3{u, v, -0.5 * u}; },
                                  [](double, double) { return 0.0; })
                                  .mesh;
    auto const make = [&] {
        sph<double> const water({.box = {.lo = vec3{0.2, 0.3, -0.07}, .hi = vec3{0.4, 0.6, 0}}, .velocity = vec3{2, 0, 0}},
                                {.keep = {.lo = vec3{-1, -1, -1}, .hi = vec3{2, 2, 2}}},
                                {.particles = 40, .spacing = 0.1, .viscosity = 1e-3, .frame = 0});
        return hydraulic_run(ground, water, partheniades_erosion{.coefficient = 1e-3, .critical = 0},
                             {.refine_length = 0.1, .refine_every = 3, .check_every = 2});
    };
    std::vector<triangle_surface> after;
    auto whole = make();
    after.push_back(whole.surface());
    for (int k = 0; k < 5; ++k) {
        whole.run(1);
        after.push_back(whole.surface());
    }
    REQUIRE(whole.report().vertices_added > 0);
    REQUIRE(whole.report().ledger.eroded > 0);
    auto const act = [](auto& run) { run.run(5); };
    long const k = fail_each_allocation(make, act, [&](auto& run, bool) {
        std::uint64_t const done = run.report().iterations;
        REQUIRE(done <= 5);
        REQUIRE(run.balanced());
        REQUIRE((run.surface() == after[done]));
        run.run(5 - done);
        REQUIRE((run.surface() == after[5]));
        REQUIRE(run.fluid().particle_count() == whole.fluid().particle_count());
    });
    CHECK(k >= 100);  // and got through in the end
}
