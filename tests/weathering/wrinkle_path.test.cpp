#include "support/curved_surfaces.hpp"
#include "support/flat_sheet.hpp"

#include <tafoni/core/random.hpp>
#include <tafoni/weathering/wrinkle_path.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace tafoni;
using namespace tafoni_test;

TEST_CASE("a path leads along the plane, edge by edge, through every control") {
    std::uint32_t const n = 20;
    triangle_surface const s = flat_sheet(n);
    std::vector<vertex_index> const controls{sheet_vertex(n, 2, 3), sheet_vertex(n, 15, 3), sheet_vertex(n, 15, 17)};
    auto const path = find_wrinkle_path(s, controls);
    vertex_rings const rings(s.positions.size(), s.triangles);
    REQUIRE(path.front() == controls.front());
    REQUIRE(path.back() == controls.back());
    CHECK(std::count(path.begin(), path.end(), controls[1]) == 1);
    for (std::size_t k = 1; k < path.size(); ++k) {
        auto const around = rings.neighbors(path[k - 1].value);
        CHECK(std::binary_search(around.begin(), around.end(), path[k].value));
    }
    CHECK(path.size() == 13 + 14 + 1);  // straight along the grid
}

TEST_CASE("a path finds its way around a hole") {
    std::uint32_t const n = 12;
    triangle_surface s = flat_sheet(n);
    std::erase_if(s.triangles, [&](auto const& t) {
        double x = 0;
        double y = 0;
        for (auto const c : t) {
            x += s.positions[c][0] / 3;
            y += s.positions[c][1] / 3;
        }
        return x > 0.4 && x < 0.6 && y > 0.1 && y < 0.9;
    });
    // Edges of many lengths, but for the straight row.
    stream random(3, stage::user, 0);
    for (std::size_t v = 0; v < s.positions.size(); ++v) {
        double const x = random.uniform(-0.03, 0.03);
        double const y = random.uniform(-0.03, 0.03);
        if (v % (n + 1) != 6) s.positions[v] += vec3{x, y, 0};
    }
    auto const path = find_wrinkle_path(s, std::vector<vertex_index>{sheet_vertex(n, 1, 6), sheet_vertex(n, 11, 6)});
    CHECK(path.size() > 11);
    CHECK(path.back() == sheet_vertex(n, 11, 6));
    // From the rim on it is as short as edges allow, by relaxation until nothing changes.
    std::vector<double> way(s.positions.size(), 1e9);
    way[sheet_vertex(n, 11, 6).value] = 0;
    for (bool changed = true; changed;) {
        changed = false;
        for (auto const& t : s.triangles) {
            for (std::size_t k = 0; k < 6; ++k) {
                std::uint32_t const a = t[k % 3];
                std::uint32_t const b = t[(k + 1 + k / 3) % 3];
                double const d = way[b] + length(vec3{s.positions[a] - s.positions[b]});
                if (d < way[a] - 1e-12) {
                    way[a] = d;
                    changed = true;
                }
            }
        }
    }
    double left = 0;
    for (std::size_t k = 5; k < path.size(); ++k) left += length(vec3{s.positions[path[k].value] - s.positions[path[k - 1].value]});
    CHECK(path[4] == sheet_vertex(n, 5, 6));
    CHECK(left == Approx(way[path[4].value]));
    s.triangles.clear();
    CHECK_THROWS_AS(find_wrinkle_path(s, std::vector<vertex_index>{sheet_vertex(n, 1, 6), sheet_vertex(n, 11, 6)}), bad_topology);
}

TEST_CASE("a path keeps to the plane through its ends and their mean normal") {
    triangle_surface const s = sphere(5).mesh;
    auto const nearest = [&](vec3 const& p) {
        std::size_t best = 0;
        for (std::size_t v = 0; v < s.positions.size(); ++v) {
            if (length(vec3{s.positions[v] - p}) < length(vec3{s.positions[best] - p})) best = v;
        }
        return vertex_index{best};
    };
    double const edge = s.mean_edge_length();
    auto const a = nearest(normalized(vec3{1, 0.2, 0.4}));
    auto const b = nearest(normalized(vec3{-0.1, 1, -0.2}));
    auto const path = find_wrinkle_path(s, std::vector<vertex_index>{a, b});
    // On a sphere that is the great circle, which is as short as can be.
    vec3 const across = normalized(cross(s.positions[a.value], s.positions[b.value]));
    for (vertex_index const v : path) CHECK(std::fabs(dot(s.positions[v.value], across)) < edge);
    double const angle = std::acos(dot(s.positions[a.value], s.positions[b.value]));
    CHECK(static_cast<double>(path.size() - 1) * edge < 1.4 * angle);
    auto const back = find_wrinkle_path(s, std::vector<vertex_index>{b, a});
    CHECK(back.front() == b);
    CHECK(back.back() == a);
}

TEST_CASE("the plane leans to both ends alike") {
    triangle_surface const s = cylinder(200, 120, 0).mesh;
    auto const vertex = [](std::uint32_t i, std::uint32_t j) { return vertex_index{i * 120 + j}; };
    vertex_index const a = vertex(0, 5);
    vertex_index const b = vertex(50, 110);
    vec3 const p = s.positions[a.value];
    vec3 const q = s.positions[b.value];
    auto const farthest = [&](std::vector<vertex_index> const& path, vec3 const& n) {
        vec3 const across = normalized(cross(vec3{q - p}, n));
        double most = 0;
        for (vertex_index const v : path) most = std::max(most, std::fabs(dot(vec3{s.positions[v.value] - p}, across)));
        return most;
    };
    vec3 const outwards{p[0], p[1], 0};
    vec3 const there{q[0], q[1], 0};
    double const edge = s.mean_edge_length();
    for (auto const& ends : {std::vector<vertex_index>{a, b}, {b, a}}) {
        auto const path = find_wrinkle_path(s, ends);
        CHECK(farthest(path, vec3{outwards + there}) < edge);
        CHECK(farthest(path, outwards) > 3 * edge);
        CHECK(farthest(path, there) > 3 * edge);
    }
}

TEST_CASE("where normals lay no plane a path still runs straight") {
    triangle_surface const s = sphere(4).mesh;
    double const edge = s.mean_edge_length();
    // Opposite vertices: their normals cancel.
    for (std::size_t from : {0U, 3U, 77U, 900U}) {
        vec3 const p = s.positions[from];
        auto const to = static_cast<std::size_t>(std::find_if(s.positions.begin(), s.positions.end(), [&](vec3 const& q) { return length(vec3{q + p}) < 1e-6; }) - s.positions.begin());
        REQUIRE(to < s.positions.size());
        auto const path = find_wrinkle_path(s, std::vector<vertex_index>{vertex_index{from}, vertex_index{to}});
        CHECK(path.back() == vertex_index{to});
        CHECK(static_cast<double>(path.size() - 1) * edge < 1.4 * tau / 2);
    }
    // A ribbon of no width at both ends, where no face has a normal.
    triangle_surface thin = flat_sheet(10);
    for (std::uint32_t j = 0; j <= 10; ++j) {
        for (std::uint32_t const i : {1U, 2U, 3U, 7U, 8U, 9U}) thin.positions[sheet_vertex(10, i, j).value][1] = 0.5;
    }
    auto const path = find_wrinkle_path(thin, std::vector<vertex_index>{sheet_vertex(10, 2, 5), sheet_vertex(10, 8, 5)});
    CHECK(path.back() == sheet_vertex(10, 8, 5));
    CHECK(path.size() == 7);
}
