#include "support/curved_surfaces.hpp"

#include <tafoni/geometry/triangle_surface.hpp>

#include <catch2/catch.hpp>

#include <limits>
#include <string>

using namespace tafoni;

namespace {

struct refusal {
    errc code{};
    std::string text{};
    std::uint64_t index = error_place::nowhere;
};
template <class F>
refusal refused(F const& f) {
    try {
        f();
    } catch (invalid_input const& e) {
        return {e.code(), e.what(), e.place().index};
    }
    return {};
}

}  // namespace

TEST_CASE("a copy keeps the numbers of vertices and faces, isolated vertices too") {
    indexed_mesh m;
    for (vec3 const& p : {vec3{0, 0, 0}, vec3{9, 9, 9}, vec3{1, 0, 0}, vec3{0, 1, 0}, vec3{0, 0, 1}}) m.add_vertex(p);
    m.add_face({0, 2, 3});
    m.add_face({3, 2, 4});
    triangle_surface const s = triangle_surface::copy_of(m);
    CHECK(s.positions == m.positions);
    CHECK(s.triangles == std::vector<std::array<std::uint32_t, 3>>{{0, 2, 3}, {3, 2, 4}});
    CHECK(triangle_surface::copy_of(s) == s);
    CHECK(triangle_surface::copy_of(indexed_mesh{}) == triangle_surface{});
    CHECK_FALSE(s == triangle_surface{});
}

TEST_CASE("the mean side counts three for each triangle") {
    triangle_surface const s{.positions = {vec3{0, 0, 0}, vec3{3, 0, 0}, vec3{0, 4, 0}, vec3{3, 4, 0}},
                             .triangles = {{0, 1, 2}, {3, 2, 1}}};
    CHECK(s.mean_edge_length() == 4);
    CHECK(triangle_surface{}.mean_edge_length() == 0);
}

TEST_CASE("what is no surface of triangles is refused with its place") {
    indexed_mesh quad;
    for (vec3 const& p : {vec3{0, 0, 0}, vec3{1, 0, 0}, vec3{1, 1, 0}, vec3{0, 1, 0}}) quad.add_vertex(p);
    quad.add_face({0, 1, 2});
    quad.add_face({0, 1, 2, 3});
    refusal r = refused([&] { (void)triangle_surface::copy_of(quad); });
    CHECK(r.code == errc::unsupported);
    CHECK(r.index == 1);
    CHECK_THAT(r.text, Catch::Contains("face 1 has 4 corners"));
    triangle_surface s{.positions = {vec3{0, 0, 0}, vec3{1, 0, 0}, vec3{0, 1, 0}}, .triangles = {{0, 1, 2}, {1, 2, 3}}};
    r = refused([&] { (void)triangle_surface::copy_of(s); });
    CHECK(r.code == errc::index_out_of_range);
    CHECK(r.index == 1);
    CHECK_THAT(r.text, Catch::Contains("face 1 corner 2 is vertex 3 of 3"));
    r = refused([&] { s.validate(); });
    CHECK(r.code == errc::index_out_of_range);
    CHECK(r.index == 1);
    s.triangles.pop_back();
    s.validate();
    for (double const bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        s.positions[2][1] = bad;
        r = refused([&] { (void)triangle_surface::copy_of(s); });
        CHECK(r.code == errc::non_finite_vertex);
        CHECK(r.index == 2);
    }
}
