// What water does at the border of an open mesh.
#include "support/water_scenes.hpp"

#include <tafoni/core/elementary.hpp>
#include <tafoni/curvature/vertex_normals.hpp>
#include <tafoni/weathering/hydraulic_run.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace tafoni;
using namespace tafoni_test;

namespace {

/// Water that stands close above the ground as it was.
struct flood {
    std::vector<vec3> at{};
    std::size_t particle_count() const { return at.size(); }
    vec3 position(std::size_t i) const { return at[i]; }
    vec3 velocity(std::size_t) const { return vec3{1, 0.3, 0}; }
    double reach() const { return 0.2; }
    double step(fluid_boundary auto const&, executor auto const&) { return 0.1; }
};

template <class Height>
flood over(Height const& height) {
    flood out;
    for (int i = 0; i < 80; ++i) {
        for (int j = 0; j < 80; ++j) {
            double const x = 0.125 * i + 0.0625;
            double const y = 0.125 * j + 0.0625;
            out.at.push_back(vec3{x, y, height(x, y) + 0.05});
        }
    }
    return out;
}
double flat(double, double) { return 0; }
double incline(double x, double) { return -0.6 * x; }
double hills(double x, double y) { return 0.3 * elementary::sin(1.3 * x) * elementary::cos(0.9 * y) - 0.2 * x; }

bool on_side(double x) { return x == 0 || x == 10; }

/// The sides are upright in plan: whether border vertices are where they were there.
bool same_outline(triangle_surface const& before, triangle_surface const& after) {
    for (std::size_t v = 0; v < before.positions.size(); ++v) {
        for (int d = 0; d < 2; ++d) {
            if (on_side(before.positions[v][d]) && after.positions[v][d] != before.positions[v][d]) return false;
        }
    }
    return true;
}
/// Of the rock between the surface and a level far below, with upright sides.
double volume_under(triangle_surface const& s) {
    double sum = 0;
    for (auto const& t : s.triangles) {
        vec3 const& a = s.positions[t[0]];
        vec3 const& b = s.positions[t[1]];
        vec3 const& c = s.positions[t[2]];
        sum += cross(vec3{b - a}, vec3{c - a})[2] / 2 * (a[2] + b[2] + c[2]) / 3;
    }
    return sum;
}
curvature_erosion<> const by_curvature{.influence = 0.8};
partheniades_erosion const by_stress{.coefficient = 2e-3, .critical = 0};

std::vector<detail::border_hold> kept_in(triangle_surface const& s) {
    detail::held_borders const borders(s.positions, s.triangles);
    std::vector<detail::border_hold> out(s.positions.size());
    for (std::size_t v = 0; v < out.size(); ++v) {
        if (detail::border_hold const* h = borders.kept().of(v)) out[v] = *h;
    }
    return out;
}
detail::axis_bits kept_at(triangle_surface const& s, std::size_t v) {
    detail::border_hold const h = kept_in(s)[v];
    CHECK(h.planes == 0);
    return h.axes;
}

/// Columns of a rotation: by 30 degrees about z, or about an axis that lies askew.
struct turned {
    vec3 x{std::sqrt(0.75), 0.5, 0};
    vec3 y{-0.5, std::sqrt(0.75), 0};
    vec3 z{0, 0, 1};
    vec3 operator()(vec3 const& p) const { return p[0] * x + p[1] * y + p[2] * z; }
    vec3 back(vec3 const& p) const { return vec3{dot(p, x), dot(p, y), dot(p, z)}; }
};
turned askew() {
    turned t;
    t.x = normalized(vec3{0.6, 0.5, -0.4});
    t.z = normalized(cross(t.x, vec3{0.1, 0.9, 0.3}));
    t.y = cross(t.z, t.x);
    return t;
}
/// Rough all over, so that no side is straight.
double rough(double x, double y) { return 0.2 * elementary::sin(1.7 * x + 0.4) * elementary::cos(1.1 * y + 0.3) - 0.25 * x + 0.03 * y * y; }
/// Straight at two of its sides.
double half_straight(double x, double y) { return 0.3 * elementary::sin(1.7 * x) * elementary::sin(1.1 * y) - 0.3 * x; }

}  // namespace

