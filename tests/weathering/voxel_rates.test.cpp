#include <tafoni/core/random.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/weathering/voxel_run.hpp>

#include <catch2/catch.hpp>

#include <array>
#include <cstdint>
#include <vector>

using namespace tafoni;

namespace {

constexpr std::int32_t n = 12;

/// Half of space is rock: what lies on one side of the middle of an axis.
sparse_grid half_space(std::size_t axis, bool rock_above) {
    grid_border border;
    border.sides.fill(border_kind::extend);
    sparse_grid g({.size = {n, n, n}}, up_axis::plus_z, border);
    for (std::int32_t z = 0; z < n; ++z) {
        for (std::int32_t y = 0; y < n; ++y) {
            for (std::int32_t x = 0; x < n; ++x) {
                std::int32_t const at = std::array{x, y, z}[axis];
                if (rock_above ? at >= n / 2 : at < n / 2) g.set({x, y, z}, voxel_state::rock);
            }
        }
    }
    return g;
}

std::vector<bubble_stencil> bubbles() {
    return {sphere_bubble{.radius = 2},
            sphere_bubble{.radius = 3},
            sphere_bubble{.radius = 7},
            disc_bubble{.radius = 4, .thickness = 1},
            disc_bubble{.radius = 6, .thickness = 3},
            gumdrop_bubble{.radius = 5},
            ellipsoid_bubble{.semi_axes = {3, 5, 8}},
            predicate_bubble{.inside = [](vec3 const& o) { return o[2] > -2 && o[0] + o[1] > -3; }, .within = 4}};
}

/// The voxels of a bubble beyond a plane square to an axis.
std::uint32_t beyond(bubble_stencil const& b, std::size_t axis, int sign, int from) {
    std::uint32_t count = 0;
    for (int z = -b.reach(); z <= b.reach(); ++z) {
        for (int y = -b.reach(); y <= b.reach(); ++y) {
            for (int x = -b.reach(); x <= b.reach(); ++x) {
                if (b.contains(x, y, z) && sign * std::array{x, y, z}[axis] >= from) ++count;
            }
        }
    }
    return count;
}

double cube(double c) { return 3 * (c * c * c); }

}  // namespace

TEST_CASE("the rate functions are those of the paper, and a clamp keeps any of them within its bounds") {
    for (double const c : {0.0, 0.125, 0.5, 0.75, 1.0}) {
        CHECK(cubic_rate{}(c) == 3 * c * c * c);
        CHECK(linear_rate{}(c) == c);
        CHECK(quartic_rate{}(c) == 3 * c * c * c * c);
        CHECK(linear_rate{.scale = 5}(c) == 5 * c);
    }
    clamped_rate<> const clamped{.lowest = 0.25, .highest = 2};
    CHECK(clamped(0.125) == 0.25);
    CHECK(clamped(0.5) == 0.375);
    CHECK(clamped(1) == 2);
    clamped_rate const own{.base = [](double c) { return c > 0.5 ? 9.0 : 0.0; }, .lowest = 1, .highest = 8};
    CHECK(own(0.5) == 1);
    CHECK(own(0.6) == 8);
}

TEST_CASE("with the excess over flat rock, flat ground, walls and ceilings stay as they are, whatever the bubble") {
    for (bubble_stencil const& bubble : bubbles()) {
        bool const ball = bubble == bubble_stencil(sphere_bubble{.radius = 7});
        for (int const depth : {1, 2}) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (bool const above : {false, true}) {
                    voxel_run run(half_space(axis, above),
                                  voxel_weathering{.bubbles = single_bubble{bubble}, .durability = constant_field{.value = 1e-3}},
                                  {.measure = curvature_measure::flat_excess, .skin_depth = depth});
                    REQUIRE(run.report().surface_voxels == static_cast<std::size_t>(depth * n * n));
                    run.run({.phases = {{.steps = 3, .spheroidal = 1e6, .cavernous = 1e6}}});
                    bool whole = true;
                    for (skin_voxel const& v : run.skin()) {
                    whole = whole && v.decimation == 100;
                    if (depth == 1 && ball) whole = whole && run.curvature(v) == 0;  // alike in all directions
                }
                    REQUIRE(whole);
                }
            }
        }
    }
}

TEST_CASE("with the excess over one half, flat rock recedes under cavernous weathering by what its half voxel weighs") {
    for (double const radius : {3.0, 5.0, 7.0, 12.0}) {
        bubble_stencil const ball = sphere_bubble{.radius = radius};
        auto const process = voxel_weathering{.bubbles = single_bubble{ball}, .durability = constant_field{.value = 0.5}};
        voxel_run run(half_space(2, false), process, {.measure = curvature_measure::signed_excess});
        run.run({.phases = {{.steps = 1, .spheroidal = 1, .cavernous = 0}}});
        CHECK(run.at({3, 4, n / 2 - 1})->decimation == 100);
        run.run({.phases = {{.steps = 1, .spheroidal = 0, .cavernous = 1}}});
        double const size = ball.size();
        double const up = beyond(ball, 2, 1, 1);
        double const excess = (size - up) / size - up / size;
        CHECK(excess == Approx(0.75 / radius).epsilon(0.25));
        CHECK(run.at({3, 4, n / 2 - 1})->decimation == 100 - cube(excess) / 0.5);
    }
}

