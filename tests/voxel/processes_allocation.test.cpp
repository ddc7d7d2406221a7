// C2, C3: what works on a grid in place leaves it as it was when memory runs out or a caller's function throws.
#include "reliability/failing_new.hpp"

#include <catch2/catch.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/voxel/colluvium.hpp>
#include <tafoni/voxel/copy_states.hpp>
#include <tafoni/voxel/dense_grid.hpp>
#include <tafoni/voxel/dual_surface.hpp>
#include <tafoni/voxel/isosurface.hpp>
#include <tafoni/voxel/rockfall.hpp>
#include <tafoni/voxel/voxel_surface.hpp>

#include <cstddef>
#include <cstdint>
#include <new>
#include <stdexcept>
#include <vector>

using namespace tafoni;

namespace {

/// Posts, shelves and heaps over several bricks.
dense_grid scene() {
    dense_grid g({.size = {40, 34, 36}});
    stream random(3, stage::user, 0);
    for (int z = 0; z < 36; ++z) {
        for (int y = 0; y < 34; ++y) {
            for (int x = 0; x < 40; ++x) {
                bool const post = x % 9 < 4 && y % 8 < 3 && z < 30;
                bool const shelf = z % 12 == 7 && x > 6;
                std::uint64_t const chance = random.index_below(20);
                if (post || shelf) g.set({x, y, z}, chance == 0 ? voxel_state::air : chance < 3 ? voxel_state::colluvium : voxel_state::rock);
            }
        }
    }
    return g;
}

dense_grid states_of(sparse_grid const& g) {
    dense_grid out(g.user_frame());
    copy_states(g, out);
    return out;
}

std::vector<voxel> all_of(sparse_grid const& g, voxel_state s) {
    std::vector<voxel> out;
    for (std::size_t b = 0; b < g.brick_count(); ++b) {
        voxel const low = g.brick_corner(b);
        for (int n = 0; n < 32768; ++n) {
            voxel const v{low.x + n % 32, low.y + n / 32 % 32, low.z + n / 1024};
            if (g.contains(v) && g.state(v) == s) out.push_back(v);
        }
    }
    return out;
}

/// Two threads by name, one in fact; the k-th call throws.
struct refusing_executor {
    mutable int left = 1000000;

    template <class F>
    void for_blocks(std::size_t n, std::size_t grain, F const& f) const {
        if (left-- == 0) throw std::runtime_error("no more");
        inline_executor{}.for_blocks(n, grain, f);
    }
    [[nodiscard]] std::size_t thread_count() const noexcept { return 2; }
};

}  // namespace

TEST_CASE("C3: grains that run out of memory at any point leave the grid as it was") {
    sparse_grid const start = sparse_grid::copy_of(scene(), up_axis::plus_z, {{border_kind::air, border_kind::rock, border_kind::extend, border_kind::air, border_kind::rock, border_kind::air}});
    dense_grid const before = states_of(start);
    std::vector<voxel> const opened = all_of(start, voxel_state::colluvium);
    std::vector<voxel> released;
    for (voxel const v : all_of(start, voxel_state::air)) {
        if (v.z == 35 && v.x % 3 == 0) released.push_back(v);
    }
    voxel_change const earlier{{1, 2, 3}, voxel_state::rock, voxel_state::air};
    bool failed = true;
    long tried = 0;
    for (long k = 0; failed; k += 3) {
        sparse_grid g = start;
        std::vector<voxel_change> changes{earlier};
        failed = false;
        tafoni_test::allocations_left = k;
        try {
            settle(g, released, opened, {.angle = 45, .baseline = 2}, 1, 1, refusing_executor{}, changes);
        } catch (std::bad_alloc const&) {
            failed = true;
        }
        tafoni_test::allocations_left = -1;
        if (!failed) break;
        ++tried;
        REQUIRE(changes == std::vector<voxel_change>{earlier});
        if (k % 5 == 0) REQUIRE(states_of(g) == before);
        REQUIRE(g.count(voxel_plane::colluvium) == start.count(voxel_plane::colluvium));
    }
    CHECK(tried > 10);
}

