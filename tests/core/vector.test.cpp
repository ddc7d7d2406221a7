#include <tafoni/core/random.hpp>
#include <tafoni/core/vector.hpp>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace tafoni;

TEST_CASE("products agree with Eigen's and with their laws") {
    stream s(1, stage::user, 0);
    for (int i = 0; i < 1000; ++i) {
        vec3 const a = s.unit_vector();
        vec3 const b = s.unit_vector();
        vec3 const c = s.unit_vector();
        CHECK(dot(a, b) == Approx(a.dot(b)).margin(1e-15));
        CHECK(dot(a, b) == dot(b, a));
        CHECK((cross(a, b) - a.cross(b)).norm() < 1e-15);
        CHECK(cross(a, b) == -cross(b, a));
        CHECK(std::fabs(dot(cross(a, b), a)) < 1e-15);
        CHECK(dot(a, cross(b, c)) == Approx(dot(c, cross(a, b))).margin(1e-15));
        CHECK(squared_length(cross(a, b)) + dot(a, b) * dot(a, b) == Approx(1).epsilon(1e-14));
    }
}

TEST_CASE("the scalar product is summed in the order x, y, z") {
    CHECK(dot(vec3{1e16, -1e16, 1}, vec3{1, 1, 1}) == 1);
    CHECK(dot(vec3{1, 1e16, -1e16}, vec3{1, 1, 1}) == 0);
}

TEST_CASE("normalized vectors have unit length; the zero vector stays zero") {
    CHECK(normalized(vec3{3, 0, 4}) == vec3{3.0 / 5, 0, 4.0 / 5});
    CHECK(normalized(vec3{0, 0, 0}) == vec3{0, 0, 0});
    CHECK(length(normalized(vec3{1e-100, 2e-100, -3e-100})) == Approx(1));
}

TEST_CASE("lexicographic order is strict and looks at x, then y, then z") {
    CHECK(lexicographically_less(vec3{0, 9, 9}, vec3{1, 0, 0}));
    CHECK(lexicographically_less(vec3{1, 0, 9}, vec3{1, 1, 0}));
    CHECK(lexicographically_less(vec3{1, 1, 0}, vec3{1, 1, 1}));
    CHECK_FALSE(lexicographically_less(vec3{1, 1, 1}, vec3{1, 1, 1}));
    CHECK_FALSE(lexicographically_less(vec3{0.0, 0, 0}, vec3{-0.0, 0, 0}));
}

TEST_CASE("is_finite sees NaN and infinity in every coordinate") {
    CHECK(is_finite(vec3{1, 2, 3}));
    for (int axis = 0; axis < 3; ++axis) {
        for (double const bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity()}) {
            vec3 v{1, 2, 3};
            v[axis] = bad;
            CHECK_FALSE(is_finite(v));
        }
    }
}

TEST_CASE("a box starts empty, grows by points and contains its border") {
    box3 b;
    CHECK(b.empty());
    CHECK_FALSE(b.contains(vec3{0, 0, 0}));
    b.include(vec3{1, 2, 3});
    CHECK_FALSE(b.empty());
    CHECK(b.diagonal() == 0);
    CHECK(b.contains(vec3{1, 2, 3}));
    b.include(vec3{-1, 4, 3});
    CHECK(b.lo == vec3{-1, 2, 3});
    CHECK(b.hi == vec3{1, 4, 3});
    CHECK(b.extent() == vec3{2, 2, 0});
    CHECK(b.centre() == vec3{0, 3, 3});
    CHECK(b.diagonal() == std::sqrt(8.0));
    CHECK(b.contains(vec3{0, 3, 3}));
    CHECK_FALSE(b.contains(vec3{0, 3, std::nextafter(3.0, 4.0)}));
    CHECK_FALSE(b.contains(vec3{std::numeric_limits<double>::quiet_NaN(), 3, 3}));
}

TEST_CASE("the centre of a huge box does not overflow") {
    box3 b;
    b.include(vec3{1e308, 0, 0});
    b.include(vec3{1.5e308, 0, 0});
    CHECK(b.centre()[0] == Approx(1.25e308));
}
