#include "support/water_scenes.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/fluid/mesh_boundary.hpp>
#include <tafoni/fluid/rain_particles.hpp>

#include <catch2/catch.hpp>

#include <limits>
#include <set>

using namespace tafoni;
using namespace tafoni_test;

namespace {

triangle_surface floor_at(double slope) {
    return parametric(
               9, 9, false, false, 0,
               [=](double u, double v) { return vec3{20 * u - 10, 20 * v - 10, -slope * (20 * u - 10)}; },
               [](double, double) { return 0.0; })
        .mesh;
}

}  // namespace

TEST_CASE("a drop in open space falls as the parabola says") {
    rain_particles rain({.box = between(vec3{0, 0, 100}, vec3{0, 0, 100}), .velocity = vec3{3, 0, 0}},
                        {.keep = between(vec3{-1e3, -1e3, -1e3}, vec3{1e3, 1e3, 1e3})},
                        {.particles = 1, .radius = 0.01, .gravity = vec3{0, 0, -10}});
    double t = 0;
    for (int k = 0; k < 400; ++k) t += rain.step(open_space{}, inline_executor{});
    CHECK(rain.position(0)[0] == Approx(3 * t));
    CHECK(rain.velocity(0)[2] == Approx(-10 * t));
    CHECK(rain.position(0)[2] == Approx(100 - 5 * t * t).epsilon(0.01));
}

TEST_CASE("in a frame each drop takes the steps that it needs") {
    rain_options o{.particles = 200, .radius = 0.1, .gravity = vec3{0, 0, -10}, .frame = 0.5};
    box_sink const keep{.keep = between(vec3{-1e3, -1e3, -1e3}, vec3{1e3, 1e3, 1e3})};
    rain_particles falling({.box = between(vec3{0, 0, 100}, vec3{0, 0, 100}), .velocity = vec3{3, 0, 0}}, keep, o);
    for (int k = 0; k < 4; ++k) REQUIRE(falling.step(open_space{}, inline_executor{}) == 0.5);
    CHECK(falling.position(7)[0] == Approx(6));
    CHECK(falling.velocity(7)[2] == Approx(-20));
    CHECK(falling.position(7)[2] == Approx(80).epsilon(0.001));

    // The same water as step by step: none falls through, and slow drops rest where they do.
    triangle_surface const ground = floor_at(0.5);
    mesh_boundary const walls(ground.positions, ground.triangles, 0.1);
    box_emitter const from{.box = between(vec3{-8, -6, 5}, vec3{-5, 6, 8})};
    rain_particles by_frames(from, keep, o);
    o.frame = 0;
    rain_particles by_steps(from, keep, o);
    double t = 0;
    while (t < 1.5) t += by_steps.step(walls, inline_executor{});
    for (int k = 0; k < 3; ++k) by_frames.step(walls, inline_executor{});
    for (std::size_t i = 0; i < 200; ++i) {
        CHECK(by_frames.position(i)[2] + 0.5 * by_frames.position(i)[0] > 0);
        CHECK(length(by_frames.position(i) - by_steps.position(i)) < 0.3);
    }

    o.frame = 1e9;
    rain_particles endless({.box = from.box, .velocity = vec3{1e6, 0, 0}}, keep, o);
    vec3 const before = endless.position(3);
    CHECK_THROWS_WITH(endless.step(walls, inline_executor{}), Catch::Contains("10^6 steps"));
    CHECK(endless.position(3) == before);
}

TEST_CASE("drops land, do not pass through, and run downhill") {
    triangle_surface const ground = floor_at(0.5);
    mesh_boundary const walls(ground.positions, ground.triangles, 0.3);
    rain_particles rain({.box = between(vec3{-8, -6, 5}, vec3{-5, 6, 7})}, {.keep = between(vec3{-9, -9, -9}, vec3{9, 9, 9})},
                        {.particles = 300, .radius = 0.3, .gravity = vec3{0, 0, -10}});
    double moved = 0;
    double lowest = 1e9;
    std::set<std::uint64_t> ids;
    for (int k = 0; k < 1200; ++k) {
        rain.step(walls, inline_executor{});
        for (std::size_t i = 0; i < rain.particle_count(); ++i) {
            vec3 const p = rain.position(i);
            lowest = std::min(lowest, p[2] + 0.5 * p[0]);
            moved = std::max(moved, p[0]);
            ids.insert(rain.id(i));
        }
    }
    CHECK(lowest > 0);    // above the plane
    CHECK(moved > 5);     // and down it
    CHECK(ids.size() > 300);  // those that left came again as others
}

