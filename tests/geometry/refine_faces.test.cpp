#include "support/curved_surfaces.hpp"

#include <tafoni/geometry/refine_faces.hpp>

#include <catch2/catch.hpp>

#include <array>
#include <map>
#include <set>
#include <vector>

using namespace tafoni;
using namespace tafoni_test;

namespace {

triangle_surface refined(triangle_surface const& s, refined_faces const& r) {
    triangle_surface out{.positions = s.positions, .triangles = r.triangles};
    add_midpoints(out.positions, r.midpoints);
    return out;
}
double area(triangle_surface const& s) {
    double twice = 0;
    for (auto const& t : s.triangles) {
        twice += length(cross(s.positions[t[1]] - s.positions[t[0]], s.positions[t[2]] - s.positions[t[0]]));
    }
    return twice / 2;
}
bool closed(triangle_surface const& s) {
    std::map<std::array<std::uint32_t, 2>, int> count;
    for (auto const& t : s.triangles) {
        for (std::size_t k = 0; k < 3; ++k) ++count[{t[k], t[(k + 1) % 3]}];
    }
    for (auto const& [e, n] : count) {
        auto const back = count.find({e[1], e[0]});
        if (n != 1 || back == count.end()) return false;
    }
    return true;
}

}  // namespace

TEST_CASE("whatever is chosen, the refined mesh is closed and covers the same surface") {
    triangle_surface const s = torus_surface(20, 12, 0.3).mesh;
    stream random(5, 0, 0);
    for (double const share : {0.02, 0.3, 0.7, 1.0}) {
        std::vector<unsigned char> chosen(s.triangles.size());
        for (auto& c : chosen) c = random.chance(share) ? 1 : 0;
        refined_faces const r = refine_faces(s, chosen);
        triangle_surface const fine = refined(s, r);
        CHECK(closed(fine));
        CHECK(area(fine) == Approx(area(s)).epsilon(1e-12));
        CHECK(fine.positions.size() - fine.triangles.size() / 2 == s.positions.size() - s.triangles.size() / 2);
        std::vector<int> children(s.triangles.size(), 0);
        for (face_index const f : r.parent) ++children[f.value];
        for (std::size_t f = 0; f < children.size(); ++f) {
            CHECK((chosen[f] != 0 ? children[f] == 4 : children[f] >= 1));
        }
        // Every child lies in its parent, faces as it does, and a chosen face's children are its quarters.
        for (std::size_t c = 0; c < r.triangles.size(); ++c) {
            auto const normal = [](triangle_surface const& m, std::array<std::uint32_t, 3> const& k) {
                return cross(vec3{m.positions[k[1]] - m.positions[k[0]]}, vec3{m.positions[k[2]] - m.positions[k[0]]});
            };
            vec3 const whole = normal(s, s.triangles[r.parent[c].value]);
            vec3 const part = normal(fine, r.triangles[c]);
            REQUIRE(length(vec3{part - whole * (dot(part, whole) / dot(whole, whole))}) < 1e-12 * length(whole));
            double const portion = dot(part, whole) / dot(whole, whole);
            REQUIRE(portion > 0);
            if (chosen[r.parent[c].value] != 0) REQUIRE(portion == Approx(0.25).epsilon(1e-10));
            REQUIRE(portion > 0.2499);
        }
        // No vertex lies within an edge: of both halves of a split edge, the whole is gone.
        std::set<std::array<std::uint32_t, 2>> sides;
        for (auto const& k : r.triangles) {
            for (std::size_t e = 0; e < 3; ++e) sides.insert({std::min(k[e], k[(e + 1) % 3]), std::max(k[e], k[(e + 1) % 3])});
        }
        for (std::size_t m = 0; m < r.midpoints.size(); ++m) {
            auto const middle = static_cast<std::uint32_t>(s.positions.size() + m);
            REQUIRE(sides.count(r.midpoints[m]) == 0);
            for (std::uint32_t const end : r.midpoints[m]) REQUIRE(sides.count({end, middle}) == 1);
        }
        if (share == 1.0) CHECK(fine.triangles.size() == 4 * s.triangles.size());
        CHECK(r.parent.size() == r.triangles.size());
    }
}

TEST_CASE("nothing chosen is the identity") {
    triangle_surface const s = torus_surface(8, 6, 0).mesh;
    refined_faces const r = refine_faces(s, std::vector<unsigned char>(s.triangles.size(), 0));
    CHECK(r.triangles == s.triangles);
    CHECK(r.midpoints.empty());
    CHECK_THROWS_AS(refine_faces(s, std::vector<unsigned char>(3, 1)), invalid_input);
}

TEST_CASE("a neighbour of one chosen triangle becomes two, of two chosen three") {
    // Four triangles in a row.
    triangle_surface const s{.positions = {vec3{0, 0, 0}, vec3{1, 0, 0}, vec3{0, 1, 0}, vec3{1, 1, 0}, vec3{0, 2, 0}},
                             .triangles = {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}};
    auto const children = [&](std::vector<unsigned char> const& chosen) {
        std::vector<int> n(3, 0);
        for (face_index const f : refine_faces(s, chosen).parent) ++n[f.value];
        return n;
    };
    CHECK(children({1, 0, 0}) == std::vector<int>{4, 2, 1});
    CHECK(children({1, 0, 1}) == std::vector<int>{4, 3, 4});
}

