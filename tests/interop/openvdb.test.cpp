#include "support/code_of.hpp"

#include <tafoni/interop/openvdb.hpp>

#include <catch2/catch.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/testing/voxel_laws.hpp>
#include <tafoni/voxel/copy_states.hpp>
#include <tafoni/voxel/dense_grid.hpp>

#include <openvdb/io/Stream.h>

#include <algorithm>
#include <cmath>
#include <sstream>

using namespace tafoni;
using tafoni_test::code_of;

namespace {

dense_grid any_grid(std::uint64_t seed) {
    stream random(seed, stage::user, 0);
    grid_frame frame{.spacing = {0.5, 1, 2}, .origin = {-3, 7, 100}};
    for (std::size_t& n : frame.size) n = 1 + random.index_below(70);
    dense_grid g(frame);
    double const mixed = random.uniform01();
    for (int z = 0; z < static_cast<int>(frame.size[2]); ++z) {
        for (int y = 0; y < static_cast<int>(frame.size[1]); ++y) {
            for (int x = 0; x < static_cast<int>(frame.size[0]); ++x) {
                voxel_state s = x > 20 && y > 20 ? voxel_state::rock : voxel_state::air;
                if (x <= 20 && random.chance(mixed)) s = static_cast<voxel_state>(random.index_below(3));
                g.set({x, y, z}, s);
            }
        }
    }
    return g;
}

openvdb::CoordBBox whole(grid_frame const& f) {
    return {openvdb::Coord(0), openvdb::Coord(static_cast<int>(f.size[0]) - 1, static_cast<int>(f.size[1]) - 1,
                                              static_cast<int>(f.size[2]) - 1)};
}

template <class G>
dense_grid dense_of(G const& g, grid_frame const& frame) {
    dense_grid out(frame);
    copy_states(g, out);
    return out;
}

}  // namespace

TEST_CASE("states go to OpenVDB and come back, in place, whatever is up") {
    openvdb::initialize();
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        INFO("seed " << seed);
        dense_grid const before = any_grid(seed);
        auto const vdb = to_openvdb(sparse_grid::copy_of(before, static_cast<up_axis>(seed % 6)));
        openvdb_grid const view(openvdb::Int32Grid::ConstPtr(vdb), whole(before.frame()));
        CHECK(view.frame() == before.frame());
        CHECK(dense_of(view, before.frame()) == before);
        CHECK(vdb->activeVoxelCount() == before.frame().voxel_count() - before.count(voxel_state::air));
        CHECK(to_openvdb(before)->activeVoxelCount() == vdb->activeVoxelCount());
    }
}

TEST_CASE("what lies in blocks of one state is stored as tiles") {
    openvdb::initialize();
    dense_grid const rock({.size = {64, 64, 64}}, voxel_state::rock);
    auto const vdb = to_openvdb(rock);
    CHECK(vdb->activeVoxelCount() == 64 * 64 * 64);
    CHECK(vdb->constTree().leafCount() == 0);
}

TEST_CASE("an OpenVDB grid of states keeps the laws of editable grids") {
    openvdb::initialize();
    auto const vdb = openvdb::Int32Grid::create(0);
    openvdb_grid grid(vdb, {{-5, 3, -9}, {7, 11, 4}});
    CHECK(laws::editable_voxel_grid(grid) == std::vector<std::string>{});
    CHECK(grid_access<decltype(grid)>::size(grid) == std::array<std::size_t, 3>{13, 9, 14});
    grid_access<decltype(grid)>::set(grid, 1, 2, 3, voxel_state::colluvium);
    CHECK(vdb->tree().getValue({-4, 5, -6}) == 2);
    CHECK(vdb->activeVoxelCount() == 1);
    grid_access<decltype(grid)>::set(grid, 1, 2, 3, voxel_state::air);
    CHECK(vdb->activeVoxelCount() == 0);

    sparse_grid work = sparse_grid::copy_of(grid, up_axis::plus_y);
    work.set({3, 2, 1}, voxel_state::rock);
    copy_states(work, grid);
    CHECK(vdb->activeVoxelCount() == 1);
}