TEST_CASE("every measure is that of its definition at every count of air") {
    for (bubble_stencil const& bubble : bubbles()) {
        for (int const depth : {1, 2}) {
            std::uint32_t least = bubble.size();
            std::uint32_t most = 0;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (int const sign : {-1, 1}) {
                    least = std::min(least, beyond(bubble, axis, sign, depth));
                    most = std::max(most, beyond(bubble, axis, sign, 1));
                }
            }
            auto const process = voxel_weathering{.bubbles = single_bubble{bubble}};
            detail::voxel_rates share;
            detail::voxel_rates excess;
            detail::voxel_rates flat;
            share.read(process, {.measure = curvature_measure::air_share, .skin_depth = depth});
            excess.read(process, {.measure = curvature_measure::signed_excess, .skin_depth = depth});
            flat.read(process, {.measure = curvature_measure::flat_excess, .skin_depth = depth});
            double const size = bubble.size();
            bool right = true;
            for (std::uint32_t air = 0; air <= bubble.size(); ++air) {
                double const v = air / size;
                double const w = (bubble.size() - air) / size;
                right = right && share.spheroidal(0, air) == cube(v) && share.cavernous(0, air) == cube(w);
                right = right && excess.spheroidal(0, air) == cube(v > w ? v - w : 0);
                right = right && excess.cavernous(0, air) == cube(w > v ? w - v : 0);
                double const round = air <= most ? 0 : (air - most) / (size - most);
                double const hollow = air >= least ? 0 : (double(least) - air) / double(least);
                right = right && flat.spheroidal(0, air) == cube(round) && flat.cavernous(0, air) == cube(hollow);
                right = right && flat.flat_excess(0, air) == round - hollow;
            }
            REQUIRE(right);
            CHECK(flat.spheroidal(0, bubble.size()) == (most < bubble.size() ? 3 : 0));  // all air
            CHECK(flat.cavernous(0, 0) == (least > 0 ? 3 : 0));                          // all rock
        }
    }
}

TEST_CASE("with the linear f on plain shares, both processes at once cancel: every voxel loses alike") {
    sparse_grid rock({.size = {33, 20, 18}});
    stream random(8, stage::user, 0);
    for (std::int32_t z = 0; z < 18; ++z) {
        for (std::int32_t y = 0; y < 20; ++y) {
            for (std::int32_t x = 0; x < 33; ++x) {
                if (random.uniform01() < 0.8) rock.set({x, y, z}, voxel_state::rock);
            }
        }
    }
    voxel_run run(std::move(rock), voxel_weathering{.bubbles = single_bubble{sphere_bubble{.radius = 4}}, .rate = linear_rate{},
                                                    .durability = constant_field{.value = 0.1}});
    run.run({.phases = {{.steps = 4, .spheroidal = 2, .cavernous = 2}}});
    for (skin_voxel const& v : run.skin()) REQUIRE(v.decimation == Approx(20).epsilon(1e-12));
    auto const first = run.report().voxels_vanished;
    REQUIRE(first == 0);
    run.run({.phases = {{.steps = 2, .spheroidal = 2, .cavernous = 2}}});
    REQUIRE(run.report().voxels_vanished > 1000);
    for (skin_voxel const& v : run.skin()) REQUIRE((v.decimation == 100 || v.decimation == Approx(80).epsilon(1e-12)));
}

TEST_CASE("the strengths of a phase multiply the rates of the two processes") {
    auto const process = voxel_weathering{.bubbles = single_bubble{sphere_bubble{.radius = 3}}, .durability = constant_field{.value = 0.25}};
    voxel_run run(half_space(2, false), process);
    voxel const at{5, 5, n / 2 - 1};
    double left = 100;
    for (voxel_phase const& phase : {voxel_phase{}, voxel_phase{.spheroidal = 0.5, .cavernous = 0.25}, voxel_phase{.spheroidal = 0, .cavernous = 3},
                                     voxel_phase{.spheroidal = 0, .cavernous = 0}}) {
        skin_voxel const v = *run.at(at);
        double const size = run.process().bubbles.stencils()[0].size();
        double const air = v.air_share;
        double const rock = (size - air * size) / size;
        REQUIRE(run.spheroidal_rate(v) == cube(air) / 0.25);
        REQUIRE(run.cavernous_rate(v) == Approx(cube(rock) / 0.25));
        run.run({.phases = {phase}});
        left -= (phase.spheroidal * cube(air) + phase.cavernous * cube(rock)) / 0.25;
        REQUIRE(run.at(at)->decimation == Approx(left).epsilon(1e-14));
    }
}
