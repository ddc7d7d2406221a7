#include "support/curved_surfaces.hpp"
#include "support/flat_sheet.hpp"
#include "support/test_data.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/io/read_mesh.hpp>
#include <tafoni/weathering/wrinkles.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

using namespace tafoni;
using namespace tafoni_test;

namespace {

std::vector<wrinkle> across(std::uint32_t n, double r, wrinkle_profile p = wrinkle_profile::fold, double strength = 1) {
    return {{.controls = {sheet_vertex(n, n / 4, n / 2), sheet_vertex(n, 3 * n / 4, n / 2)}, .radius = r, .strength = strength, .profile = p}};
}

double distance_to_path(triangle_surface const& s, std::vector<vertex_index> const& path, vec3 const& p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
        vec3 const a = s.positions[path[k].value];
        vec3 const d{s.positions[path[k + 1].value] - a};
        double const t = std::clamp(dot(vec3{p - a}, d) / dot(d, d), 0.0, 1.0);
        least = std::min(least, length(vec3{p - a - t * d}));
    }
    return least;
}
double bell(double t) { return std::exp(-4.5 * t * t) * 3 / std::sqrt(tau); }

}  // namespace

TEST_CASE("distances are those to the whole path, also where it turns back") {
    std::uint32_t const n = 40;
    triangle_surface const s = flat_sheet(n);
    vertex_rings const rings(s.positions.size(), s.triangles);
    std::vector<vertex_index> const controls{sheet_vertex(n, 5, 10), sheet_vertex(n, 30, 10), sheet_vertex(n, 30, 13), sheet_vertex(n, 5, 14), sheet_vertex(n, 20, 30)};
    auto const path = find_wrinkle_path(s, controls);
    double const r = 0.09;
    auto const reach = detail::reach_of_path(s, rings, path, r);
    std::vector<double> found(s.positions.size(), -1);
    for (auto const& q : reach) found[q.vertex] = q.distance;
    for (std::size_t v = 0; v < s.positions.size(); ++v) {
        double const d = distance_to_path(s, path, s.positions[v]);
        if (std::fabs(d - r) < 1e-9) continue;
        REQUIRE(found[v] == Approx(d < r ? d : -1).margin(1e-12));
    }
    CHECK(std::is_sorted(reach.begin(), reach.end(), [](auto const& a, auto const& b) { return a.vertex < b.vertex; }));
}

TEST_CASE("a fold leaves its line and swells beside it as the equations say") {
    std::uint32_t const n = 32;
    triangle_surface const s = flat_sheet(n);
    double const r = 0.15;
    wrinkle_pattern const pattern(s, across(n, r));
    triangle_surface const worn = pattern.wear(s.positions);
    double most = 0;
    for (std::size_t v = 0; v < worn.positions.size(); ++v) {
        vec3 const& p = worn.positions[v];
        double const dx = std::max({0.25 - p[0], p[0] - 0.75, 0.0});
        double const d = std::sqrt(dx * dx + (p[1] - 0.5) * (p[1] - 0.5));
        double const t = d / r;
        double const expected = d < r ? r * std::exp(-4.5 * t * t) * 3 / std::sqrt(tau) * std::sqrt(t) / 10 : 0.0;
        CHECK(p[2] == Approx(expected).margin(1e-12));
        most = std::max(most, p[2]);
    }
    CHECK(most == Approx(0.0453 * r).epsilon(0.02));  // at a distance of r / sqrt(18)
}

