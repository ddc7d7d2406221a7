#include <tafoni/core/random.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/weathering/voxel_run.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

using namespace tafoni;

namespace {

sparse_grid lump() {
    sparse_grid g({.size = {36, 12, 20}}, up_axis::plus_z,
                  {{border_kind::air, border_kind::air, border_kind::air, border_kind::air, border_kind::rock, border_kind::air}});
    stream random(3, stage::user, 0);
    for (std::int32_t z = 0; z < 18; ++z) {
        for (std::int32_t y = 1; y < 11; ++y) {
            for (std::int32_t x = 2; x < 34; ++x) {
                if (random.uniform01() < 0.92) g.set({x, y, z}, voxel_state::rock);
            }
        }
    }
    return g;
}

voxel_options everything() { return {.colluvium = repose_rule{}, .rockfall = rockfall_options{}}; }

/// Throws at a call that is counted down from outside.
struct fragile_durability {
    std::shared_ptr<int> left = std::make_shared<int>(1 << 30);
    double operator()(vec3 const&) const {
        if (--*left == 0) throw std::runtime_error("no more");
        return 0.015;
    }
};

}  // namespace

TEST_CASE("C1: a run that is stopped at any tick goes on to the same state") {
    voxel_schedule const schedule{.phases = {{.steps = 4}, {.steps = 3, .spheroidal = 0, .cavernous = 2}}};
    auto const process = voxel_weathering{.durability = constant_field{.value = 0.015}};
    voxel_run whole(lump(), process, everything());
    std::vector<double> ticks;
    whole.run(schedule, {[&](progress_event const& e) {
                  REQUIRE(e.stage == "weather");
                  ticks.push_back(e.fraction);
                  return step_control::proceed;
              }});
    REQUIRE(ticks.front() == 0);
    REQUIRE(ticks.back() == 1);
    REQUIRE(std::is_sorted(ticks.begin(), ticks.end()));
    REQUIRE(ticks.size() == 8);
    for (std::size_t stop = 0; stop < ticks.size(); ++stop) {
        voxel_run run(lump(), process, everything());
        std::size_t tick = 0;
        auto const r = run.run(schedule, {[&](progress_event const&) {
                                   return tick++ == stop ? step_control::stop : step_control::proceed;
                               }});
        REQUIRE(r.steps == stop);
        REQUIRE((r.stopped == voxel_stop::observer) == (stop < 7));
        auto const rest = run.run(schedule.after(r.steps));
        REQUIRE(rest.stopped == voxel_stop::finished);
        REQUIRE(run.checkpoint() == whole.checkpoint());
    }
}

TEST_CASE("snapshots come at multiples and may end the run") {
    voxel_run run(lump(), voxel_weathering{.durability = constant_field{.value = 0.03}});
    std::vector<std::uint64_t> seen;
    auto r = run.run({.phases = {{.steps = 7}}, .snapshot_every = 3, .on_snapshot = [&](std::uint64_t steps) {
                          seen.push_back(steps);
                          return step_control::proceed;
                      }});
    REQUIRE(seen == std::vector<std::uint64_t>{3, 6});
    r = run.run({.phases = {{.steps = 7}}, .snapshot_every = 3, .on_snapshot = [](std::uint64_t) { return step_control::stop; }});
    REQUIRE(r.steps == 9);
    REQUIRE(r.stopped == voxel_stop::observer);
}

TEST_CASE("C2: a policy that throws at any call leaves the state after the last complete step") {
    for (bool const more : {false, true}) {
        voxel_options const options = more ? everything() : voxel_options{};
        voxel_schedule const schedule{.phases = {{.steps = 5}}};
        fragile_durability const whole_durability;
        voxel_run whole(lump(), voxel_weathering{.durability = whole_durability}, options);
        std::vector<std::vector<std::byte>> states{whole.checkpoint()};
        int const first = (1 << 30) - *whole_durability.left;
        for (int k = 0; k < 5; ++k) {
            whole.run({.phases = {{.steps = 1}}});
            states.push_back(whole.checkpoint());
        }
        int const calls = (1 << 30) - *whole_durability.left - first;
        REQUIRE(calls > 200);
        for (int at = 1; at <= calls; at += 1 + calls / 40) {
            fragile_durability const durability;
            voxel_run run(lump(), voxel_weathering{.durability = durability}, options);
            *durability.left = at;
            REQUIRE_THROWS_AS(run.run(schedule), std::runtime_error);
            REQUIRE(run.checkpoint() == states[run.steps()]);
            *durability.left = 1 << 30;
            run.run(schedule.after(run.steps()));
            REQUIRE(run.checkpoint() == states.back());
        }
    }
}

TEST_CASE("C2: an event that is cut short leaves the events before it, and the run goes on") {
    fragile_durability const durability;
    voxel_run run(lump(), voxel_weathering{.durability = durability}, everything());
    *durability.left = 150;
    voxel_schedule const schedule{.phases = {{.steps = 6}}, .clock = voxel_clock::events};
    REQUIRE_THROWS_AS(run.run(schedule), std::runtime_error);
    *durability.left = 1 << 30;
    auto const saved = run.checkpoint();
    fragile_durability const again;
    voxel_run other(lump(), voxel_weathering{.durability = again}, everything());
    other.resume(saved);
    auto const a = run.run(schedule.after(run.steps()));
    other.run(schedule.after(other.steps()));
    REQUIRE(a.steps == 6);
    REQUIRE(other.checkpoint() == run.checkpoint());
    REQUIRE(a.voxels_rock + a.voxels_colluvium + a.voxels_vanished + a.voxels_fallen + a.voxels_left == a.voxels_initial);
}
