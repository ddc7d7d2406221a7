#include "support/curved_surfaces.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/repair/collapse_short_edges.hpp>
#include <tafoni/testing/archetypes.hpp>
#include <tafoni/weathering/curvature_run.hpp>

#include <catch2/catch.hpp>

#include <atomic>
#include <limits>
#include <memory>
#include <stdexcept>

using namespace tafoni;
using namespace tafoni_test;

namespace {

struct stumble : std::runtime_error {
    stumble() : std::runtime_error("stumbled") {}
};
/// Throws at call k, counted over all copies.
struct fuse {
    std::shared_ptr<std::atomic<long>> left = std::make_shared<std::atomic<long>>(std::numeric_limits<long>::max());
    void burn() const {
        if (left->fetch_sub(1) == 1) throw stumble();
    }
};
struct stumbling_estimator {
    fuse at{};
    void operator()(surface_view const& s, std::span<double> mean, executor auto const& x) const {
        tensor_fit{}(s, mean, x);
        at.burn();
    }
};
struct stumbling_direction {
    fuse at{};
    [[nodiscard]] vec3 direction(wear_point const& p) const {
        at.burn();
        return blended_direction{}.direction(p);
    }
};
struct stumbling_field {
    fuse at{};
    double operator()(vec3 const& p) const {
        at.burn();
        return 1 + 0.5 * p[0];
    }
};

/// Long and thin, so that edges collapse on the way.
triangle_surface bar() {
    triangle_surface s = torus_surface(24, 12, 0.3).mesh;
    for (vec3& p : s.positions) p[2] *= 0.3;
    return s;
}
constexpr curvature_options thinning{.small_edge = 0.35, .check_every = 3};

/// A run that throws at every k-th call keeps whole iterations and goes on to the same bits.
template <class Process, class Executor>
void stumbles_well(Process const& process, fuse const& f, long step, Executor const& threads) {
    triangle_surface const s = bar();
    std::vector<triangle_surface> after;
    long const endless = std::numeric_limits<long>::max();
    *f.left = endless;
    {
        curvature_run run(s, process, thinning);
        after.push_back(run.surface());
        for (int k = 0; k < 6; ++k) {
            run.run(1);
            after.push_back(run.surface());
        }
        REQUIRE(run.report().edges_collapsed > 0);
    }
    long const calls = endless - f.left->load();
    REQUIRE(calls >= 6);
    for (long k = 1; k <= calls; k += step) {
        *f.left = endless;
        curvature_run run(s, process, thinning);
        *f.left = k;
        CHECK_THROWS_AS(run.run(6, {}, threads), stumble);
        std::uint64_t const done = run.report().iterations;
        REQUIRE(done < 6);
        REQUIRE(run.surface() == after[done]);
        *f.left = endless;
        run.run(6 - done, {}, threads);
        REQUIRE(run.surface() == after[6]);
    }
}

struct everywhere {
    void operator()(surface_view const&, std::span<double> mean, executor auto const&) const {
        std::fill(mean.begin(), mean.end(), 1.0);
    }
};
/// Pushes the middle of a plate's upper side down, farther than a direction may.
struct punch {
    [[nodiscard]] vec3 direction(wear_point const& at) const {
        double const x = at.position[0] - 0.5;
        double const y = at.position[1] - 0.5;
        return at.normal[2] > 0.5 && x * x + y * y < 0.04 ? vec3{0, 0, -2.5} : vec3{0, 0, 0};
    }
};
struct stumbling_everywhere {
    fuse at{};
    void operator()(surface_view const& s, std::span<double> mean, executor auto const& x) const {
        everywhere{}(s, mean, x);
        at.burn();
    }
};
struct one_bad_number {
    double number = 0;
    std::size_t at = 0;
    void operator()(surface_view const& s, std::span<double> mean, executor auto const& x) const {
        everywhere{}(s, mean, x);
        mean[at] = number;
    }
};
/// Pushes the middle of the upper sheet into the lower one, all the rest sinks.
struct punch_and_sink {
    [[nodiscard]] vec3 direction(wear_point const& at) const {
        vec3 const down = punch{}.direction(at);
        return down[2] < 0 ? vec3{0, 0, -0.4} : vec3{0, 0, -0.05};
    }
};
/// Two sheets of n x n squares, one above the other.
triangle_surface two_sheets(std::uint32_t n, double gap) {
    triangle_surface s;
    for (std::uint32_t level = 0; level < 2; ++level) {
        auto const first = static_cast<std::uint32_t>(s.positions.size());
        for (std::uint32_t j = 0; j <= n; ++j) {
            for (std::uint32_t i = 0; i <= n; ++i) s.positions.push_back(vec3{1.0 * i / n, 1.0 * j / n, gap * level});
        }
        for (std::uint32_t j = 0; j < n; ++j) {
            for (std::uint32_t i = 0; i < n; ++i) {
                std::uint32_t const a = first + i + (n + 1) * j;
                std::uint32_t const d = a + n + 2;
                if (level == 1) {
                    s.triangles.push_back({a, a + 1, d});
                    s.triangles.push_back({a, d, d - 1});
                } else {
                    s.triangles.push_back({a, d, a + 1});
                    s.triangles.push_back({a, d - 1, d});
                }
            }
        }
    }
    return s;
}

/// Thin walls that `punch_and_sink` drives through each other.
triangle_surface pierced() { return two_sheets(10, 0.06); }

}  // namespace

