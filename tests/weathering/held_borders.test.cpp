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

detail::axis_bits kept_at(triangle_surface const& s, std::size_t v) {
    vertex_rings const rings(s.positions.size(), s.triangles);
    detail::held_borders borders;
    borders.adopt(rings, s.triangles, s.positions.size());
    borders.look(s.positions, s.triangles, rings);
    return borders.kept().empty() ? detail::axis_bits{0} : borders.kept()[v];
}

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

TEST_CASE("a border that no axis holds does not creep inwards by curvature") {
    // The hills, turned by 30 degrees.
    double const c = std::sqrt(0.75);
    auto const turned = [&](vec3 const& p) { return vec3{c * p[0] - 0.5 * p[1], 0.5 * p[0] + c * p[1], p[2]}; };
    triangle_surface s = sheet(40, hills);
    flood water = over(hills);
    for (vec3& p : s.positions) p = turned(p);
    for (vec3& p : water.at) p = turned(p);
    hydraulic_run run(s, water, by_curvature);
    run.run(8);
    vertex_rings const rings(s.positions.size(), s.triangles);
    double across = 0;
    double count = 0;
    for (std::size_t v = 0; v < s.positions.size(); ++v) {
        if (!rings.is_border(v) || rings.faces(v).size() < 3) continue;
        auto const back = [&](vec3 const& p) { return vec3{c * p[0] + 0.5 * p[1], c * p[1] - 0.5 * p[0], p[2]}; };
        vec3 const was = back(s.positions[v]);
        vec3 const step{back(run.surface().positions[v]) - was};
        // Inwards, away from the nearest side.
        int const d = std::min(was[0], 10 - was[0]) < std::min(was[1], 10 - was[1]) ? 0 : 1;
        across += was[d] < 5 ? step[d] : -step[d];
        ++count;
    }
    double const sunk = run.report().ledger.eroded / 100;
    REQUIRE(sunk > 0.05);
    CHECK(std::fabs(across / count) < 0.03 * sunk);  // 0.09 by the mean of all neighbours
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
