// However fast the rock is taken, the surface stays one that water can run over.
#include "support/water_scenes.hpp"

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
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

triangle_surface heights(std::uint32_t n, auto const& height) { return sheet(n, height, 0.2); }
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

namespace {
/// Water that stays at both sides of the middle of the slab, however far these recede.
struct gripping {
    std::vector<vec3> at{};
    std::size_t particle_count() const { return at.size(); }
    vec3 position(std::size_t i) const { return at[i]; }
    vec3 velocity(std::size_t) const { return vec3{1, 0.3, 0}; }
    double reach() const { return 0.25; }
    double step(fluid_boundary auto const&, executor auto const&) { return 0.1; }
    void save(auto& out) const { out.put(std::uint64_t{at.size()}); }
    void load(auto& in) { (void)in.get(); }
};
gripping both_sides(double thick) {
    gripping out;
    for (int k = 0; k < 300; ++k) {
        double const x = 0.7 + 0.013 * (k % 100);
        double const y = 0.7 + 0.21 * (k % 7);
        out.at.push_back(vec3{x, y, k % 2 == 0 ? thick + 0.1 : -0.1});
    }
    return out;
}
}  // namespace

TEST_CASE("walls thinner than an edge do not cut each other where the run looks around") {
    double const thick = 0.06;
    triangle_surface const start = slab(10, thick);
    REQUIRE(self_intersections(start.positions, start.triangles).empty());
    auto const cuts = [&](auto const& process, std::uint32_t every) {
        hydraulic_run run(start, both_sides(thick), process, {.check_every = every});
        std::size_t found = 0;
        double gone = 0;
        for (int k = 0; k < 6; ++k) {
            run.run(5);
            found = std::max(found, self_intersections(run.surface().positions, run.surface().triangles).size());
            REQUIRE(run.balanced());
            CHECK(run.report().ledger.eroded >= gone);
            gone = run.report().ledger.eroded;
        }
        CHECK(gone > 0);
        return found;
    };
    partheniades_erosion const stress{.coefficient = 0.01, .critical = 0};
    CHECK(cuts(stress, 0) > 0);  // else this shows nothing
    CHECK(cuts(curvature_erosion<>{.influence = 0.6}, 0) > 0);
    for (std::uint32_t const every : {1U, 3U, 10U}) {
        INFO("every " << every);
        CHECK(cuts(stress, every) == 0);
        CHECK(cuts(curvature_erosion<>{.influence = 0.6}, every) == 0);
    }
}

namespace {
struct leaving : gripping {
    std::size_t particle_count() const { return ran < 3 ? at.size() : 0; }
    double step(fluid_boundary auto const&, executor auto const&) {
        ++ran;
        return 0.1;
    }
    int ran = 0;
};
}  // namespace

TEST_CASE("looks as rare as can be hold nothing that is far from other walls") {
    auto const eroded = [](std::uint32_t every) {
        hydraulic_run run(slab(10, 3.0), both_sides(3.0), partheniades_erosion{.coefficient = 0.001, .critical = 0}, {.check_every = every});
        return run.run(3).ledger.eroded;
    };
    double const usual = eroded(20);
    CHECK(usual > 0);
    CHECK(eroded(std::uint32_t{1} << 31) == usual);
    CHECK(eroded(4294967295U) == usual);
}

// The slab gives a little and is held then; its water goes, with what the slab was to give.
TEST_CASE("water that takes rock between near walls never carries less than nothing") {
    double most = 0;
    for (std::uint32_t const every : {1U, 4U}) {
        INFO("every " << every);
        hydraulic_run run(slab(10, 0.06), leaving{both_sides(0.06)}, partheniades_erosion{.coefficient = 0.01, .critical = 0}, {.check_every = every});
        for (int k = 0; k < 8; ++k) {
            sediment_ledger const l = run.run(1).ledger;
            REQUIRE(run.balanced());
            CHECK(l.carried >= 0);
            CHECK(l.left >= 0);
            CHECK(l.eroded == Approx(l.deposited + l.carried + l.left).epsilon(1e-12));
            most = std::max(most, l.eroded);
        }
    }
    CHECK(most > 0);
}

