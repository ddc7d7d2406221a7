#include "support/water_scenes.hpp"

#include <tafoni/fluid/rain_particles.hpp>
#include <tafoni/fluid/sph.hpp>
#include <tafoni/geometry/indexed_mesh.hpp>
#include <tafoni/testing/exchange_laws.hpp>
#include <tafoni/testing/fluid_archetypes.hpp>
#include <tafoni/weathering/hydraulic_run.hpp>

#include <catch2/catch.hpp>

#include <limits>
#include <stdexcept>

using namespace tafoni;
using namespace tafoni_test;

namespace {

rain_particles rain_over(double drop) {
    return rain_particles({.box = between(vec3{1.5, 1.5, 0.5}, vec3{8, 8.5, 2})},
                          {.keep = between(vec3{1, 1, -drop - 1}, vec3{9, 9, 5})}, {.particles = 300, .radius = 0.3, .seed = 3});
}

/// Particles that slide straight on; may throw at a step.
struct sliding {
    std::vector<vec3> at{};
    vec3 speed{0, 0, 0};
    int throws_at = -1;
    int steps = 0;
    std::size_t particle_count() const { return at.size(); }
    vec3 position(std::size_t i) const { return at[i]; }
    vec3 velocity(std::size_t) const { return speed; }
    double reach() const { return 0.3; }
    double step(fluid_boundary auto const&, executor auto const&) {
        if (steps == throws_at) {
            throws_at = -1;
            throw std::runtime_error("fluid");
        }
        ++steps;
        for (vec3& p : at) p += 0.1 * speed;
        return 0.1;
    }
};
/// With numbers that go round with every step.
struct going_round : sliding {
    std::size_t turn = 0;
    std::uint64_t id(std::size_t i) const { return (i + turn) % at.size(); }
    vec3 position(std::size_t i) const { return at[id(i)]; }
    double step(fluid_boundary auto const& walls, executor auto const& x) {
        turn += 7;
        return sliding::step(walls, x);
    }
};
/// Half of it is gone after a while.
struct melting : sliding {
    std::size_t particle_count() const { return steps < 20 ? at.size() : at.size() / 2; }
};
struct stuck : sliding {
    double step(fluid_boundary auto const&, executor auto const&) { return 0; }
};
sliding swarm(int n) {
    sliding s{.at = {}, .speed = vec3{0.7, 0.2, -0.1}};
    stream random(4, 0, 0);
    for (int k = 0; k < n; ++k) {
        double const x = random.uniform(2, 7);
        double const y = random.uniform(2, 7);
        double const z = random.uniform(0, 0.2);
        s.at.push_back(vec3{x, y, z - 0.1 * x});
    }
    return s;
}
/// Throws when its count of calls runs out.
struct fragile {
    int* left;
    double rate(wash_point const& at) const {
        if (--*left == 0) throw std::runtime_error("rule");
        return 1e-4 * length(at.velocity);
    }
};
struct fragile_estimator {
    int* left = nullptr;
    void operator()(surface_view const& s, std::span<double> mean, executor auto const& x) const {
        if (left != nullptr && --*left == 0) throw std::runtime_error("estimator");
        tensor_fit{}(s, mean, x);
    }
};

bool same(hydraulic_report const& a, hydraulic_report const& b) {
    return a.iterations == b.iterations && a.time == b.time && a.contacts == b.contacts && a.ledger.eroded == b.ledger.eroded &&
           a.ledger.deposited == b.ledger.deposited && a.ledger.carried == b.ledger.carried && a.ledger.left == b.ledger.left;
}
template <class Run>
bool same_state(Run const& a, Run const& b) {
    return a.surface().positions == b.surface().positions && a.surface().triangles == b.surface().triangles &&
           std::equal(a.wear().begin(), a.wear().end(), b.wear().begin(), b.wear().end()) &&
           std::equal(a.flow().begin(), a.flow().end(), b.flow().begin(), b.flow().end()) && a.sediment() == b.sediment() &&
           same(a.report(), b.report());
}

}  // namespace

