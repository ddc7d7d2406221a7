#include "support/curved_surfaces.hpp"

#include <tafoni/geometry/refine_faces.hpp>

#include <catch2/catch.hpp>

#include <map>

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

TEST_CASE("edges are split where they are asked for, on both sides") {
    triangle_surface const s = sphere(2).mesh;
    double const target = 1.02 * s.mean_edge_length();
    auto const long_edge = [&](std::uint32_t a, std::uint32_t b) { return length(s.positions[a] - s.positions[b]) > target; };
    refined_faces const r = refine_edges(s, long_edge);
    CHECK(!r.midpoints.empty());
    for (auto const& m : r.midpoints) CHECK(long_edge(m[0], m[1]));
    CHECK(closed(refined(s, r)));
}
