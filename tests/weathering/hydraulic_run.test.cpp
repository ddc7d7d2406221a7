#include "support/water_scenes.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/fluid/rain_particles.hpp>
#include <tafoni/weathering/hydraulic_run.hpp>

#include <catch2/catch.hpp>

#include <limits>

using namespace tafoni;
using namespace tafoni_test;

namespace {

rain_particles rain_over(double drop, double gravity = 9.81, std::uint32_t particles = 400) {
    box3 from;
    from.lo = vec3{2.5, 2.5, 0.5};
    from.hi = vec3{7, 7.5, 2};
    box3 keep;
    keep.lo = vec3{2.2, 2.2, -drop - 1};  // the rim stays dry
    keep.hi = vec3{7.8, 7.8, 5};
    return rain_particles({.box = from}, {.keep = keep},
                          {.particles = particles, .radius = 0.3, .gravity = vec3{0, 0, -gravity}, .seed = 3});
}


}  // namespace

TEST_CASE("rock that leaves the surface is carried, laid down or gone, to the last unit") {
    hydraulic_run run(slope(20, 6), rain_over(6), partheniades_erosion{.coefficient = 2e-3, .critical = 4});
    for (int k = 0; k < 30; ++k) {
        hydraulic_report const r = run.run(10);
        REQUIRE(run.balanced());
        CHECK(r.ledger.eroded >= 0);
    }
    hydraulic_report const& r = run.report();
    CHECK(r.contacts > 1000);
    CHECK(r.ledger.eroded > 0);
    CHECK(r.ledger.left > 0);
}

TEST_CASE("what slows down lays down what it carries, and no more") {
    // A chute that ends in a flat basin.
    triangle_surface s = slope(40, 0);
    for (vec3& p : s.positions) p[2] = p[0] < 5 ? (5 - p[0]) * 1.2 : 0.0;
    box3 from;
    from.lo = vec3{1.5, 2, 4.8};
    from.hi = vec3{2.5, 8, 5.5};
    box3 keep;
    keep.lo = vec3{0.5, 0.5, -1};
    keep.hi = vec3{9.5, 9.5, 9};
    rain_particles const drops({.box = from}, {.keep = keep},
                               {.particles = 200, .radius = 0.3, .friction = 3, .lifetime = 8});
    hydraulic_run run(s, drops, partheniades_erosion{.coefficient = 1e-3, .critical = 6});
    hydraulic_report const r = run.run(600);
    CHECK(run.balanced());
    CHECK(r.ledger.deposited > 0.01 * r.ledger.eroded);
    CHECK(r.ledger.deposited <= r.ledger.eroded);
    double chute = 0;
    double basin = 0;
    auto const net = run.sediment();
    for (std::size_t v = 0; v < net.size(); ++v) (s.positions[v][0] < 5 ? chute : basin) += net[v];
    CHECK(chute < 0);
    CHECK(basin > chute);
}

TEST_CASE("the ledger is the volume that the surface really lost") {
    triangle_surface const before = slope(16, 5);
    hydraulic_run run(before, rain_over(5), partheniades_erosion{.coefficient = 2e-3, .critical = 4});
    hydraulic_report const r = run.run(200);
    // Of an open sheet with its rim at rest: the signed volume under it.
    auto const under = [](triangle_surface const& s) {
        double six = 0;
        for (auto const& t : s.triangles) {
            vec3 const o{5, 5, -100};
            six += dot(s.positions[t[0]] - o, cross(s.positions[t[1]] - o, s.positions[t[2]] - o));
        }
        return six / 6;
    };
    bool rim_moved = false;
    vertex_rings const rings(before.positions.size(), before.triangles);
    for (std::size_t v = 0; v < before.positions.size(); ++v) {
        rim_moved = rim_moved || (rings.is_border(v) && run.surface().positions[v] != before.positions[v]);
    }
    double const lost = under(before) - under(run.surface());
    CHECK(r.ledger.eroded - r.ledger.deposited == Approx(lost).epsilon(rim_moved ? 0.05 : 1e-6));
}

