#include "percolation/box_network.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/weathering/frost_presets.hpp>
#include <tafoni/weathering/frost_run.hpp>

#include <catch2/catch.hpp>

#include <stdexcept>

using namespace tafoni;
using tafoni_test::box_network;

namespace {

frost_wedging<> slanting() {
    frost_wedging<> p;
    p.rain.rain.direction = normalized(vec3{1, -0.5, -0.5});
    return p;
}

/// Throws at a chosen call; every role of a process.
struct fuse {
    long* left;
    void burn() const {
        if (--*left == 0) throw std::runtime_error("fuse");
    }
};
struct fused_rain : fuse {
    vec3 draw(stream& s) const { burn(); return slanting().rain.draw(s); }
    double acceptance(link_view const& l, vec3 const& d) const { burn(); return slanting().rain.acceptance(l, d); }
};
struct fused_flow : fuse {
    double weight(link_view const& a, link_view const& b, water const& w) const { burn(); return gravity_flow{}.weight(a, b, w); }
};
struct fused_absorb : fuse {
    double absorbed(link_view const& l, water const& w, link_scale const& s) const { burn(); return surface_absorption{}.absorbed(l, w, s); }
    double soak_chance(link_view const& l, water const& w) const { burn(); return depletion_soaking{}.soak_chance(l, w); }
};
struct fused_wear : fuse {
    double damage(link_view const& l, double w, link_scale const& s) const { burn(); return surface_damage{}.damage(l, w, s); }
    double break_chance(link_view const& l) const { burn(); return low_life_breakage{}.break_chance(l); }
    falling decide(part const& a, part const& b) const { burn(); return smaller_part_falls{}.decide(a, b); }
};

}  // namespace

TEST_CASE("C1: stopping at any tick leaves a state that goes on to the same bytes") {
    box_network const n(4, 4, 4);
    frost_run whole(n, slanting());
    int ticks = 0;
    run_context const counting{.on_progress = [&](progress_event const& e) {
        CHECK(e.stage == "weather");
        ++ticks;
        return step_control::proceed;
    }};
    whole.run({.paths = 600}, counting);
    REQUIRE(ticks > 100);
    auto const end = whole.checkpoint();
    for (int k = 1; k <= ticks; ++k) {
        frost_run run(n, slanting());
        int seen = 0;
        double last = -1;
        auto const r = run.run({.paths = 600}, {.on_progress = [&](progress_event const& e) {
            REQUIRE(e.fraction >= last);
            last = e.fraction;
            return ++seen == k ? step_control::stop : step_control::proceed;
        }});
        REQUIRE(r.stopped == (k < ticks ? stop_reason::observer : stop_reason::finished));
        run.run({.paths = 600 - run.paths()});
        REQUIRE((run.checkpoint() == end));
    }
}

TEST_CASE("C2: a policy that throws at any call leaves the state after the last complete path") {
    box_network const n(3, 3, 3);
    for (std::uint32_t const batch : {1u, 8u}) {
        long left = -1;
        frost_wedging<fused_rain, fused_flow, fused_absorb, fused_wear> const p{
            .rain = {{&left}}, .flow = {{&left}}, .absorb = {{&left}}, .wear = {{&left}}};
        frost_run whole(n, p);
        whole.run({.paths = 640, .batch = batch});
        long const calls = -1 - left;
        REQUIRE(whole.report().cells_detached > 1);
        auto const end = whole.checkpoint();
        for (long k = 1; k <= calls; k += k < 300 ? 1 : 97) {
            left = -1;
            frost_run run(n, p);
            left = k;
            bool thrown = false;
            try {
                run.run({.paths = 640, .batch = batch});
            } catch (std::runtime_error const&) {
                thrown = true;
            }
            REQUIRE(thrown);
            REQUIRE(run.paths() < 640);
            REQUIRE(run.paths() % batch == 0);
            left = -1;
            if (k % 16 == 0) {  // the state is exactly that of as many paths
                frost_run same(n, p);
                same.run({.paths = run.paths(), .batch = batch});
                REQUIRE((run.checkpoint() == same.checkpoint()));
            }
            run.run({.paths = 640 - run.paths(), .batch = batch});
            REQUIRE((run.checkpoint() == end));
        }
    }
}

TEST_CASE("a run stops at the first break or the first detachment, and snapshots come when asked for") {
    box_network const n(4, 4, 4);
    frost_run run(n, slanting());
    auto const broken = run.run({.paths = 5000, .stop = stop_when::first_break});
    CHECK(broken.stopped == stop_reason::first_break);
    CHECK(broken.links_broken >= 1);
    auto const fallen = run.run({.paths = 5000, .stop = stop_when::first_detachment});
    CHECK(fallen.stopped == stop_reason::first_detachment);
    CHECK(fallen.blocks >= 1);
    CHECK(fallen.paths < 5000);

    frost_run snapped(n, slanting());
    std::vector<std::uint64_t> at;
    auto const r = snapped.run({.paths = 100, .snapshot_every = 30, .on_snapshot = [&](std::uint64_t paths) {
        CHECK(paths == snapped.paths());
        at.push_back(paths);
        return paths == 90 ? step_control::stop : step_control::proceed;
    }});
    CHECK(at == std::vector<std::uint64_t>{30, 60, 90});
    CHECK(r.stopped == stop_reason::observer);
    CHECK(r.paths == 90);
}

TEST_CASE("a copy of a run is a snapshot that goes on by itself") {
    box_network const n(4, 4, 4);
    frost_run run(n, slanting());
    run.run({.paths = 200});
    auto copy = run;
    run.run({.paths = 200});
    CHECK(copy.paths() == 200);
    copy.run({.paths = 200});
    CHECK((copy.checkpoint() == run.checkpoint()));
}