TEST_CASE("subdivision is local: twice along the line, once around, none elsewhere") {
    std::uint32_t const n = 32;
    triangle_surface const s = flat_sheet(n);
    wrinkle_pattern const fine(s, across(n, 0.15));
    wrinkle_pattern const once(s, across(n, 0.15), {}, {.subdivisions = 1});
    wrinkle_pattern const none(s, across(n, 0.15), {}, {.subdivisions = 0});
    CHECK(none.triangles().size() == s.triangles.size());
    CHECK(once.triangles().size() > s.triangles.size());
    CHECK(fine.triangles().size() > once.triangles().size());
    CHECK(fine.triangles().size() < 6 * s.triangles.size());
    // The line itself is refined with it: 16 edges became 64.
    CHECK(fine.paths()[0].size() == 65);
    // Vertex by vertex: edges near the line are a quarter, those within the radius at most half as long as they were.
    triangle_surface const flat = fine.wear(s.positions, 0);
    double const edge = 1.0 / n;
    for (auto const& t : flat.triangles) {
        double nearest = 1;
        double longest = 0;
        double shortest = 1;
        for (std::size_t k = 0; k < 3; ++k) {
            vec3 const& p = flat.positions[t[k]];
            nearest = std::min(nearest, distance_to_path(flat, fine.paths()[0], p));
            longest = std::max(longest, length(vec3{flat.positions[t[(k + 1) % 3]] - p}));
            shortest = std::min(shortest, length(vec3{flat.positions[t[(k + 1) % 3]] - p}));
        }
        if (nearest < 0.99 * 0.05) CHECK(longest < 1.01 * std::sqrt(2) * edge / 4);
        if (nearest < 0.99 * 0.15) CHECK(longest < 1.01 * std::sqrt(2) * edge / 2);
        if (nearest > 0.05 + 2 * edge) CHECK(shortest > 0.99 * edge / 2);
        if (nearest > 0.15 + 3 * edge) CHECK(shortest > 0.99 * edge);
    }
    wrinkle_pattern const finer(s, across(n, 0.15), {}, {.subdivisions = 4});
    CHECK(finer.paths()[0].size() == 257);
}