TEST_CASE("eroded is deposited and carried and left, exactly, after every iteration") {
    auto const exact = [](auto run) {
        for (int k = 0; k < 60; ++k) {
            sediment_ledger const l = run.run(1).ledger;
            REQUIRE(l.eroded == l.deposited + l.carried + l.left);
            REQUIRE(run.balanced());
        }
        CHECK(run.report().ledger.eroded > 0);
    };
    triangle_surface const s = slope(14, 5);
    sph<float> const water({.box = between(vec3{2, 2, 0}, vec3{4, 8, 1}), .velocity = vec3{2, 0, -4}},
                           {.keep = between(vec3{0, 0, -7}, vec3{10, 10, 9})}, {.particles = 300, .spacing = 0.5, .sound_speed = 40});
    partheniades_erosion const rule{.coefficient = 2e-3, .critical = 3};
    exact(hydraulic_run(s, rain_over(5), rule));
    exact(hydraulic_run(s, water, rule));
    exact(hydraulic_run(s, rain_over(5), curvature_erosion<>{}));
    exact(hydraulic_run(s, water, curvature_erosion<>{}));
}

TEST_CASE("who carries nothing lays down nothing, and who does, no more than that") {
    struct greedy {
        double rate(wash_point const& at) const { return at.position[0] < 5 ? 1e-4 : -1e9; }
    };
    triangle_surface const s = slope(20, 0);
    sliding empty{.at = {vec3{6, 5, 0.1}, vec3{7, 3, 0.1}}, .speed = vec3{0.5, 0, 0}};
    hydraulic_run nothing(s, empty, greedy{});
    nothing.run(10);
    CHECK(nothing.surface().positions == s.positions);
    CHECK(nothing.report().ledger.deposited == 0);

    sliding full{.at = {vec3{4, 5.1, 0.1}, vec3{4.5, 3.2, 0.1}}, .speed = vec3{0.5, 0, 0}};
    hydraulic_run moves(s, full, greedy{});
    double most = 0;
    for (int k = 0; k < 60; ++k) {
        sediment_ledger const l = moves.run(1).ledger;
        CHECK(l.deposited <= l.eroded);
        most = std::max(most, l.eroded);
    }
    sediment_ledger const l = moves.report().ledger;
    CHECK(most > 0);
    CHECK(l.deposited == Approx(l.eroded));
    CHECK(l.carried == Approx(0).margin(1e-9 * most));
    double lowest = 0;
    for (std::size_t v = 0; v < s.positions.size(); ++v) {
        double const z = moves.surface().positions[v][2];
        lowest = std::min(lowest, z);
        if (s.positions[v][0] < 4) CHECK(z <= 0);
    }
    CHECK(lowest < 0);
}

TEST_CASE("a turned scene erodes alike") {
    triangle_surface const s = slope(16, 1);
    sliding const water = swarm(200);
    auto const turned = [](vec3 const& p) { return vec3{p[1], p[2], p[0]}; };
    triangle_surface t = s;
    for (vec3& p : t.positions) p = turned(p);
    sliding turned_water = water;
    for (vec3& p : turned_water.at) p = turned(p);
    turned_water.speed = turned(water.speed);
    auto const alike = [&](auto const& process) {
        hydraulic_run a(s, water, process);
        hydraulic_run b(t, turned_water, process);
        a.run(1);
        b.run(1);
        CHECK(a.surface().positions != s.positions);
        double worst = 0;
        for (std::size_t v = 0; v < s.positions.size(); ++v) {
            worst = std::max(worst, length(turned(a.surface().positions[v]) - b.surface().positions[v]));
        }
        CHECK(worst < 1e-11);  // 1e-12 of the scene
    };
    alike(partheniades_erosion{.coefficient = 1e-3, .critical = 0.1});
    alike(curvature_erosion<>{.influence = 1});
}

