#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/weathering/voxel_run.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <span>
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

/// Likewise.
struct fragile_choice {
    std::array<bubble_stencil, 2> bubbles{sphere_bubble{.radius = 3}, sphere_bubble{.radius = 4}};
    std::shared_ptr<std::atomic<int>> left = std::make_shared<std::atomic<int>>(1 << 30);
    std::span<bubble_stencil const> stencils() const { return bubbles; }
    std::size_t choose(vec3 const& p) const {
        if (--*left == 0) throw std::runtime_error("no more");
        return p[0] > 12 ? 1 : 0;
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

TEST_CASE("C1: a run by events that is stopped at any tick goes on to the same state") {
    voxel_schedule const schedule{.phases = {{.steps = 2}, {.steps = 2, .spheroidal = 0.5, .cavernous = 1}}, .clock = voxel_clock::events};
    auto const process = voxel_weathering{.durability = constant_field{.value = 0.03}};
    voxel_run whole(lump(), process, everything());
    REQUIRE(whole.run(schedule).voxels_vanished + whole.report().voxels_colluvium > 20);
    for (std::size_t stop = 0; stop <= 4; ++stop) {
        voxel_run run(lump(), process, everything());
        std::size_t tick = 0;
        auto const r = run.run(schedule, {[&](progress_event const&) { return tick++ == stop ? step_control::stop : step_control::proceed; }});
        REQUIRE(r.steps == stop);
        run.run(schedule.after(r.steps));
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

TEST_CASE("C2: an observer that throws at any tick or snapshot leaves the state after the step just completed") {
    voxel_schedule schedule{.phases = {{.steps = 3}, {.steps = 2, .spheroidal = 0, .cavernous = 2}}, .snapshot_every = 1};
    auto const process = voxel_weathering{.durability = constant_field{.value = 0.015}};
    std::vector<std::vector<std::byte>> states;
    voxel_run whole(lump(), process, everything());
    states.push_back(whole.checkpoint());
    schedule.on_snapshot = [&](std::uint64_t) {
        states.push_back(whole.checkpoint());
        return step_control::proceed;
    };
    whole.run(schedule);
    REQUIRE(states.size() == 6);
    for (std::size_t at = 0; at < 11; ++at) {  // a tick, then a snapshot and a tick for each step
        voxel_run run(lump(), process, everything());
        std::size_t told = 0;
        auto const tell = [&](auto const&) {
            if (told++ == at) throw std::runtime_error("enough");
            return step_control::proceed;
        };
        schedule.on_snapshot = tell;
        REQUIRE_THROWS_AS(run.run(schedule, {tell}), std::runtime_error);
        REQUIRE(run.steps() == (at + 1) / 2);
        REQUIRE(run.checkpoint() == states[run.steps()]);
        schedule.on_snapshot = {};
        run.run(schedule.after(run.steps()));
        REQUIRE(run.checkpoint() == states.back());
    }
}

TEST_CASE("C2: a choice of bubbles that throws at any call leaves the state after the last complete step") {
    fragile_choice const whole_choice;
    voxel_run whole(lump(), voxel_weathering{.bubbles = whole_choice, .durability = constant_field{.value = 0.015}}, everything());
    std::vector<std::vector<std::byte>> states{whole.checkpoint()};
    int const first = (1 << 30) - *whole_choice.left;
    for (int k = 0; k < 4; ++k) {
        whole.run({.phases = {{.steps = 1}}});
        states.push_back(whole.checkpoint());
    }
    int const calls = (1 << 30) - *whole_choice.left - first;
    REQUIRE(calls > 200);
    voxel_schedule const schedule{.phases = {{.steps = 4}}};
    for (int at = 1; at <= calls; at += 1 + calls / 30) {
        fragile_choice const choice;
        voxel_run run(lump(), voxel_weathering{.bubbles = choice, .durability = constant_field{.value = 0.015}}, everything());
        *choice.left = at;
        thread_pool const pool(3);
        REQUIRE_THROWS_AS(run.run(schedule, {}, pool), std::runtime_error);
        *choice.left = 1 << 30;
        REQUIRE(run.checkpoint() == states[run.steps()]);
        run.run(schedule.after(run.steps()), {}, pool);
        REQUIRE(run.checkpoint() == states.back());
    }
}

TEST_CASE("C2: policies that throw while they replace others leave the others, and the run goes on as if nothing had been") {
    fragile_choice const choice;
    auto const left = std::make_shared<std::atomic<int>>(1 << 30);
    auto const rate = [left](double c) {
        if (--*left == 0) throw std::runtime_error("no more");
        return 3 * c * c * c;
    };
    voxel_weathering const process{.bubbles = choice, .rate = rate, .durability = constant_field{.value = 0.015}};
    voxel_run whole(lump(), process, everything());
    whole.run({.phases = {{.steps = 2}}});
    auto const start = whole.checkpoint();
    whole.run({.phases = {{.steps = 3}}});
    auto const end = whole.checkpoint();

    voxel_run run(lump(), process, everything());
    run.run({.phases = {{.steps = 2}}});
    int const asked = [&] {
        *left = 1 << 30;
        *choice.left = 1 << 30;
        run.replace(process);
        return (1 << 30) - *choice.left;
    }();
    int const rated = (1 << 30) - *left;
    REQUIRE(asked > 200);
    REQUIRE(rated > 50);
    voxel_weathering const harder{.bubbles = choice, .rate = rate, .durability = constant_field{.value = 0.5}};
    for (auto const& [countdown, calls] : {std::pair{choice.left, asked}, std::pair{left, rated}}) {
        for (int at = 1; at <= calls; at += 1 + calls / 30) {
            *countdown = at;
            REQUIRE_THROWS_AS(run.replace(harder), std::runtime_error);
            *countdown = at;
            REQUIRE_THROWS_AS(run.replace(voxel_options{.skin_depth = 2}), std::runtime_error);
            *countdown = 1 << 30;
            REQUIRE(run.process().durability.value == 0.015);
            REQUIRE(run.options().skin_depth == 1);
            REQUIRE(run.checkpoint() == start);
        }
    }
    run.run({.phases = {{.steps = 3}}});
    REQUIRE(run.checkpoint() == end);
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