TEST_CASE("triangles are cut as in Figure 12.1, corner by corner") {
    // 2 - 3
    // | \ |   the edge 1-2 in the middle
    // 0 - 1
    std::vector<vec3> const square{vec3{0, 0, 0}, vec3{1, 0, 0}, vec3{0, 1, 0}, vec3{1, 1, 0}};
    using corners = std::vector<std::array<std::uint32_t, 3>>;
    triangle_surface const s{.positions = square, .triangles = {{0, 1, 2}, {3, 2, 1}}};
    refined_faces const r = refine_faces(s, std::vector<unsigned char>{1, 0});
    CHECK(r.midpoints == std::vector<std::array<std::uint32_t, 2>>{{0, 1}, {0, 2}, {1, 2}});  // 4, 5, 6
    CHECK(r.triangles == corners{{0, 4, 5}, {4, 1, 6}, {5, 6, 2}, {4, 6, 5}, {2, 6, 3}, {6, 1, 3}});
    CHECK(r.parent == std::vector<face_index>{face_index{0U}, face_index{0U}, face_index{0U}, face_index{0U}, face_index{1U}, face_index{1U}});
    std::vector<vec3> moved = square;
    add_midpoints(moved, r.midpoints);
    CHECK(moved[4] == vec3{0.5, 0, 0});
    CHECK(moved[5] == vec3{0, 0.5, 0});
    CHECK(moved[6] == vec3{0.5, 0.5, 0});
    // Two splits: of the quadrilateral that is left the shorter diagonal; with equal ones that from the lower corner.
    auto const two = [](vec3 const& top) {
        triangle_surface const one{.positions = {vec3{0, 0, 0}, vec3{2, 0, 0}, top}, .triangles = {{0, 1, 2}}};
        return refine_edges(one, [](std::uint32_t a, std::uint32_t b) { return !(a == 0 && b == 1); }).triangles;
    };
    CHECK(two({0.5, 2, 0}) == corners{{3, 4, 2}, {0, 1, 4}, {0, 4, 3}});    // from 0 to the middle of 1-2
    CHECK(two({1.5, 2, 0}) == corners{{3, 4, 2}, {0, 1, 3}, {1, 4, 3}});    // from 1 to the middle of 0-2
    CHECK(two({1, 2, 0}) == corners{{3, 4, 2}, {0, 1, 4}, {0, 4, 3}});
    // The same choice from whatever corner the triangle is named.
    triangle_surface const turned{.positions = {vec3{0, 0, 0}, vec3{2, 0, 0}, vec3{1, 2, 0}}, .triangles = {{2, 0, 1}}};
    CHECK(refine_edges(turned, [](std::uint32_t a, std::uint32_t b) { return !(a == 0 && b == 1); }).triangles ==
          corners{{3, 4, 2}, {0, 1, 4}, {0, 4, 3}});
}

TEST_CASE("crowded edges, triangles with a corner twice and open borders are refined like the rest") {
    // Three triangles at the edge 0-1, one with a corner twice, one without area.
    triangle_surface const s{.positions = {vec3{0, 0, 0}, vec3{1, 0, 0}, vec3{0, 1, 0}, vec3{0, 0, 1}, vec3{0, -1, 0}, vec3{0.5, 0, 0}},
                             .triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {0, 0, 1}, {0, 5, 1}}};
    refined_faces const r = refine_faces(s, std::vector<unsigned char>{1, 0, 0, 1, 0});
    CHECK(r.midpoints.size() == 3);
    std::vector<int> children(5, 0);
    for (face_index const f : r.parent) ++children[f.value];
    CHECK(children[0] == 4);
    CHECK(children[1] == 2);
    CHECK(children[2] == 2);
    CHECK(children[4] == 2);
    for (auto const& t : r.triangles) {
        for (std::uint32_t const c : t) CHECK(c < s.positions.size() + r.midpoints.size());
    }
    // A second refinement goes on from the first one's vertices.
    triangle_surface const fine = refined(s, r);
    refined_faces const again = refine_faces(fine, std::vector<unsigned char>(fine.triangles.size(), 1));
    std::vector<std::array<std::uint32_t, 2>> both = r.midpoints;
    both.insert(both.end(), again.midpoints.begin(), again.midpoints.end());
    std::vector<vec3> at_once = s.positions;
    add_midpoints(at_once, both);
    CHECK(at_once == refined(fine, again).positions);
}

TEST_CASE("edges are split where they are asked for, on both sides") {
    triangle_surface const s = sphere(2).mesh;
    double const target = 1.02 * s.mean_edge_length();
    auto const long_edge = [&](std::uint32_t a, std::uint32_t b) { return length(s.positions[a] - s.positions[b]) > target; };
    refined_faces const r = refine_edges(s, long_edge);
    CHECK(!r.midpoints.empty());
    for (auto const& m : r.midpoints) CHECK(long_edge(m[0], m[1]));
    CHECK(closed(refined(s, r)));
}
