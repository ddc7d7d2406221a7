#include "support/test_data.hpp"
#include "support/water_scenes.hpp"

#include <tafoni/curvature/estimate_curvature.hpp>
#include <tafoni/fluid/rain_particles.hpp>
#include <tafoni/fluid/sph.hpp>
#include <tafoni/geometry/terrain_solid.hpp>
#include <tafoni/io/esri_ascii.hpp>
#include <tafoni/io/read_mesh.hpp>
#include <tafoni/repair/collapse_short_edges.hpp>
#include <tafoni/voxel/isosurface.hpp>
#include <tafoni/weathering/hydraulic_run.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <vector>

using namespace tafoni;
using namespace tafoni_test;

namespace {

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

/// Faces that look down.
std::size_t overhanging(triangle_surface const& s) {
    std::size_t n = 0;
    for (auto const& t : s.triangles) {
        vec3 const w = normalized(cross(vec3{s.positions[t[1]] - s.positions[t[0]]}, vec3{s.positions[t[2]] - s.positions[t[0]]}));
        n += w[2] < -0.15 ? 1U : 0U;
    }
    return n;
}
/// A trough along x with walls that stand at y = -1 and 1.
triangle_surface trough(std::uint32_t n, std::uint32_t m, double fall) {
    return parametric(
               n, m, false, false, 0,
               [=](double u, double v) {
                   double const t = 12 * v - 6;  // down one wall, over the bed, up the other
                   double const a = std::clamp(t, -1.0, 1.0);
                   return vec3{10 * u, a, (std::fabs(t) > 1 ? std::fabs(t) - 1 : 0.0) - fall * u};
               },
               [](double, double) { return 0.0; })
        .mesh;
}

/// The middle of the tunnel at x.
double axis_at(double x) { return 1.9 - 0.1 * x; }
/// A block of rock, 8 x 3 x 3, that a round tunnel of radius 0.7 falls through along x [thesis, figure 8.6].
triangle_surface pierced_block() {
    grid_frame frame;
    double const cell = 0.2;
    frame.size = {43, 18, 18};
    for (Eigen::Index a = 0; a < 3; ++a) {
        frame.spacing[a] = cell;
        frame.origin[a] = -cell - 0.01;
    }
    indexed_mesh const raw = isosurface(
        [](vec3 const& p) -> double {
            double inside = 1e9;
            vec3 const hi{8, 3, 3};
            for (int a = 0; a < 3; ++a) inside = std::min({inside, p[a], hi[a] - p[a]});
            double const y = p[1] - 1.5;
            double const z = p[2] - axis_at(p[0]);
            return std::min(inside, std::sqrt(y * y + z * z) - 0.7);
        },
        frame, 0);
    triangle_surface s = triangles_of(raw);
    collapse_short_edges(s, 0.4 * cell);
    return s;
}

triangle_surface terrain(std::filesystem::path const& path) { return triangles_of(detail::terrain_top(read_esri_ascii(path))); }
box3 bounds_of(triangle_surface const& s) {
    box3 b;
    for (vec3 const& p : s.positions) b.include(p);
    return b;
}
/// Rain over all of a terrain but its rim, with gravity and stresses by its size as the tool scales them.
auto rained_on(triangle_surface const& s, std::uint32_t drops, double friction) {
    box3 const b = bounds_of(s);
    double const size = std::max(b.hi[0] - b.lo[0], b.hi[1] - b.lo[1]);
    double const edge = s.mean_edge_length();
    double const rim = 4 * edge;
    double const fall = std::sqrt(0.1);
    double const stress = std::sqrt(10.0) * size / edge;
    rain_particles const rain({.box = between({b.lo[0] + rim, b.lo[1] + rim, b.hi[2] + edge}, {b.hi[0] - rim, b.hi[1] - rim, b.hi[2] + 3 * edge})},
                              {.keep = between({b.lo[0] + 2 * edge, b.lo[1] + 2 * edge, b.lo[2] - size}, {b.hi[0] - 2 * edge, b.hi[1] - 2 * edge, b.hi[2] + size})},
                              {.particles = drops, .radius = edge, .gravity = vec3{0, 0, -10 * size}, .friction = friction,
                               .largest_step = 0.1 * fall, .lifetime = 15 * fall});
    return hydraulic_run(s, rain, partheniades_erosion{.coefficient = 0.015 * size / (fall * stress), .critical = 0.1 * stress});
}

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
    // The outlet is cut: the sill that the water went over is lower.
    double sill = 0;
    double n = 0;
    for (std::size_t v = 0; v < s.positions.size(); ++v) {
        vec3 const p = s.positions[v];
        if (p[0] < 6.7 || p[0] > 7.3 || std::fabs(p[1] - 5) > 0.6) continue;
        sill += run.surface().positions[v][2] - p[2];
        ++n;
    }
    CHECK(sill / n < 0);
    CHECK(run.surface().positions.size() == s.positions.size());
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
    triangle_surface const canyon = trough(41, 49, 0);
    REQUIRE(overhanging(canyon) == 0);
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
    CHECK(overhanging(run.surface()) > 20);
    CHECK(run.balanced());
}