TEST_CASE("particles keep what they carry when a fluid numbers them anew, and what is gone has left") {
    // Takes on one half, lays down on the other.
    struct ferry {
        double rate(wash_point const& at) const { return at.position[0] < 5 ? 1e-4 : -1e-4; }
    };
    triangle_surface const s = slope(12, 1);
    going_round round;
    round.at = swarm(60).at;
    round.speed = swarm(60).speed;
    hydraulic_run straight(s, swarm(60), ferry{});
    hydraulic_run turned(s, round, ferry{});
    straight.run(40);
    turned.run(40);
    CHECK(straight.report().ledger.deposited > 0);
    CHECK(turned.surface().positions == straight.surface().positions);
    CHECK(turned.sediment() == straight.sediment());
    CHECK(turned.report().ledger.left == 0);
    CHECK(turned.report().ledger.carried == straight.report().ledger.carried);
    melting some;
    some.at = round.at;
    some.speed = round.speed;
    hydraulic_run less(s, some, ferry{});
    CHECK(less.run(19).ledger.left == 0);
    double const before = less.report().ledger.carried;
    CHECK(less.run(2).ledger.left > 0);
    CHECK(less.report().ledger.left < before);
    CHECK(less.balanced());
}

TEST_CASE("every parameter of the shear stress may be a field") {
    triangle_surface const s = slope(20, 0);
    sliding water{.at = {}, .speed = vec3{0.01, 0, 0}};
    for (int i = 0; i < 20; ++i) {
        for (int j = 0; j < 20; ++j) water.at.push_back(vec3{0.26 + 0.5 * i, 0.26 + 0.5 * j, 0.1});
    }
    water.speed = vec3{2, 0, 0};
    struct halves {
        double low;
        double high;
        double operator()(vec3 const& p) const { return p[0] < 5 ? low : high; }
    };
    std::vector<partheniades_erosion> const rules{
        {.coefficient = halves{1e-3, 1e-5}, .critical = 1},
        {.coefficient = 1e-4, .critical = halves{1, 19}},
        {.coefficient = 1e-4, .critical = 1, .exponent = halves{1.5, 0.5}},
        {.coefficient = 1e-4, .critical = 1, .consistency = halves{1, 0.1}},
        {.coefficient = 1e-4, .critical = 1, .power = halves{1, 0.3}},
    };
    for (auto const& rule : rules) {
        hydraulic_run run(s, water, rule);
        run.run(2);
        double soft = 0;
        double hard = 0;
        for (std::size_t v = 0; v < s.positions.size(); ++v) (s.positions[v][0] < 5 ? soft : hard) += run.wear()[v];
        CHECK(soft > 4 * hard);
    }
}

TEST_CASE("what throws leaves the last whole iteration, and the next run goes on from there") {
    triangle_surface const s = slope(12, 1);
    int never = -1;
    {
        hydraulic_run whole(s, swarm(60), fragile{&never});
        whole.run(8);
        for (int call : {1, 40, 150, 333}) {
            int left = call;
            hydraulic_run run(s, swarm(60), fragile{&left});
            CHECK_THROWS_WITH(run.run(8), "rule");
            hydraulic_run before(s, swarm(60), fragile{&never});
            before.run(run.report().iterations);
            CHECK(same_state(run, before));
            run.run(8 - run.report().iterations);
            CHECK(same_state(run, whole));
        }
    }
    {
        curvature_erosion<fragile_estimator> const process{.influence = 1};
        hydraulic_run whole(s, swarm(60), process);
        whole.run(6);
        int left = 4;
        hydraulic_run run(s, swarm(60), curvature_erosion<fragile_estimator>{.estimator = {&left}, .influence = 1});
        CHECK_THROWS_WITH(run.run(6), "estimator");
        CHECK(run.report().iterations == 3);
        run.run(3);
        CHECK(same_state(run, whole));
    }
    {
        sliding water = swarm(60);
        hydraulic_run whole(s, water, fragile{&never});
        whole.run(6);
        water.throws_at = 2;
        hydraulic_run run(s, water, fragile{&never});
        CHECK_THROWS_WITH(run.run(6), "fluid");
        CHECK(run.report().iterations == 2);
        run.run(4);
        CHECK(same_state(run, whole));
    }
}