TEST_CASE("whatever a policy throws, whole iterations stay and the run goes on to the same bits") {
    stumbling_estimator const e;
    stumbles_well(curvature_weathering{.estimator = e}, e.at, 1, inline_executor{});
    stumbling_direction const d;
    stumbles_well(curvature_weathering{.direction = d}, d.at, 97, inline_executor{});
    stumbling_field const f;
    stumbles_well(curvature_weathering{.durability = f}, f.at, 97, inline_executor{});
}

TEST_CASE("what a policy throws on a thread arrives once and leaves whole iterations", "[threads]") {
    stumbling_direction const d;
    stumbles_well(curvature_weathering{.direction = d}, d.at, 331, thread_pool(3));
}

TEST_CASE("an observer that throws leaves whole iterations") {
    triangle_surface const s = bar();
    curvature_run whole(s, {}, thinning);
    whole.run(6);
    for (int k = 0; k <= 6; ++k) {
        curvature_run run(s, {}, thinning);
        int ticks = 0;
        run_context context;
        context.on_progress = [&](progress_event const&) {
            if (ticks++ == k) throw stumble();
            return step_control::proceed;
        };
        CHECK_THROWS_AS(run.run(6, context), stumble);
        CHECK(run.report().iterations == static_cast<std::uint64_t>(k));
        run.run(6 - static_cast<std::uint64_t>(k));
        CHECK(run.surface() == whole.surface());
        CHECK(run.report().removed_volume == whole.report().removed_volume);
    }
}

TEST_CASE("a step that makes triangles cut each other is taken back and halved, progress never falls") {
    triangle_surface const s = two_sheets(10, 0.02);
    auto const process = curvature_weathering{.estimator = everywhere{}, .direction = punch{}};
    curvature_run hasty(s, process);
    hasty.run(1);
    CHECK(!self_intersections(hasty.surface().positions, s.triangles).empty());

    curvature_run careful(s, process, {.check_every = 1, .hold_after = 6});  // nothing is held
    double before = 0;
    run_context context;
    context.on_progress = [&](progress_event const& e) {
        CHECK(e.fraction >= before);
        CHECK(e.fraction <= 1);
        before = e.fraction;
        return step_control::proceed;
    };
    curvature_report const once = careful.run(1, context);
    CHECK(once.stopped == curvature_stop::finished);
    CHECK(once.iterations == 1);
    CHECK(once.retries == 1);
    CHECK(once.step == 0.05);
    CHECK(self_intersections(careful.surface().positions, s.triangles).empty());

    before = 0;
    std::uint64_t ticks = 0;
    context.on_progress = [&, check = context.on_progress](progress_event const& e) {
        ++ticks;
        return check(e);
    };
    curvature_report const last = careful.run(100, context);  // the punch comes through in the end
    // No step back loses more than the iteration that went wrong; the start ticks too, the end for good does not.
    CHECK(ticks == last.iterations - once.iterations + last.retries - once.retries);
    CHECK(last.stopped == curvature_stop::self_intersection);
    CHECK(last.retries == 7);
    CHECK(self_intersections(careful.surface().positions, s.triangles).empty());
}

