#include "reliability/failing_new.hpp"
#include "support/curved_surfaces.hpp"

#include <tafoni/weathering/curvature_run.hpp>

#include <catch2/catch.hpp>

using namespace tafoni;
using namespace tafoni_test;

TEST_CASE("C3: when memory runs out at any point, whole iterations stay and the run goes on to the same bits") {
    triangle_surface s = torus_surface(12, 8, 0.3).mesh;
    for (vec3& p : s.positions) p[2] *= 0.3;
    curvature_options const options{.small_edge = 0.4, .check_every = 2};
    std::vector<triangle_surface> after;
    curvature_run whole(s, {}, options);
    after.push_back(whole.surface());
    for (int k = 0; k < 5; ++k) {
        whole.run(1);
        after.push_back(whole.surface());
    }
    REQUIRE(whole.report().edges_collapsed > 0);
    bool failed = true;
    long k = 0;
    for (; failed && k < 20000; ++k) {
        curvature_run run(s, {}, options);
        failed = false;
        allocations_left = k;
        try {
            run.run(5);
        } catch (std::bad_alloc const&) {
            failed = true;
        }
        allocations_left = -1;
        std::uint64_t const done = run.report().iterations;
        REQUIRE(done <= 5);
        REQUIRE((run.surface() == after[done]));
        run.run(5 - done);
        REQUIRE((run.surface() == after[5]));
    }
    CHECK(k > 20);
    CHECK_FALSE(failed);
}
