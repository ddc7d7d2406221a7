#include "support/curved_surfaces.hpp"

#include <tafoni/fluid/rain_particles.hpp>
#include <tafoni/fluid/sph.hpp>
#include <tafoni/weathering/hydraulic_run.hpp>

#include <catch2/catch.hpp>

using namespace tafoni;
using namespace tafoni_test;

namespace {

box3 between(vec3 const& lo, vec3 const& hi) {
    box3 b;
    b.lo = lo;
    b.hi = hi;
    return b;
}
triangle_surface heights(std::uint32_t n, double size, auto const& height) {
    return parametric(
               n + 1, n + 1, false, false, 0,
               [&](double u, double v) { return vec3{size * u, size * v, height(size * u, size * v)}; }, [](double, double) { return 0.0; })
        .mesh;
}

/// Rows of particles along both sides of a channel.
struct river {
    std::size_t particle_count() const { return 600; }
    vec3 position(std::size_t i) const {
        auto const k = static_cast<double>(i % 60);
        auto const j = static_cast<double>(i / 60);
        return vec3{1 + 8 * k / 60, -0.95 + 1.9 * (j >= 5 ? 1.0 : 0.0), 0.1 + 0.15 * (j >= 5 ? j - 5 : j)};
    }
    vec3 velocity(std::size_t) const { return vec3{1, 0, 0}; }
    double reach() const { return 0.3; }
    double step(fluid_boundary auto const&, executor auto const&) { return 0.1; }
};

}  // namespace

TEST_CASE("in a tunnel erosion is strongest where the water first meets the rock", "[slow]") {
    // A tube of radius 1 that falls from z = 12, bends at the ground and runs out to x = 14 [thesis, figure 8.6].
    double const bend = 2.5;
    double const down = 10;
    double const arc = bend * tau / 4;
    double const out = 11;
    auto const along = [&](double s) -> std::pair<vec3, vec3> {  // middle, and the normal in the plane y = 0
        if (s < down) return {vec3{0, 0, bend + down - s}, vec3{1, 0, 0}};
        if (s < down + arc) {
            double const a = (s - down) / bend;
            return {vec3{bend - bend * std::cos(a), 0, bend - bend * std::sin(a)}, vec3{std::cos(a), 0, std::sin(a)}};
        }
        return {vec3{bend + s - down - arc, 0, 0}, vec3{0, 0, 1}};
    };
    double const whole = down + arc + out;
    triangle_surface const tube = parametric(
                                      97, 24, false, true, 0,
                                      [&](double u, double v) {
                                          auto const [m, n] = along(u * whole);
                                          double const a = std::cos(tau * v);
                                          double const b = -std::sin(tau * v);
                                          return vec3{m[0] + a * n[0], b, m[2] + a * n[2]};
                                      },
                                      [](double, double) { return 0.0; })
                                      .mesh;
    // Normals to the inside: rock is around the tube.
    vec3 const a = tube.positions[tube.triangles[0][0]];
    vec3 const n = cross(tube.positions[tube.triangles[0][1]] - a, tube.positions[tube.triangles[0][2]] - a);
    REQUIRE(dot(n, vec3{-a[0], -a[1], 0}) > 0);
    rain_particles const water({.box = between(vec3{-0.4, -0.4, 11}, vec3{0.4, 0.4, 12}), .velocity = vec3{0, 0, -2}},
                               {.keep = between(vec3{-3, -3, -3}, vec3{13, 3, 13})},
                               {.particles = 400, .radius = 0.3, .friction = 5, .lifetime = 12});
    hydraulic_run run(tube, water, partheniades_erosion{.coefficient = 2e-5, .critical = 8});
    run.run(500);
    CHECK(run.balanced());
    double shaft = 0;
    double turn = 0;
    double exit = 0;
    for (std::size_t v = 0; v < tube.positions.size(); ++v) {
        vec3 const p = tube.positions[v];
        (p[2] > bend ? shaft : p[0] < bend ? turn : exit) += run.wear()[v] / (p[2] > bend ? down : p[0] < bend ? arc : out);
    }
    std::size_t most = 0;
    for (std::size_t v = 0; v < tube.positions.size(); ++v) {
        if (run.wear()[v] > run.wear()[most]) most = v;
    }
    CHECK(tube.positions[most][2] < bend);  // below the shaft, on the outer side of the bend
    CHECK(tube.positions[most][0] < bend);
    CHECK(turn > 1.5 * exit);
    CHECK(turn > 2 * shaft);
    CHECK(exit > 0);
}

