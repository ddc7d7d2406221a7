#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/voxel/bubble_mixture.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/weathering/voxel_run.hpp>

#include <catch2/catch.hpp>
#include <support/code_of.hpp>

#include <array>
#include <cmath>
#include <string>
#include <vector>

using namespace tafoni;
using tafoni_test::code_of;

namespace {

sparse_grid ruin() {
    grid_border const ground{{border_kind::air, border_kind::air, border_kind::air, border_kind::air, border_kind::rock,
                              border_kind::air}};
    sparse_grid g({.size = {40, 12, 35}}, up_axis::plus_z, ground);
    stream random(4, stage::user, 0);
    for (std::int32_t z = 0; z < 30; ++z) {
        for (std::int32_t y = 2; y < 10; ++y) {
            for (std::int32_t x = 3; x < 37; ++x) {
                if (random.uniform01() < 0.9) g.set({x, y, z}, voxel_state::rock);
            }
        }
    }
    return g;
}

auto process() {
    return voxel_weathering{.bubbles = bubble_mixture{.bubbles = {sphere_bubble{.radius = 3}, sphere_bubble{.radius = 5}},
                                                      .field = gradient_noise{.seed = 2, .frequency = 0.1}},
                            .durability = constant_field{.value = 0.02}};
}
constexpr int every = 3;

voxel_options options() { return {.colluvium = repose_rule{}, .rockfall = rockfall_options{}, .seed = 6}; }

}  // namespace

TEST_CASE("a run that goes on from a checkpoint ends with the bytes of the run that was never stopped") {
    for (voxel_clock const clock : {voxel_clock::steps, voxel_clock::events}) {
        voxel_schedule const half{.phases = {{.steps = every, .spheroidal = 1, .cavernous = 0.5}}, .clock = clock};
        voxel_run whole(ruin(), process(), options());
        whole.run(half);
        auto const saved = whole.checkpoint();
        whole.run(half);

        voxel_run again(ruin(), process(), options());
        again.resume(saved);
        REQUIRE(again.checkpoint() == saved);
        REQUIRE(again.report().steps == every);
        again.run(half);
        REQUIRE(again.checkpoint() == whole.checkpoint());
        REQUIRE(whole.report().voxels_colluvium > 0);
        REQUIRE(std::equal(again.blocks().begin(), again.blocks().end(), whole.blocks().begin(), whole.blocks().end()));
    }
}

TEST_CASE("a run that was left in the middle of a schedule goes on by what is left of it, on other threads, to the same bytes") {
    voxel_schedule const schedule{.phases = {{.steps = 2}, {.steps = 3, .spheroidal = 0, .cavernous = 2}, {.steps = 0}, {.steps = 2, .spheroidal = 0.5, .cavernous = 0.5}}};
    voxel_run whole(ruin(), process(), options());
    whole.run(schedule);
    auto const end = whole.checkpoint();
    for (std::size_t stop = 0; stop <= 7; ++stop) {
        std::size_t tick = 0;
        voxel_run first(ruin(), process(), options());
        first.run(schedule, {[&](progress_event const&) { return tick++ == stop ? step_control::stop : step_control::proceed; }});
        auto const saved = first.checkpoint();
        thread_pool const pool(1 + stop % 4);
        voxel_run again(ruin(), process(), options(), pool);
        again.resume(saved);
        voxel_schedule const rest = schedule.after(again.steps());
        REQUIRE(rest.steps() == 7 - stop);
        auto const r = again.run(rest, {}, pool);
        REQUIRE(again.checkpoint() == end);
        voxel_report const w = whole.report();
        REQUIRE(std::array{r.steps, r.voxels_initial, r.voxels_rock, r.voxels_colluvium, r.voxels_vanished, r.voxels_fallen, r.voxels_left, r.surface_voxels, r.blocks} ==
                std::array{w.steps, w.voxels_initial, w.voxels_rock, w.voxels_colluvium, w.voxels_vanished, w.voxels_fallen, w.voxels_left, w.surface_voxels, w.blocks});
    }
    REQUIRE(schedule.after(100).steps() == 0);
}

TEST_CASE("with joints and friction, a run that goes on from a checkpoint lets fall what it would have let fall") {
    voxel_options all = options();
    all.rockfall->friction_angle = 35;
    for (int k = 0; k < 6; ++k) {
        double const tilt = 0.1 * k;
        double const across = std::sqrt(1 - tilt * tilt);
        all.rockfall->joints.discs.push_back({.centre = {6.0 * k, 6, 4.0 * k + 2}, .normal = {tilt, 0, across}, .radius = 9});
        all.rockfall->joints.discs.push_back({.centre = {6.0 * k + 3, 6, 15}, .normal = {across, 0, tilt}, .radius = 20});
    }
    voxel_run whole(ruin(), process(), all);
    std::vector<std::vector<std::byte>> states;
    for (int k = 0; k < 8; ++k) {
        states.push_back(whole.checkpoint());
        whole.run({.phases = {{.steps = 1, .spheroidal = 1, .cavernous = 0.5}}});
    }
    REQUIRE(whole.report().blocks > 1);
    for (std::size_t k = 0; k < states.size(); ++k) {
        voxel_run again(ruin(), process(), all);
        for (std::uint64_t const detour : {0u, 3u, 1u}) {  // also from where it has gone on, and come back
            again.run({.phases = {{.steps = detour, .spheroidal = 3}}});
            again.resume(states[k]);
            REQUIRE(again.checkpoint() == states[k]);
            again.run({.phases = {{.steps = states.size() - k, .spheroidal = 1, .cavernous = 0.5}}});
            REQUIRE(again.checkpoint() == whole.checkpoint());
        }
    }
    voxel_run looser(ruin(), process(), [&] {
        auto o = all;
        o.rockfall->joints.discs.pop_back();
        return o;
    }());
    REQUIRE(code_of<io_error>([&] { looser.resume(states[3]); }) == errc::checkpoint_mismatch);
}

