#include "support/odd_meshes.hpp"

#include <tafoni/geometry/self_intersections.hpp>
#include <tafoni/repair/collapse_short_edges.hpp>

#include <catch2/catch.hpp>

#include <limits>
#include <map>

using namespace tafoni;
using namespace tafoni_test;

namespace {

/// Directed edges whose opposite is missing, plus edges used twice in one direction.
std::size_t open_edges(triangle_surface const& s) {
    std::map<std::array<std::uint32_t, 2>, int> count;
    for (auto const& t : s.triangles) {
        for (std::size_t k = 0; k < 3; ++k) ++count[{t[k], t[(k + 1) % 3]}];
    }
    std::size_t open = 0;
    for (auto const& [e, n] : count) {
        auto const back = count.find({e[1], e[0]});
        if (n != 1 || back == count.end()) ++open;
    }
    return open;
}
long euler(triangle_surface const& s) {
    return static_cast<long>(s.positions.size()) - static_cast<long>(s.triangles.size()) / 2;
}
double volume(triangle_surface const& s) {
    double six = 0;
    for (auto const& t : s.triangles) {
        six += dot(s.positions[t[0]], cross(s.positions[t[1]], s.positions[t[2]]));
    }
    return six / 6;
}
double shortest_edge(triangle_surface const& s) {
    double least = std::numeric_limits<double>::max();
    for (auto const& t : s.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            least = std::min(least, length(s.positions[t[k]] - s.positions[t[(k + 1) % 3]]));
        }
    }
    return least;
}

}  // namespace

TEST_CASE("a closed manifold stays closed, of the same genus and nearly the same volume") {
    for (double const jitter : {0.3, 0.45}) {
        triangle_surface s = torus_surface(60, 40, jitter).mesh;
        triangle_surface const before = s;
        double const threshold = 0.6 * s.mean_edge_length();
        collapse_report const r = collapse_short_edges(s, threshold);
        REQUIRE(r.collapsed > 50);
        CHECK(open_edges(s) == 0);
        CHECK(euler(s) == euler(before));
        CHECK(volume(s) == Approx(volume(before)).epsilon(0.01));
        CHECK(s.positions.size() + r.collapsed == before.positions.size());
        CHECK(s.triangles.size() + 2 * r.collapsed == before.triangles.size());
    }
}

TEST_CASE("no short edge is left on a mesh where all may go") {
    triangle_surface s = torus_surface(80, 30, 0.3).mesh;
    double const threshold = 0.3 * s.mean_edge_length();
    collapse_short_edges(s, threshold);
    CHECK(shortest_edge(s) >= threshold);
}

TEST_CASE("the maps lead every old vertex and triangle to what it became") {
    triangle_surface s = torus_surface(50, 30, 0.45).mesh;
    triangle_surface const before = s;
    double const threshold = 0.5 * s.mean_edge_length();
    collapse_report const r = collapse_short_edges(s, threshold);
    REQUIRE(r.new_vertex.size() == before.positions.size());
    REQUIRE(r.new_face.size() == before.triangles.size());
    for (std::size_t v = 0; v < before.positions.size(); ++v) {
        REQUIRE(r.new_vertex[v].value < s.positions.size());
        CHECK(length(before.positions[v] - s.positions[r.new_vertex[v].value]) < 2 * threshold);
    }
    std::size_t kept = 0;
    for (std::size_t f = 0; f < before.triangles.size(); ++f) {
        if (!r.new_face[f].valid()) continue;
        ++kept;
        for (std::size_t k = 0; k < 3; ++k) {
            CHECK(s.triangles[r.new_face[f].value][k] == r.new_vertex[before.triangles[f][k]].value);
        }
    }
    CHECK(kept == s.triangles.size());
}

