#include "reliability/failing_new.hpp"

#include <catch2/catch.hpp>

#include <tafoni/voxel/bit_grid.hpp>
#include <tafoni/voxel/copy_states.hpp>
#include <tafoni/voxel/dense_grid.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

using namespace tafoni;

namespace {

dense_grid layers() {
    dense_grid g({.size = {70, 40, 50}});
    for (int z = 0; z < 50; ++z) {
        for (int y = 0; y < 40; ++y) {
            for (int x = 0; x < 70; ++x) g.set({x, y, z}, static_cast<voxel_state>((x / 9 + z / 11) % 3));
        }
    }
    return g;
}

template <class G>
bool same(G const& a, dense_grid const& b) {
    dense_grid out(b.frame());
    copy_states(a, out);
    return out == b;
}

}  // namespace

TEST_CASE("C3: grids that run out of memory while they are made leave nothing behind") {
    dense_grid const from = layers();
    auto const r = tafoni_test::fail_every_allocation([&] {
        sparse_grid const a = sparse_grid::copy_of(from, up_axis::plus_y);
        sparse_grid b = a;
        bit_grid bits(from.frame());
        copy_states(b, bits);
        copy_states(bits, b);
    });
    CHECK(r.tried > 20);
    CHECK(r.leaks == 0);
    CHECK(r.strangers == 0);
}

TEST_CASE("C3: a voxel that finds no memory keeps its state, and so does the rest of the grid") {
    sparse_grid const rock = [] {
        sparse_grid g({.size = {70, 70, 70}});
        for (std::size_t b = 0; b < g.brick_count(); ++b) g.fill_brick(b, [](voxel) { return voxel_state::rock; });
        return g;
    }();
    bool failed = true;
    for (long k = 0; failed; ++k) {
        sparse_grid g = rock;
        bit_grid bits({.size = {70, 70, 70}});
        std::size_t holes = 0;
        failed = false;
        tafoni_test::allocations_left = k;
        try {
            for (int n = 0; n < 70; n += 10) {
                g.set({n, 69 - n, n}, voxel_state::air);
                ++holes;
            }
            bits.set({1, 2, 3}, voxel_state::colluvium);
        } catch (std::bad_alloc const&) {
            failed = true;
        }
        tafoni_test::allocations_left = -1;
        REQUIRE(g.count(voxel_plane::rock) == 70 * 70 * 70 - holes);
        REQUIRE(bits.count(voxel_state::colluvium) == (failed ? 0U : 1U));
        bits.set({1, 2, 3}, voxel_state::colluvium);
        REQUIRE(bits.at({1, 2, 3}) == voxel_state::colluvium);
        for (int n = 0; n < 70; n += 10) g.set({n, 69 - n, n}, voxel_state::rock);
        for (std::size_t b = 0; b < g.brick_count(); ++b) {
            g.compact(b);
            REQUIRE(g.is_rock_brick(b));
        }
        REQUIRE(k < 100);
    }
}

TEST_CASE("C3: a copy into a grid that runs out of memory can be made again") {
    dense_grid const from = layers();
    bool failed = true;
    for (long k = 0; failed; ++k) {
        sparse_grid to(from.frame(), up_axis::minus_x);
        failed = false;
        tafoni_test::allocations_left = k;
        try {
            copy_states(from, to);
        } catch (std::bad_alloc const&) {
            failed = true;
        }
        tafoni_test::allocations_left = -1;
        copy_states(from, to);
        REQUIRE(same(to, from));
        REQUIRE(k < 200);
    }
}
