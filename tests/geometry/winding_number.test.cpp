#include <tafoni/geometry/winding_number.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/geometry/bvh.hpp>
#include <tafoni/geometry/make_solid.hpp>

#include <catch2/catch.hpp>

#include <support/shapes.hpp>

#include <cmath>

using namespace tafoni;

namespace {

/// The integral over solid angles [Van Oosterom and Strackee 1983], by the standard library's atan2.
double winding_by_angles(solid const& s, vec3 const& p) {
    double sum = 0;
    for (auto const& t : s.triangles) {
        vec3 const a = s.positions[t[0]] - p;
        vec3 const b = s.positions[t[1]] - p;
        vec3 const c = s.positions[t[2]] - p;
        double const la = length(a), lb = length(b), lc = length(c);
        sum += std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
    return sum / (2 * 3.14159265358979323846);
}

}  // namespace

TEST_CASE("the winding number is that of the solid angles, for the plain sum and the tree") {
    indexed_mesh doubled = tafoni_test::box(vec3{0, 0, 0}, vec3{3, 3, 3});
    tafoni_test::append(doubled, tafoni_test::box(vec3{1, 1, 1}, vec3{5, 2, 2}));
    for (auto const& m : {tafoni_test::l_shape(), tafoni_test::box_with_cavity(), tafoni_test::torus(2, 0.7, 12, 9),
                          tafoni_test::thin_limbs(), tafoni_test::icosphere(2), doubled}) {
        solid const s = make_solid(m);
        bvh const tree(s);
        stream draw(5, stage::user, 7);
        int seen_inside = 0;
        for (int i = 0; i < 2000; ++i) {
            vec3 p;
            for (int a = 0; a < 3; ++a) p[a] = draw.uniform(s.bounds.lo[a] - 0.1, s.bounds.hi[a] + 0.1);
            double const expected = winding_by_angles(s, p);
            int const got = winding_number(s, p);
            CHECK(std::fabs(got - expected) < 1e-6);
            CHECK(tree.winding_number(p) == got);
            seen_inside += got > 0 ? 1 : 0;
        }
        CHECK(seen_inside > 5);
    }
}

TEST_CASE("points under corners, edges and walls are decided as exactly as others") {
    // All coordinates are whole or half, so rays along z meet vertices and edges and run in faces.
    for (auto const& m : {tafoni_test::l_shape(), tafoni_test::box_with_cavity(), tafoni_test::frame()}) {
        solid const s = make_solid(m);
        bvh const tree(s);
        for (int i = -1; i < 14; ++i) {
            for (int j = -1; j < 14; ++j) {
                for (int k = -1; k < 14; ++k) {
                    vec3 const p{0.25 * i, 0.25 * j, 0.25 * k};
                    int const got = winding_number(s, p);
                    CHECK(tree.winding_number(p) == got);
                    if (tree.nearest_point(p)->distance > 0) CHECK(got == std::lround(winding_by_angles(s, p)));
                    else CHECK((got == 0 || got == 1));  // on the surface: one of its sides
                }
            }
        }
    }
}

TEST_CASE("a point a rounding below or above a face is told apart") {
    solid const s = make_solid(tafoni_test::tetrahedron());
    double const x = 0.3, y = 0.3;
    double const z = 1 - x - y;
    CHECK(point_in_solid(s, vec3{x, y, std::nextafter(std::nextafter(z, 0.0), 0.0)}));
    CHECK_FALSE(point_in_solid(s, vec3{x, y, std::nextafter(std::nextafter(z, 1.0), 1.0)}));
    CHECK(point_in_solid(s, vec3{0.1, 0.1, 1e-300}));
    CHECK_FALSE(point_in_solid(s, vec3{0.1, 0.1, -1e-300}));
    CHECK_FALSE(point_in_solid(s, vec3{std::numeric_limits<double>::quiet_NaN(), 0.1, 0.1}));
}

TEST_CASE("in a cavity the number is 0, in an overlap 2") {
    CHECK(winding_number(make_solid(tafoni_test::box_with_cavity()), vec3{1.5, 1.5, 1.5}) == 0);
    indexed_mesh m = tafoni_test::unit_box();
    tafoni_test::append(m, tafoni_test::box(vec3{0.5, 0, 0}, vec3{1.5, 1, 1}));
    CHECK(winding_number(make_solid(m), vec3{0.75, 0.5, 0.5}) == 2);
}