TEST_CASE("what cannot be collapsed without harm stays") {
    triangle_surface tetrahedron{.positions = {vec3{0, 0, 0}, vec3{1e-3, 0, 0}, vec3{0, 1, 0}, vec3{0, 0, 1}},
                                 .triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
    triangle_surface const before = tetrahedron;
    CHECK(collapse_short_edges(tetrahedron, 0.1).collapsed == 0);
    CHECK(tetrahedron == before);
    // A tube of three sides: its waist must not be pinched shut, whatever the threshold.
    triangle_surface tube = torus_surface(60, 3, 0, 1, 0.01).mesh;
    collapse_short_edges(tube, 0.15);
    CHECK(open_edges(tube) == 0);
    CHECK(euler(tube) == 0);
}

TEST_CASE("the border of an open mesh keeps its line") {
    triangle_surface s = cylinder(48, 9, 0).mesh;
    for (vec3& p : s.positions) p[2] *= 0.15;  // edges along the axis are the short ones
    triangle_surface const before = s;
    collapse_short_edges(s, 0.06);
    CHECK(s.positions.size() < before.positions.size());
    double low = 1;
    double high = 0;
    for (vec3 const& p : s.positions) {
        low = std::min(low, p[2]);
        high = std::max(high, p[2]);
    }
    CHECK(low == 0);
    CHECK(high == Approx(0.3));
}

TEST_CASE("a threshold of zero changes nothing, a bad one is refused before anything changes") {
    triangle_surface s = torus_surface(12, 8, 0.2).mesh;
    triangle_surface const before = s;
    CHECK(collapse_short_edges(s, 0).collapsed == 0);
    CHECK(s == before);
    CHECK_THROWS_AS(collapse_short_edges(s, -1), invalid_input);
    CHECK_THROWS_AS(collapse_short_edges(s, std::numeric_limits<double>::quiet_NaN()), invalid_input);
    CHECK(s == before);
}

TEST_CASE("points that coincide are collapsed without a number that is not one") {
    triangle_surface s = torus_surface(12, 8, 0).mesh;
    s.positions[9] = s.positions[10];
    collapse_short_edges(s, 1e-9);
    for (vec3 const& p : s.positions) CHECK(is_finite(p));
    CHECK(open_edges(s) == 0);
}

TEST_CASE("no triangle of a plane turns over, however many edges go") {
    for (double const share : {0.6, 0.9, 1.3}) {
        triangle_surface s = parametric(
            40, 37, false, false, 0.3, [](double u, double v) { return vec3{u, v, 0}; }, [](double, double) { return 0.0; }).mesh;
        for (auto const& t : s.triangles) {
            REQUIRE(cross(s.positions[t[1]] - s.positions[t[0]], s.positions[t[2]] - s.positions[t[0]])[2] > 0);
        }
        REQUIRE(collapse_short_edges(s, share * s.mean_edge_length()).collapsed > 100);
        for (auto const& t : s.triangles) {
            CHECK(cross(s.positions[t[1]] - s.positions[t[0]], s.positions[t[2]] - s.positions[t[0]])[2] > 0);
        }
    }
}

TEST_CASE("a closed manifold stays one down to a few dozen triangles") {
    for (std::uint32_t const n : {30U, 47U, 64U}) {
        for (double const share : {1.0, 1.5, 2.5, 4.0}) {
            triangle_surface s = torus_surface(n, 25, 0.45, 1, 0.45).mesh;
            collapse_short_edges(s, share * s.mean_edge_length());
            CHECK(open_edges(s) == 0);
            CHECK(euler(s) == 0);
            vertex_rings const rings(s.positions.size(), s.triangles);
            for (std::size_t v = 0; v < s.positions.size(); ++v) {  // a fan around every vertex: as many triangles as neighbours
                REQUIRE(rings.faces(v).size() == rings.neighbors(v).size());
                REQUIRE(rings.neighbors(v).size() >= 3);
            }
        }
    }
}

TEST_CASE("a narrow band is not pinched: only the edges at its ends go") {
    triangle_surface band;
    for (std::uint32_t k = 0; k < 20; ++k) {
        band.positions.push_back(vec3{1.0 * k, 0, 0});
        band.positions.push_back(vec3{1.0 * k, 0.01, 0});
    }
    for (std::uint32_t a = 0; a < 38; a += 2) {
        band.triangles.push_back({a, a + 2, a + 1});
        band.triangles.push_back({a + 1, a + 2, a + 3});
        band.positions.push_back(vec3{0.5 * a + 0.5, -1, 0});  // a fringe
        band.triangles.push_back({a, static_cast<std::uint32_t>(band.positions.size() - 1), a + 2});
    }
    CHECK(collapse_short_edges(band, 0.1).collapsed == 2);
    CHECK(band.triangles.size() == 3 * 19 - 2);
}

TEST_CASE("M4: a tetrahedron does not fold flat where another shares its edge") {
    triangle_surface s{.positions = {vec3{0, 0, 0}, vec3{1e-3, 0, 0}, vec3{0, 1, 0}, vec3{0, 0, 1}, vec3{1, 1, 1}, vec3{2, 1, 1}},
                       .triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {4, 5, 2}, {4, 3, 5}, {5, 3, 2}, {2, 3, 4}}};
    CHECK(collapse_short_edges(s, 0.1).collapsed == 0);
}

