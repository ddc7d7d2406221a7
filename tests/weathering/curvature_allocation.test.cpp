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
    auto const make = [&] { return curvature_run(s, {}, options); };
    auto const act = [](auto& run) { run.run(5); };
    long const k = fail_each_allocation(make, act, [&](auto& run, bool) {
        std::uint64_t const done = run.report().iterations;
        REQUIRE(done <= 5);
        REQUIRE((run.surface() == after[done]));
        run.run(5 - done);
        REQUIRE((run.surface() == after[5]));
    });
    CHECK(k >= 20);  // and got through in the end
}

namespace {

/// A roof of 5 x 5 vertices, its middle farther in front of a floor than a ring is wide.
triangle_surface roof_and_floor() {
    triangle_surface s;
    for (int level : {0, 1}) {
        auto const first = static_cast<std::uint32_t>(s.positions.size());
        for (int j = 0; j < 5; ++j) {
            for (int i = 0; i < 5; ++i) s.positions.push_back(vec3{0.25 * i, 0.25 * j, 0.02 * level});
        }
        for (std::uint32_t j = 0; j < 4; ++j) {
            for (std::uint32_t i = 0; i < 4; ++i) {
                std::uint32_t const a = first + i + 5 * j;
                s.triangles.push_back({a, a + 1, a + 6});
                s.triangles.push_back({a, a + 6, a + 5});
            }
        }
    }
    return s;
}
struct everywhere {
    void operator()(surface_view const&, std::span<double> mean, executor auto const&) const {
        std::fill(mean.begin(), mean.end(), 1.0);
    }
};
/// The middle of the roof goes down fast, the rest slowly.
struct dent {
    [[nodiscard]] vec3 direction(wear_point const& at) const {
        double const x = at.position[0] - 0.5;
        double const y = at.position[1] - 0.5;
        return vec3{0, 0, x * x + y * y < 0.01 && at.position[2] > 0 ? -0.5 : -0.001};
    }
};

}  // namespace

TEST_CASE("C3: memory that runs out in a search, a step back or a hold changes no bit of what follows") {
    triangle_surface const s = roof_and_floor();
    auto const process = curvature_weathering{.estimator = everywhere{}, .direction = dent{}};
    curvature_options const options{.check_every = 2};
    curvature_run whole(s, process, options);
    whole.run(16);
    REQUIRE(whole.report().held > 0);
    REQUIRE(whole.report().stopped == curvature_stop::finished);
    auto const end = whole.checkpoint();
    auto const make = [&] { return curvature_run(s, process, options); };
    auto const act = [](auto& run) { run.run(16); };
    long const k = fail_each_allocation(make, act, [&](auto& run, bool failed) {
        if (run.report().iterations < 16) run.run(16 - run.report().iterations);
        else if (failed) return;  // in the search at the end: `run(0)` makes none
        REQUIRE((run.checkpoint() == end));
    });
    CHECK(k >= 100);  // and got through in the end
}
