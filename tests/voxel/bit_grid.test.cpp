#include "support/code_of.hpp"

#include <catch2/catch.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/voxel/bit_grid.hpp>
#include <tafoni/voxel/dense_grid.hpp>

using namespace tafoni;
using tafoni_test::code_of;

TEST_CASE("a bit grid answers what a dense grid does, whatever is set in whatever order") {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        INFO("seed " << seed);
        stream random(seed, stage::user, 0);
        grid_frame frame;
        for (std::size_t& n : frame.size) n = 1 + random.index_below(20);
        bit_grid bits(frame);
        dense_grid dense(frame);
        for (int q = 0; q < 3000; ++q) {
            auto const coordinate = [&](std::size_t d) { return static_cast<std::int32_t>(random.index_below(frame.size[d])); };
            voxel v;
            v.x = coordinate(0);
            v.y = coordinate(1);
            v.z = coordinate(2);
            auto const s = static_cast<voxel_state>(random.index_below(q < 1000 ? 2 : 3));
            bits.set(v, s);
            dense.set(v, s);
        }
        for (int z = 0; z < static_cast<int>(frame.size[2]); ++z) {
            for (int y = 0; y < static_cast<int>(frame.size[1]); ++y) {
                for (int x = 0; x < static_cast<int>(frame.size[0]); ++x) REQUIRE(bits.at({x, y, z}) == dense.at({x, y, z}));
            }
        }
        for (auto const s : {voxel_state::air, voxel_state::rock, voxel_state::colluvium}) REQUIRE(bits.count(s) == dense.count(s));
    }
}

TEST_CASE("a bit grid takes an eighth of a byte per voxel, twice that with colluvium") {
    bit_grid g({.size = {64, 64, 64}});
    CHECK(g.bytes() == 64 * 64 * 8);
    g.set({1, 2, 3}, voxel_state::rock);
    CHECK(g.bytes() == 64 * 64 * 8);
    g.set({1, 2, 3}, voxel_state::colluvium);
    CHECK(g.bytes() == 2 * 64 * 64 * 8);
}

TEST_CASE("a bit grid of no voxels or too many, or a voxel beyond it, is refused", "[V1][V5]") {
    CHECK(code_of([] { bit_grid({.size = {1, 0, 1}}); }) == errc::empty_input);
    std::size_t const huge = 0xFFFFFFFF;
    CHECK(code_of([&] { bit_grid({.size = {huge, huge, huge}}); }) == errc::size_overflow);
    std::size_t const mega = grid_frame::longest;
    CHECK(code_of([&] { bit_grid({.size = {mega, mega, mega}}); }) == errc::size_overflow);
    bit_grid g({.size = {2, 3, 4}});
    CHECK(code_of([&] { (void)g.at({0, 0, 4}); }) == errc::index_out_of_range);
    CHECK(code_of([&] { (void)g.at({-1, 0, 0}); }) == errc::index_out_of_range);
    bit_grid const moved = std::move(g);
    CHECK(g.count(voxel_state::air) == 0);
    CHECK(moved.count(voxel_state::air) == 24);
}
