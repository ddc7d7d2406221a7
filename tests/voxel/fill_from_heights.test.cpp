#include <catch2/catch.hpp>

#include "fill_testing.hpp"

#include <io/file_testing.hpp>
#include <support/test_data.hpp>

#include <tafoni/io/esri_ascii.hpp>
#include <tafoni/voxel/fill_from_heights.hpp>
#include <tafoni/voxel/fill_from_predicate.hpp>

#include <cmath>

using namespace tafoni;
using tafoni_test::differences;
using tafoni_test::failure_of;
using tafoni_test::plain_grid;

namespace {

height_grid hills(std::size_t columns, std::size_t rows) {
    height_grid g{.columns = columns, .rows = rows, .cell_size_x = 2, .cell_size_y = 2, .lower_left_x = 10, .lower_left_y = -7};
    stream random(31, stage::user, columns);
    for (std::size_t i = 0; i < columns * rows; ++i) g.heights.push_back(random.uniform(50, 80));
    return g;
}

}  // namespace

TEST_CASE("with a voxel per cell a column is rock up to the height of its cell, the northernmost row last") {
    height_grid g = hills(40, 35);
    g.missing.assign(g.heights.size(), 0);
    g.missing[17] = g.missing[40 * 20 + 3] = 1;
    g.heights[17] = -9999;
    sparse_grid const grid = fill_from_heights(g);
    REQUIRE(grid.user_frame().size[0] == 40);
    REQUIRE(grid.user_frame().size[1] == 35);
    REQUIRE(grid.border().sides == std::array<border_kind, 6>{border_kind::extend, border_kind::extend, border_kind::extend,
                                                              border_kind::extend, border_kind::rock, border_kind::air});
    auto const height = static_cast<std::int32_t>(grid.size()[2]);
    for (std::int32_t row = 0; row < 35; ++row) {
        for (std::int32_t column = 0; column < 40; ++column) {
            auto const r = static_cast<std::size_t>(row);
            auto const c = static_cast<std::size_t>(column);
            for (std::int32_t z = 0; z < height; ++z) {
                voxel const v{column, 34 - row, z};
                vec3 const centre = grid.centre(v);
                REQUIRE(centre[0] == Approx(g.position(r, c)[0]));
                REQUIRE(centre[1] == Approx(g.position(r, c)[1]));
                REQUIRE(grid.is_solid(v) == (g.has_height(r, c) && centre[2] < g.height(r, c)));
            }
            // The base is at least four voxels, the top has air.
            if (g.has_height(r, c)) REQUIRE(grid.is_solid({column, 34 - row, 3}));
            REQUIRE_FALSE(grid.is_solid({column, 34 - row, height - 1}));
        }
    }
}

TEST_CASE("a slope stays a slope at any resolution, whatever the registration") {
    for (grid_registration const registration : {grid_registration::corner, grid_registration::centre}) {
        height_grid g{.columns = 10, .rows = 8, .cell_size_x = 3, .cell_size_y = 2, .registration = registration};
        for (std::size_t r = 0; r < 8; ++r) {
            for (std::size_t c = 0; c < 10; ++c) g.heights.push_back(0);
        }
        for (std::size_t r = 0; r < 8; ++r) {
            for (std::size_t c = 0; c < 10; ++c) g.heights[10 * r + c] = 0.5 * g.position(r, c)[0] - 0.25 * g.position(r, c)[1];
        }
        sparse_grid const grid = fill_from_heights(g, {.resolution = 90, .base = 2, .headroom = 3});
        double const edge = grid.spacing()[0];
        REQUIRE(edge == Approx(30.0 / 90));
        for (std::int32_t y = 3; y < 45; ++y) {
            for (std::int32_t x = 5; x < 85; ++x) {
                vec3 const p = grid.centre({x, y, 0});
                // Inside the outermost centres the bilinear terrain is the plane.
                double const top = 0.5 * p[0] - 0.25 * p[1];
                std::int32_t n = 0;
                while (grid.is_solid({x, y, n})) ++n;
                REQUIRE(std::fabs(grid.centre({x, y, n})[2] - top - 0.5 * edge) <= 0.5 * edge + 1e-9);
            }
        }
    }
}

