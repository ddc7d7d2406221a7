// However fast the rock is taken, the surface stays one that water can run over.
#include "support/curved_surfaces.hpp"

#include <tafoni/core/elementary.hpp>
#include <tafoni/field/fractal_noise.hpp>
#include <tafoni/fluid/rain_particles.hpp>
#include <tafoni/geometry/self_intersections.hpp>
#include <tafoni/weathering/hydraulic_run.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

using namespace tafoni;
using namespace tafoni_test;

namespace {

/// Cosines between the two faces at each edge that has two, by edge; 1 where a face is a sliver without a direction.
std::map<std::pair<std::uint32_t, std::uint32_t>, double> bends(triangle_surface const& s) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<vec3>> normals;
    for (auto const& t : s.triangles) {
        vec3 const n = normalized(cross(vec3{s.positions[t[1]] - s.positions[t[0]]}, vec3{s.positions[t[2]] - s.positions[t[0]]}));
        for (std::size_t k = 0; k < 3; ++k) {
            normals[{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])}].push_back(n);
        }
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> out;
    for (auto const& [edge, n] : normals) {
        if (n.size() == 2) out[edge] = dot(n[0], n[1]);
    }
    return out;
}
double six_volumes(triangle_surface const& s) {
    double six = 0;
    for (auto const& t : s.triangles) six += dot(s.positions[t[0]], cross(s.positions[t[1]], s.positions[t[2]]));
    return six;
}
bool rim_at_rest(triangle_surface const& before, triangle_surface const& after) {
    vertex_rings const rings(before.positions.size(), before.triangles);
    for (std::size_t v = 0; v < before.positions.size(); ++v) {
        if (rings.is_border(v) && before.positions[v] != after.positions[v]) return false;
    }
    return true;
}

struct shape {
    std::string name;
    triangle_surface mesh{};
    box3 source{};
    box3 keep{};
    vec3 velocity{0, 0, 0};
};
box3 between(vec3 const& lo, vec3 const& hi) { return {.lo = lo, .hi = hi}; }

triangle_surface heights(std::uint32_t n, auto const& height) {
    return parametric(
               n + 1, n + 1, false, false, 0.2,
               [&](double u, double v) { return vec3{10 * u, 10 * v, height(10 * u, 10 * v)}; }, [](double, double) { return 0.0; })
        .mesh;
}
std::vector<shape> shapes() {
    std::vector<shape> all;
    triangle_surface ball = sphere(3).mesh;
    for (vec3& p : ball.positions) p *= 3.0;
    all.push_back({"sphere", ball, between({-2, -2, 3.2}, {2, 2, 3.8}), between({-4, -4, -4}, {4, 4, 5})});
    triangle_surface plate = ball;
    for (vec3& p : plate.positions) p[2] *= 0.12;
    all.push_back({"thin plate", plate, between({-2, -2, 0.8}, {2, 2, 1.4}), between({-4, -4, -2}, {4, 4, 3})});
    fractal_noise const rough{.seed = 4, .frequency = 0.35, .octaves = 4};
    all.push_back({"noise terrain", heights(32, [&](double x, double y) { return 1.2 * rough({x, y, 0}) - 0.3 * x; }),
                   between({2.5, 2.5, 1.5}, {6, 7, 2.5}), between({2, 2, -6}, {7.8, 7.8, 5})});
    all.push_back({"canyon", heights(32,
                                     [](double x, double y) {
                                         double const off = std::fabs(y - 5 - elementary::sin(0.7 * x));
                                         return std::clamp(2.5 * (off - 0.6), 0.0, 3.0) - 0.15 * x;
                                     }),
                   between({1.8, 4.6, 0.3}, {2.4, 6.6, 1.2}), between({1.5, 2, -6}, {8.2, 8, 5}), vec3{3, 0, 0}});
    return all;
}

/// One jet, which follows the ground down.
struct jet {
    std::size_t particle_count() const { return 40; }
    vec3 position(std::size_t i) const { return vec3{5.01 + 1e-3 * static_cast<double>(i % 7), 5.02 + 1e-3 * static_cast<double>(i % 5), depth + 0.05}; }
    vec3 velocity(std::size_t) const { return vec3{5, 0, 0}; }
    double reach() const { return 0.3; }
    double step(fluid_boundary auto const& walls, executor auto const&) {
        for (double z = depth; z > depth - 0.3; z -= 0.01) {
            bool meets = false;
            walls.for_each_contact(vec3{5.01, 5.02, z}, 0.05, [&](boundary_contact const&) { meets = true; });
            if (meets) {
                depth = z;
                break;
            }
        }
        return 0.1;
    }
    double depth = 0;
};

/// Drops in one place of water that runs for ten steps.
struct still {
    std::size_t count = 1;
    std::size_t particle_count() const { return count; }
    vec3 position(std::size_t) const { return vec3{5.05, 5.02, 0.05}; }
    vec3 velocity(std::size_t) const { return vec3{steps <= 10 ? 5.0 : 0.0, 0, 0}; }
    double reach() const { return 0.3; }
    double step(fluid_boundary auto const&, executor auto const&) {
        ++steps;
        return 0.1;
    }
    int steps = 0;
};

}  // namespace

