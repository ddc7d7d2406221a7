#include <tafoni/core/random.hpp>
#include <tafoni/voxel/bubble_mixture.hpp>
#include <tafoni/voxel/bubble_profile.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/voxel/dense_grid.hpp>
#include <tafoni/weathering/voxel_run.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

using namespace tafoni;

namespace {

single_bubble ball(double radius) { return {sphere_bubble{.radius = radius}}; }

sparse_grid speckled(std::array<std::size_t, 3> size, double rock, std::uint64_t seed, grid_border border = {}) {
    sparse_grid g({.size = size}, up_axis::plus_z, border);
    stream random(seed, stage::user, 0);
    for (std::int32_t z = 0; z < static_cast<std::int32_t>(size[2]); ++z) {
        for (std::int32_t y = 0; y < static_cast<std::int32_t>(size[1]); ++y) {
            for (std::int32_t x = 0; x < static_cast<std::int32_t>(size[0]); ++x) {
                if (random.uniform01() < rock) g.set({x, y, z}, voxel_state::rock);
            }
        }
    }
    return g;
}

template <class F>
void for_each_voxel(sparse_grid const& g, F const& f) {
    for (std::int32_t z = 0; z < static_cast<std::int32_t>(g.size()[2]); ++z) {
        for (std::int32_t y = 0; y < static_cast<std::int32_t>(g.size()[1]); ++y) {
            for (std::int32_t x = 0; x < static_cast<std::int32_t>(g.size()[0]); ++x) f(voxel{x, y, z});
        }
    }
}
std::vector<voxel> rock_of(sparse_grid const& g) {
    std::vector<voxel> out;
    for_each_voxel(g, [&](voxel v) {
        if (g.is_rock(v)) out.push_back(v);
    });
    return out;
}

}  // namespace

TEST_CASE("law 18: without colluvium the air only grows") {
    voxel_run run(speckled({20, 20, 34}, 0.8, 3), voxel_weathering{.bubbles = ball(3), .durability = constant_field{.value = 0.02}},
                  {.rockfall = rockfall_options{}});
    sparse_grid before = run.grid();
    for (int k = 0; k < 12; ++k) {
        run.run({.phases = {{.steps = 1, .spheroidal = 1, .cavernous = 0.5}}});
        bool grows = true;
        for_each_voxel(before, [&](voxel v) { grows = grows && (before.is_solid(v) || !run.grid().is_solid(v)); });
        REQUIRE(grows);
        before = run.grid();
    }
    REQUIRE(run.report().voxels_fallen > 0);
}

TEST_CASE("law 21: harder rock and shorter runs lose less, voxel by voxel") {
    auto const left = [](double durability, std::uint64_t steps) {
        voxel_run run(speckled({24, 24, 24}, 0.95, 4), voxel_weathering{.bubbles = ball(4), .durability = constant_field{.value = durability}});
        run.run({.phases = {{.steps = steps}}});
        return rock_of(run.grid());
    };
    std::vector<voxel> last;
    for (double const durability : {0.01, 0.015, 0.02, 0.04, 0.08}) {
        auto const now = left(durability, 12);
        REQUIRE(std::includes(now.begin(), now.end(), last.begin(), last.end()));
        REQUIRE(now.size() > last.size());
        last = now;
    }
    last = left(0.02, 2);
    for (std::uint64_t const steps : {4u, 8u, 16u}) {
        auto const now = left(0.02, steps);
        REQUIRE(std::includes(last.begin(), last.end(), now.begin(), now.end()));
        last = now;
    }
}