TEST_CASE("water at the foot of a wall undercuts it by its shear stress too") {
    triangle_surface const canyon = trough(41, 49, 0);
    hydraulic_run run(canyon, river{}, partheniades_erosion{.coefficient = 2e-3, .critical = 1});
    run.run(40);
    CHECK(run.balanced());
    CHECK(overhanging(run.surface()) > 20);
    double foot = 0;
    for (std::size_t v = 0; v < canyon.positions.size(); ++v) {
        vec3 const q = canyon.positions[v];
        if (q[2] > 0.2 && q[2] < 0.8) foot = std::max(foot, std::fabs(run.surface().positions[v][1]) - 1);
        if (q[2] > 2.5) CHECK(run.surface().positions[v] == q);
    }
    CHECK(foot > 0.1);
}

TEST_CASE("a river with pressure undercuts the walls of its canyon", "[slow]") {
    triangle_surface const canyon = trough(41, 49, 0.8);
    sph<float> const water({.box = between(vec3{0.4, -0.7, 0.2}, vec3{1.6, 0.7, 1.0}), .velocity = vec3{4, 0, 0}},
                           {.keep = between(vec3{0.3, -2.5, -4}, vec3{9.7, 2.5, 4})},
                           {.particles = 1500, .spacing = 0.2, .sound_speed = 30, .damping = 0.2, .frame = 0.02});
    hydraulic_run run(canyon, water, partheniades_erosion{.coefficient = 2e-3, .critical = 3});
    run.run(250);
    CHECK(run.balanced());
    CHECK(run.report().ledger.eroded > 0);
    CHECK(overhanging(run.surface()) > 10);
    for (std::size_t v = 0; v < canyon.positions.size(); ++v) {
        if (canyon.positions[v][2] > 3.5) CHECK(run.surface().positions[v] == canyon.positions[v]);  // what stays dry stands
    }
}

TEST_CASE("a stream enlarges the tunnel that it runs through, and leaves the roof alone") {
    triangle_surface const block = pierced_block();
    rain_particles const water({.box = between(vec3{0.3, 1.2, 1.5}, vec3{0.8, 1.8, 1.9}), .velocity = vec3{3, 0, 0}},
                               {.keep = between(vec3{0.1, 0, 0}, vec3{7.8, 3, 3})},
                               {.particles = 400, .radius = 0.25, .friction = 1, .adhesion = 0, .lifetime = 6});
    hydraulic_run run(block, water, partheniades_erosion{.coefficient = 1e-3, .critical = 3});
    run.run(300);
    CHECK(run.balanced());
    double floor = 0;
    double floors = 0;
    for (std::size_t v = 0; v < block.positions.size(); ++v) {
        vec3 const p = block.positions[v];
        double const y = p[1] - 1.5;
        double const z = p[2] - axis_at(p[0]);
        if (p[0] < 1 || p[0] > 7 || y * y + z * z > 0.8 * 0.8) continue;
        if (z > 0.45) {
            CHECK(run.wear()[v] == 0);
        } else if (z < -0.45) {
            double const then = run.surface().positions[v][2] - axis_at(run.surface().positions[v][0]);
            floor += z - then;
            ++floors;
        }
    }
    REQUIRE(floors > 20);
    CHECK(floor / floors > 0.025);  // of a radius of 0.7: the section grows
    auto const six = [](triangle_surface const& s) {
        double sum = 0;
        for (auto const& t : s.triangles) sum += dot(s.positions[t[0]], cross(s.positions[t[1]], s.positions[t[2]]));
        return sum;
    };
    CHECK((six(block) - six(run.surface())) / 6 == Approx(run.report().ledger.eroded - run.report().ledger.deposited).epsilon(1e-9));
}

