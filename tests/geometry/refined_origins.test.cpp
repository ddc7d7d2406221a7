#include <tafoni/geometry/refined_origins.hpp>

#include <tafoni/core/vector.hpp>

#include <catch2/catch.hpp>

#include "support/water_scenes.hpp"

#include <vector>

using namespace tafoni;

namespace {

vec3 normal_of(triangle_surface const& s, std::size_t f) {
    auto const& t = s.triangles[f];
    return cross(vec3{s.positions[t[1]] - s.positions[t[0]]}, vec3{s.positions[t[2]] - s.positions[t[0]]});
}

}  // namespace

TEST_CASE("a surface refined three times leads back to its vertices and faces") {
    triangle_surface const input = tafoni_test::sheet(5, [](double x, double y) { return 0.1 * x * y; });
    triangle_surface s = input;
    refined_origins origins(s.triangles.size());
    for (std::size_t round = 0; round < 3; ++round) {
        std::vector<unsigned char> chosen(s.triangles.size(), 0);
        for (std::size_t f = round; f < chosen.size(); f += 3) chosen[f] = 1;
        refined_faces const fine = refine_faces(s, chosen);
        origins.follow(fine);
        add_midpoints(s.positions, fine.midpoints);
        s.triangles = fine.triangles;
    }
    REQUIRE(s.positions.size() == input.positions.size() + origins.midpoints.size());
    REQUIRE(origins.face.size() == s.triangles.size());
    REQUIRE(s.triangles.size() > 4 * input.triangles.size());

    CHECK(origins.carried(input.positions) == s.positions);
    std::vector<double> x;
    for (vec3 const& p : input.positions) x.push_back(p[0]);
    std::vector<double> const now = origins.carried(x);
    for (std::size_t v = 0; v < now.size(); ++v) CHECK(now[v] == s.positions[v][0]);

    // What lies in a triangle of the input has its normal, and together they have its area.
    std::vector<double> area(input.triangles.size(), 0.0);
    for (std::size_t f = 0; f < s.triangles.size(); ++f) {
        vec3 const whole = normal_of(input, origins.face[f].value);
        vec3 const part = normal_of(s, f);
        CHECK(length(cross(whole, part)) < 1e-12);
        CHECK(dot(whole, part) > 0);
        area[origins.face[f].value] += length(part);
    }
    for (std::size_t f = 0; f < area.size(); ++f) CHECK(area[f] == Approx(length(normal_of(input, f))).epsilon(1e-12));
}

TEST_CASE("what was not refined is its own origin") {
    refined_origins const origins(3);
    CHECK(origins.face == std::vector<face_index>{face_index{0U}, face_index{1U}, face_index{2U}});
    CHECK(origins.carried(std::vector<double>{1, 2}) == std::vector<double>{1, 2});
}