TEST_CASE("law 22: weathering commutes with the 48 symmetries of the grid") {
    constexpr std::int32_t n = 33;
    sparse_grid const rock = speckled({n, n, n}, 0.97, 5);
    auto const process = voxel_weathering{.bubbles = ball(3), .durability = constant_field{.value = 0.02}};
    auto const schedule = voxel_schedule{.phases = {{.steps = 6}, {.steps = 4, .spheroidal = 0.3, .cavernous = 1}}};
    voxel_run plain(rock, process);
    plain.run(schedule);
    std::array<int, 3> axis{0, 1, 2};
    int checked = 0;
    do {
        for (int mirror = 0; mirror < 8; ++mirror) {
            auto const turned = [&](voxel v) {
                std::array<std::int32_t, 3> const in{v.x, v.y, v.z};
                std::array<std::int32_t, 3> out{};
                for (std::size_t k = 0; k < 3; ++k) {
                    std::int32_t const u = in[static_cast<std::size_t>(axis[k])];
                    out[k] = (mirror >> k & 1) != 0 ? n - 1 - u : u;
                }
                return voxel{out[0], out[1], out[2]};
            };
            sparse_grid image({.size = {n, n, n}});
            for (voxel const v : rock_of(rock)) image.set(turned(v), voxel_state::rock);
            voxel_run run(std::move(image), process);
            run.run(schedule);
            bool same = run.report().voxels_rock == plain.report().voxels_rock;
            for (skin_voxel const& v : plain.skin()) {
                auto const other = run.at(turned(v.at));
                same = same && other && other->decimation == v.decimation;
            }
            REQUIRE(same);
            ++checked;
        }
    } while (std::next_permutation(axis.begin(), axis.end()));
    REQUIRE(checked == 48);
}

TEST_CASE("the user's axis that points up changes names, nothing else") {
    sparse_grid const rock = speckled({20, 24, 28}, 0.9, 6);
    auto const process = voxel_weathering{.bubbles = single_bubble{gumdrop_bubble{.radius = 4}}, .durability = constant_field{.value = 0.02}};
    voxel_run plain(rock, process, {.colluvium = repose_rule{}});
    plain.run({.phases = {{.steps = 10}}});
    for (up_axis const up : {up_axis::plus_x, up_axis::plus_y, up_axis::minus_x, up_axis::minus_y, up_axis::minus_z}) {
        up_rotation const turn = up_rotation::of(up);
        std::array<std::size_t, 3> user{};
        for (std::size_t k = 0; k < 3; ++k) user[turn.axis[k]] = rock.size()[k];
        dense_grid mine({.size = user});
        for_each_voxel(rock, [&](voxel v) {
            voxel const u = turn.to_user(v, rock.size());
            grid_access<dense_grid>::set(mine, static_cast<std::size_t>(u.x), static_cast<std::size_t>(u.y), static_cast<std::size_t>(u.z), rock.state(v));
        });
        voxel_run run(mine, process, {.up = up, .colluvium = repose_rule{}});
        run.run({.phases = {{.steps = 10}}});
        run.write_states(mine);
        bool same = true;
        for_each_voxel(rock, [&](voxel v) {
            voxel const u = turn.to_user(v, rock.size());
            same = same && plain.grid().state(v) == grid_access<dense_grid>::state(mine, static_cast<std::size_t>(u.x), static_cast<std::size_t>(u.y), static_cast<std::size_t>(u.z));
        });
        REQUIRE(same);
    }
}

TEST_CASE("events agree with steps the better, the smaller the steps") {
    sparse_grid const rock = speckled({32, 32, 34}, 0.98, 7);
    auto const process = voxel_weathering{.bubbles = ball(3), .durability = constant_field{.value = 0.03}};
    voxel_run events(rock, process);
    voxel_report const r = events.run({.phases = {{.steps = 12}}, .clock = voxel_clock::events});
    REQUIRE(r.steps == 12);
    std::size_t const fell = r.voxels_vanished;
    REQUIRE(fell > 1000);
    std::size_t last = fell;
    for (std::uint64_t const parts : {1u, 8u, 64u}) {
        voxel_run steps(rock, process);
        steps.run({.phases = {{.steps = 12 * parts, .spheroidal = 1.0 / static_cast<double>(parts)}}});
        std::size_t different = 0;
        for_each_voxel(rock, [&](voxel v) { different += events.grid().is_rock(v) != steps.grid().is_rock(v) ? 1u : 0u; });
        REQUIRE(different < last);
        last = different;
    }
    REQUIRE(last < fell / 100);  // the tolerance: one per cent of what fell, at 64 parts of a step
}