TEST_CASE("a level set is rock where it is negative, a fog volume where it is positive") {
    openvdb::initialize();
    vec3 const centre{1, 2, 3};
    double const radius = 6.5;
    auto const level = openvdb::FloatGrid::create(1.5F);  // a band of three voxels of 0.5, as OpenVDB's own tools make it
    auto const fog = openvdb::FloatGrid::create(0);
    level->setGridClass(openvdb::GRID_LEVEL_SET);
    fog->setGridClass(openvdb::GRID_FOG_VOLUME);
    for (auto const& grid : {level, fog}) grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    for (int z = -10; z < 24; ++z) {
        for (int y = -12; y < 22; ++y) {
            for (int x = -14; x < 20; ++x) {
                openvdb::Coord const at(x, y, z);
                double const distance = length(vec3{0.5 * x, 0.5 * y, 0.5 * z} - centre) - radius;
                auto const band = static_cast<float>(std::clamp(distance, -1.5, 1.5));
                if (std::fabs(distance) < 1.5) level->tree().setValueOn(at, band);
                else if (distance < 0) level->tree().setValueOff(at, -1.5F);
                if (distance < 0) fog->tree().setValueOn(at, -band / 1.5F);
            }
        }
    }
    openvdb_grid const sphere(openvdb::FloatGrid::ConstPtr(level), level->evalActiveVoxelBoundingBox());
    openvdb_grid const cloud(fog, sphere.box());
    CHECK(laws::voxel_grid(sphere) == std::vector<std::string>{});
    CHECK(openvdb_grid<openvdb::FloatGrid>(level).box() == sphere.box());
    dense_grid const rock = dense_of(sphere, sphere.frame());
    std::size_t wrong = 0;
    for (int z = 0; z < static_cast<int>(rock.frame().size[2]); ++z) {
        for (int y = 0; y < static_cast<int>(rock.frame().size[1]); ++y) {
            for (int x = 0; x < static_cast<int>(rock.frame().size[0]); ++x) {
                double const depth = radius - length(rock.frame().centre({x, y, z}) - centre);
                if (std::fabs(depth) > 1e-4 && (rock.at({x, y, z}) == voxel_state::rock) != (depth > 0)) ++wrong;
            }
        }
    }
    CHECK(wrong == 0);
    CHECK(rock.count(voxel_state::rock) > 8000);
    CHECK(dense_of(cloud, sphere.frame()) == rock);
}

TEST_CASE("Booleans are rock where they are true, active or not") {
    openvdb::initialize();
    auto const truth = openvdb::BoolGrid::create(false);
    truth->tree().setValueOn({1, 2, 3}, true);
    truth->tree().setValueOn({2, 2, 3}, false);
    truth->tree().setValueOff({3, 2, 3}, true);
    openvdb_grid const grid(truth, {{1, 2, 3}, {3, 2, 3}});
    using access = grid_access<openvdb_grid<openvdb::BoolGrid>>;
    CHECK(access::state(grid, 0, 0, 0) == voxel_state::rock);
    CHECK(access::state(grid, 1, 0, 0) == voxel_state::air);
    CHECK(access::state(grid, 2, 0, 0) == voxel_state::rock);
    CHECK_FALSE(editable_voxel_grid<openvdb_grid<openvdb::BoolGrid>>);
    CHECK_FALSE(editable_voxel_grid<openvdb_grid<openvdb::Int32Grid const>>);
}

TEST_CASE("OpenVDB grids that are no box of states are refused") {
    openvdb::initialize();
    auto const made = [](auto const& grid) { return openvdb_grid(grid, {{0, 0, 0}, {3, 3, 3}}); };
    CHECK(code_of([&] { (void)made(openvdb::Int32Grid::Ptr()); }) == errc::empty_input);
    CHECK(code_of([&] { (void)openvdb_grid(openvdb::Int32Grid::create(0)); }) == errc::empty_input);
    CHECK(code_of([&] { (void)openvdb_grid(openvdb::Int32Grid::Ptr{}); }) == errc::empty_input);
    CHECK(code_of([&] { (void)openvdb_grid(openvdb::Int32Grid::create(0), openvdb::CoordBBox({0, 0, 0}, {3, -1, 3})); }) ==
          errc::empty_input);
    int const most = std::numeric_limits<int>::max();
    CHECK(code_of([&] { (void)openvdb_grid(openvdb::Int32Grid::create(0), openvdb::CoordBBox({0, 0, 0}, {most, 1, 1})); }) ==
          errc::size_overflow);
    CHECK(code_of([&] { (void)made(openvdb::FloatGrid::create(0)); }) == errc::unsupported);

    auto const turned = openvdb::Int32Grid::create(0);
    turned->transform().preRotate(0.5, openvdb::math::Z_AXIS);
    CHECK(code_of([&] { (void)made(turned); }) == errc::unsupported);
    auto const mirrored = openvdb::Int32Grid::create(0);
    mirrored->transform().preScale(openvdb::Vec3d(1, -1, 1));
    CHECK(code_of([&] { (void)made(mirrored); }) == errc::unsupported);

    auto const wrong = openvdb::Int32Grid::create(0);
    wrong->tree().setValue({1, 2, 3}, 3);
    try {
        (void)sparse_grid::copy_of(made(wrong));
        FAIL("accepted");
    } catch (invalid_input const& e) {
        CHECK(e.code() == errc::out_of_range);
        CHECK(std::string(e.what()) == "openvdb_grid: state of voxel (1, 2, 3): got 3, allowed [0, 2]");
    }
}

TEST_CASE("a grid of states survives OpenVDB's own file format") {
    openvdb::initialize();
    dense_grid const before = any_grid(5);
    std::ostringstream out(std::ios::binary);
    openvdb::io::Stream(out).write({to_openvdb(before)});
    std::istringstream in(out.str(), std::ios::binary);
    auto const grids = openvdb::io::Stream(in, false).getGrids();
    REQUIRE(grids->size() == 1);
    openvdb_grid const after(openvdb::gridPtrCast<openvdb::Int32Grid>(grids->front()), whole(before.frame()));
    CHECK(after.frame() == before.frame());
    CHECK(dense_of(after, before.frame()) == before);
}