TEST_CASE("an observer stops a run after a whole iteration, and may throw") {
    triangle_surface const s = slope(12, 1);
    partheniades_erosion const rule{.coefficient = 1e-3, .critical = 0.1};
    hydraulic_run whole(s, swarm(60), rule);
    whole.run(10);
    hydraulic_run run(s, swarm(60), rule);
    int calls = 0;
    double last = -1;
    run_context context;
    context.on_progress = [&](progress_event const& e) {
        CHECK(e.fraction >= last);
        last = e.fraction;
        return ++calls == 5 ? step_control::stop : step_control::proceed;
    };
    hydraulic_report const r = run.run(10, context);
    CHECK(r.stopped == hydraulic_stop::observer);
    CHECK(r.iterations == 4);
    context.on_progress = [&](progress_event const&) -> step_control { throw std::runtime_error("observer"); };
    CHECK_THROWS_WITH(run.run(6, context), "observer");
    CHECK(run.report().iterations == 4);
    CHECK(run.run(6).stopped == hydraulic_stop::finished);
    CHECK(same_state(run, whole));
}

TEST_CASE("odd meshes erode without a number that is none") {
    auto const finite = [](auto run) {
        run.run(12);
        CHECK(run.report().iterations == 12);
        CHECK(run.balanced());
        for (vec3 const& p : run.surface().positions) REQUIRE(is_finite(p));
        for (double const w : run.wear()) REQUIRE(std::isfinite(w));
    };
    triangle_surface odd = slope(8, 1);
    odd.positions.push_back(vec3{3, 3, 4});  // of no face
    auto const lone = static_cast<std::uint32_t>(odd.positions.size() - 1);
    odd.positions.push_back(odd.positions[30]);  // twice at one place
    odd.triangles.push_back({30, lone + 1, 31});
    odd.triangles.push_back({10, 10, 11});
    odd.triangles.push_back({20, 21, 22});  // in a line
    odd.triangles.push_back(odd.triangles[5]);
    triangle_surface const empty;
    triangle_surface const points{.positions = {vec3{0, 0, 0}, vec3{1, 2, 3}}, .triangles = {}};
    triangle_surface const one{.positions = {vec3{0, 0, 0}, vec3{9, 0, 0}, vec3{0, 9, 0}}, .triangles = {{0, 1, 2}}};
    triangle_surface const speck{.positions = {vec3{5, 5, 0}, vec3{5, 5, 0}, vec3{5, 5, 0}}, .triangles = {{0, 1, 2}}};
    for (triangle_surface const& s : {odd, empty, points, one, speck}) {
        finite(hydraulic_run(s, swarm(80), partheniades_erosion{.coefficient = 1e-3, .critical = 0.1}, {.refine_length = 1, .refine_every = 4}));
        finite(hydraulic_run(s, swarm(80), curvature_erosion<>{.influence = 1}));
    }
    triangle_surface broken = one;
    broken.triangles[0][2] = 7;
    CHECK_THROWS_AS(hydraulic_run(broken, swarm(1), curvature_erosion<>{}), invalid_input);
    broken = one;
    broken.positions[1][0] = std::numeric_limits<double>::infinity();
    CHECK_THROWS_AS(hydraulic_run(broken, swarm(1), curvature_erosion<>{}), invalid_input);
}

TEST_CASE("a fluid that does not advance and a rule without an answer are refused") {
    stuck s;
    s.at = {vec3{5, 5, 0.1}};
    hydraulic_run run(slope(4, 0), s, partheniades_erosion{});
    CHECK_THROWS_WITH(run.run(1), Catch::Contains("advanced by 0"));
    struct blind {
        double rate(wash_point const&) const { return std::numeric_limits<double>::quiet_NaN(); }
    };
    hydraulic_run unsure(slope(4, 0), sliding{.at = {vec3{5.1, 5.2, 0.1}}}, blind{});
    CHECK_THROWS_WITH(unsure.run(1), Catch::Contains("rule"));
}

