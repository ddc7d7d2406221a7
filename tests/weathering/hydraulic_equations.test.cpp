// The equations of the thesis's chapters 8 and 9, one by one, where their answer is known.
#include "support/curved_surfaces.hpp"
#include "support/water_scenes.hpp"

#include <tafoni/curvature/estimate_curvature.hpp>
#include <tafoni/curvature/vertex_normals.hpp>
#include <tafoni/weathering/hydraulic_run.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

using namespace tafoni;
using namespace tafoni_test;

namespace {

/// 20 x 20 squares of 0.1.
triangle_surface sheet(vec3 const& along, vec3 const& up, vec3 const& origin, double bend = 0) {
    vec3 const a = normalized(along);
    vec3 const b = normalized(cross(up, a));
    vec3 const n = cross(a, b);
    return parametric(
               21, 21, false, false, 0,
               [&](double u, double v) {
                   double const height = bend * (u - 0.5) * (u - 0.5) * (u - 0.5);
                   return vec3{origin + 2 * u * a + 2 * v * b + height * n};
               },
               [](double, double) { return 0.0; })
        .mesh;
}
std::vector<vec3> normals_of(triangle_surface const& s) {
    vertex_rings const rings(s.positions.size(), s.triangles);
    std::vector<vec3> normal(s.positions.size());
    vertex_normals(surface_view{.positions = s.positions, .triangles = s.triangles, .rings = &rings}, normal);
    return normal;
}
struct range {
    double low;
    double high;
};
range range_of(std::span<double const> x) {
    auto const [low, high] = std::minmax_element(x.begin(), x.end());
    return {*low, *high};
}

}  // namespace

TEST_CASE("a plane wears evenly by curvature, however it lies") {
    for (vec3 const& origin : {vec3{0, 0, 0}, vec3{1000.3, -77.7, 1e4}}) {
        for (vec3 const& along : {vec3{1, 0, 0}, vec3{0.8, 0.1, 0.59}, vec3{0.3, -0.7, 0.2}}) {
            triangle_surface const s = sheet(along, vec3{-0.6, 0.2, 0.7}, origin);
            vec3 const n = normals_of(s)[0];
            hydraulic_run run(s, standing{.at = s.positions}, curvature_erosion<>{.influence = 0.1});
            run.run(1);
            double const most = s.mean_edge_length() / 10;
            vertex_rings const rings(s.positions.size(), s.triangles);
            for (std::size_t v = 0; v < s.positions.size(); ++v) {
                if (rings.is_border(v)) continue;  // it may have a side to stay in
                CHECK(run.wear()[v] == Approx(most / 2).epsilon(1e-7));
                CHECK(length(run.surface().positions[v] - s.positions[v] + most / 2 * n) < 1e-7 * most);
            }
        }
    }
}

TEST_CASE("a ball wears evenly by curvature, however its triangles lie") {
    for (int const level : {2, 3, 4}) {
        triangle_surface const s = sphere(level).mesh;
        hydraulic_run run(s, standing{.at = s.positions}, curvature_erosion<>{});
        run.run(1);
        double const most = s.mean_edge_length() / 10;
        range const wear = range_of(run.wear());
        CHECK(wear.low > 0.49 * most);
        CHECK(wear.high < 0.51 * most);
    }
}

TEST_CASE("curvature is scaled over its range, and over a turn of 0.01 per edge where that is more") {
    // From a hundredth of that turn to a hundred of it; the bend is cubic, so that both signs are there.
    for (double const bend : {0.0, 1e-4, 1e-3, 6e-3, 7e-3, 8e-3, 0.1, 1.0}) {
        triangle_surface const s = sheet(vec3{0.8, 0.1, 0.59}, vec3{-0.6, 0.2, 0.7}, vec3{3, 1, 2}, bend);
        double const edge = s.mean_edge_length();
        std::vector<double> const h = estimate_curvature(s);
        range const r = range_of(h);
        double const width = std::max(r.high - r.low, 0.01 / edge);
        for (double const power : {1.0, 2.0}) {
            hydraulic_run run(s, standing{.at = s.positions}, curvature_erosion<>{.power = power, .influence = 0.1});
            run.run(1);
            vertex_rings const rings(s.positions.size(), s.triangles);
            for (std::size_t v = 0; v < s.positions.size(); ++v) {
                if (rings.is_border(v)) continue;
                double const share = 0.5 + (h[v] - 0.5 * (r.low + r.high)) / width;
                // Straight in where the surface is flat; shorter, the more it is bent.
                double const turn = std::fabs(h[v]) / std::max({std::fabs(r.low), std::fabs(r.high), 0.005 / edge});
                double const d = (power == 1 ? share : share * share) * edge / 10;
                CHECK(run.wear()[v] <= d * (1 + 1e-9) + 1e-12);
                CHECK(run.wear()[v] >= d * (1 - 2 * turn) - 1e-12);
            }
        }
    }
}

TEST_CASE("the power of curvature is that of equation 9.5") {
    triangle_surface const s = torus_surface(40, 24, 0.1).mesh;
    std::vector<double> const h = estimate_curvature(s);
    range const r = range_of(h);
    auto const worn = [&](double power) {
        hydraulic_run run(s, standing{.at = s.positions}, curvature_erosion<>{.power = power, .influence = 0.1});
        run.run(1);
        return std::vector<double>(run.wear().begin(), run.wear().end());
    };
    std::vector<double> const one = worn(1);
    std::vector<double> const two = worn(2);
    std::vector<double> const half_more = worn(1.5);
    for (std::size_t v = 0; v < h.size(); ++v) {
        double const share = (h[v] - r.low) / (r.high - r.low);
        REQUIRE(one[v] >= 0.2 * share * s.mean_edge_length() / 10);
        CHECK(two[v] == Approx(share * one[v]).epsilon(1e-9).margin(1e-15));
        CHECK(half_more[v] == Approx(std::sqrt(share) * one[v]).epsilon(1e-9).margin(1e-15));
    }
}