TEST_CASE("where no shorter step helps, what would cut is held still and the rest goes on with the whole step") {
    triangle_surface const s = pierced();
    auto const process = curvature_weathering{.estimator = everywhere{}, .direction = punch_and_sink{}};
    for (mesh_topology const topology : {mesh_topology::keep, mesh_topology::adapt}) {
        curvature_run plain(s, process, {.topology = topology, .check_every = 4, .hold_after = 6});
        CHECK(plain.run(60).stopped == curvature_stop::self_intersection);
        CHECK(plain.report().iterations < 60);
        CHECK(plain.report().held == 0);

        curvature_options const options{.topology = topology, .check_every = 4};
        curvature_run run(s, process, options);
        curvature_report const r = run.run(60);
        CHECK(r.stopped == curvature_stop::finished);
        CHECK(r.iterations == 60);
        CHECK(r.step == 0.1);
        CHECK(r.held > 0);
        CHECK(r.held < s.positions.size() / 2);
        CHECK(self_intersections(run.surface().positions, run.surface().triangles).empty());
        auto const corner = [](auto const& of) { return of.surface().positions[of.new_vertex()[0].value][2]; };
        CHECK(corner(run) < 2 * corner(plain));  // it sinks as far as its iterations take it
        // As many stay where they are as are held, all others sink.
        triangle_surface const before = run.surface();
        run.run(20);
        triangle_surface const after = run.surface();
        REQUIRE(before.positions.size() == after.positions.size());
        std::size_t stayed = 0;
        for (std::size_t v = 0; v < after.positions.size(); ++v) stayed += after.positions[v] == before.positions[v] ? 1U : 0U;
        CHECK(stayed == run.report().held);

        curvature_run threaded(s, process, options);
        threaded.run(80, {}, thread_pool(3));
        CHECK(threaded.checkpoint() == run.checkpoint());

        // New options hold nothing.
        run.replace(options);
        CHECK(run.report().held == 0);
        CHECK(run.report().step == 0.1);
    }
}

TEST_CASE("n then m iterations equal n + m across a hold, wherever a scheduled search ends n, and so do resumed ones") {
    triangle_surface const s = pierced();
    auto const process = curvature_weathering{.estimator = everywhere{}, .direction = punch_and_sink{}};
    curvature_options const options{.check_every = 4};
    curvature_run whole(s, process, options);
    whole.run(40);
    auto const end = whole.checkpoint();
    bool free = false;
    bool held = false;
    bool short_step = false;
    for (std::uint64_t n = 4; n < 40; n += 4) {
        curvature_run parts(s, process, options);
        parts.run(n);
        free = free || parts.report().held == 0;
        held = held || parts.report().held > 0;
        short_step = short_step || (parts.report().held > 0 && parts.report().step < 0.1);
        curvature_run resumed(s, process, options);
        resumed.resume(parts.checkpoint());
        CHECK(resumed.checkpoint() == parts.checkpoint());
        CHECK(resumed.report().held == parts.report().held);
        parts.run(40 - n);
        resumed.run(40 - n);
        CHECK(parts.checkpoint() == end);
        CHECK(resumed.checkpoint() == end);
    }
    CHECK(free);
    CHECK(held);
    CHECK(short_step);
    // Saved by an observer between any two iterations, steps taken back included.
    std::uint64_t const ticks = whole.report().iterations + 4 * whole.report().retries;
    for (std::uint64_t k = 1; k < ticks; k += 3) {
        curvature_run stopped(s, process, options);
        run_context context;
        std::uint64_t seen = 0;
        context.on_progress = [&](progress_event const&) { return ++seen > k ? step_control::stop : step_control::proceed; };
        stopped.run(40, context);
        curvature_run resumed(s, process, options);
        resumed.resume(stopped.checkpoint());
        resumed.run(40 - resumed.report().iterations);
        REQUIRE(resumed.checkpoint() == end);
    }
}