TEST_CASE("progress starts at 0 and ends at 1, also for no paths") {
    box_network const n(2, 2, 2);
    frost_run run(n, slanting());
    for (std::uint64_t const paths : {0u, 1u, 10u, 1000u}) {
        std::vector<double> seen;
        run.run({.paths = paths}, {.on_progress = [&](progress_event const& e) {
            seen.push_back(e.fraction);
            return step_control::proceed;
        }});
        REQUIRE(seen.size() >= 2);
        CHECK(seen.front() == 0);
        CHECK(seen.back() == 1);
    }
}

TEST_CASE("an observer that throws loses nothing") {
    box_network const n(4, 4, 4);
    frost_run whole(n, slanting());
    whole.run({.paths = 300});
    frost_run run(n, slanting());
    for (int k = 0; k < 5; ++k) {
        CHECK_THROWS_AS(run.run({.paths = 300 - run.paths()},
                                {.on_progress = [&](progress_event const& e) -> step_control {
                                    if (e.fraction > 0.1) throw std::runtime_error("observer");
                                    return step_control::proceed;
                                }}),
                        std::runtime_error);
    }
    run.run({.paths = 300 - run.paths()});
    CHECK((run.checkpoint() == whole.checkpoint()));
}

TEST_CASE("a batch has the same bits on any number of threads", "[threads]") {
    box_network const n(6, 6, 6);
    auto const preset = addon_preset();
    frost_run serial(n, preset.process, preset.options);
    serial.run({.paths = 4000, .batch = 500});
    auto const expected = serial.checkpoint();
    for (std::size_t const threads : {1u, 2u, 3u, 4u, 7u}) {
        thread_pool const pool(threads);
        frost_run run(n, preset.process, preset.options);
        run.run({.paths = 4000, .batch = 500}, {}, pool);
        CHECK((run.checkpoint() == expected));
    }
}

TEST_CASE("an exception from a worker thread reaches the caller and loses nothing", "[threads]") {
    box_network const n(4, 4, 4);
    struct picky {
        double weight(link_view const& a, link_view const& b, water const& w) const {
            if (w.step == 6) throw std::runtime_error("deep");
            return gravity_flow{}.weight(a, b, w);
        }
    };
    frost_run run(n, frost_wedging{.rain = slanting().rain, .flow = picky{}});
    thread_pool const pool(4);
    bool thrown = false;
    for (int k = 0; k < 200 && !thrown; ++k) {
        auto const before = run.checkpoint();
        try {
            run.run({.paths = 64, .batch = 64}, {}, pool);
        } catch (std::runtime_error const&) {
            thrown = true;
            CHECK((run.checkpoint() == before));
        }
    }
    CHECK(thrown);
}

TEST_CASE("the report tells the time of each stage") {
    box_network const n(5, 5, 5);
    auto const preset = paper_preset();
    frost_run run(n, preset.process, preset.options);
    auto const r = run.run({.paths = 2000, .batch = 100});
    CHECK(r.cells_detached > 0);
    CHECK(r.seconds.walk > 0);
    CHECK(r.seconds.detach > 0);
    CHECK(r.seconds.walk + r.seconds.detach <= r.seconds.run);
    run.reset();
    CHECK(run.report().seconds.walk == 0);
    CHECK(run.run({.paths = 100}).seconds.walk > 0);  // one by one: an estimate
}

TEST_CASE("where no skin is left, paths are booked at once, with the snapshots and counts of a walk") {
    box_network const n(2, 2, 2);
    std::vector<cell_index> all;
    for (std::size_t c = 0; c < n.cell_count(); ++c) all.push_back(cell_index{c});
    frost_run run(n, slanting());
    run.mark(all, cell_state::air);
    std::vector<std::uint64_t> seen;
    std::size_t ticks = 0;
    run_context context;
    context.on_progress = [&](auto const&) { return ++ticks, step_control::proceed; };
    auto const some = run.run({.paths = 1000, .batch = 64, .snapshot_every = 300, .on_snapshot = [&](std::uint64_t paths) {
                                   seen.push_back(paths);
                                   return step_control::proceed;
                               }}, context);
    CHECK(seen == std::vector<std::uint64_t>{320, 640, 960});
    CHECK(some.paths == 1000);
    CHECK(some.paths_without_entry == 1000);
    CHECK(some.stopped == stop_reason::finished);
    CHECK(ticks > 10);
    auto const many = run.run({.paths = 100'000'000'000});
    CHECK(many.paths_without_entry == 100'000'001'000);
    CHECK(many.seconds.run < 5);
    auto const none = run.run({.paths = 50, .stop = stop_when::nothing_enters});
    CHECK(none.paths == many.paths);
    CHECK(none.stopped == stop_reason::nothing_enters);
}

TEST_CASE("a run that stops when nothing enters stops as soon as the last skin is gone") {
    box_network const n(2, 2, 2);
    struct all_fall {
        [[nodiscard]] falling decide(part const&, part const&) const { return falling::both; }
    };
    frost_run run(n, frost_wedging{.wear = wear{.detachment = all_fall{}}});
    auto const report = run.run({.paths = 1'000'000, .stop = stop_when::nothing_enters});
    CHECK(report.stopped == stop_reason::nothing_enters);
    CHECK(report.cells_detached == 8);
    CHECK(report.blocks >= 1);
    CHECK(run.blocks().back().path == report.paths);
}