TEST_CASE("events on any number of voxels keep the ledger and stop at whole steps") {
    voxel_run run(speckled({20, 20, 20}, 0.9, 8), voxel_weathering{.bubbles = ball(3), .durability = constant_field{.value = 0.01}},
                  {.colluvium = repose_rule{}, .rockfall = rockfall_options{}});
    voxel_run other = run;
    voxel_report const r = run.run({.phases = {{.steps = 3}}, .clock = voxel_clock::events});
    REQUIRE(r.voxels_rock + r.voxels_colluvium + r.voxels_vanished + r.voxels_fallen + r.voxels_left == r.voxels_initial);
    REQUIRE(r.voxels_rock == run.grid().count(voxel_plane::rock));
    for (int k = 0; k < 3; ++k) other.run({.phases = {{.steps = 1}}, .clock = voxel_clock::events});
    REQUIRE(other.checkpoint() == run.checkpoint());
}

TEST_CASE("what is covered keeps its decimation, and goes on from there") {
    sparse_grid g({.size = {5, 5, 12}}, up_axis::plus_z, {{border_kind::rock, border_kind::rock, border_kind::rock, border_kind::rock, border_kind::rock, border_kind::air}});
    for (std::int32_t y = 0; y < 5; ++y) {
        for (std::int32_t x = 0; x < 5; ++x) g.set({x, y, 0}, voxel_state::rock);
    }
    for (std::int32_t z = 6; z < 8; ++z) g.set({2, 2, z}, voxel_state::rock);  // a stone in the air, soft
    auto const soft_above = [](vec3 const& p) { return p[2] > 4 ? 0.01 : 0.2; };
    voxel_run run(g, voxel_weathering{.bubbles = ball(3), .durability = soft_above}, {.colluvium = repose_rule{.angle = 80}});
    double before = 100;
    int covered = 0;
    bool was_covered = false;
    for (int k = 0; k < 200 && run.report().voxels_rock > 0; ++k) {
        double const now = run.look({2, 2, 0}).decimation;
        if (!run.grid().is_rock({2, 2, 0})) break;
        REQUIRE(now <= before);
        if (!run.at({2, 2, 0})) {
            if (was_covered) REQUIRE(now == before);
            ++covered;
        }
        was_covered = !run.at({2, 2, 0});
        before = now;
        run.run({.phases = {{.steps = 1}}});
    }
    REQUIRE(covered > 1);
    REQUIRE(before < 100);
}

TEST_CASE("policies and options are replaced between steps, and decimation stays") {
    sparse_grid const rock = speckled({24, 24, 24}, 0.95, 9);
    auto const soft = voxel_weathering{.bubbles = ball(3), .durability = constant_field{.value = 0.05}};
    voxel_run run(rock, soft);
    run.run({.phases = {{.steps = 3}}});
    auto const before = run.skin();
    run.replace(constant_field{.value = 0.5});
    run.replace(cubic_rate{.scale = 1});
    run.replace(ball(5));
    auto const after = run.skin();
    REQUIRE(before.size() == after.size());
    for (std::size_t i = 0; i < after.size(); ++i) {
        REQUIRE(after[i].decimation == before[i].decimation);
        REQUIRE(after[i].durability == 0.5);
    }
    REQUIRE(run.process().bubbles.stencils()[0].reach() == 4);
    run.run({.phases = {{.steps = 1}}});
    auto const v = after[after.size() / 2];
    if (auto const now = run.at(v.at)) {
        double const c = v.air_share;
        REQUIRE(now->decimation == v.decimation - c * c * c / 0.5);
    }
    run.replace(voxel_options{.measure = curvature_measure::signed_excess, .skin_depth = 2});
    REQUIRE(run.report().surface_voxels > before.size());
    REQUIRE_THROWS_AS(run.replace(voxel_options{.skin_depth = 3}), invalid_input);
    REQUIRE(run.options().skin_depth == 2);
}