TEST_CASE("flat open ground sinks evenly by curvature, its rim and corners too") {
    triangle_surface const s = sheet(20, flat);
    flood close;  // above every vertex
    for (vec3 const& p : s.positions) close.at.push_back(vec3{p[0], p[1], 0.05});
    hydraulic_run wet(s, close, by_curvature);
    hydraulic_report const r = wet.run(10);
    double const depth = -wet.surface().positions.front()[2];
    REQUIRE(depth > 0.01);
    for (std::size_t v = 0; v < s.positions.size(); ++v) {
        vec3 const& p = wet.surface().positions[v];
        CHECK(p[0] == s.positions[v][0]);
        CHECK(p[1] == s.positions[v][1]);
        CHECK(p[2] == Approx(-depth).epsilon(1e-12));
    }
    CHECK(r.ledger.eroded == Approx(100 * depth).epsilon(1e-9));
    // As much at every vertex as the ground around it.
    auto const net = wet.sediment();
    std::vector<double> third(net.size(), 0);
    for (auto const& t : s.triangles) {
        double const area = length(cross(vec3{s.positions[t[1]] - s.positions[t[0]]}, vec3{s.positions[t[2]] - s.positions[t[0]]})) / 2;
        for (std::uint32_t const v : t) third[v] += area / 3;
    }
    for (std::size_t v = 0; v < net.size(); ++v) CHECK(net[v] == Approx(-depth * third[v]).epsilon(1e-6));
}

TEST_CASE("a terrain under water keeps its outline, wears as much at its rim as behind it, and the ledger is its volume") {
    auto const worn = [](auto const& height, auto const& process, double least, double most) {
        triangle_surface const s = sheet(40, height);
        hydraulic_run run(s, over(height), process);
        sediment_ledger const l = run.run(8).ledger;
        CHECK(run.balanced());
        CHECK(same_outline(s, run.surface()));
        CHECK(l.eroded - l.deposited == Approx(volume_under(s) - volume_under(run.surface())).epsilon(1e-6));
        vertex_rings const rings(s.positions.size(), s.triangles);
        std::vector<vec3> normal(s.positions.size());
        vertex_normals(surface_view{.positions = s.positions, .triangles = s.triangles, .rings = &rings}, normal);
        double rim = 0;
        double inner = 0;
        double rims = 0;
        double inners = 0;
        for (std::size_t v = 0; v < s.positions.size(); ++v) {
            vec3 const& p = s.positions[v];
            double const lost = dot(p - run.surface().positions[v], normal[v]);
            if (on_side(p[0]) || on_side(p[1])) {
                rim += lost;
                ++rims;
            } else if (std::min(p[0], p[1]) < 1 || std::max(p[0], p[1]) > 9) {
                inner += lost;
                ++inners;
            }
        }
        CHECK(inner > 0);
        CHECK(rim / rims > least * inner / inners);
        CHECK(rim / rims < most * inner / inners);
    };
    worn(flat, by_curvature, 0.95, 1.05);
    worn(incline, by_curvature, 0.95, 1.05);
    worn(hills, by_curvature, 0.95, 1.05);
    worn(flat, by_stress, 0.95, 1.05);
    worn(incline, by_stress, 0.95, 1.05);
    worn(hills, by_stress, 0.95, 1.05);
}

TEST_CASE("edges that are split at the border keep the outline") {
    triangle_surface const s = sheet(12, hills);
    hydraulic_run run(s, over(hills), by_stress, {.refine_length = 0.5, .refine_every = 2});
    run.run(8);
    REQUIRE(run.report().vertices_added > 100);
    vertex_rings const rings(run.surface().positions.size(), run.surface().triangles);
    for (std::size_t v = 0; v < run.surface().positions.size(); ++v) {
        vec3 const& p = run.surface().positions[v];
        if (rings.is_border(v)) CHECK((on_side(p[0]) || on_side(p[1])));
    }
    CHECK(same_outline(s, run.surface()));
}

TEST_CASE("a turned scene erodes alike, up to its border") {
    auto const alike = [](auto const& height, turned const& turn, auto const& process) {
        triangle_surface const s = sheet(25, height);
        flood water;  // over the middles of triangles: over a ridge two would be as near
        for (auto const& f : s.triangles) {
            vec3 const& a = s.positions[f[0]];
            vec3 const n = normalized(cross(vec3{s.positions[f[1]] - a}, vec3{s.positions[f[2]] - a}));
            water.at.push_back((a + s.positions[f[1]] + s.positions[f[2]]) / 3 + 0.05 * n);
        }
        triangle_surface t = s;
        for (vec3& p : t.positions) p = turn(p);
        struct turned_flood : flood {
            vec3 speed{0, 0, 0};
            vec3 velocity(std::size_t) const { return speed; }
        };
        turned_flood turned_water;
        for (vec3 const& p : water.at) turned_water.at.push_back(turn(p));
        turned_water.speed = turn(water.velocity(0));
        hydraulic_run a(s, water, process);
        hydraulic_run b(t, turned_water, process);
        a.run(1);
        b.run(1);
        double worst = 0;
        double moved = 0;
        for (std::size_t v = 0; v < s.positions.size(); ++v) {
            worst = std::max(worst, length(turn(a.surface().positions[v]) - b.surface().positions[v]));
            moved = std::max(moved, a.wear()[v]);
        }
        CHECK(moved > 0.005);
        CHECK(worst < 1e-11);  // 1e-12 of the scene
    };
    for (turned const& turn : {turned{}, askew()}) {
        alike(rough, turn, by_stress);
        alike(rough, turn, by_curvature);
        alike(rough, turn, partheniades_erosion{.coefficient = 5e-2, .critical = 0});  // more than the ground gives
    }
    alike(half_straight, turned{}, by_stress);
    alike(half_straight, turned{}, by_curvature);
    alike(incline, turned{}, by_stress);
    alike(flat, turned{}, by_curvature);
}