TEST_CASE("M18: short edges around a vertex of a hundred thousand triangles go in a moment") {
    for (bool const closed : {true, false}) {
        triangle_surface s = hub(100000, 0.5, closed);
        std::size_t const before = s.positions.size();
        collapse_report const r = collapse_short_edges(s, 0.01);
        CHECK(r.collapsed > 90000);
        CHECK(s.positions.size() + r.collapsed == before);
        if (closed) CHECK(open_edges(s) == 0);
        CHECK(shortest_edge(s) >= 0.01);
        CHECK(length(s.positions[0] - vec3{0, 0, 0.5}) == 0);
    }
}

TEST_CASE("M18: a spike of a thousand short spokes shrinks into its hub, which stays where it is") {
    triangle_surface s = hub(1000, 0.5, true);
    for (vec3& p : s.positions) p[2] *= p[2] > 0 ? 1 : 40;  // the lower hub far away
    for (std::size_t v = 1; v <= 1000; ++v) s.positions[v] *= 1e-3;
    s.positions[0] = vec3{0, 0, 1e-3};
    collapse_short_edges(s, 0.01);
    for (vec3 const& p : s.positions) CHECK(is_finite(p));
    CHECK(s.positions.size() < 20);
    CHECK(open_edges(s) == 0);
}

TEST_CASE("M4, M5, M14, M15: sheets that touch, cut or hold each other are thinned out each for itself") {
    for (odd_mesh const& odd : odd_meshes()) {
        CAPTURE(odd.name);
        triangle_surface s = odd.mesh;
        for (std::size_t v = 0; v < s.positions.size(); ++v) s.positions[v] *= 1 + 1e-3 * static_cast<double>(v % 7);
        double const threshold = 1.02 * shortest_edge(s);
        collapse_report const r = collapse_short_edges(s, threshold);
        CHECK(r.collapsed > 0);
        for (vec3 const& p : s.positions) REQUIRE(is_finite(p));
        // Every sheet stays closed: no edge is left with an odd number of triangles.
        std::map<std::array<std::uint32_t, 2>, int> sides;
        for (auto const& t : s.triangles) {
            for (std::size_t k = 0; k < 3; ++k) ++sides[{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])}];
        }
        for (auto const& [e, n] : sides) REQUIRE(n % 2 == 0);
        for (std::size_t f = 0; f < odd.mesh.triangles.size(); ++f) {
            if (!r.new_face[f].valid()) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                REQUIRE(s.triangles[r.new_face[f].value][k] == r.new_vertex[odd.mesh.triangles[f][k]].value);
            }
        }
    }
}

TEST_CASE("a collapse meets in the middle of its edge, where both ends are inside or both on the border") {
    triangle_surface s = triangles_of(icosphere(2));
    auto const edge = s.triangles[100];
    vec3 const p = s.positions[edge[0]];
    vec3 const q{0.9 * p + 0.1 * s.positions[edge[1]]};
    s.positions[edge[1]] = q;
    collapse_report const r = collapse_short_edges(s, 1.01 * length(p - q));
    REQUIRE(r.collapsed == 1);
    CHECK(r.new_vertex[edge[0]] == r.new_vertex[edge[1]]);
    CHECK(length(s.positions[r.new_vertex[edge[0]].value] - vec3{0.5 * p + 0.5 * q}) < 1e-15);
}
