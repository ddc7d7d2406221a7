// A thin wall that is wet on one side wears on that side.
#include "support/water_scenes.hpp"

#include <tafoni/curvature/vertex_normals.hpp>
#include <tafoni/weathering/detail/wet_side.hpp>
#include <tafoni/weathering/hydraulic_run.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace tafoni;
using namespace tafoni_test;

namespace {

bool inner(vec3 const& p, double rim) { return std::min({p[0], p[1], 4 - p[0], 4 - p[1]}) > rim; }

/// Squared distance from each vertex to the nearest particle, or infinity beyond `influence`.
std::vector<double> squares(triangle_surface const& s, std::vector<vec3> const& water, double influence) {
    std::vector<double> out(s.positions.size(), std::numeric_limits<double>::infinity());
    for (std::size_t v = 0; v < out.size(); ++v) {
        for (vec3 const& p : water) out[v] = std::min(out[v], squared_length(p - s.positions[v]));
        if (out[v] > influence * influence) out[v] = std::numeric_limits<double>::infinity();
    }
    return out;
}

}  // namespace

TEST_CASE("a plate thinner than the reach that is wet on one side stays as it is on the other") {
    double const thick = 0.1;
    triangle_surface const plate = slab(16, thick);  // 4 x 4; the first 289 vertices are the upper side
    auto const wears = [&](double z, auto const& process) {
        standing water{.speed = vec3{1, 0.3, 0}, .wide = 0.3};
        for (int i = 0; i < 40; ++i) {
            for (int j = 0; j < 40; ++j) water.at.push_back(vec3{0.1 * i + 0.05, 0.1 * j + 0.05, z});
        }
        hydraulic_run run(plate, water, process);
        run.run(3);
        CHECK(run.balanced());
        bool const above = z > 0;
        double wet = 0;
        for (std::size_t v = 0; v < plate.positions.size(); ++v) {
            if (!inner(plate.positions[v], 1.2)) continue;
            if ((v < 289) == above) {
                CHECK(run.flow()[v] > 0);
                wet += run.wear()[v];
            } else {
                CHECK(run.flow()[v] == 0);
                CHECK(run.wear()[v] == 0);
                CHECK(run.surface().positions[v] == plate.positions[v]);
            }
        }
        CHECK(wet > 0);
    };
    for (double const z : {thick + 0.05, -0.05}) {
        wears(z, partheniades_erosion{.coefficient = 1e-3, .critical = 0});
        wears(z, curvature_erosion<>{.influence = 0.5});
    }
}

TEST_CASE("nothing near water on a thick body stays dry") {
    auto const all = [](triangle_surface const& s, double influence, double off) {
        vertex_rings const rings(s.positions.size(), s.triangles);
        std::vector<vec3> water;
        std::vector<std::uint32_t> touched;
        for (std::size_t f = 0; f < s.triangles.size(); f += 5) {
            auto const& t = s.triangles[f];
            vec3 const& a = s.positions[t[0]];
            vec3 const n = normalized(cross(vec3{s.positions[t[1]] - a}, vec3{s.positions[t[2]] - a}));
            vec3 const m{(a + s.positions[t[1]] + s.positions[t[2]]) / 3};
            water.push_back(vec3{m + off * n});
            touched.insert(touched.end(), t.begin(), t.end());
        }
        std::vector<double> const near_by = squares(s, water, influence);
        std::vector<double> kept = near_by;
        detail::wet_side side;
        side.keep(rings, s.positions, influence, kept, [&](auto const& visit) {
            for (std::uint32_t const v : touched) visit(v);
        });
        CHECK(kept == near_by);
        CHECK(std::any_of(kept.begin(), kept.end(), [](double d) { return std::isfinite(d); }));
    };
    triangle_surface const ball = sphere(4).mesh;
    triangle_surface const ring = torus_surface(40, 24, 0.4).mesh;
    for (double const edges : {0.5, 1.0, 3.0}) {
        all(ball, edges * ball.mean_edge_length(), 0.05 * ball.mean_edge_length());
        all(ring, edges * ring.mean_edge_length(), 0.05 * ring.mean_edge_length());
    }
}

TEST_CASE("water goes along edges that are near it, and no farther than its influence beyond what it touches") {
    triangle_surface const s = slope(20, 0);  // edges of 0.5
    vertex_rings const rings(s.positions.size(), s.triangles);
    std::vector<double> square(s.positions.size(), 0.01);
    for (std::size_t v = 0; v < square.size(); ++v) {
        if (s.positions[v][0] > 6) square[v] = std::numeric_limits<double>::infinity();
    }
    std::size_t const middle = 220;
    detail::wet_side side;
    side.keep(rings, s.positions, 1.1, square, [&](auto const& visit) { visit(static_cast<std::uint32_t>(middle)); });
    vec3 const o = s.positions[middle];
    for (std::size_t v = 0; v < square.size(); ++v) {
        double const away = length(s.positions[v] - o);
        if (s.positions[v][0] > 6 || away > 0.75 + 1.1) CHECK(std::isinf(square[v]));
        if (s.positions[v][0] <= 6 && away < 0.5 + 0.7) CHECK(square[v] == 0.01);
    }
}