TEST_CASE("a checkpoint of another grid, other parameters or damaged bytes is refused, and nothing changes") {
    voxel_run run(ruin(), process(), options());
    run.run({.phases = {{.steps = every}}});
    auto const saved = run.checkpoint();
    auto const refused = [&](auto& other) {
        auto const before = other.checkpoint();
        errc const e = code_of<io_error>([&] { other.resume(saved); });
        REQUIRE(other.checkpoint() == before);
        return e;
    };
    sparse_grid changed = ruin();
    changed.set({20, 5, 31}, voxel_state::rock);
    voxel_run other_grid(changed, process(), options());
    REQUIRE(refused(other_grid) == errc::checkpoint_mismatch);
    voxel_run other_options(ruin(), process(), {.colluvium = repose_rule{.angle = 30, .baseline = 2}});
    REQUIRE(refused(other_options) == errc::checkpoint_mismatch);
    auto harder = process();
    harder.durability.value = 0.03;
    voxel_run other_durability(ruin(), harder, options());
    REQUIRE(refused(other_durability) == errc::checkpoint_mismatch);
    auto faster = process();
    faster.rate.scale = 2;
    voxel_run other_rate(ruin(), faster, options());
    REQUIRE(refused(other_rate) == errc::checkpoint_mismatch);

    auto const with = [&](auto const& change) {
        voxel_options o = options();
        change(o);
        voxel_run other(ruin(), process(), o);
        return refused(other);
    };
    REQUIRE(with([](voxel_options& o) { o.seed = 7; }) == errc::checkpoint_mismatch);
    REQUIRE(with([](voxel_options& o) { o.skin_depth = 2; }) == errc::checkpoint_mismatch);
    REQUIRE(with([](voxel_options& o) { o.measure = curvature_measure::signed_excess; }) == errc::checkpoint_mismatch);
    REQUIRE(with([](voxel_options& o) { o.measure = curvature_measure::flat_excess; }) == errc::checkpoint_mismatch);
    REQUIRE(with([](voxel_options& o) { o.colluvium.reset(); }) == errc::checkpoint_mismatch);
    REQUIRE(with([](voxel_options& o) { o.colluvium->baseline = 3; }) == errc::checkpoint_mismatch);
    REQUIRE(with([](voxel_options& o) { o.rockfall.reset(); }) == errc::checkpoint_mismatch);
    REQUIRE(with([](voxel_options& o) { o.rockfall->friction_angle = 30; }) == errc::checkpoint_mismatch);
    REQUIRE(with([](voxel_options& o) { o.rockfall->sides[4] = ground_side::loose; }) == errc::checkpoint_mismatch);
    REQUIRE(with([](voxel_options& o) { o.rockfall->ground_voxels = {{4, 4, 0}}; }) == errc::checkpoint_mismatch);
    auto larger = process();
    larger.bubbles.bubbles[1] = sphere_bubble{.radius = 6};
    voxel_run other_bubbles(ruin(), larger, options());
    REQUIRE(refused(other_bubbles) == errc::checkpoint_mismatch);
    auto spread = process();
    spread.bubbles.field.seed = 3;
    voxel_run other_choice(ruin(), spread, options());
    REQUIRE(refused(other_choice) == errc::checkpoint_mismatch);
    for (int kind = 0; kind < 4; ++kind) {  // the same voxels in another place, scale, border or turn
        sparse_grid const g = ruin();
        grid_frame frame = g.user_frame();
        grid_border border = g.border();
        if (kind == 0) frame.origin[1] = 3;
        if (kind == 1) frame.spacing[2] = 0.5;
        if (kind == 2) border.sides[2] = border_kind::extend;
        sparse_grid same(frame, kind == 3 ? up_axis::plus_x : up_axis::plus_z, border);
        for (std::int32_t z = 0; z < 35; ++z) {
            for (std::int32_t y = 0; y < 12; ++y) {
                for (std::int32_t x = 0; x < 40; ++x) {
                    voxel const v{x, y, z};
                    if (same.contains(v) && g.is_rock(v)) same.set(v, voxel_state::rock);
                }
            }
        }
        voxel_run other_frame(std::move(same), process(), options());
        REQUIRE(refused(other_frame) == errc::checkpoint_mismatch);
    }

    voxel_run fresh(ruin(), process(), options());
    auto const before = fresh.checkpoint();
    std::vector<std::byte> const nothing;
    REQUIRE(code_of<io_error>([&] { fresh.resume(nothing); }) == errc::wrong_format);
    for (std::size_t n = 8; n < saved.size(); n += saved.size() / 40 + 1) {
        std::vector<std::byte> const part(saved.begin(), saved.begin() + static_cast<std::ptrdiff_t>(n));
        REQUIRE(code_of<io_error>([&] { fresh.resume(part); }) != errc{});
    }
    for (std::size_t n = 0; n < saved.size(); n += saved.size() / 40 + 1) {
        std::vector<std::byte> wrong = saved;
        wrong[n] ^= std::byte{16};
        REQUIRE(code_of<io_error>([&] { fresh.resume(wrong); }) != errc{});
    }
    REQUIRE(fresh.checkpoint() == before);
    fresh.resume(saved);
    REQUIRE(fresh.checkpoint() == saved);
}
