// Shapes that the paper on directable weathering shows: Figures 9 to 13.
#include "paper/voxel_scene.hpp"

#include <tafoni/field/noise.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/weathering/weathered_voxels.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

using namespace tafoni;
using namespace tafoni_test;

namespace {

struct spread {
    double mean = 0;
    double deviation = 0;
};
spread of(std::vector<double> const& values) {
    double sum = 0;
    double square = 0;
    for (double const v : values) sum += v;
    double const mean = sum / static_cast<double>(values.size());
    for (double const v : values) square += (v - mean) * (v - mean);
    return {mean, std::sqrt(square / static_cast<double>(values.size()))};
}

std::vector<double> radii(sparse_grid const& g) {
    vec3 const middle{static_cast<double>(g.size()[0]) / 2, static_cast<double>(g.size()[1]) / 2,
                      static_cast<double>(g.size()[2]) / 2};
    std::vector<double> out;
    auto const surface = extract_voxel_surface(g);
    for (vec3 const& p : surface.rock.mesh.positions) out.push_back(length(vec3{p[0] - middle[0], p[1] - middle[1], p[2] - middle[2]}));
    return out;
}

single_bubble ball(double radius) { return {sphere_bubble{.radius = radius}}; }

/// Runs step by step until less than that share of the rock is left.
template <class Run>
void until(Run& run, double share, std::uint64_t at_most) {
    auto const enough = share * static_cast<double>(run.report().voxels_initial);
    while (static_cast<double>(run.report().voxels_rock) > enough && run.steps() < at_most) run.run({.phases = {{.steps = 1}}});
    REQUIRE(run.steps() < at_most);
}

}  // namespace

TEST_CASE("Figure 9: spheroidal weathering turns a cube into a sphere", "[slow][paper]") {
    // 128 voxels along the edge, a bubble of radius 16, the linear f of the excess of air over one half.
    constexpr int n = 128;
    sparse_grid cube({.size = {n + 8, n + 8, n + 8}});
    fill_box(cube, {4, 4, 4}, {n + 4, n + 4, n + 4});
    voxel_run run(std::move(cube),
                  voxel_weathering{.bubbles = ball(16), .rate = linear_rate{}, .durability = constant_field{.value = 0.003}},
                  {.measure = curvature_measure::signed_excess});
    spread const before = of(radii(run.grid()));
    REQUIRE(before.deviation > 0.08 * before.mean);
    until(run, 0.5, 1000);
    spread const after = of(radii(run.grid()));
    CHECK(after.deviation < 0.03 * after.mean);
    // Curvature is more even too.
    std::vector<double> air;
    for (skin_voxel const& v : run.skin()) air.push_back(v.air_share);
    CHECK(of(air).deviation < 0.03);
}

TEST_CASE("Figure 9: with the shares and powers of the paper the cube grows rounder all the time", "[paper]") {
    constexpr int n = 48;
    sparse_grid cube({.size = {n + 4, n + 4, n + 4}});
    fill_box(cube, {2, 2, 2}, {n + 2, n + 2, n + 2});
    voxel_run run(std::move(cube), voxel_weathering{.bubbles = ball(12), .rate = quartic_rate{}, .durability = constant_field{.value = 0.01}});
    double last = 1;
    for (double const share : {1.0, 0.6, 0.3, 0.1}) {
        until(run, share == 1 ? 0.999 : share, 500);
        spread const now = of(radii(run.grid()));
        CHECK(now.deviation < last * now.mean);
        last = now.deviation / now.mean;
    }
    CHECK(last < 0.03);
}

TEST_CASE("Figure 10: an inside corner becomes a cavern in the layer that is less durable", "[paper]") {
    constexpr std::int32_t n = 64;
    grid_border const goes_on{{border_kind::extend, border_kind::extend, border_kind::extend, border_kind::extend,
                               border_kind::rock, border_kind::extend}};
    sparse_grid fold({.size = {n, n, n}}, up_axis::plus_z, goes_on);
    fill_box(fold, {0, 0, 0}, {n, n, n});
    fill_box(fold, {32, 32, 0}, {n, n, n}, voxel_state::air);
    auto const soft_between_hard = [](vec3 const& p) { return p[2] >= 20 && p[2] < 44 ? 0.001 : 0.05; };
    for (curvature_measure const measure : {curvature_measure::signed_excess, curvature_measure::flat_excess}) {
        bool const flat = measure == curvature_measure::flat_excess;
        INFO("measured from " << (flat ? "flat rock" : "one half"));
        voxel_run run(fold, voxel_weathering{.bubbles = ball(8), .durability = soft_between_hard},
                      {.measure = measure, .rockfall = rockfall_options{}});
        voxel_report const r = run.run({.phases = {{.steps = 17, .spheroidal = 0, .cavernous = 1},
                                                   {.steps = 1},
                                                   {.steps = 2, .spheroidal = 0, .cavernous = 1}}});
        REQUIRE(r.steps == 20);
        REQUIRE(r.voxels_colluvium == 0);
        voxel_run caverns(fold, run.process(), run.options());
        caverns.run({.phases = {{.steps = 20, .spheroidal = 0, .cavernous = 1}}});
        int soft = 0;
        int hard = 0;
        int roofed = 0;
        int opened = 0;
        for (std::int32_t z = 0; z < n; ++z) {
            for (std::int32_t y = 0; y < n; ++y) {
                for (std::int32_t x = 0; x < n; ++x) {
                    if (!fold.is_rock({x, y, z}) || run.grid().is_rock({x, y, z})) continue;
                    opened += caverns.grid().is_rock({x, y, z}) ? 1 : 0;
                    bool const in_layer = z >= 20 && z < 44;
                    ++(in_layer ? soft : hard);
                    if (in_layer && run.grid().is_rock({x, y, 50})) ++roofed;
                }
            }
        }
        CHECK(soft > 5000);
        CHECK(opened > 100);  // by the round of spheroidal weathering: walls of caverns, seen from outside
        CHECK(hard < soft / 20);
        CHECK(roofed > soft * 9 / 10);
        auto const depth = [&](voxel from, voxel step) {
            int deepest = 0;
            for (int k = 0; k < 32; ++k) {
                if (!run.grid().is_rock({from.x + k * step.x, from.y + k * step.y, from.z})) deepest = k + 1;
            }
            return deepest;
        };
        CHECK(depth({31, 31, 32}, {-1, -1, 0}) >= 6);  // the corner, in diagonals
        CHECK(depth({31, 58, 32}, {-1, 0, 0}) <= 1);   // the wall
        if (flat) CHECK(run.look({31, 58, 32}).decimation == 100);  // untouched
    }
}