TEST_CASE("a drop that meets flat ground rests on it") {
    triangle_surface const ground = floor_at(0);
    mesh_boundary const walls(ground.positions, ground.triangles, 0.2);
    rain_particles rain({.box = between(vec3{0.3, 0.2, 1}, vec3{0.3, 0.2, 1})}, {.keep = between(vec3{-9, -9, -9}, vec3{9, 9, 9})},
                        {.particles = 1, .radius = 0.2, .lifetime = 1e6});
    for (int k = 0; k < 2000; ++k) rain.step(walls, inline_executor{});
    CHECK(rain.position(0)[2] > 0.05);
    CHECK(rain.position(0)[2] < 0.2);
    CHECK(rain.position(0)[0] == Approx(0.3));
}

/// n . g / |g| where each of twenty drops, let go on top of a ball, was last at rest on it.
std::vector<double> left_ball_at(double wide, double friction, double adhesion, double r) {
    triangle_surface const ball = sphere(4).mesh;
    mesh_boundary const walls(ball.positions, ball.triangles, r);
    double const top = 1 + 0.5 * r;
    rain_particles rain({.box = between(vec3{-wide, -wide, top}, vec3{wide, wide, top})}, {.keep = between(vec3{-3, -3, -1.3}, vec3{3, 3, 3})},
                        {.particles = 20, .radius = r, .gravity = vec3{0, 0, -10}, .friction = friction, .adhesion = adhesion});
    std::vector<double> last(20, -2);
    for (bool any = true; any;) {
        rain.step(walls, inline_executor{});
        any = false;
        for (std::size_t i = 0; i < 20; ++i) {
            if (rain.id(i) >= 20) continue;
            any = true;
            vec3 const p = rain.position(i);
            if (length(p) < 1 + 0.53 * r) last[rain.id(i)] = -p[2] / length(p);
        }
    }
    return last;
}

TEST_CASE("slow drops run round a ball to where adhesion no longer holds them, n . g = adhesion |g|") {
    for (double const adhesion : {0.0, 0.3, 0.6, 0.9}) {
        for (double const at : left_ball_at(0.4, 40, adhesion, 0.03)) {
            CHECK(at > adhesion);
            CHECK(at < adhesion + 0.06);
        }
    }
}

TEST_CASE("fast drops leave a ball where n . g + v^2 / R = adhesion |g|") {
    for (double const adhesion : {0.0, 0.5, 0.8}) {
        double sum = 0;
        for (double const at : left_ball_at(0.05, 0, adhesion, 0.03)) {
            sum += at;
            CHECK(at == Approx(-(2 - adhesion) / 3).margin(0.15));  // each at the edge of a face
        }
        CHECK(sum / 20 == Approx(-(2 - adhesion) / 3).margin(0.04));  // v^2 = 2 g R (1 - cos)
    }
}

TEST_CASE("a drop hangs below what overhangs wholly where adhesion is more than gravity, and dries there") {
    triangle_surface const ball = sphere(4).mesh;
    double const r = 0.03;
    mesh_boundary const walls(ball.positions, ball.triangles, r);
    rain_particles rain({.box = between(vec3{0.1, 0.1, 1.05}, vec3{0.4, 0.4, 1.05})}, {.keep = between(vec3{-3, -3, -3}, vec3{3, 3, 3})},
                        {.particles = 20, .radius = r, .friction = 20, .adhesion = 1.1, .lifetime = 30});
    double t = 0;
    while (t < 29) t += rain.step(walls, inline_executor{});
    for (std::size_t i = 0; i < 20; ++i) {
        CHECK(rain.id(i) < 20);
        CHECK(rain.position(i)[2] == Approx(-1 - 0.5 * r).margin(0.003));
    }
    while (t < 31) t += rain.step(walls, inline_executor{});
    for (std::size_t i = 0; i < 20; ++i) CHECK(rain.id(i) >= 20);
}

