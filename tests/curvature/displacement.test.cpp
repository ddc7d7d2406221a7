#include <tafoni/curvature/displacement.hpp>

#include <catch2/catch.hpp>

using namespace tafoni;

TEST_CASE("the Laplacian is taken at unit length, or as printed as long as it is") {
    wear_point const at{.laplacian = vec3{0, 3, -4}, .normal = vec3{0, 0, 1}};
    CHECK(laplacian_direction{}.direction(at) == vec3{0, 0.6, -0.8});
    CHECK(laplacian_direction{.scale = laplacian_length::as_printed}.direction(at) == vec3{0, 3, -4});
    CHECK(laplacian_direction{}.direction(wear_point{}) == vec3{0, 0, 0});
}

TEST_CASE("the inward normal leads into the solid, and nowhere without one") {
    CHECK(inward_normal{}.direction({.normal = vec3{0, 1, 0}}) == vec3{0, -1, 0});
    CHECK(inward_normal{}.direction(wear_point{}) == vec3{0, 0, 0});
}

TEST_CASE("the blend is the normal where flat, the Laplacian where bent most, halfway in between") {
    wear_point at{.laplacian = vec3{2, 0, 0}, .normal = vec3{0, 0, 1}};
    CHECK(blended_direction{}.direction(at) == vec3{0, 0, -1});
    at.curvature = 0.5;
    CHECK(blended_direction{}.direction(at) == vec3{0.5, 0, -0.5});
    for (double const most : {1.0, -1.0}) {
        at.curvature = most;
        CHECK(blended_direction{}.direction(at) == vec3{1, 0, 0});
    }
}