TEST_CASE("a lake that overflows erodes its spillway and not the other rim", "[slow]") {
    // A bowl in a plateau with a notch towards high x, and a slope behind it [thesis, figure 8.3].
    auto const ground = [](double x, double y) {
        double const r = std::sqrt((x - 4) * (x - 4) + (y - 5) * (y - 5));
        double z = r < 2.5 ? -1.6 * (1 - r * r / 6.25) : 0.0;
        if (x > 4 && std::fabs(y - 5) < 1 && z > -0.7) z = -0.7;
        if (x > 7) z -= 1.2 * (x - 7);
        return z;
    };
    triangle_surface const s = heights(40, 10, ground);
    sph<float> const water({.box = between(vec3{3.2, 4.2, -0.2}, vec3{4.8, 5.8, 0.6})}, {.keep = between(vec3{0.4, 0.4, -6}, vec3{9.6, 9.6, 3})},
                           {.particles = 900, .spacing = 0.25, .sound_speed = 25, .damping = 0.2});
    hydraulic_run run(s, water, partheniades_erosion{.coefficient = 1e-5, .critical = 3});
    run.run(1500);
    CHECK(run.balanced());
    double spillway = 0;
    double rim = 0;
    for (std::size_t v = 0; v < s.positions.size(); ++v) {
        vec3 const p = s.positions[v];
        if (p[0] > 6.6) spillway += run.wear()[v];
        if (p[0] < 1.3 || (p[0] < 6 && std::fabs(p[1] - 5) > 3)) rim += run.wear()[v];
    }
    CHECK(spillway > 0);
    CHECK(rim < 0.05 * spillway);
    double lowest = 0;
    for (std::size_t v = 0; v < s.positions.size(); ++v) lowest = std::min(lowest, run.surface().positions[v][2] - s.positions[v][2]);
    CHECK(lowest < 0);
}

TEST_CASE("a hard layer stands out over a soft one that water falls along") {
    // A wall of two layers; drops run down it [thesis, figure 11.4].
    triangle_surface const wall = parametric(
                                      31, 31, false, false, 0,
                                      [](double u, double v) { return vec3{0.6 * (1 - v), 10 * u, 6 * v}; }, [](double, double) { return 0.0; })
                                      .mesh;
    struct layers {
        double operator()(vec3 const& p) const { return p[2] < 3 ? 4e-4 : 4e-6; }
    };
    rain_particles const rain({.box = between(vec3{0, 2, 6}, vec3{0.2, 8, 6.5})}, {.keep = between(vec3{-3, 1, 0.3}, vec3{3, 9, 9})},
                              {.particles = 300, .radius = 0.25, .friction = 4});
    hydraulic_run run(wall, rain, partheniades_erosion{.coefficient = layers{}, .critical = 2});
    run.run(200);
    double soft = 0;
    double hard = 0;
    for (std::size_t v = 0; v < wall.positions.size(); ++v) (wall.positions[v][2] < 3 ? soft : hard) += run.wear()[v];
    CHECK(soft > 8 * hard);
    CHECK(hard > 0);
    CHECK(run.balanced());
}

TEST_CASE("a canyon's walls are undercut at the water, and stand above it") {
    // A channel that curvature erosion widens where particles are: low on the walls [thesis, figure 9.10].
    triangle_surface const canyon = parametric(
                                        41, 49, false, false, 0,
                                        [](double u, double v) {
                                            double const t = 12 * v - 6;  // down one wall, over the bed, up the other
                                            double const a = std::clamp(t, -1.0, 1.0);
                                            return vec3{10 * u, a, std::fabs(t) > 1 ? std::fabs(t) - 1 : 0.0};
                                        },
                                        [](double, double) { return 0.0; })
                                        .mesh;
    hydraulic_run run(canyon, river{}, curvature_erosion<>{});
    run.run(15);
    double deepest = 0;
    for (std::size_t v = 0; v < canyon.positions.size(); ++v) {
        vec3 const p = run.surface().positions[v];
        vec3 const q = canyon.positions[v];
        if (q[2] > 2 || q[0] < 0.3 || q[0] > 9.7) {
            CHECK(p == q);
        } else if (q[2] > 0.2 && q[2] < 0.8) {
            deepest = std::max(deepest, std::fabs(p[1]) - 1);
        }
    }
    CHECK(deepest > 0.1);  // under the wall above, which still stands at 1
    CHECK(run.balanced());
}