TEST_CASE("a turned terrain keeps its outline") {
    auto const stays = [](auto const& height, turned const& turn, auto const& process) {
        triangle_surface s = sheet(40, height);
        flood water = over(height);
        std::vector<vec3> const plan = s.positions;
        for (vec3& p : s.positions) p = turn(p);
        for (vec3& p : water.at) p = turn(p);
        hydraulic_run run(s, water, process);
        run.run(20);
        REQUIRE(run.report().ledger.eroded > 2);
        double across = 0;
        for (std::size_t v = 0; v < plan.size(); ++v) {
            vec3 const now = turn.back(run.surface().positions[v]);
            for (int d = 0; d < 2; ++d) {
                if (on_side(plan[v][d])) across = std::max(across, std::fabs(now[d] - plan[v][d]));
            }
        }
        CHECK(across < 1e-11);
    };
    for (turned const& turn : {turned{}, askew()}) {
        stays(rough, turn, by_stress);
        stays(rough, turn, by_curvature);
    }
    stays(half_straight, turned{}, by_stress);
    stays(half_straight, turned{}, by_curvature);
    stays(hills, turned{}, by_curvature);
    stays(incline, turned{}, by_stress);
}

TEST_CASE("a hole's rim that lies in no plane is free, one that does is kept in it") {
    // A tube whose ends are cut askew, or wave.
    auto const tube = [](double wave) {
        return parametric(
                   40, 9, true, false, 0,
                   [&](double u, double v) {
                       double const x = std::cos(tau * u);
                       double const y = std::sin(tau * u);
                       return vec3{x, y, (2 * v - 1) * (2 + 0.3 * x + wave * std::sin(3 * tau * u))};
                   },
                   [](double, double) { return 0.0; })
            .mesh;
    };
    triangle_surface const wavy = tube(0.1);
    for (detail::border_hold const& h : kept_in(wavy)) CHECK((h.axes == 0 && h.planes == 0));
    triangle_surface const cut = tube(0);
    vertex_rings const rings(cut.positions.size(), cut.triangles);
    auto const held = kept_in(cut);
    for (std::size_t v = 0; v < held.size(); ++v) {
        REQUIRE(held[v].planes == (rings.is_border(v) ? 1 : 0));
        if (!rings.is_border(v)) continue;
        vec3 const m = normalized(vec3{cut.positions[v][2] > 0 ? -0.3 : 0.3, 0, 1});
        CHECK(length(cross(held[v].across[0], m)) < 1e-9);
    }
}

TEST_CASE("sides, level rims and corners are held; ground that is level sinks") {
    triangle_surface const level = sheet(4, flat);
    CHECK(kept_at(level, 0) == 3);
    CHECK(kept_at(level, 2) == 1);
    CHECK(kept_at(level, 12) == 0);
    triangle_surface const inclined = sheet(4, incline);
    CHECK(kept_at(inclined, 2) == 1);
    CHECK(kept_at(inclined, 10) == 2);
    CHECK(kept_at(inclined, 0) == 3);
    triangle_surface steep = sheet(4, [](double x, double y) { return 2.5 * x + (y == 5 ? 0.1 : 0.0); });
    CHECK(kept_at(steep, 2) == 1);
    triangle_surface const pipe = cylinder(12, 4, 0).mesh;
    vertex_rings const rings(pipe.positions.size(), pipe.triangles);
    for (std::size_t v = 0; v < pipe.positions.size(); ++v) CHECK(kept_at(pipe, v) == (rings.is_border(v) ? 4 : 0));
    CHECK(kept_at(torus_surface(8, 6, 0.1).mesh, 3) == 0);
    triangle_surface disc{.positions = {{0, 0, 0}, {1, 0.1, 0}, {0.2, 1.1, 0}, {-1, 0.3, 0}, {-0.1, -1, 0}},
                          .triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}}};
    for (std::size_t v = 0; v < 5; ++v) CHECK(kept_at(disc, v) == 0);
}