TEST_CASE("a drop inside the rock comes out by half its radius a step, and rests at half of it") {
    triangle_surface const ground = floor_at(0);
    mesh_boundary const walls(ground.positions, ground.triangles, 0.2);
    rain_particles rain({.box = between(vec3{0.3, 0.2, -0.15}, vec3{0.3, 0.2, -0.15})}, {.keep = between(vec3{-9, -9, -9}, vec3{9, 9, 9})},
                        {.particles = 1, .radius = 0.2, .lifetime = 1e6});
    rain.step(walls, inline_executor{});
    CHECK(rain.position(0)[2] == Approx(-0.05));
    rain.step(walls, inline_executor{});
    CHECK(rain.position(0)[2] == Approx(0.05));
    rain.step(walls, inline_executor{});
    for (int k = 0; k < 50; ++k) {
        CHECK(rain.position(0)[2] == Approx(0.1));
        rain.step(walls, inline_executor{});
    }
}

TEST_CASE("between two walls the nearer one holds a drop") {
    // A floor at 0 and a ceiling at 0.25, in both orders.
    for (bool const ceiling_first : {false, true}) {
        triangle_surface s{.positions = {vec3{-9, -9, 0}, vec3{9, -9, 0}, vec3{0, 9, 0}, vec3{-9, -9, 0.25}, vec3{9, -9, 0.25}, vec3{0, 9, 0.25}},
                           .triangles = {{0, 1, 2}, {3, 5, 4}}};
        if (ceiling_first) std::swap(s.triangles[0], s.triangles[1]);
        mesh_boundary const walls(s.positions, s.triangles, 0.2);
        for (double const from : {0.12, 0.14}) {
            vec3 const at{0, -1, from};
            rain_particles rain({.box = between(at, at)}, {.keep = between(vec3{-9, -9, -9}, vec3{9, 9, 9})},
                                {.particles = 1, .radius = 0.2, .adhesion = 5, .largest_step = 0.01});
            for (int k = 0; k < 40; ++k) rain.step(walls, inline_executor{});
            CHECK(rain.position(0)[2] == Approx(from < 0.125 ? 0.1 : 0.15));
        }
    }
}

TEST_CASE("no drop moves farther than half its radius, and half of it towards the ground") {
    triangle_surface const ball = sphere(3).mesh;
    mesh_boundary const walls(ball.positions, ball.triangles, 0.1);
    rain_particles rain({.box = between(vec3{-1, -1, 1}, vec3{1, 1, 3}), .velocity = vec3{0, 0, -4}}, {.keep = between(vec3{-2, -2, -2}, vec3{2, 2, 4})},
                        {.particles = 60, .radius = 0.1, .adhesion = 3});
    for (int k = 0; k < 200; ++k) {
        double const dt = rain.step(walls, inline_executor{});
        for (std::size_t i = 0; i < 60; ++i) REQUIRE(length(rain.velocity(i)) * dt <= 0.05 * 1.4143);
    }
}

TEST_CASE("drops fall where the seed says") {
    auto const at = [](std::uint64_t seed) {
        rain_particles const rain({.box = between(vec3{0, 0, 0}, vec3{1, 1, 1})}, {.keep = between(vec3{0, 0, 0}, vec3{1, 1, 1})}, {.particles = 9, .seed = seed});
        std::vector<vec3> all;
        for (std::size_t i = 0; i < 9; ++i) all.push_back(rain.position(i));
        return all;
    };
    CHECK(at(1) == at(1));
    CHECK(at(1) != at(2));
}

TEST_CASE("threads change no bit of the rain", "[threads]") {
    triangle_surface const ground = floor_at(0.3);
    mesh_boundary const walls(ground.positions, ground.triangles, 0.3);
    auto const rained = [&](auto const& threads) {
        rain_particles rain({.box = between(vec3{-8, -8, 4}, vec3{8, 8, 9})}, {.keep = between(vec3{-9, -9, -9}, vec3{9, 9, 12})},
                            {.particles = 5000, .radius = 0.3, .lifetime = 1});
        for (int k = 0; k < 60; ++k) rain.step(walls, threads);
        std::vector<vec3> all;
        for (std::size_t i = 0; i < rain.particle_count(); ++i) all.push_back(rain.position(i));
        return all;
    };
    auto const one = rained(inline_executor{});
    for (std::size_t n : {2U, 7U}) CHECK(one == rained(thread_pool(n)));
}

