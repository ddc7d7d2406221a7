// Scenes of the processes on meshes that need no file: Figures 9.6 and 9.7 of the source on fingers, beds of rock, a crack.
#include "support/curved_surfaces.hpp"

#include <tafoni/core/elementary.hpp>
#include <tafoni/field/strata.hpp>
#include <tafoni/weathering/curvature_run.hpp>
#include <tafoni/weathering/wrinkles.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <span>

using namespace tafoni;
using namespace tafoni_test;

namespace {

constexpr double turn = 6.283185307179586;

/// An upright column of radius 1 and height 6 around z, open at both ends.
triangle_surface column(std::uint32_t around, std::uint32_t along) {
    return parametric(
               around, along, true, false, 0,
               [](double u, double v) {
                   return vec3{elementary::cos(turn * u), elementary::sin(turn * u), 6 * v};
               },
               [](double, double) { return 0.5; })
        .mesh;
}
double radius_at(triangle_surface const& s, double lo, double hi) {
    double sum = 0;
    double n = 0;
    for (vec3 const& p : s.positions) {
        if (p[2] < lo || p[2] > hi) continue;
        sum += std::sqrt(p[0] * p[0] + p[1] * p[1]);
        ++n;
    }
    return sum / n;
}
/// A ball with a finger: the finger's tip is bent five times as much.
triangle_surface finger() {
    triangle_surface s = sphere(4).mesh;
    for (vec3& p : s.positions) {
        double const off = std::sqrt(p[0] * p[0] + p[1] * p[1]);
        if (p[2] > 0 && off < 0.3) p[2] += 1.5 * (1 - off / 0.3) * (1 - off / 0.3) * (1 + 2 * off / 0.3);
    }
    return s;
}
double top(triangle_surface const& s) {
    double z = -1e9;
    for (vec3 const& p : s.positions) z = std::max(z, p[2]);
    return z;
}
double bottom(triangle_surface const& s) {
    double z = 1e9;
    for (vec3 const& p : s.positions) z = std::min(z, p[2]);
    return z;
}

}  // namespace

TEST_CASE("hard beds stand out of a column, soft ones make waists", "[paper]") {
    strata const beds{.tops = {2, 4}, .values = {8, 1, 8}};
    curvature_run run(column(48, 61), curvature_weathering{.direction = inward_normal{}, .durability = beds});
    run.run(40);
    triangle_surface const s = run.surface();
    double const soft = radius_at(s, 2.4, 3.6);
    double const below = radius_at(s, 0.4, 1.6);
    double const above = radius_at(s, 4.4, 5.6);
    CHECK(soft < below - 0.05);
    CHECK(soft < above - 0.05);
    CHECK(below == Approx(above).epsilon(0.02));
    CHECK(below > 0.9);
}

TEST_CASE("a finger goes before the ball it stands on, the more so with a power", "[paper]") {
    triangle_surface const whole = finger();
    double before = 0;
    for (double const n : {1.0, 3.0, 5.0}) {
        curvature_run run(whole, curvature_weathering{}, {.power = n});
        run.run(60);
        triangle_surface const s = run.surface();
        double const tip = top(whole) - top(s);
        double const ball = bottom(s) - bottom(whole);
        REQUIRE(tip > 0);
        double const ratio = tip / std::max(ball, 1e-12);
        CHECK(ratio > 3);
        CHECK(ratio > before);
        before = ratio;
    }
}

TEST_CASE("a crack runs through what weathering has rounded, and weathering widens its rim", "[paper]") {
    curvature_run rounded(sphere(4).mesh);
    rounded.run(5);
    triangle_surface const base = rounded.surface();
    auto nearest = [&](vec3 const& p) {
        std::size_t best = 0;
        for (std::size_t v = 0; v < base.positions.size(); ++v) {
            if (squared_length(vec3{base.positions[v] - p}) < squared_length(vec3{base.positions[best] - p})) best = v;
        }
        return vertex_index{best};
    };
    wrinkle const line{.controls = {nearest({0.3, -0.9, 0.5}), nearest({-0.1, -1, 0}), nearest({0.2, -0.9, -0.5})},
                       .radius = 0.12, .strength = -1, .profile = wrinkle_profile::groove};
    wrinkle_pattern const pattern(base, std::span(&line, 1));
    triangle_surface const cracked = pattern.wear(base.positions, 3);
    auto const depth = [&](triangle_surface const& s) {
        double sum = 0;
        for (vertex_index const v : pattern.paths()[0]) sum += 1 - length(s.positions[v.value]);
        return sum / static_cast<double>(pattern.paths()[0].size());
    };
    CHECK(depth(cracked) > depth(pattern.wear(base.positions, 1)) + 0.01);
    curvature_run later(cracked, curvature_weathering{}, {.topology = mesh_topology::keep});
    auto const h = later.curvature();
    double floor = 0;
    for (vertex_index const v : pattern.paths()[0]) floor += h[v.value];
    CHECK(floor < 0);  // a hollow
    later.run(10);
    auto const wear = later.wear();
    double deepest = 0;
    for (vertex_index const v : pattern.paths()[0]) deepest = std::max(deepest, wear[v.value]);
    double rim = 0;
    for (std::size_t v = 0; v < wear.size(); ++v) rim = std::max(rim, wear[v]);
    CHECK(rim > 2 * deepest);  // the floor is sheltered, the rim is not
}