TEST_CASE("no rate folds a surface, and the ledger stays the volume that it lost") {
    for (shape const& s : shapes()) {
        auto const start = bends(s.mesh);
        double eroded = 0;
        for (double const k : {1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) {
            INFO(s.name << ", k = " << k);
            rain_particles const water({.box = s.source, .velocity = s.velocity}, {.keep = s.keep},
                                       {.particles = 300, .radius = 0.35, .friction = 1, .lifetime = 6});
            hydraulic_run run(s.mesh, water, partheniades_erosion{.coefficient = k, .critical = 3});
            run.run(50);
            triangle_surface const& now = run.surface();
            REQUIRE(run.balanced());
            REQUIRE(std::all_of(now.positions.begin(), now.positions.end(), [](vec3 const& p) { return is_finite(p); }));
            std::size_t sharper = 0;
            for (auto const& [edge, bend] : bends(now)) sharper += bend < std::min(start.at(edge), 0.3) - 1e-6 ? 1U : 0U;
            CHECK(sharper == 0);
            auto const& l = run.report().ledger;
            if (rim_at_rest(s.mesh, now)) {
                CHECK((six_volumes(s.mesh) - six_volumes(now)) / 6 == Approx(l.eroded - l.deposited).epsilon(1e-9).margin(1e-9));
            }
            CHECK(l.eroded > eroded);  // a higher rate takes more, but no tenfold where the rock cannot follow
            eroded = l.eroded;
            CHECK(l.deposited <= l.eroded);
            // No vertex goes farther than the limit of an iteration.
            double const most = 50 * s.mesh.mean_edge_length() / hydraulic_options{}.step_divisor;
            for (double const w : run.wear()) REQUIRE(w <= most);
        }
    }
}

TEST_CASE("at a moderate rate no triangles cut each other") {
    for (shape const& s : shapes()) {
        INFO(s.name);
        for (double const k : {1e-4, 1e-3}) {
            rain_particles const water({.box = s.source, .velocity = s.velocity}, {.keep = s.keep},
                                       {.particles = 300, .radius = 0.35, .friction = 1, .lifetime = 6});
            hydraulic_run run(s.mesh, water, partheniades_erosion{.coefficient = k, .critical = 3});
            run.run(60);
            CHECK(run.report().ledger.eroded > 0);
            CHECK(self_intersections(run.surface().positions, run.surface().triangles).empty());
        }
    }
}

TEST_CASE("erosion by curvature folds no surface either") {
    for (shape const& s : shapes()) {
        INFO(s.name);
        auto const start = bends(s.mesh);
        for (double const divisor : {10.0, 1.0}) {
            rain_particles const water({.box = s.source, .velocity = s.velocity}, {.keep = s.keep},
                                       {.particles = 300, .radius = 0.35, .friction = 1, .lifetime = 6});
            hydraulic_run run(s.mesh, water, curvature_erosion<>{}, {.step_divisor = divisor});
            run.run(50);
            CHECK(run.balanced());
            CHECK(run.report().ledger.eroded > 0);
            std::size_t sharper = 0;
            for (auto const& [edge, bend] : bends(run.surface())) sharper += bend < std::min(start.at(edge), 0.3) - 1e-6 ? 1U : 0U;
            CHECK(sharper == 0);
            if (divisor > 1) CHECK(self_intersections(run.surface().positions, run.surface().triangles).empty());
        }
    }
}

TEST_CASE("a place that all water meets goes down as a bowl, not as a needle") {
    triangle_surface const ground = heights(40, [](double, double) { return 0.0; });
    hydraulic_run run(ground, jet{}, partheniades_erosion{.coefficient = 1, .critical = 0});
    run.run(60);
    CHECK(run.balanced());
    double deepest = 0;
    for (vec3 const& p : run.surface().positions) deepest = std::min(deepest, p[2]);
    REQUIRE(deepest < -0.2);
    // Nothing is steeper than its edges allow: the pit is as wide as deep.
    for (auto const& [edge, bend] : bends(run.surface())) CHECK(bend > 0.29);
    std::size_t deep = 0;
    for (vec3 const& p : run.surface().positions) deep += p[2] < 0.3 * deepest ? 1U : 0U;
    CHECK(deep > 4);
}

TEST_CASE("what a place cannot give in an iteration is not taken, so nothing goes on wearing when the water stops") {
    triangle_surface const ground = heights(20, [](double, double) { return 0.0; });
    double before = 0;
    for (std::size_t const n : {std::size_t{100}, std::size_t{1000}}) {
        hydraulic_run run(ground, still{.count = n}, partheniades_erosion{.coefficient = 1, .critical = 0});
        double const most = ground.mean_edge_length() / hydraulic_options{}.step_divisor;
        run.run(1);
        for (double const w : run.wear()) REQUIRE(w <= most * (1 + 1e-9));
        double const first = run.report().ledger.eroded;
        CHECK(first > 0);
        if (before > 0) CHECK(first == Approx(before));  // ten times the drops take no more
        before = first;
        run.run(9);
        double const flowing = run.report().ledger.eroded;
        run.run(40);
        CHECK(run.balanced());
        CHECK(run.report().ledger.eroded < 1.5 * flowing);
    }
}
