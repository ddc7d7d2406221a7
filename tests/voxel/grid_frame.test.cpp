#include "support/code_of.hpp"

#include <catch2/catch.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/voxel/grid_frame.hpp>

using namespace tafoni;
using tafoni_test::code_of;

namespace {

vec3 const axes[6] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {-1, 0, 0}, {0, -1, 0}};  // as up_axis

}  // namespace

TEST_CASE("voxels are ordered by z, then y, then x") {
    CHECK(voxel{9, 9, 0} < voxel{0, 0, 1});
    CHECK(voxel{9, 0, 0} < voxel{0, 1, 0});
    CHECK(voxel{0, 1, 1} < voxel{1, 1, 1});
    CHECK(voxel{1, 2, 3} + voxel{1, 1, 1} - voxel{2, 3, 4} == voxel{});
    CHECK(voxel{-1, 0, 0} < voxel{});
}

TEST_CASE("a rotation brings the user's up to +z, keeps right hands right, and leads back") {
    for (int up = 0; up < 6; ++up) {
        INFO("up " << up);
        up_rotation const turn = up_rotation::of(static_cast<up_axis>(up));
        CHECK(turn.direction_to_user({0, 0, 1}) == axes[up]);
        vec3 const x = turn.direction_to_user({1, 0, 0});
        vec3 const y = turn.direction_to_user({0, 1, 0});
        CHECK(cross(x, y) == axes[up]);

        std::array<std::size_t, 3> const user{3, 5, 7};
        auto const size = turn.turned_size(user);
        std::vector<int> met(3 * 5 * 7, 0);
        for (int c = 0; c < static_cast<int>(size[2]); ++c) {
            for (int b = 0; b < static_cast<int>(size[1]); ++b) {
                for (int a = 0; a < static_cast<int>(size[0]); ++a) {
                    voxel const u = turn.to_user({a, b, c}, size);
                    REQUIRE(grid_frame{.size = user}.contains(u));
                    REQUIRE(turn.from_user(u, size) == voxel{a, b, c});
                    ++met[static_cast<std::size_t>(u.x + 3 * (u.y + 5 * u.z))];
                }
            }
        }
        CHECK(std::all_of(met.begin(), met.end(), [](int m) { return m == 1; }));
        // Steps along the turned axes are steps along the directions that they are said to have.
        voxel const origin = turn.to_user({0, 0, 0}, size);
        for (int k = 0; k < 3; ++k) {
            voxel const step = turn.to_user({k == 0, k == 1, k == 2}, size) - origin;
            vec3 const d = turn.direction_to_user({k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0});
            CHECK(vec3{double(step.x), double(step.y), double(step.z)} == d);
        }
    }
}

TEST_CASE("a side of the border is turned to where its voxels go") {
    for (int up = 0; up < 6; ++up) {
        for (std::size_t side = 0; side < 6; ++side) {
            INFO("up " << up << ", side " << side);
            up_rotation const turn = up_rotation::of(static_cast<up_axis>(up));
            grid_border user;
            user.sides[side] = border_kind::rock;
            grid_border const turned = turn.turned_border(user);
            std::array<std::size_t, 3> const size = turn.turned_size({3, 5, 7});
            voxel beyond{1, 2, 3};  // in the user's axes, one step beyond that side
            std::int32_t* const at[3] = {&beyond.x, &beyond.y, &beyond.z};
            std::int32_t const upper[3] = {3, 5, 7};
            *at[side / 2] = side % 2 == 0 ? -1 : upper[side / 2];
            voxel const v = turn.from_user(beyond, size);
            std::int32_t const in[3] = {v.x, v.y, v.z};
            for (std::size_t k = 0; k < 3; ++k) {
                CHECK((turned.sides[2 * k] == border_kind::rock) == (in[k] < 0));
                CHECK((turned.sides[2 * k + 1] == border_kind::rock) == (in[k] >= static_cast<std::int32_t>(size[k])));
            }
        }
    }
}

TEST_CASE("frames of no voxels, too many, or in no space are refused", "[V1][V5][V13]") {
    double const nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(code_of([] { grid_frame{}.validate(); }) == errc::empty_input);
    for (std::size_t d = 0; d < 3; ++d) {
        grid_frame f{.size = {4, 4, 4}};
        CHECK_NOTHROW(f.validate());
        f.size[d] = 0;
        CHECK(code_of([&] { f.validate(); }) == errc::empty_input);
        for (std::size_t const many : {grid_frame::longest + 1, std::size_t{0xFFFFFFFF}, ~std::size_t{0}}) {
            f.size[d] = many;
            CHECK(code_of([&] { f.validate(); }) == errc::size_overflow);
        }
        f.size[d] = grid_frame::longest;
        CHECK_NOTHROW(f.validate());
        auto const e = static_cast<Eigen::Index>(d);
        for (double const s : {0.0, -1.0, nan, 1e101, std::numeric_limits<double>::infinity()}) {
            grid_frame g{.size = {1, 1, 1}};
            g.spacing[e] = s;
            CHECK(code_of([&] { g.validate(); }) == errc::bad_parameter);
        }
        grid_frame g{.size = {1, 1, 1}};
        g.origin[e] = nan;
        CHECK(code_of([&] { g.validate(); }) == errc::bad_parameter);
    }
    grid_frame const largest{.size = {grid_frame::longest, grid_frame::longest, grid_frame::longest}};
    CHECK(largest.voxel_count() == std::size_t{1} << 60);
}