TEST_CASE("a pattern before it is worn is the same surface: closed, oriented, of the same volume and area") {
    triangle_surface const s = torus_surface(36, 24, 0.2).mesh;
    std::vector<wrinkle> const lines{{.controls = {vertex_index{3}, vertex_index{400}, vertex_index{90}}, .radius = 0.25},
                                     {.controls = {vertex_index{12}, vertex_index{700}}, .radius = 0.1, .strength = -2,
                                      .profile = wrinkle_profile::groove}};
    wrinkle_pattern const pattern(s, lines, {}, {.subdivisions = 3});
    triangle_surface const fine = pattern.wear(s.positions, 0);
    std::map<std::array<std::uint32_t, 2>, int> sides;
    auto const measure = [](triangle_surface const& m) {
        double six = 0;
        double twice = 0;
        for (auto const& t : m.triangles) {
            vec3 const n = cross(vec3{m.positions[t[1]] - m.positions[t[0]]}, vec3{m.positions[t[2]] - m.positions[t[0]]});
            twice += length(n);
            six += dot(m.positions[t[0]], n);
        }
        return std::array{six / 6, twice / 2};
    };
    for (auto const& t : fine.triangles) {
        for (std::size_t k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
    }
    for (auto const& [side, times] : sides) {
        REQUIRE(times == 1);
        REQUIRE(sides.count({side[1], side[0]}) == 1);
    }
    CHECK(measure(fine)[0] == Approx(measure(s)[0]).epsilon(1e-12));
    CHECK(measure(fine)[1] == Approx(measure(s)[1]).epsilon(1e-12));
    for (std::size_t v = 0; v < s.positions.size(); ++v) REQUIRE(fine.positions[v] == s.positions[v]);
    // Paths run along edges of the refined mesh, through every control.
    for (std::size_t w = 0; w < lines.size(); ++w) {
        auto const& path = pattern.paths()[w];
        for (std::size_t k = 1; k < path.size(); ++k) REQUIRE(sides.count({path[k - 1].value, path[k].value}) == 1);
        CHECK(path.front() == lines[w].controls.front());
        CHECK(path.back() == lines[w].controls.back());
        for (vertex_index const c : lines[w].controls) CHECK(std::count(path.begin(), path.end(), c) >= 1);
    }
}

TEST_CASE("folds cut into each other and into what is enlarged, grooves into all") {
    std::uint32_t const n = 24;
    triangle_surface const s = flat_sheet(n);
    double const r = 0.15;
    std::vector<wrinkle> const lines{{.controls = {sheet_vertex(n, 4, 12), sheet_vertex(n, 20, 12)}, .radius = r},
                                     {.controls = {sheet_vertex(n, 12, 5), sheet_vertex(n, 12, 19)}, .radius = r, .strength = 2},
                                     {.controls = {sheet_vertex(n, 8, 3), sheet_vertex(n, 8, 21)}, .radius = 0.07, .strength = -3, .profile = wrinkle_profile::groove}};
    std::vector<enlargement> const bulge{{.centre = sheet_vertex(n, 15, 14), .radius = 0.3, .strength = 4}};
    wrinkle_pattern const p(s, lines, bulge, {.subdivisions = 1});
    triangle_surface const flat = p.wear(s.positions, 0);
    auto const factor = p.displacement();
    for (std::size_t k = 0; k < 2; ++k) {
        for (vertex_index const v : p.paths()[k]) {
            if (distance_to_path(flat, p.paths()[2], flat.positions[v.value]) > 0.07) CHECK(factor[v.value] == 0);
        }
    }
    for (std::size_t v = 0; v < flat.positions.size(); ++v) {
        double const a = distance_to_path(flat, p.paths()[0], flat.positions[v]) / r;
        double const b = distance_to_path(flat, p.paths()[1], flat.positions[v]) / r;
        double const c = length(vec3{flat.positions[v] - s.positions[sheet_vertex(n, 15, 14).value]}) / 0.3;
        double expected = r / 10 * ((a < 1 ? bell(a) : 0) + (b < 1 ? 2 * bell(b) : 0)) + (c < 1 ? 0.3 / 10 * 4 * bell(c) : 0);
        if (a < 1 || b < 1) expected *= std::sqrt(std::min(a, b));
        double const d = distance_to_path(flat, p.paths()[2], flat.positions[v]) / 0.07;
        if (d < 1) expected += 0.07 / 10 * -3 * bell(d);  // carved whatever swells there
        if (std::fabs(a - 1) < 1e-9 || std::fabs(d - 1) < 1e-9 || std::fabs(b - 1) < 1e-9 || std::fabs(c - 1) < 1e-9) continue;
        REQUIRE(factor[v] == Approx(expected).margin(1e-14));
    }
}

TEST_CASE("as printed, equations 12.1 to 12.3 hold in the model's unit") {
    std::uint32_t const n = 16;
    double const size = 8;
    triangle_surface const s = flat_sheet(n, size);
    double const r = 1.6;
    double const sigma = r * r / 3;
    std::vector<enlargement> const bulge{{.centre = sheet_vertex(n, 8, 13), .radius = 2, .strength = 3}};
    wrinkle_pattern const p(s, across(n, r), bulge, {.divisor = 5, .subdivisions = 0, .formula = wrinkle_formula::as_printed});
    for (std::size_t v = 0; v < s.positions.size(); ++v) {
        double const d = distance_to_path(s, p.paths()[0], s.positions[v]);
        double const c = length(vec3{s.positions[v] - s.positions[sheet_vertex(n, 8, 13).value]});
        auto const f = [](double x, double sig) { return std::exp(-x * x / (2 * sig * sig)) / (sig * std::sqrt(tau)); };
        double const expected = ((d < r ? f(d, sigma) : 0) + (c < 2 ? 3 * f(c, 4.0 / 3) : 0)) * std::sqrt(d) / 5;
        REQUIRE(p.displacement()[v] == Approx(expected).margin(1e-13));
    }
}

TEST_CASE("n times, then m times more equal n + m times, on any number of threads") {
    triangle_surface const s = sphere(3).mesh;
    std::vector<wrinkle> const lines{{.controls = {vertex_index{5}, vertex_index{300}}, .radius = 0.3}};
    wrinkle_pattern const p(s, lines);
    triangle_surface const five = p.wear(s.positions, 5);
    CHECK(p.wear_again(p.wear(s.positions, 2), 3) == five);
    CHECK(p.wear_again(five, 0) == five);
    CHECK(p.wear(s.positions, 5, thread_pool(3)) == five);
    CHECK_THROWS_WITH(p.wear_again(s), Catch::Contains("the refined base"));
    triangle_surface turned = five;
    std::swap(turned.triangles[0][0], turned.triangles[0][1]);
    CHECK_THROWS_WITH(p.wear_again(turned), Catch::Contains("triangles"));
    triangle_surface broken = five;
    broken.positions[7][1] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(p.wear_again(broken), Catch::Contains("vertex 7"));
}

TEST_CASE("a wrinkle is the same on a model of any size, unless asked as printed") {
    std::uint32_t const n = 24;
    triangle_surface const small = flat_sheet(n);
    triangle_surface const large = flat_sheet(n, 1024);
    triangle_surface const a = wrinkle_pattern(small, across(n, 0.2)).wear(small.positions);
    triangle_surface const b = wrinkle_pattern(large, across(n, 0.2 * 1024)).wear(large.positions);
    REQUIRE(a.positions.size() == b.positions.size());
    for (std::size_t v = 0; v < a.positions.size(); ++v) CHECK(b.positions[v] == vec3{1024 * a.positions[v]});
    // Any unit, any place; lengths whose squares do not fit into a double.
    for (auto const& [scale, shift] : {std::pair{1e30, 0.0}, {1e-30, 0.0}, {1.7e-85, 0.0}, {1.7e85, 0.0}, {3.0, 1000.0}, {0.3, -20000.0}}) {
        triangle_surface moved = small;
        for (vec3& p : moved.positions) p = vec3{scale * p + vec3{shift, -shift, 2 * shift}};
        std::vector<wrinkle> const lines = across(n, 0.2 * scale);
        wrinkle_pattern const pattern(moved, lines);
        triangle_surface const c = pattern.wear(moved.positions);
        REQUIRE(c.triangles == a.triangles);
        double off = 0;
        for (std::size_t v = 0; v < a.positions.size(); ++v) {
            off = std::max(off, length(vec3{(c.positions[v] - vec3{shift, -shift, 2 * shift}) / scale - a.positions[v]}));
        }
        INFO(scale << " " << shift);
        CHECK(off < 1e-9);
    }
    triangle_surface huge = small;
    for (vec3& p : huge.positions) p *= 1e150;
    CHECK_THROWS_WITH(wrinkle_pattern(huge, across(n, 1e90)), Catch::Contains("too large"));
    CHECK_THROWS_WITH(wrinkle_pattern(small, across(n, 0.2)).wear(huge.positions), Catch::Contains("too large"));
    wrinkle_options const printed{.formula = wrinkle_formula::as_printed};
    triangle_surface const c = wrinkle_pattern(large, across(n, 0.2 * 1024), {}, printed).wear(large.positions);
    double difference = 0;
    for (std::size_t v = 0; v < a.positions.size(); ++v) difference = std::max(difference, length(c.positions[v] - b.positions[v]));
    CHECK(difference > 1);
}

TEST_CASE("a negative groove carves a crack, as deep as its strength") {
    std::uint32_t const n = 32;
    triangle_surface const s = flat_sheet(n);
    auto const depth = [&](double strength, std::uint32_t times) {
        wrinkle_pattern const p(s, across(n, 0.1, wrinkle_profile::groove, strength));
        double low = 0;
        for (vec3 const& q : p.wear(s.positions, times).positions) low = std::min(low, q[2]);
        return -low;
    };
    CHECK(depth(-1, 1) == Approx(0.1 * 3 / std::sqrt(tau) / 10));
    CHECK(depth(-2, 1) == Approx(2 * depth(-1, 1)));
    CHECK(depth(-1, 2) > 1.6 * depth(-1, 1));
    CHECK(depth(1, 1) == 0);
}

TEST_CASE("an enlargement swells around its vertex and nowhere else") {
    std::uint32_t const n = 16;
    triangle_surface const s = flat_sheet(n);
    std::vector<enlargement> const bulge{{.centre = sheet_vertex(n, 8, 8), .radius = 0.3}};
    wrinkle_pattern const p(s, {}, bulge);
    triangle_surface const worn = p.wear(s.positions);
    CHECK(worn.triangles == s.triangles);
    for (std::size_t v = 0; v < worn.positions.size(); ++v) {
        double const d = length(s.positions[v] - s.positions[sheet_vertex(n, 8, 8).value]);
        CHECK((worn.positions[v][2] > 0) == (d < 0.3));
    }
    CHECK(worn.positions[sheet_vertex(n, 8, 8).value][2] == Approx(0.3 * 3 / std::sqrt(tau) / 10));
}

TEST_CASE("the other side of a thin wall stays as it is") {
    // A flat box of 0.01 between two sheets that hang together at the rim only.
    std::uint32_t const n = 24;
    triangle_surface s = flat_sheet(n);
    std::size_t const m = s.positions.size();
    triangle_surface const top = s;
    for (auto p : top.positions) s.positions.push_back(vec3{p[0], p[1], -0.01});
    for (auto const& t : top.triangles) {
        auto const c = static_cast<std::uint32_t>(m);
        s.triangles.push_back({t[0] + c, t[2] + c, t[1] + c});
    }
    wrinkle_pattern const p(s, across(n, 0.1));
    triangle_surface const worn = p.wear(s.positions);
    for (std::size_t v = m; v < 2 * m; ++v) CHECK(worn.positions[v] == s.positions[v]);
}

TEST_CASE("one pattern is worn by every model of the same topology") {
    triangle_surface const base = sphere(4).mesh;
    std::vector<wrinkle> const lines{{.controls = {vertex_index{5}, vertex_index{700}}, .radius = 0.2}};
    wrinkle_pattern const p(base, lines);
    triangle_surface other = base;
    for (vec3& q : other.positions) q[2] *= 1.5;
    triangle_surface const a = p.wear(base.positions);
    triangle_surface const b = p.wear(other.positions);
    CHECK(a.triangles == b.triangles);
    CHECK(p.displacement().size() == b.positions.size());
    std::size_t moved = 0;
    std::vector<vec3> plain = other.positions;
    add_midpoints(plain, p.midpoints());
    for (std::size_t v = 0; v < plain.size(); ++v) {
        double const d = length(b.positions[v] - plain[v]);
        CHECK(d == Approx(std::fabs(p.displacement()[v])).margin(1e-12));
        moved += d > 0 ? 1U : 0U;
    }
    CHECK(moved > 20);
    CHECK_THROWS_AS(p.wear(std::span<vec3 const>(base.positions).first(10)), invalid_input);
}

TEST_CASE("wearing zero times only refines") {
    std::uint32_t const n = 16;
    triangle_surface const s = flat_sheet(n);
    wrinkle_pattern const p(s, across(n, 0.2));
    triangle_surface const fine = p.wear(s.positions, 0);
    for (vec3 const& q : fine.positions) CHECK(q[2] == 0);
    CHECK(p.origins().carried(s.positions) == fine.positions);
    REQUIRE(p.origins().face.size() == fine.triangles.size());
    REQUIRE(fine.triangles.size() > s.triangles.size());
    auto const middle = [](triangle_surface const& m, std::size_t f) {
        auto const& t = m.triangles[f];
        return vec3{(m.positions[t[0]] + m.positions[t[1]] + m.positions[t[2]]) / 3};
    };
    double const edge = s.mean_edge_length();
    for (std::size_t f = 0; f < fine.triangles.size(); ++f) {
        CHECK(length(vec3{middle(fine, f) - middle(s, p.origins().face[f].value)}) < edge);
    }
}

TEST_CASE("bad wrinkles are refused by name") {
    std::uint32_t const n = 4;
    triangle_surface const s = flat_sheet(n);
    auto const refused = [&](wrinkle const& w, char const* what) {
        std::vector<wrinkle> const one{w};
        CHECK_THROWS_WITH(wrinkle_pattern(s, one), Catch::Contains(what));
    };
    double const nan = std::numeric_limits<double>::quiet_NaN();
    for (double const r : {0.0, -1.0, nan}) refused({.controls = {vertex_index{0}, vertex_index{5}}, .radius = r}, "radius");
    refused({.controls = {vertex_index{0}, vertex_index{5}}, .radius = 1, .strength = nan}, "strength");
    refused({.controls = {vertex_index{0}}, .radius = 1}, "at least 2");
    refused({.controls = {vertex_index{0}, vertex_index{99}}, .radius = 1}, "99");
    refused({.controls = {vertex_index{3}, vertex_index{3}}, .radius = 1}, "twice");
    std::vector<enlargement> const far{{.centre = vertex_index{1000}, .radius = 1}};
    CHECK_THROWS_WITH(wrinkle_pattern(s, {}, far), Catch::Contains("1000"));
    CHECK_THROWS_WITH(wrinkle_pattern(s, {}, {}, {.divisor = 0}), Catch::Contains("divisor"));
    CHECK_THROWS_WITH(wrinkle_pattern(s, {}, {}, {.subdivisions = 7}), Catch::Contains("subdivisions"));
    triangle_surface odd = s;
    odd.positions.push_back(vec3{0.5, 0.5, 0});  // vertex 25 belongs to nothing
    std::size_t const m = odd.positions.size();
    for (vec3 const& p : {vec3{3, 0, 0}, vec3{4, 0, 0}, vec3{3, 1, 0}}) odd.positions.push_back(p);
    auto const first = static_cast<std::uint32_t>(m);
    odd.triangles.push_back({first, first + 1, first + 2});  // an island
    auto const place = [&](std::vector<vertex_index> controls, std::vector<enlargement> swell) -> std::string {
        std::vector<wrinkle> one;
        if (!controls.empty()) one.push_back({.controls = std::move(controls), .radius = 1});
        try {
            wrinkle_pattern const p(odd, one, swell);
        } catch (bad_topology const& e) {
            return e.what();
        }
        return "accepted";
    };
    CHECK_THAT(place({vertex_index{0}, vertex_index{25}}, {}), Catch::Contains("controls[1]") && Catch::Contains("vertex 25"));
    CHECK_THAT(place({vertex_index{25}, vertex_index{1}}, {}), Catch::Contains("controls[0]") && Catch::Contains("vertex 25"));
    CHECK_THAT(place({}, {{.centre = vertex_index{25}, .radius = 1}}), Catch::Contains("enlargements[0]") && Catch::Contains("vertex 25"));
    CHECK_THAT(place({vertex_index{2}, vertex_index{std::size_t{first}}}, {}), Catch::Contains("from vertex 2 to vertex 26"));
    CHECK(place({vertex_index{0}, vertex_index{24}}, {{.centre = vertex_index{std::size_t{first}}, .radius = 1}}) == "accepted");
}

TEST_CASE("zero-area faces, doubled faces and open borders carry wrinkles without a number that is none") {
    std::uint32_t const n = 8;
    triangle_surface s = flat_sheet(n);
    s.positions[sheet_vertex(n, 4, 4).value] = s.positions[sheet_vertex(n, 4, 5).value];  // edges of no length
    s.triangles.push_back({0, 0, 1});
    s.triangles.push_back(s.triangles.front());
    s.triangles.push_back({sheet_vertex(n, 2, 2).value, sheet_vertex(n, 3, 3).value, sheet_vertex(n, 4, 4).value});
    std::vector<wrinkle> const lines{{.controls = {sheet_vertex(n, 0, 0), sheet_vertex(n, 4, 4), sheet_vertex(n, 4, 5), sheet_vertex(n, 8, 8), sheet_vertex(n, 0, 8), sheet_vertex(n, 0, 0)}, .radius = 0.2},
                                     {.controls = {sheet_vertex(n, 8, 0), sheet_vertex(n, 7, 0)}, .radius = 1e-3, .strength = -1, .profile = wrinkle_profile::groove}};
    std::vector<enlargement> const bulge{{.centre = sheet_vertex(n, 4, 4), .radius = 0.2}};
    wrinkle_pattern const p(s, lines, bulge);
    for (double const d : p.displacement()) REQUIRE(std::isfinite(d));
    for (vec3 const& q : p.wear(s.positions, 3).positions) REQUIRE(is_finite(q));
    // An empty mesh has no vertex to pick.
    CHECK(wrinkle_pattern(triangle_surface{}, {}).wear({}).positions.empty());
}

TEST_CASE("a crack across the bust stays within its radius") {
    auto const path = find("meshes/nefertiti_35k.ply");
    if (path.empty()) {
        WARN("skipped: meshes/nefertiti_35k.ply is not here");
        return;
    }
    triangle_surface const bust = triangles_of(read_mesh(path).mesh);
    std::vector<wrinkle> const crack{{.controls = {vertex_index{100}, vertex_index{12000}}, .radius = 12, .strength = -1,
                                      .profile = wrinkle_profile::groove}};
    wrinkle_pattern const p(bust, crack);
    triangle_surface const worn = p.wear(bust.positions);
    CHECK(worn.triangles.size() > bust.triangles.size());
    for (vec3 const& q : worn.positions) REQUIRE(is_finite(q));
}