TEST_CASE("bubbles may be of several kinds, beyond 16 voxels too, and every count is right") {
    sparse_grid const rock = speckled({50, 40, 40}, 0.9, 10);
    bubble_mixture<> const mixed{.bubbles = {sphere_bubble{.radius = 2}, disc_bubble{.radius = 6, .thickness = 3}, sphere_bubble{.radius = 19}, gumdrop_bubble{.radius = 5}},
                                 .field = gradient_noise{.seed = 3, .frequency = 0.2}};
    voxel_run run(rock, voxel_weathering{.bubbles = mixed, .durability = constant_field{.value = 0.01}});
    run.run({.phases = {{.steps = 4}}});
    std::set<std::size_t> kinds;
    for (skin_voxel const& v : run.skin()) {
        kinds.insert(v.bubble);
        if ((v.at.x + v.at.y + v.at.z) % 29 != 0) continue;
        bubble_stencil const& b = mixed.stencils()[v.bubble];
        std::uint32_t air = 0;
        for (auto const& row : b.rows()) {
            for (int dz = -b.reach(); dz <= b.reach(); ++dz) {
                if (b.contains(row.dx, row.dy, dz) && !run.grid().is_solid(v.at + voxel{row.dx, row.dy, dz})) ++air;
            }
        }
        REQUIRE(v.air_share == air / static_cast<double>(b.size()));
    }
    REQUIRE(kinds.size() == 4);
}

TEST_CASE("V1 to V4, V10, V11: grids without rock, of nothing else, of one voxel, thin and chequered") {
    auto const process = voxel_weathering{.bubbles = ball(3), .durability = constant_field{.value = 0.02}};
    voxel_options const all{.colluvium = repose_rule{}, .rockfall = rockfall_options{}};
    REQUIRE_THROWS_AS(dense_grid({.size = {0, 3, 3}}), invalid_input);
    REQUIRE_THROWS_AS(sparse_grid({.size = {4294967295u, 4294967295u, 4294967295u}}), invalid_input);
    for (auto const& size : {std::array<std::size_t, 3>{1, 1, 1}, {33, 1, 1}, {1, 40, 1}, {1, 1, 65}, {31, 32, 33}}) {
        for (double const share : {0.0, 1.0}) {
            voxel_run run(speckled(size, share, 1), process, all);
            run.run({.phases = {{.steps = 30}}});
            auto const r = run.report();
            REQUIRE(r.voxels_initial == (share > 0 ? size[0] * size[1] * size[2] : 0));
            REQUIRE(r.voxels_rock + r.voxels_colluvium + r.voxels_vanished + r.voxels_fallen + r.voxels_left == r.voxels_initial);
        }
    }
    grid_border rocky;
    rocky.sides.fill(border_kind::rock);
    voxel_run buried(speckled({40, 40, 40}, 1, 1, rocky), process, all);
    buried.run({.phases = {{.steps = 5}}});
    REQUIRE(buried.report().voxels_rock == 64000);
    REQUIRE(buried.report().surface_voxels == 0);

    for (int kind = 0; kind < 2; ++kind) {
        sparse_grid g({.size = {34, 34, 10}});
        for_each_voxel(g, [&](voxel v) {
            bool const rock = kind == 0 ? (v.x + v.y + v.z) % 2 == 0 : v.z == 5 || v.x == 7;
            if (rock) g.set(v, voxel_state::rock);
        });
        voxel_run run(std::move(g), process, {.colluvium = repose_rule{}});
        if (kind == 0) REQUIRE(run.report().surface_voxels == run.report().voxels_rock);
        run.run({.phases = {{.steps = 40}}});
        auto const r = run.report();
        REQUIRE(r.voxels_rock == run.grid().count(voxel_plane::rock));
        REQUIRE(r.voxels_rock + r.voxels_colluvium + r.voxels_vanished + r.voxels_left == r.voxels_initial);
        REQUIRE(r.voxels_rock < r.voxels_initial / 2);
    }
}