TEST_CASE("a run that looks around goes on from a checkpoint between two looks, on any number of threads") {
    double const thick = 0.06;
    triangle_surface const start = slab(10, thick);
    auto const make = [&](std::uint32_t every) {
        return hydraulic_run(start, both_sides(thick), partheniades_erosion{.coefficient = 0.01, .critical = 0},
                             {.refine_length = 0.2, .refine_every = 4, .check_every = every});
    };
    auto whole = make(3);
    whole.run(11);
    auto first = make(3);
    first.run(7, {}, thread_pool(3));
    auto second = make(3);
    second.resume(first.checkpoint());
    second.run(4);
    CHECK(second.checkpoint() == whole.checkpoint());
    CHECK(second.surface().positions == whole.surface().positions);
    CHECK(self_intersections(whole.surface().positions, whole.surface().triangles).empty());
    CHECK_THROWS_AS(make(2).resume(first.checkpoint()), io_error);
}

TEST_CASE("the gap between two triangles is that of their nearest points") {
    auto random = [k = std::uint64_t{0}]() mutable {
        stream s(5, 1, k++);
        return s.uniform(-1, 1);
    };
    for (int n = 0; n < 300; ++n) {
        std::array<vec3, 3> a;
        std::array<vec3, 3> b;
        for (vec3* p : {&a[0], &a[1], &a[2], &b[0], &b[1], &b[2]}) {
            for (int d = 0; d < 3; ++d) (*p)[d] = random();
        }
        for (vec3& p : b) p[0] += 0.5 * (n % 4);
        if (n % 5 == 0) b[2] = b[0] + 0.3 * (b[1] - b[0]);  // no area
        double least = 1e9;
        int const m = 40;
        for (int i = 0; i <= m; ++i) {
            for (int j = 0; i + j <= m; ++j) {
                vec3 const p{a[0] + (i / 40.0) * (a[1] - a[0]) + (j / 40.0) * (a[2] - a[0])};
                least = std::min(least, length(p - detail::nearest_on_triangle(b[0], b[1], b[2], p)));
            }
        }
        double const gap = std::sqrt(detail::squared_gap(a, b));
        INFO("pair " << n);
        CHECK(gap <= least + 1e-12);
        CHECK(gap >= least - 0.1);
        CHECK(gap == Approx(std::sqrt(detail::squared_gap(b, a))).margin(1e-9));
    }
}

TEST_CASE("a tip whose triangle is flat slides off it and goes on") {
    // A hexagon with its middle above one side, where the triangle over that side is a sliver before the tip is down.
    std::vector<vec3> p;
    for (auto const& [x, y] : {std::array{1.0, 0.0}, {0.5, 0.866}, {-0.5, 0.866}, {-1.0, 0.0}, {-0.5, -0.866}, {0.5, -0.866}}) {
        p.push_back(vec3{x, y, 0});
    }
    p.push_back(vec3{0, 0.81, 0.3});
    std::vector<std::array<std::uint32_t, 3>> t;
    for (std::uint32_t k = 0; k < 6; ++k) t.push_back({k, (k + 1) % 6, 6});
    vertex_rings const rings(p.size(), t);
    detail::sound_moves moves;
    detail::moving_surface const s{p, t, rings};
    moves.adopt(s);
    std::vector<vec3> next;
    for (int k = 0; k < 200; ++k) {
        next = p;
        next[6][2] = std::max(next[6][2] - 0.01, 0.0);
        detail::follow(s, next, moves, 0.01);
        REQUIRE(next == p);
    }
    CHECK(p[6][2] < 0.005);
    CHECK(p[6][1] < 0.79);
    for (std::uint32_t k = 0; k < 6; ++k) CHECK(p[k][2] == 0);
}