TEST_CASE("without flow nothing erodes by shear stress") {
    triangle_surface const s = slope(10, 0);
    standing still;
    for (int k = 0; k < 50; ++k) still.at.push_back(vec3{0.1 + 0.19 * k, 5.03, 0.1});
    hydraulic_run run(s, still, partheniades_erosion{.coefficient = 1, .critical = 0.5});
    hydraulic_report const r = run.run(20);
    CHECK(r.contacts > 0);
    CHECK(r.ledger.eroded == 0);
    CHECK(same_bits(run.surface(), s));
    // The same particles under way do.
    still.speed = vec3{1, 0, 0};
    hydraulic_run flowing(s, still, partheniades_erosion{.coefficient = 1e-3, .critical = 0.5});
    CHECK(flowing.run(20).ledger.eroded > 0);
}

TEST_CASE("the eroded volume is rate x contact area x time") {
    triangle_surface const s = slope(4, 0);
    standing one{.at = {vec3{5.3, 5.1, 0.05}}, .speed = vec3{2, 0, 0}};
    partheniades_erosion const rule{.coefficient = 1e-4, .critical = 1, .consistency = 0.5};
    hydraulic_run run(s, one, rule);
    hydraulic_report const r = run.run(1);
    double const rate = 1e-4 * (0.5 * 2 / 0.05 - 1);
    double const area = tau / 2 * (0.2 * 0.2 - 0.05 * 0.05);
    CHECK(r.ledger.eroded == Approx(rate * area * 0.1).epsilon(1e-6));
}

TEST_CASE("flat ground erodes evenly by curvature, and only near the water") {
    triangle_surface const s = slope(20, 0);
    standing flood;
    for (int i = 0; i < 40; ++i) {
        for (int j = 0; j < 20; ++j) flood.at.push_back(vec3{0.25 * i + 0.1, 0.25 * j + 0.1, 0.05});
    }
    hydraulic_run run(s, flood, curvature_erosion<>{.influence = 0.5});
    run.run(1);
    double most = 0;
    for (std::size_t v = 0; v < s.positions.size(); ++v) {
        double const down = s.positions[v][2] - run.surface().positions[v][2];
        CHECK(down >= 0);
        if (s.positions[v][1] > 5.6) CHECK(down == 0);
        most = std::max(most, down);
    }
    CHECK(most > 0);
}

TEST_CASE("curvature erosion never moves a vertex outwards") {
    triangle_surface s = torus_surface(40, 24, 0.2).mesh;
    standing around;
    vertex_rings const rings(s.positions.size(), s.triangles);
    std::vector<vec3> normal(s.positions.size());
    vertex_normals(surface_view{.positions = s.positions, .triangles = s.triangles, .rings = &rings}, normal);
    for (std::size_t v = 0; v < s.positions.size(); ++v) around.at.push_back(vec3{s.positions[v] + 0.01 * normal[v]});
    hydraulic_run run(s, around, curvature_erosion<>{});
    run.run(1);
    for (std::size_t v = 0; v < s.positions.size(); ++v) {
        CHECK(dot(run.surface().positions[v] - s.positions[v], normal[v]) <= 1e-15);
    }
}

TEST_CASE("a soft layer goes before a hard one") {
    triangle_surface const s = slope(20, 6);
    struct layers {
        double operator()(vec3 const& p) const { return p[0] < 5 ? 1e-2 : 1e-5; }
    };
    hydraulic_run run(s, rain_over(6), partheniades_erosion{.coefficient = layers{}, .critical = 4});
    run.run(150);
    double soft = 0;
    double hard = 0;
    // But for the faces that have corners on both.
    for (std::size_t v = 0; v < s.positions.size(); ++v) {
        if (s.positions[v][0] < 4.4) soft += run.wear()[v];
        if (s.positions[v][0] > 6.1) hard += run.wear()[v];
    }
    CHECK(soft > 5 * hard);
    CHECK(hard > 0);
}