TEST_CASE("rain gathers in the valleys of a real ridge and wears them", "[slow]") {
    auto const path = find("dems/bigtujunga_ridge128_30m.asc");
    if (path.empty()) {
        WARN("skipped: no data");
        return;
    }
    triangle_surface const s = terrain(path);
    auto run = rained_on(s, 3000, 6);
    run.run(150);
    CHECK(run.balanced());
    CHECK(run.report().ledger.eroded > 0);
    std::vector<double> const bent = estimate_curvature(s);
    double hollows = 0;
    double ridges = 0;
    double wear_hollows = 0;
    double wear_ridges = 0;
    for (std::size_t v = 0; v < bent.size(); ++v) {
        (bent[v] < 0 ? hollows : ridges) += 1;
        (bent[v] < 0 ? wear_hollows : wear_ridges) += run.wear()[v];
    }
    CHECK(wear_hollows / hollows > 1.3 * wear_ridges / ridges);
    // Most is worn where most water ran.
    std::vector<std::size_t> order(bent.size());
    for (std::size_t v = 0; v < order.size(); ++v) order[v] = v;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return run.flow()[a] != run.flow()[b] ? run.flow()[a] > run.flow()[b] : a < b;
    });
    double whole = 0;
    double wet = 0;
    for (std::size_t k = 0; k < order.size(); ++k) {
        whole += run.wear()[order[k]];
        if (k < order.size() / 10) wet += run.wear()[order[k]];
    }
    CHECK(wet > 0.3 * whole);
}

TEST_CASE("rain in a real valley leaves what it did not touch as it was", "[slow]") {
    auto const path = find("dems/stubai_10m.asc");
    if (path.empty()) {
        WARN("skipped: no data");
        return;
    }
    // A piece of the valley, 80 x 80 nodes.
    height_grid const all = read_esri_ascii(path);
    height_grid g{.columns = 80, .rows = 80, .cell_size_x = all.cell_size_x, .cell_size_y = all.cell_size_y};
    for (std::size_t r = 0; r < g.rows; ++r) {
        for (std::size_t c = 0; c < g.columns; ++c) g.heights.push_back(all.heights[(r + 40) * all.columns + c + 40]);
    }
    triangle_surface const s = triangles_of(detail::terrain_top(g));
    auto run = rained_on(s, 3000, 4);
    run.run(150);
    CHECK(run.balanced());
    CHECK(run.report().ledger.eroded > 0);
    // What no drop came near stands as it was.
    vertex_rings const rings(s.positions.size(), s.triangles);
    std::size_t dry = 0;
    for (std::size_t v = 0; v < s.positions.size(); ++v) {
        bool away = run.flow()[v] == 0;
        for (std::uint32_t const w : rings.neighbors(v)) {
            away = away && run.flow()[w] == 0;
            for (std::uint32_t const x : rings.neighbors(w)) away = away && run.flow()[x] == 0;
        }
        if (!away) continue;
        ++dry;
        CHECK(run.surface().positions[v] == s.positions[v]);
    }
    CHECK(dry > 0);
}

TEST_CASE("water poured over a statue runs down it", "[slow]") {
    auto const path = find("meshes/nefertiti_35k.ply");
    if (path.empty()) {
        WARN("skipped: no data");
        return;
    }
    triangle_surface const s = triangles_of(read_mesh(path).mesh);
    box3 const b = bounds_of(s);
    vec3 const e = b.extent();
    double const size = std::max({e[0], e[1], e[2]});
    double const edge = s.mean_edge_length();
    double const stress = std::sqrt(10.0) * size / edge;
    double const fall = std::sqrt(0.1);
    rain_particles const water({.box = between({b.lo[0] + 0.15 * e[0], b.hi[1] + edge, b.lo[2] + 0.15 * e[2]}, {b.hi[0] - 0.15 * e[0], b.hi[1] + 4 * edge, b.hi[2] - 0.15 * e[2]})},
                               {.keep = between({b.lo[0] - 9 * edge, b.lo[1] - 9 * edge, b.lo[2] - 9 * edge}, {b.hi[0] + 9 * edge, b.hi[1] + 9 * edge, b.hi[2] + 9 * edge})},
                               {.particles = 3000, .radius = edge, .gravity = vec3{0, -10 * size, 0}, .friction = 6, .largest_step = 0.1 * fall});
    hydraulic_run run(s, water, partheniades_erosion{.coefficient = 0.005 * size / (fall * stress), .critical = 0.1 * stress});
    run.run(250);
    CHECK(run.balanced());
    auto const six = [](triangle_surface const& m) {
        double sum = 0;
        for (auto const& t : m.triangles) sum += dot(m.positions[t[0]], cross(m.positions[t[1]], m.positions[t[2]]));
        return sum;
    };
    auto const& l = run.report().ledger;
    CHECK((six(s) - six(run.surface())) / 6 == Approx(l.eroded - l.deposited).epsilon(1e-6));
    std::array<std::uint64_t, 4> flow{};
    for (std::size_t v = 0; v < s.positions.size(); ++v) {
        auto const quarter = std::min(3.0, 4 * (s.positions[v][1] - b.lo[1]) / e[1]);
        flow[static_cast<std::size_t>(quarter)] += run.flow()[v];
    }
    CHECK(flow[3] > 0);  // the crown
    CHECK(flow[2] > 0);
    CHECK(flow[1] > 0);  // the neck
}