TEST_CASE("what throws between a search and a hold leaves a run that goes on to the same bits") {
    triangle_surface const s = pierced();
    stumbling_everywhere const e;
    auto const process = curvature_weathering{.estimator = e, .direction = punch_and_sink{}};
    long const endless = std::numeric_limits<long>::max();
    curvature_options const options{.check_every = 4};
    curvature_run whole(s, process, options);
    whole.run(24);
    REQUIRE(whole.report().held > 0);
    auto const end = whole.checkpoint();
    long const calls = endless - e.at.left->load();
    for (long k = 1; k <= calls; ++k) {
        *e.at.left = endless;
        curvature_run run(s, process, options);
        *e.at.left = k;
        CHECK_THROWS_AS(run.run(24), stumble);
        *e.at.left = endless;
        run.run(24 - run.report().iterations);
        REQUIRE(run.checkpoint() == end);
    }
}

TEST_CASE("what cut from the start is not held, what cuts later beside it is") {
    triangle_surface s = pierced();
    auto const first = static_cast<std::uint32_t>(s.positions.size());
    for (vec3 const& p : {vec3{2, 0, 0}, vec3{3, 0, 0}, vec3{2, 1, 0}, vec3{2.2, 0.2, -1}, vec3{2.2, 0.2, 1}, vec3{2.4, 0.3, 1}}) s.positions.push_back(p);
    s.triangles.push_back({first, first + 1, first + 2});
    s.triangles.push_back({first + 3, first + 4, first + 5});
    REQUIRE(self_intersections(s.positions, s.triangles).size() == 1);
    curvature_run run(s, curvature_weathering{.estimator = everywhere{}, .direction = punch_and_sink{}},
                      {.topology = mesh_topology::keep, .check_every = 4});
    curvature_report const r = run.run(40);
    CHECK(r.stopped == curvature_stop::finished);
    CHECK(r.held > 0);
    triangle_surface const end = run.surface();
    CHECK(self_intersections(end.positions, end.triangles).size() == 1);
    run.run(8);
    for (std::size_t v = first; v < s.positions.size(); ++v) CHECK(run.surface().positions[v] != end.positions[v]);  // sinks
}

TEST_CASE("edges at fixed vertices are not collapsed, others are") {
    triangle_surface const ball = triangles_of(icosphere(2));
    std::vector<unsigned char> fixed(ball.positions.size(), 0);
    for (std::size_t v = 0; v < fixed.size(); ++v) fixed[v] = ball.positions[v][2] > 0 ? 1 : 0;
    triangle_surface s = ball;
    collapse_report const r = detail::collapse_short_edges_fn::trusted(s, 0.4, nullptr, fixed);
    CHECK(r.collapsed > 10);
    std::vector<int> parts(s.positions.size(), 0);
    for (vertex_index const v : r.new_vertex) ++parts[v.value];
    for (std::size_t v = 0; v < fixed.size(); ++v) {
        if (fixed[v] == 0) continue;
        CHECK(s.positions[r.new_vertex[v].value] == ball.positions[v]);
        CHECK(parts[r.new_vertex[v].value] == 1);
    }
    vertex_rings const rings(ball.positions.size(), ball.triangles);
    auto const edges = detail::measure_edges(ball.positions, rings, inline_executor{});
    auto const found = detail::edges_below(edges, 0.4, ball.positions, rings);
    CHECK(detail::any_may_collapse(found, ball.positions, ball.triangles, rings, fixed));
    fixed.assign(fixed.size(), 1);
    CHECK_FALSE(detail::any_may_collapse(found, ball.positions, ball.triangles, rings, fixed));
}

TEST_CASE("searches between the ends of runs do not depend on where runs end") {
    triangle_surface const s = two_sheets(10, 0.05);
    auto const process = curvature_weathering{.estimator = everywhere{}, .direction = punch{}};
    curvature_run once(s, process, {.check_every = 4});
    once.run(6);
    curvature_run twice(s, process, {.check_every = 4});
    twice.run(1);
    twice.run(5);
    CHECK(once.report().retries > 0);
    CHECK(once.surface() == twice.surface());
    CHECK(once.report().retries == twice.report().retries);
}