TEST_CASE("C2: an executor that throws at any call leaves grains and rocks where they were") {
    sparse_grid const start = sparse_grid::copy_of(scene());
    dense_grid const before = states_of(start);
    std::vector<voxel> const opened = all_of(start, voxel_state::colluvium);
    sparse_grid wanted = start;
    std::vector<voxel_change> told;
    settle(wanted, {}, opened, {}, 1, 1, inline_executor{}, told);
    int calls = 0;
    for (bool failed = true; failed; ++calls) {
        sparse_grid g = start;
        std::vector<voxel_change> changes;
        failed = false;
        try {
            settle(g, {}, opened, {}, 1, 1, refusing_executor{calls}, changes);
        } catch (std::runtime_error const&) {
            failed = true;
        }
        REQUIRE(states_of(g) == (failed ? before : states_of(wanted)));
        REQUIRE(changes == (failed ? std::vector<voxel_change>{} : told));
    }
    CHECK(calls > 1);

    rockfall_options const ground{.sides = {ground_side::loose, ground_side::loose, ground_side::loose, ground_side::loose, ground_side::ground, ground_side::loose}};
    for (int k = 0; k < 2; ++k) {
        sparse_grid g = start;
        rockfall rocks(ground);
        std::vector<voxel_change> changes;
        try {
            rocks.fall(g, {}, 0, refusing_executor{k}, changes);
        } catch (std::runtime_error const&) {
            REQUIRE(states_of(g) == before);
            REQUIRE(changes.empty());
        }
    }
}

TEST_CASE("C3: rocks that run out of memory at any point hang where they were, and fall in the next call") {
    rockfall_options const ground{.sides = {ground_side::loose, ground_side::loose, ground_side::loose, ground_side::loose, ground_side::ground, ground_side::loose},
                                  .joints = {.discs = {{.centre = {20, 17, 12}, .normal = {0.2, 0.1, 1}, .radius = 15}}},
                                  .friction_angle = 10};
    sparse_grid start = sparse_grid::copy_of(scene());
    std::vector<voxel_change> changes;
    rockfall standing(ground);
    standing.fall(start, {}, 0, inline_executor{}, changes);
    std::vector<voxel> removed;
    for (voxel const v : all_of(start, voxel_state::rock)) {
        if (v.z == 3) removed.push_back(v);
    }
    for (voxel const v : removed) start.set(v, voxel_state::air);
    dense_grid const before = states_of(start);

    sparse_grid wanted = start;
    changes.clear();
    auto const blocks = rockfall(standing).fall(wanted, removed, 7, inline_executor{}, changes);
    REQUIRE(!blocks.empty());
    auto const told = changes;
    bool failed = true;
    long tried = 0;
    for (long k = 0; failed; k += 7) {
        sparse_grid g = start;
        rockfall rocks = standing;
        changes.clear();
        failed = false;
        tafoni_test::allocations_left = k;
        try {
            rocks.fall(g, removed, 7, inline_executor{}, changes);
        } catch (std::bad_alloc const&) {
            failed = true;
        }
        tafoni_test::allocations_left = -1;
        if (!failed) break;
        ++tried;
        REQUIRE(changes.empty());
        REQUIRE(states_of(g) == before);
        REQUIRE(rocks.fall(g, removed, 7, inline_executor{}, changes) == blocks);
        REQUIRE(changes == told);
    }
    CHECK(tried > 10);
}

TEST_CASE("C3: surfaces that run out of memory leave nothing behind") {
    sparse_grid const g = sparse_grid::copy_of(scene());
    auto const voxels = tafoni_test::fail_every_allocation([&] { (void)extract_voxel_surface(g); }, 11);
    CHECK(voxels.tried > 3);
    CHECK(voxels.leaks == 0);
    CHECK(voxels.strangers == 0);
    auto const ball = [](vec3 const& p) { return 30 - squared_length(p - vec3{5, 6, 4}); };
    auto const fields = tafoni_test::fail_every_allocation([&] {
        (void)isosurface(ball, {.size = {11, 12, 9}}, 0.0);
        (void)dual_surface(ball, {.size = {11, 12, 9}}, 0.0);
    });
    CHECK(fields.tried > 10);
    CHECK(fields.leaks == 0);
    CHECK(fields.strangers == 0);
}
