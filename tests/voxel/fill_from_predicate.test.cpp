#include <catch2/catch.hpp>

#include "fill_testing.hpp"

#include <io/file_testing.hpp>

#include <tafoni/voxel/fill_from_predicate.hpp>

#include <stdexcept>

using namespace tafoni;
using tafoni_test::differences;
using tafoni_test::plain_grid;

TEST_CASE("a predicate is asked once at the centre of every voxel, in the user's space") {
    grid_frame const frame{.size = {5, 70, 34}, .spacing = {0.5, 2, 1}, .origin = {-3, 10, 100}};
    auto const inside = [&](vec3 const& p) { return p[0] + 0.1 * p[1] > 8 || p[2] > 120; };
    plain_grid dense(frame);
    std::size_t asked = 0;
    std::size_t const rock = fill_from_predicate(dense, [&](vec3 const& p) { ++asked; return inside(p); });
    REQUIRE(asked == frame.voxel_count());
    std::size_t expected = 0;
    for (std::int32_t k = 0; k < 34; ++k) {
        for (std::int32_t j = 0; j < 70; ++j) {
            for (std::int32_t i = 0; i < 5; ++i) {
                bool const is = inside(vec3{-3 + 0.5 * (i + 0.5), 10 + 2 * (j + 0.5), 100 + (k + 0.5)});
                expected += is ? 1U : 0U;
                auto const at = dense.at(static_cast<std::size_t>(i), static_cast<std::size_t>(j), static_cast<std::size_t>(k));
                REQUIRE(dense.states[at] == (is ? voxel_state::rock : voxel_state::air));
            }
        }
    }
    REQUIRE(rock == expected);
    for (up_axis const up : {up_axis::plus_z, up_axis::plus_x, up_axis::plus_y, up_axis::minus_z, up_axis::minus_x, up_axis::minus_y}) {
        sparse_grid sparse(frame, up);
        REQUIRE(fill_from_predicate(sparse, inside) == rock);
        REQUIRE(differences(sparse, dense) == 0);
    }
}

TEST_CASE("one voxel, nothing but air and nothing but rock are grids like others; bricks of one kind take no memory") {
    sparse_grid one({.size = {1, 1, 1}});
    REQUIRE(fill_from_predicate(one, [](vec3 const&) { return true; }) == 1);
    sparse_grid grid({.size = {100, 33, 64}});
    REQUIRE(fill_from_predicate(grid, [](vec3 const&) { return true; }) == 100 * 33 * 64);
    REQUIRE(grid.bytes() < 8192);
    REQUIRE(fill_from_predicate(grid, [](vec3 const&) { return false; }) == 0);
    REQUIRE(grid.count(voxel_plane::solid) == 0);
    // A checkerboard, the worst case.
    auto const checker = [](vec3 const& p) { return (static_cast<int>(p[0]) + static_cast<int>(p[1]) + static_cast<int>(p[2])) % 2 == 0; };
    REQUIRE(fill_from_predicate(grid, checker) == 50 * 33 * 64);
}

TEST_CASE("grids without voxels or with spacings that are none are refused; an exception of the predicate comes through") {
    for (grid_frame const& frame : {grid_frame{.size = {1, 0, 1}}, grid_frame{.size = {1, 1, 1}, .spacing = {1, 0, 1}}}) {
        plain_grid grid(frame);
        REQUIRE(tafoni_test::failure_of([&] { return fill_from_predicate(grid, [](vec3 const&) { return true; }); }).happened);
    }
    sparse_grid grid({.size = {2, 2, 2}});
    REQUIRE_THROWS_AS(fill_from_predicate(grid, [](vec3 const&) -> bool { throw std::runtime_error("no"); }), std::runtime_error);
}