TEST_CASE("no iterations change nothing; n then m equal n + m") {
    triangle_surface const s = slope(12, 4);
    partheniades_erosion const rule{.coefficient = 1e-3, .critical = 4};
    hydraulic_run none(s, rain_over(4), rule);
    none.run(0);
    CHECK(same_bits(none.surface(), s));
    hydraulic_run once(s, rain_over(4), rule);
    hydraulic_run twice(s, rain_over(4), rule);
    once.run(60);
    twice.run(25);
    twice.run(35);
    CHECK(same_bits(once.surface(), twice.surface()));
}

TEST_CASE("threads change no bit of an eroded mesh", "[threads]") {
    triangle_surface const s = slope(16, 5);
    auto const washed = [&](auto const& threads, auto const& process) {
        hydraulic_run run(s, rain_over(5, 9.81, 3000), process);
        run.run(25, {}, threads);
        return run.surface();
    };
    partheniades_erosion const rule{.coefficient = 1e-3, .critical = 4};
    triangle_surface const a = washed(inline_executor{}, rule);
    triangle_surface const b = washed(inline_executor{}, curvature_erosion<>{});
    for (std::size_t n : {2U, 3U, 7U}) {
        CHECK(same_bits(a, washed(thread_pool(n), rule)));
        CHECK(same_bits(b, washed(thread_pool(n), curvature_erosion<>{})));
    }
}

TEST_CASE("edges near the water are refined, others are not") {
    triangle_surface const s = slope(10, 0);
    standing drop{.at = {vec3{5.1, 5.2, 0.1}}, .speed = vec3{1, 0, 0}};
    hydraulic_run run(s, drop, partheniades_erosion{.coefficient = 1e-4, .critical = 1},
                      {.refine_length = 0.4, .refine_every = 1});
    hydraulic_report const r = run.run(4);
    CHECK(r.vertices_added > 3);
    CHECK(run.surface().positions.size() == s.positions.size() + r.vertices_added);
    for (std::size_t v = s.positions.size(); v < run.surface().positions.size(); ++v) {
        CHECK(length(run.surface().positions[v] - vec3{5.1, 5.2, 0}) < 3);
    }
    CHECK(run.balanced());
}

TEST_CASE("parameters out of range are refused by name") {
    triangle_surface const s = slope(4, 1);
    double const nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(hydraulic_run(s, rain_over(1), partheniades_erosion{.coefficient = -1}), Catch::Contains("coefficient"));
    CHECK_THROWS_WITH(hydraulic_run(s, rain_over(1), partheniades_erosion{.critical = nan}), Catch::Contains("critical"));
    CHECK_THROWS_WITH(hydraulic_run(s, rain_over(1), partheniades_erosion{.exponent = 0}), Catch::Contains("exponent"));
    CHECK_THROWS_WITH(hydraulic_run(s, rain_over(1), curvature_erosion<>{.power = 0.5}), Catch::Contains("power"));
    CHECK_THROWS_WITH(hydraulic_run(s, rain_over(1), curvature_erosion<>{.influence = nan}), Catch::Contains("influence"));
    CHECK_THROWS_WITH(hydraulic_run(s, rain_over(1), curvature_erosion<>{}, {.step_divisor = 0}), Catch::Contains("step_divisor"));
}

TEST_CASE("rock goes at the rate of the rule, however slow, on ground of kilometres") {
    // 2 km of 10 m edges, SI units: what a particle takes in a step is down to 10^-15 of the ground's box.
    double const drop = 600;
    triangle_surface ground = slope(200, 0);
    for (vec3& p : ground.positions) p = vec3{200 * p[0], 200 * p[1], -drop * p[0] / 10};
    double first = 0;
    for (double const k : {1e-4, 1e-6, 1e-8, 1e-10}) {
        rain_particles const rain({.box = {.lo = vec3{10, 10, -drop}, .hi = vec3{1990, 1990, 100}}},
                                  {.keep = {.lo = vec3{0, 0, -2 * drop}, .hi = vec3{2000, 2000, 200}}},
                                  {.particles = 4000, .radius = 2, .frame = 0.05});
        hydraulic_run run(ground, rain, partheniades_erosion{.coefficient = k, .critical = 0});
        double const share = run.run(20).ledger.eroded / k;
        INFO("k = " << k);
        REQUIRE(run.balanced());
        REQUIRE(share > 0);
        if (first == 0) first = share;
        CHECK(share == Approx(first).epsilon(0.01));
    }
}

