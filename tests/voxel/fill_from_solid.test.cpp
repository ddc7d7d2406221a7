#include <catch2/catch.hpp>

#include "fill_testing.hpp"

#include <io/file_testing.hpp>
#include <support/shapes.hpp>
#include <support/test_data.hpp>

#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/geometry/winding_number.hpp>
#include <tafoni/io/read_mesh.hpp>
#include <tafoni/voxel/fill_from_solid.hpp>
#include <tafoni/voxel/frame_for.hpp>

using namespace tafoni;
using tafoni_test::differences;
using tafoni_test::failure_of;
using tafoni_test::plain_grid;

namespace {

constexpr up_axis all_ups[] = {up_axis::plus_z, up_axis::plus_x, up_axis::plus_y,
                               up_axis::minus_z, up_axis::minus_x, up_axis::minus_y};

}  // namespace

TEST_CASE("a box on the lattice lines is exactly its voxels, whatever the grid held") {
    solid const body = make_solid(tafoni_test::box({1, 2, 3}, {4, 4, 8}));
    grid_frame const frame{.size = {6, 6, 10}};
    plain_grid dense(frame);
    REQUIRE(fill_from_solid(dense, body) == 3 * 2 * 5);
    for (std::size_t k = 0; k < 10; ++k) {
        for (std::size_t j = 0; j < 6; ++j) {
            for (std::size_t i = 0; i < 6; ++i) {
                bool const inside = i >= 1 && i < 4 && j >= 2 && j < 4 && k >= 3 && k < 8;
                REQUIRE(dense.states[dense.at(i, j, k)] == (inside ? voxel_state::rock : voxel_state::air));
            }
        }
    }
    for (up_axis const up : all_ups) {
        sparse_grid sparse(frame, up);
        for (std::int32_t z = 0; z < 5; ++z) sparse.set({1, 1, z}, voxel_state::colluvium);
        REQUIRE(fill_from_solid(sparse, body) == 30);
        REQUIRE(sparse.count(voxel_plane::rock) == 30);
        REQUIRE(sparse.count(voxel_plane::colluvium) == 0);
        REQUIRE(differences(sparse, dense) == 0);
    }
}

TEST_CASE("voxels of turned solids are those whose centres have a positive winding number, in every grid and for every up") {
    stream random(3, stage::user, 0);
    for (auto const& mesh : {tafoni_test::box({-1, -1, -1}, {1, 1, 1}), tafoni_test::box_with_cavity(), tafoni_test::torus(1.5, 0.5, 24, 12),
                             tafoni_test::icosphere(1)}) {
        solid const body = make_solid(tafoni_test::turned(mesh, random));
        vec3 const e = body.bounds.extent();
        // Sizes on both sides of a brick's 32, and voxels that are not cubes.
        grid_frame const frame{.size = {37, 33, 65},
                               .spacing = {e[0] / 34.3, e[1] / 31.7, e[2] / 60.1},
                               .origin = vec3(body.bounds.lo - vec3(0.02 * e))};
        plain_grid dense(frame);
        std::size_t const rock = fill_from_solid(dense, body);
        std::size_t wrong = 0;
        for (std::size_t k = 0; k < frame.size[2]; ++k) {
            for (std::size_t j = 0; j < frame.size[1]; ++j) {
                for (std::size_t i = 0; i < frame.size[0]; ++i) {
                    voxel const v{static_cast<std::int32_t>(i), static_cast<std::int32_t>(j), static_cast<std::int32_t>(k)};
                    bool const inside = point_in_solid(body, frame.centre(v));
                    if (inside != (dense.states[dense.at(i, j, k)] == voxel_state::rock)) ++wrong;
                }
            }
        }
        REQUIRE(wrong == 0);
        for (up_axis const up : all_ups) {
            sparse_grid sparse(frame, up);
            REQUIRE(fill_from_solid(sparse, body) == rock);
            REQUIRE(sparse.count(voxel_plane::solid) == rock);
            // Rows along other axes may decide differently on a centre that lies on the surface only.
            REQUIRE(differences(sparse, dense) == 0);
        }
    }
}

TEST_CASE("a solid that reaches beyond the grid on every side leaves rock alone, and one outside nothing") {
    sparse_grid grid({.size = {70, 40, 33}, .spacing = {0.01, 0.01, 0.01}});
    REQUIRE(fill_from_solid(grid, make_solid(tafoni_test::box({-5, -5, -5}, {5, 5, 5}))) == 70 * 40 * 33);
    for (std::size_t b = 0; b < grid.brick_count(); ++b) REQUIRE(grid.is_rock_brick(b));
    REQUIRE(fill_from_solid(grid, make_solid(tafoni_test::box({5, 5, 5}, {6, 6, 6}))) == 0);
    for (std::size_t b = 0; b < grid.brick_count(); ++b) REQUIRE(grid.is_air_brick(b));
    REQUIRE(fill_from_solid(grid, make_solid(tafoni_test::box({0, 0, -9}, {9, 9, -8}))) == 0);
}

TEST_CASE("faces through the centres of voxels never leak") {
    solid const body = make_solid(tafoni_test::box({0.5, 0.5, 0.5}, {3.5, 3.5, 3.5}));
    for (up_axis const up : all_ups) {
        sparse_grid grid({.size = {5, 5, 5}}, up);
        REQUIRE(fill_from_solid(grid, body) == 27);
    }
}

TEST_CASE("a solid too far away and a grid that is none are refused, and nothing has changed") {
    solid const body = make_solid(tafoni_test::box({0, 0, 0}, {1, 1, 1}));
    sparse_grid grid({.size = {2, 2, 2}, .spacing = {1e-20, 1, 1}});
    grid.set({1, 1, 1}, voxel_state::colluvium);
    auto const far = failure_of([&] { return fill_from_solid(grid, body); });
    REQUIRE((far.happened && far.code == errc::out_of_range));
    REQUIRE(grid.count(voxel_plane::colluvium) == 1);
    for (grid_frame const& frame : {grid_frame{.size = {0, 1, 1}}, grid_frame{.size = {1, 1, 1}, .spacing = {0, 1, 1}},
                                    grid_frame{.size = {1, 1, 1}, .spacing = {1, -1, 1}},
                                    grid_frame{.size = {1, 1, 1}, .spacing = {1, 1, NAN}},
                                    grid_frame{.size = {1, 1, 1}, .origin = {1, NAN, 1}}}) {
        plain_grid wrong(frame);
        REQUIRE(failure_of([&] { return fill_from_solid(wrong, body); }).happened);
    }
}

TEST_CASE("the volume of rock converges to that of the bust") {
    auto const path = tafoni_test::find("meshes/nefertiti_35k.ply");
    if (path.empty()) {
        WARN("skipped: no data");
        return;
    }
    solid const body = make_solid(read_mesh(path).mesh);
    for (std::size_t const n : {64U, 256U}) {
        grid_frame const frame = frame_for(body.bounds, n);
        sparse_grid grid(frame);
        double const rock = static_cast<double>(fill_from_solid(grid, body));
        double const voxel_volume = frame.spacing[0] * frame.spacing[1] * frame.spacing[2];
        REQUIRE(rock * voxel_volume == Approx(body.volume).epsilon(0.5 / static_cast<double>(n)));
        if (n == 256) REQUIRE(grid.bytes() < 16'000'000);
    }
}
