#include <tafoni/geometry/height_grid.hpp>

#include <catch2/catch.hpp>

using namespace tafoni;

TEST_CASE("heights come row by row from the north, and are measured at the centres of cells") {
    height_grid const g{.columns = 3,
                        .rows = 2,
                        .cell_size_x = 10,
                        .cell_size_y = 5,
                        .lower_left_x = 100,
                        .lower_left_y = 1000,
                        .heights = {1, 2, 3, 4, 5, 6}};
    CHECK(g.height(0, 2) == 3);
    CHECK(g.height(1, 0) == 4);
    CHECK(g.position(0, 0) == vec3{105, 1007.5, 1});
    CHECK(g.position(1, 0) == vec3{105, 1002.5, 4});
    CHECK(g.position(1, 2) == vec3{125, 1002.5, 6});
    height_grid at_centre = g;
    at_centre.registration = grid_registration::centre;
    CHECK(at_centre.position(1, 0) == vec3{100, 1000, 4});
    CHECK(at_centre.position(0, 2) == vec3{120, 1005, 3});
    CHECK_FALSE(at_centre == g);
}

TEST_CASE("nothing is missing unless it is marked") {
    height_grid g{.columns = 2, .rows = 2, .heights = {1, 2, 3, 4}};
    CHECK(g.has_height(1, 1));
    g.missing = {0, 0, 1, 0};
    CHECK(g.has_height(0, 0));
    CHECK_FALSE(g.has_height(1, 0));
    CHECK(g.has_height(1, 1));
}