TEST_CASE("a move that large coordinates swallow is not booked") {
    // 1e6 from the origin a place is known to 1e-10: half of what is taken stays due until it is seen.
    triangle_surface ground = slope(20, 0);
    for (vec3& p : ground.positions) p[2] += 1e6;
    vec3 const o = ground.positions[220];
    struct slow {
        double rate(wash_point const&) const { return 1e-13; }
    };
    hydraulic_run run(ground, standing{.at = {o + vec3{0.1, 0.05, 0.05}, o + vec3{0.15, 0.05, 0.05}}}, slow{});
    run.run(5);
    CHECK(run.surface().positions == ground.positions);
    CHECK(run.report().ledger.eroded == 0);
    CHECK(run.balanced());
}

TEST_CASE("a mesh that is one point, or has an estimate or a durability that is no number, is no harm") {
    triangle_surface const point{.positions = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, .triangles = {{0, 1, 2}}};
    hydraulic_run still(point, standing{.at = {{0.05, 0, 0}}}, curvature_erosion<>{});
    CHECK(still.run(3).contacts == 3);
    CHECK(still.surface().positions == point.positions);

    triangle_surface const ground = slope(20, 6);
    vec3 const o = ground.positions[220];
    auto const nothing = [](vec3 const&) { return std::numeric_limits<double>::quiet_NaN(); };
    hydraulic_run run(ground, standing{.at = {o + vec3{0, 0, 0.1}}}, curvature_erosion<>{.durability = any_field(nothing)});
    try {
        run.run(1);
        FAIL("not refused");
    } catch (invalid_input const& e) {
        CHECK(e.code() == errc::out_of_range);
        CHECK(e.place().kind == entity::vertex);
    }
    CHECK(run.surface().positions == ground.positions);
    CHECK(run.report().iterations == 0);
}

namespace {
/// Its reach grows.
struct swelling {
    double wide = 0.05;
    vec3 at{0, 0, 0};
    std::size_t particle_count() const { return 1; }
    vec3 position(std::size_t) const { return at; }
    vec3 velocity(std::size_t) const { return vec3{1, 0, 0}; }
    double reach() const { return wide; }
    double step(fluid_boundary auto const&, executor auto const&) {
        wide *= 10;
        return 0.1;
    }
};
}  // namespace

TEST_CASE("a fluid whose reach grows is asked about as far") {
    triangle_surface const ground = slope(20, 0);
    hydraulic_run run(ground, swelling{.at = vec3{5.1, 5.2, 3}}, partheniades_erosion{});
    CHECK(run.run(1).contacts == 0);
    CHECK(run.run(1).contacts == 1);
}

TEST_CASE("a fluid that does not advance is refused where there is no surface too") {
    struct stuck {
        std::size_t particle_count() const { return 0; }
        vec3 position(std::size_t) const { return vec3{0, 0, 0}; }
        vec3 velocity(std::size_t) const { return vec3{0, 0, 0}; }
        double reach() const { return 1; }
        double step(open_space const&, inline_executor const&) { return std::numeric_limits<double>::quiet_NaN(); }
        double step(mesh_boundary const&, inline_executor const&) { return 0; }
    };
    hydraulic_run empty(triangle_surface{}, stuck{}, partheniades_erosion{});
    CHECK_THROWS_AS(empty.run(1), invalid_input);
    CHECK(empty.report().iterations == 0);
    CHECK(empty.report().time == 0);
    hydraulic_run run(slope(2, 0), stuck{}, partheniades_erosion{});
    CHECK_THROWS_WITH(run.run(1), Catch::Contains("advanced by 0 s"));
}