TEST_CASE("the wear by one particle falls off with the distance as equation 9.6 says") {
    triangle_surface const s = sheet(vec3{1, 0, 0}, vec3{0, 0, 1}, vec3{0, 0, 0});
    vec3 const drop{1.03, 0.97, 0.11};
    double const influence = 0.35;
    hydraulic_run run(s, standing{.at = {drop}}, curvature_erosion<>{.influence = influence});
    run.run(1);
    std::size_t wet = 0;
    for (std::size_t v = 0; v < s.positions.size(); ++v) {
        double const nearness = 1 - length(s.positions[v] - drop) / influence;
        CHECK(run.wear()[v] == Approx(nearness > 0 ? nearness * s.mean_edge_length() / 20 : 0.0).epsilon(1e-12));
        wet += nearness > 0 ? 1 : 0;
    }
    CHECK(wet > 20);
    // Of several the nearest counts.
    hydraulic_run more(s, standing{.at = {drop, drop + vec3{0.05, 0, 0.05}, drop + vec3{0, 0, 0.08}}}, curvature_erosion<>{.influence = influence});
    more.run(1);
    for (std::size_t v = 0; v < s.positions.size(); ++v) {
        double const nearest = std::min(length(s.positions[v] - drop), length(s.positions[v] - drop - vec3{0.05, 0, 0.05}));
        CHECK(more.wear()[v] == Approx(std::max(1 - nearest / influence, 0.0) * s.mean_edge_length() / 20).epsilon(1e-12));
    }
}

TEST_CASE("what curvature takes is booked at the vertices that moved, and at no others") {
    triangle_surface const s = torus_surface(40, 24, 0.1).mesh;
    hydraulic_run run(s, standing{.at = {s.positions[100], s.positions[500]}}, curvature_erosion<>{.influence = 0.15});
    sediment_ledger const l = run.run(3).ledger;
    std::vector<double> const net = run.sediment();
    double sum = 0;
    std::size_t moved = 0;
    for (std::size_t v = 0; v < net.size(); ++v) {
        sum += net[v];
        if (run.wear()[v] == 0) CHECK(net[v] == 0);
        if (run.wear()[v] > 1e-6) CHECK(net[v] < 0);
        moved += run.wear()[v] > 0 ? 1U : 0U;
    }
    CHECK(moved > 4);
    CHECK(moved < 200);
    CHECK(-sum == Approx(l.eroded).epsilon(1e-12));
}

TEST_CASE("shear is the speed along the surface over the distance") {
    partheniades_erosion const rule{.coefficient = 1e-3, .critical = 2, .exponent = 1.5, .consistency = 0.5, .power = 0.8};
    auto const rate = [&](vec3 const& velocity, double distance) {
        return rule.rate({.position = {0, 0, 0}, .velocity = velocity, .normal = {0, 0, 1}, .distance = distance, .reach = 0.2});
    };
    auto const expected = [](double speed, double distance) {
        double const over = 0.5 * std::pow(speed / distance, 0.8) - 2;
        return (over < 0 ? -1e-3 : 1e-3) * std::pow(std::fabs(over), 1.5);
    };
    CHECK(rate({3, 4, 0}, 0.1) == Approx(expected(5, 0.1)));
    CHECK(rate({3, 4, -20}, 0.1) == Approx(expected(5, 0.1)));
    CHECK(rate({0.3, 0.4, 7}, 0.1) == Approx(expected(0.5, 0.1)));  // lays down
    CHECK(rate({3, 4, 0}, 0.2) == Approx(expected(5, 0.2)));
    CHECK(rate({3, 4, 0}, -0.1) == Approx(expected(5, 0.02)));  // a tenth of the reach is the least
    CHECK(rate({0, 0, -30}, 0.1) == Approx(-1e-3 * std::pow(2, 1.5)));
}

TEST_CASE("what falls straight onto the ground does not shear it, what falls aslant does by its speed along it") {
    vec3 const up = normalized(vec3{-0.6, 0.2, 0.7});
    triangle_surface const s = sheet(vec3{0.8, 0.1, 0.59}, up, vec3{3, 1, 2});
    vec3 const n = normals_of(s)[0];
    vec3 const along = normalized(vec3{s.positions[21] - s.positions[0]});
    vec3 const over = s.positions[200] + 0.05 * n + 0.02 * along;
    auto const eroded = [&](vec3 const& speed) {
        hydraulic_run run(s, standing{.at = {over}, .speed = speed}, partheniades_erosion{.coefficient = 1e-6, .critical = 1});
        return run.run(1).ledger.eroded;
    };
    CHECK(eroded(-5 * n) == 0);
    double const by_flow = eroded(2 * along);
    CHECK(by_flow == Approx(1e-6 * (2 / 0.05 - 1) * 3.14159265358979 * (0.04 - 0.0025) * 0.1).epsilon(1e-6));
    CHECK(eroded(2 * along - 5 * n) == Approx(by_flow).epsilon(1e-9));
}