TEST_CASE("Q1: every parameter refuses what is out of its range, and nothing has happened then") {
    double const nan = std::numeric_limits<double>::quiet_NaN();
    double const inf = std::numeric_limits<double>::infinity();
    sparse_grid const rock = speckled({8, 8, 8}, 1, 1);
    auto const code = [](auto const& act) {
        try {
            act();
        } catch (invalid_input const& e) {
            return e.code();
        }
        return errc{};
    };
    for (double const bad : {nan, inf, -inf, -1.0}) {
        CAPTURE(bad);
        CHECK(code([&] { cubic_rate{.scale = bad}.validate(); }) == errc::bad_parameter);
        CHECK(code([&] { linear_rate{.scale = bad}.validate(); }) == errc::bad_parameter);
        CHECK(code([&] { quartic_rate{.scale = bad}.validate(); }) == errc::bad_parameter);
        CHECK(code([&] { clamped_rate<>{.lowest = bad}.validate(); }) == errc::bad_parameter);
        CHECK(code([&] { clamped_rate<>{.highest = bad}.validate(); }) == errc::bad_parameter);
        CHECK(code([&] { clamped_rate<>{.base = {.scale = bad}}.validate(); }) == errc::bad_parameter);
        CHECK(code([&] { voxel_run(rock, voxel_weathering{.rate = cubic_rate{.scale = bad}}); }) == errc::bad_parameter);
        CHECK(code([&] { voxel_run(rock, voxel_weathering{.bubbles = single_bubble{sphere_bubble{.radius = bad}}}); }) == errc::bad_parameter);
        CHECK(code([&] { voxel_run(rock, voxel_weathering{.rate = [bad](double c) { return c > 0.5 ? bad : 0; }}); }) == errc::bad_parameter);
        CHECK(code([&] { voxel_run(rock, voxel_weathering<>{}, {.colluvium = repose_rule{.angle = bad}}); }) == errc::bad_parameter);
        CHECK(code([&] { voxel_run(rock, voxel_weathering<>{}, {.rockfall = rockfall_options{.friction_angle = bad}}); }) == errc::bad_parameter);
        voxel_run run(rock, voxel_weathering<>{});
        auto const before = run.checkpoint();
        CHECK(code([&] { run.run({.phases = {{}, {.spheroidal = bad}}}); }) == errc::bad_parameter);
        CHECK(code([&] { run.run({.phases = {{.cavernous = bad}}}); }) == errc::bad_parameter);
        if (bad == -1) continue;  // clamped to the least durability
        CHECK(code([&] { run.replace(constant_field{.value = bad}); }) == errc::bad_parameter);
        CHECK(code([&] { voxel_run(rock, voxel_weathering{.durability = [bad](vec3 const&) { return bad; }}); }) == errc::bad_parameter);
        CHECK(run.checkpoint() == before);
    }
    CHECK(code([&] { clamped_rate<>{.lowest = 2, .highest = 1}.validate(); }) == errc::bad_parameter);
    CHECK(code([&] { voxel_run(rock, voxel_weathering<>{}, {.skin_depth = 0}); }) == errc::bad_parameter);
    CHECK(code([&] { voxel_run(rock, voxel_weathering<>{}, {.colluvium = repose_rule{.baseline = 0}}); }) == errc::bad_parameter);
    CHECK(code([&] { voxel_run(rock, voxel_weathering{.bubbles = bubble_mixture<>{}}); }) == errc::empty_input);
    voxel_run run(rock, voxel_weathering<>{});
    CHECK(code([&] { run.run({.phases = {{.steps = std::numeric_limits<std::uint64_t>::max()}}}); }) == errc::bad_parameter);
    dense_grid small({.size = {3, 3, 3}});
    CHECK(code([&] { run.write_states(small); }) == errc::bad_parameter);
    // Nothing and less than nothing count as the least durability.
    voxel_run soft(rock, voxel_weathering{.durability = constant_field{.value = -5}});
    CHECK(soft.at({0, 0, 0})->durability == 1e-3);
}
