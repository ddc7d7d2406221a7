#include <tafoni/geometry/self_intersections.hpp>

#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/io/read_obj.hpp>
#include <tafoni/io/read_ply.hpp>

#include <catch2/catch.hpp>

#include <support/shapes.hpp>
#include <support/test_data.hpp>

using namespace tafoni;

namespace {

using pairs = std::vector<std::array<std::uint32_t, 2>>;

bool cut(std::array<vec3, 3> const& a, std::array<vec3, 3> const& b) {
    bool const r = detail::cut_each_other(a, b);
    CHECK(detail::cut_each_other(b, a) == r);
    CHECK(detail::cut_each_other({a[1], a[2], a[0]}, {b[2], b[1], b[0]}) == r);
    return r;
}

}  // namespace

TEST_CASE("sound solids do not cut themselves") {
    for (auto const& m : {tafoni_test::unit_box(), tafoni_test::l_shape(), tafoni_test::box_with_cavity(),
                          tafoni_test::frame(), tafoni_test::torus(2, 0.5, 12, 9), tafoni_test::thin_limbs(),
                          tafoni_test::terrain_block(8, 8)}) {
        CHECK(self_intersections(make_solid(m)).empty());
    }
}

TEST_CASE("two triangles cut each other when they share more than corners and the side between") {
    std::array<vec3, 3> const base{vec3{0, 0, 0}, vec3{4, 0, 0}, vec3{0, 4, 0}};
    CHECK(cut(base, {vec3{1, 1, -1}, vec3{1, 1, 1}, vec3{9, 9, 0}}));           // pierced
    CHECK_FALSE(cut(base, {vec3{3, 3, -1}, vec3{3, 3, 1}, vec3{9, 9, 0}}));     // beside it
    CHECK(cut(base, {vec3{1, 1, 0}, vec3{1, 1, 1}, vec3{2, 1, 1}}));            // a corner on the face
    CHECK(cut(base, {vec3{2, 0, 0}, vec3{2, -1, 1}, vec3{2, -1, -1}}));         // a corner on a side
    CHECK(cut(base, {vec3{1, 1, 0}, vec3{2, 1, 0}, vec3{1, 2, 0}}));            // inside, in one plane
    CHECK(cut(base, {vec3{-1, 1, 0}, vec3{9, 1, 0}, vec3{9, 2, 0}}));           // across, in one plane
    CHECK_FALSE(cut(base, {vec3{5, 0, 0}, vec3{9, 0, 0}, vec3{5, 4, 0}}));      // in one plane, apart
    CHECK_FALSE(cut(base, {vec3{0, 0, 0}, vec3{-1, 0, 1}, vec3{0, -1, 1}}));    // share a corner
    CHECK(cut(base, {vec3{0, 0, 0}, vec3{2, 1, 1}, vec3{2, 1, -1}}));           // share a corner and cut
    CHECK_FALSE(cut(base, {vec3{0, 0, 0}, vec3{4, 0, 0}, vec3{1, -1, 0}}));     // share a side, spread flat
    CHECK_FALSE(cut(base, {vec3{0, 0, 0}, vec3{4, 0, 0}, vec3{1, 1, 1}}));      // share a side, bent
    CHECK(cut(base, {vec3{0, 0, 0}, vec3{4, 0, 0}, vec3{1, 1, 0}}));            // folded onto it
    CHECK(cut(base, base));
}

TEST_CASE("a box through a box is found by both sides, a gap of one rounding is not") {
    indexed_mesh m = tafoni_test::unit_box();
    tafoni_test::append(m, tafoni_test::box(vec3{0.25, 0.25, 0.5}, vec3{0.75, 0.75, 2}));
    pairs const found = self_intersections(make_solid(m));
    CHECK_FALSE(found.empty());
    CHECK(std::is_sorted(found.begin(), found.end()));
    for (auto const& p : found) {
        CHECK(p[0] < 12);
        CHECK(p[1] >= 12);
    }
    indexed_mesh apart = tafoni_test::unit_box();
    tafoni_test::append(apart, tafoni_test::box(vec3{std::nextafter(1.0, 2.0), 0.25, 0.25}, vec3{2, 0.75, 0.75}));
    CHECK(self_intersections(make_solid(apart)).empty());
    indexed_mesh touching = tafoni_test::unit_box();
    tafoni_test::append(touching, tafoni_test::box(vec3{1, 0.25, 0.25}, vec3{2, 0.75, 0.75}));
    CHECK_FALSE(self_intersections(make_solid(touching)).empty());
}

TEST_CASE("the tree finds what comparing all pairs finds") {
    indexed_mesh m = tafoni_test::torus(1, 0.4, 10, 8);
    tafoni_test::append(m, tafoni_test::icosphere(1));
    solid const s = make_solid(m);
    pairs expected;
    for (std::uint32_t i = 0; i < s.triangles.size(); ++i) {
        for (std::uint32_t j = i + 1; j < s.triangles.size(); ++j) {
            std::array<vec3, 3> a, b;
            for (std::size_t k = 0; k < 3; ++k) {
                a[k] = s.positions[s.triangles[i][k]];
                b[k] = s.positions[s.triangles[j][k]];
            }
            if (detail::cut_each_other(a, b)) expected.push_back({i, j});
        }
    }
    CHECK(expected.size() > 50);
    CHECK(self_intersections(s) == expected);
}

TEST_CASE("the scorpion cuts itself in 15 pairs, the wing nut in 3") {
    if (tafoni_test::find("meshes/scorpion_50k.ply").empty()) {
        WARN("skipped: no data");
        return;
    }
    CHECK(self_intersections(make_solid(read_ply(tafoni_test::find("meshes/scorpion_50k.ply")).mesh)).size() == 15);
    CHECK(self_intersections(make_solid(read_obj(tafoni_test::find("meshes/wingnut_3k.obj")).mesh)).size() == 3);
}