TEST_CASE("a policy that leaves the numbers is named with the vertex, and nothing has moved") {
    struct nowhere {
        [[nodiscard]] vec3 direction(wear_point const& at) const {
            return vec3{at.position[0] > 0.9 ? std::numeric_limits<double>::quiet_NaN() : 0.0, 0, 1};
        }
    };
    triangle_surface const s = triangles_of(icosphere(2));
    curvature_run run(s, curvature_weathering{.direction = nowhere{}});
    CHECK_THROWS_WITH(run.run(3), Catch::Contains("curvature_run") && Catch::Contains("vertex"));
    CHECK(run.surface() == s);
    CHECK(run.report().iterations == 0);
    struct unknown {
        double operator()(vec3 const&) const { return std::numeric_limits<double>::quiet_NaN(); }
    };
    curvature_run soft(s, curvature_weathering{.durability = unknown{}});
    CHECK_THROWS_AS(soft.run(1), invalid_input);
    for (double const bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity()}) {
        for (std::size_t const at : {std::size_t{0}, std::size_t{7}, s.positions.size() - 1}) {
            curvature_run lost(s, curvature_weathering{.estimator = one_bad_number{bad, at}});
            try {
                lost.run(1);
                FAIL("accepted");
            } catch (invalid_input const& e) {
                CHECK(e.place().kind == entity::vertex);
                CHECK(e.place().index == at);
                CHECK_THAT(e.what(), Catch::Contains("curvature_run") && Catch::Contains("estimator") &&
                                         Catch::Contains("vertex " + std::to_string(at)));
            }
            CHECK(lost.surface() == s);
        }
    }
}

TEST_CASE("the offset of a sphere has the radius R - d and its volume, with order two") {
    double before = 0;
    for (int level : {3, 4}) {
        triangle_surface const s = sphere(level).mesh;
        double const d = 3 * s.mean_edge_length() / 20;
        curvature_run run(s, curvature_weathering{.direction = inward_normal{}}, {.step_divisor = 20});
        double const start = 4 * 3.14159265358979 / 3;
        double at = 1;
        for (int k = 0; k < 3; ++k) {
            at -= run.surface().mean_edge_length() / 20;
            run.run(1);
        }
        for (vec3 const& p : run.surface().positions) REQUIRE(length(p) == Approx(at).epsilon(1e-9));
        double const error = std::fabs(run.report().removed_volume - start * (1 - at * at * at)) / start;
        CHECK(error < 0.2 * d);
        if (before > 0) CHECK(error < before / 6);  // order two, of a volume that itself halves
        before = error;
    }
}

TEST_CASE("archetypes of the policies weather") {
    triangle_surface const s = triangles_of(icosphere(2));
    auto const process = curvature_weathering{.estimator = archetypes::estimator(0), .direction = archetypes::heading(0),
                                              .durability = archetypes::field(0)};
    curvature_run run(s, process, {.check_every = 1});
    CHECK(run.run(2, {}, archetypes::executor(0)).iterations == 2);
    CHECK(run.curvature(archetypes::executor(0)).size() == run.surface().positions.size());
}

TEST_CASE("the least meshes have nothing to wear, or wear without harm") {
    triangle_surface const point{.positions = {vec3{1, 2, 3}}, .triangles = {}};
    triangle_surface const one{.positions = {vec3{0, 0, 0}, vec3{1, 0, 0}, vec3{0, 1, 0}}, .triangles = {{0, 1, 2}}};
    triangle_surface twice = one;
    twice.triangles.push_back({0, 1, 2});
    twice.triangles.push_back({0, 2, 1});
    triangle_surface flat = triangles_of(icosphere(1));
    for (vec3& p : flat.positions) p[2] = 0;
    triangle_surface thick = triangles_of(icosphere(1));  // a book: five pages on one spine
    for (std::uint32_t k = 0; k < 5; ++k) {
        thick.positions.push_back(vec3{2, 1.0 * k, 1.0});
        thick.triangles.push_back({0, 1, 42 + k});
    }
    for (triangle_surface const& s : {triangle_surface{}, point, one, twice, flat, thick}) {
        for (mesh_topology const topology : {mesh_topology::keep, mesh_topology::adapt}) {
            curvature_run run(s, curvature_weathering{.direction = blended_direction{}},
                              {.topology = topology, .check_every = 2});
            run.run(7);
            for (vec3 const& p : run.surface().positions) CHECK(is_finite(p));
            CHECK(std::isfinite(run.report().removed_volume));
            CHECK(run.new_vertex().size() == s.positions.size());
        }
    }
}