TEST_CASE("Figure 11: a cube takes on the shape of the bubble: sphere, gumdrop, disc", "[paper]") {
    constexpr int n = 40;
    auto const weathered = [](bubble_stencil bubble) {
        sparse_grid cube({.size = {n + 4, n + 4, n + 4}});
        fill_box(cube, {2, 2, 2}, {n + 2, n + 2, n + 2});
        voxel_run run(std::move(cube),
                      voxel_weathering{.bubbles = single_bubble{std::move(bubble)}, .rate = linear_rate{}, .durability = constant_field{.value = 0.004}},
                      {.measure = curvature_measure::signed_excess});
        until(run, 0.45, 600);
        std::vector<double> rows;
        for (double const r : profile(run.grid())) {
            if (r > 0) rows.push_back(r);
        }
        return rows;
    };
    auto const quarter = [](std::vector<double> const& rows, bool top) {
        std::size_t const k = rows.size() / 8;
        return rows[top ? rows.size() - 1 - k : k] / rows[rows.size() / 2];
    };
    auto const sphere = weathered(sphere_bubble{.radius = 8});
    auto const gumdrop = weathered(gumdrop_bubble{.radius = 8});
    auto const disc = weathered(disc_bubble{.radius = 8, .thickness = 3});
    CHECK(quarter(sphere, true) == Approx(quarter(sphere, false)));  // as round above as below
    CHECK(quarter(sphere, true) < 0.8);
    CHECK(quarter(gumdrop, true) < quarter(gumdrop, false) - 0.05);  // rounder above than below
    CHECK(quarter(disc, true) > 0.93);                               // a drum: no vertical curvature seen
    CHECK(quarter(disc, false) > 0.93);
}

TEST_CASE("Figure 12: colluvium protects the base", "[paper]") {
    auto const weathered = [](bool colluvium) {
        constexpr std::int32_t n = 48;
        sparse_grid cube({.size = {n + 40, n + 40, n + 4}}, up_axis::plus_z, on_ground);
        fill_box(cube, {20, 20, 0}, {n + 20, n + 20, n});
        voxel_options options;
        if (colluvium) options.colluvium = repose_rule{};
        voxel_run run(std::move(cube), voxel_weathering{.bubbles = ball(6), .durability = constant_field{.value = 0.015}}, options);
        run.run({.phases = {{.steps = 30}}});
        return profile(run.grid());
    };
    auto const bare = weathered(false);
    auto const covered = weathered(true);
    for (std::size_t z = 1; z < 12; ++z) CHECK(covered[z] > bare[z] + 0.8);
    CHECK(covered[30] == Approx(bare[30]).margin(0.3));
}

TEST_CASE("Figure 13: f = 3 c^4 smooths, f = c lets what protrudes stand", "[paper]") {
    gradient_noise const bumps{.seed = 3, .frequency = 0.12};
    sparse_grid rough({.size = {72, 72, 64}}, up_axis::plus_z, on_ground);
    for (std::size_t b = 0; b < rough.brick_count(); ++b) {
        rough.fill_brick(b, [&](voxel v) {
            double const x = v.x - 35.5;
            double const y = v.y - 35.5;
            double const r = 26 + 6 * bumps(vec3{static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)});
            return v.z < 60 && x * x + y * y < r * r ? voxel_state::rock : voxel_state::air;
        });
    }
    auto const roughness = [&](auto rate, double durability) {
        voxel_run run(rough, voxel_weathering{.bubbles = ball(6), .rate = rate, .durability = constant_field{.value = durability}});
        until(run, 0.8, 200);
        double square = 0;
        double n = 0;
        for (skin_voxel const& v : run.skin()) {
            if (v.at.z < 8 || v.at.z > 45) continue;
            square += (2 * v.air_share - 1) * (2 * v.air_share - 1);
            ++n;
        }
        return std::sqrt(square / n);
    };
    CHECK(roughness(quartic_rate{}, 0.01) < 0.8 * roughness(linear_rate{}, 0.03));
}