TEST_CASE("saved rain goes on to the bit, and takes no other's bytes") {
    using bytes = std::vector<std::byte>;
    triangle_surface const ground = floor_at(0.3);
    mesh_boundary const walls(ground.positions, ground.triangles, 0.3);
    box_emitter const from{.box = between(vec3{-8, -8, 4}, vec3{8, 8, 9}), .velocity = vec3{0, 1, -2}};
    box_sink const keep{.keep = between(vec3{-9, -9, -9}, vec3{9, 9, 12})};
    rain_options const o{.particles = 70, .radius = 0.3, .lifetime = 1.5, .seed = 4};
    auto const saved = [](rain_particles const& r) {
        tafoni::detail::byte_writer out;
        r.save(out);
        return out.bytes();
    };
    auto const load = [](rain_particles& r, bytes const& b) {
        tafoni::detail::byte_reader in(b, "here");
        r.load(in);
        CHECK(in.left() == 0);
    };
    rain_particles r(from, keep, o);
    for (int k = 0; k < 120; ++k) r.step(walls, inline_executor{});
    bytes const then = saved(r);
    rain_particles s(from, keep, o);
    load(s, then);
    CHECK(saved(s) == then);
    for (int k = 0; k < 60; ++k) REQUIRE(r.step(walls, inline_executor{}) == s.step(walls, inline_executor{}));
    CHECK(saved(r) == saved(s));
    CHECK(r.id(0) >= 70);  // drops were born again

    auto const refused = [&](rain_particles other) {
        bytes const before = saved(other);
        CHECK_THROWS_AS(load(other, then), invalid_input);
        CHECK(saved(other) == before);
    };
    rain_options others[9]{o, o, o, o, o, o, o, o, o};
    others[0].particles = 71;
    others[1].radius = 0.4;
    others[2].gravity[1] = 1;
    others[3].friction = 2;
    others[4].largest_step = 1;
    others[5].lifetime = 2;
    others[6].seed = 5;
    others[7].adhesion = 0.5;
    others[8].frame = 1;
    for (rain_options const& other : others) refused({from, keep, other});
    refused({from, {.keep = from.box}, o});
    refused({{.box = from.box}, keep, o});
    for (std::size_t k = 0; k < then.size(); k += 3) {
        bytes damaged = then;
        damaged[k] ^= std::byte{32};
        REQUIRE_THROWS_AS(load(s, damaged), io_error);
    }
    for (std::size_t k = 0; k < then.size(); k += 17) REQUIRE_THROWS_AS(load(s, bytes(then.begin(), then.begin() + static_cast<long>(k))), io_error);
    CHECK(saved(r) == saved(s));
}

TEST_CASE("rain out of range is refused by name") {
    box3 const b = between(vec3{0, 0, 0}, vec3{1, 1, 1});
    double const nan = std::numeric_limits<double>::quiet_NaN();
    auto const refused = [&](rain_options const& o, char const* what) {
        CHECK_THROWS_WITH(rain_particles({.box = b}, {.keep = b}, o), Catch::Contains(what));
    };
    refused({.particles = 0}, "particles");
    for (double const bad : {0.0, -1.0, nan}) refused({.radius = bad}, "radius");
    for (double const bad : {-1.0, nan}) refused({.friction = bad}, "friction");
    for (double const bad : {0.0, nan}) refused({.largest_step = bad}, "largest_step");
    for (double const bad : {0.0, nan}) refused({.lifetime = bad}, "lifetime");
    for (double const bad : {-1.0, nan}) refused({.frame = bad}, "frame");
    for (double const bad : {-1.0, 11.0, nan}) refused({.adhesion = bad}, "adhesion");
    refused({.gravity = vec3{0, nan, 0}}, "gravity");
    CHECK_THROWS_AS(rain_particles({.box = between(vec3{1, 0, 0}, vec3{0, 1, 1})}, {.keep = b}), invalid_input);
    CHECK_THROWS_AS(rain_particles({.box = b}, {.keep = between(vec3{0, 0, nan}, vec3{1, 1, 1})}), invalid_input);
}