TEST_CASE("columns are the same in every grid and for every up, and beyond the terrain there is air") {
    height_grid const g = hills(20, 11);
    grid_frame const frame{.size = {70, 40, 37}, .spacing = {0.7, 0.7, 1.1}, .origin = {8, -8, 43}};
    plain_grid dense(frame);
    std::size_t const rock = fill_from_heights(dense, g);
    REQUIRE(rock > 10000);
    for (up_axis const up : {up_axis::plus_z, up_axis::plus_x, up_axis::plus_y, up_axis::minus_z, up_axis::minus_x, up_axis::minus_y}) {
        sparse_grid sparse(frame, up);
        sparse.set({0, 0, 0}, voxel_state::colluvium);
        REQUIRE(fill_from_heights(sparse, g) == rock);
        REQUIRE(differences(sparse, dense) == 0);
    }
    for (std::size_t k = 0; k < 37; ++k) {
        REQUIRE(dense.states[dense.at(0, 20, k)] == voxel_state::air);   // west of it
        REQUIRE(dense.states[dense.at(69, 20, k)] == voxel_state::air);  // east
        REQUIRE(dense.states[dense.at(30, 0, k)] == voxel_state::air);   // south
    }
}

TEST_CASE("heights that make no terrain are refused, and the grid is as it was") {
    auto const code_of = [](height_grid const& g) {
        sparse_grid grid({.size = {2, 2, 2}});
        grid.set({1, 1, 1}, voxel_state::rock);
        auto const f = failure_of([&] { return fill_from_heights(grid, g); });
        REQUIRE(f.happened);
        REQUIRE(grid.count(voxel_plane::rock) == 1);
        return f.code;
    };
    REQUIRE(code_of({}) == errc::empty_input);
    REQUIRE(code_of({.columns = 2, .rows = 2, .heights = {1, 2, 3}}) == errc::attribute_length);
    REQUIRE(code_of({.columns = 0xffffffffffffffffU, .rows = 0xffffffffffffffffU, .heights = {1}}) == errc::attribute_length);
    REQUIRE(code_of({.columns = 1, .rows = 2, .heights = {1, 2}, .missing = {0}}) == errc::attribute_length);
    REQUIRE(code_of({.columns = 1, .rows = 1, .heights = {NAN}}) == errc::non_finite_vertex);
    REQUIRE(code_of({.columns = 1, .rows = 1, .cell_size_x = 0, .heights = {1}}) == errc::bad_parameter);
    REQUIRE(code_of({.columns = 1, .rows = 1, .cell_size_y = NAN, .heights = {1}}) == errc::bad_parameter);
    REQUIRE(code_of({.columns = 1, .rows = 1, .lower_left_x = INFINITY, .heights = {1}}) == errc::bad_parameter);
    height_grid const one{.columns = 1, .rows = 1, .heights = {1}};
    REQUIRE(failure_of([&] { return fill_from_heights(one, {.base = -1}); }).code == errc::bad_parameter);
    REQUIRE(failure_of([&] { return fill_from_heights(one, {.headroom = NAN}); }).code == errc::bad_parameter);
    REQUIRE(failure_of([&] { return fill_from_heights(one, {.resolution = std::size_t{1} << 40}); }).code == errc::bad_parameter);
    REQUIRE(failure_of([&] { return fill_from_heights(height_grid{.columns = 1, .rows = 1, .heights = {0}, .missing = {1}}); }).code == errc::empty_input);
    REQUIRE(fill_from_heights(one).count(voxel_plane::rock) == 4);
}

TEST_CASE("a real ridge becomes rock with its volume") {
    auto const path = tafoni_test::find("dems/bigtujunga_ridge128_30m.asc");
    if (path.empty()) {
        WARN("skipped: no data");
        return;
    }
    height_grid const g = read_esri_ascii(path);
    sparse_grid const grid = fill_from_heights(g, {.resolution = 256, .base = 60});
    double rock = 0;
    for (double const h : g.heights) rock += h - grid.user_frame().origin[2];
    double const edge = grid.spacing()[0];
    REQUIRE(edge == 15);
    REQUIRE(static_cast<double>(grid.count(voxel_plane::rock)) * edge * edge * edge == Approx(rock * 30 * 30).epsilon(1e-3));
}