TEST_CASE("a mesh of polygons that are triangles erodes as they do, one of others is refused by its face") {
    triangle_surface const s = slope(12, 1);
    indexed_mesh m;
    m.positions = s.positions;
    for (auto const& t : s.triangles) m.add_face({t[0], t[1], t[2]});
    partheniades_erosion const rule{.coefficient = 1e-3, .critical = 0.1};
    hydraulic_run a(s, swarm(60), rule);
    hydraulic_run b(m, swarm(60), rule);
    a.run(5);
    b.run(5);
    CHECK(a.report().ledger.eroded > 0);
    CHECK(same_state(a, b));
    m.add_face({0, 1, 14, 13});
    CHECK_THROWS_WITH(hydraulic_run(m, swarm(60), rule), Catch::Contains("face 288 has 4 corners"));
}

TEST_CASE("the least rule erodes, and rules keep their laws") {
    hydraulic_run run(slope(20, 0), archetypes::fluid(0), archetypes::exchange(0));
    CHECK(run.run(20).ledger.eroded > 0);
    CHECK(run.balanced());
    CHECK(laws::exchange(archetypes::exchange(0)).empty());
    CHECK(laws::exchange(partheniades_erosion{}).empty());
    CHECK(laws::exchange(partheniades_erosion{.critical = 3, .exponent = 0.5, .power = 1.7}, 1e-3).empty());
    struct steep {  // infinite at the face
        double rate(wash_point const& at) const { return 1 / at.distance; }
    };
    CHECK(laws::exchange(steep{}) == std::vector<std::string>{"rates are finite"});
    struct moody {
        mutable int asked = 0;
        double rate(wash_point const&) const { return ++asked; }
    };
    CHECK(laws::exchange(moody{}) == std::vector<std::string>{"pure: equal questions get equal answers", "a copy answers as the original"});
}

TEST_CASE("the least fluid erodes") {
    hydraulic_run run(slope(20, 0), archetypes::fluid(0), partheniades_erosion{.coefficient = 1e-3, .critical = 0.1});
    CHECK(run.run(20).ledger.eroded > 0);
    CHECK(run.balanced());
}

TEST_CASE("models too large or too small to be touched are refused by vertex or reach before anything wears") {
    sliding water{.at = {vec3{0, 0, 0}}, .speed = vec3{1, 0, 0}};
    triangle_surface vast = slope(4, 1);
    vast.positions[7][1] = -1e60;
    hydraulic_run run(vast, water, curvature_erosion<>{});
    CHECK_THROWS_WITH(run.run(1), Catch::Contains("vertex 7") && Catch::Contains("1e50"));
    CHECK(run.report().iterations == 0);
    CHECK(run.surface().positions == vast.positions);
    triangle_surface const s = slope(4, 1);
    for (double const reach : {0.0, 1e-60, 1e60, std::numeric_limits<double>::quiet_NaN()}) {
        CHECK_THROWS_WITH(mesh_boundary(s.positions, s.triangles, reach), Catch::Contains("reach"));
    }
    // What is within touches as ever.
    for (double const unit : {1e-45, 1e45}) {
        triangle_surface scaled = s;
        for (vec3& p : scaled.positions) p *= unit;
        mesh_boundary const walls(scaled.positions, scaled.triangles, 0.3 * unit);
        int met = 0;
        vec3 const over{5.1 * unit, 5.2 * unit, -0.4 * unit};
        walls.for_each_contact(over, 0.3 * unit, [&](boundary_contact const& c) {
            ++met;
            CHECK(c.distance == Approx(0.11 * unit / std::sqrt(1.01)).margin(0));
        });
        CHECK(met == 1);
    }
}
