#include "reliability/failing_new.hpp"

#include <tafoni/core/random.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/weathering/voxel_run.hpp>

#include <catch2/catch.hpp>

using namespace tafoni;

namespace {

/// A ruin over two bricks.
sparse_grid ruin() {
    sparse_grid rock({.size = {34, 9, 10}}, up_axis::plus_z,
                     {{border_kind::air, border_kind::air, border_kind::air, border_kind::air, border_kind::rock, border_kind::air}});
    stream random(3, stage::user, 0);
    for (std::int32_t z = 0; z < 9; ++z) {
        for (std::int32_t y = 1; y < 8; ++y) {
            for (std::int32_t x = 1; x < 33; ++x) {
                if (random.uniform01() < 0.9) rock.set({x, y, z}, voxel_state::rock);
            }
        }
    }
    return rock;
}

}  // namespace

TEST_CASE("C3: when memory runs out while policies are replaced or a checkpoint is read, the run is as before") {
    voxel_options const options{.colluvium = repose_rule{}, .rockfall = rockfall_options{}};
    auto const process = voxel_weathering{.durability = constant_field{.value = 0.01}};
    auto const harder = voxel_weathering{.bubbles = single_bubble{sphere_bubble{.radius = 5}}, .durability = constant_field{.value = 0.02}};
    voxel_run whole(ruin(), process, options);
    auto const start = whole.checkpoint();
    whole.run({.phases = {{.steps = 2}}});
    auto const middle = whole.checkpoint();
    whole.run({.phases = {{.steps = 2}}});
    auto const end = whole.checkpoint();
    for (int what = 0; what < 3; ++what) {
        bool failed = true;
        for (long k = 0; failed && k < 5000; k += 1 + k / 40) {
            voxel_run run(ruin(), process, options);
            run.run({.phases = {{.steps = 2}}});
            failed = false;
            tafoni_test::allocations_left = k;
            try {
                if (what == 0) run.replace(harder);
                if (what == 1) run.replace(voxel_options{.skin_depth = 2});
                if (what == 2) run.resume(start);
            } catch (std::bad_alloc const&) {
                failed = true;
            }
            if (!failed) break;
            tafoni_test::allocations_left = 20;
            try {
                run.run({.phases = {{.steps = 2}}});
            } catch (std::bad_alloc const&) {
            }
            tafoni_test::allocations_left = -1;
            bool const as_before = run.steps() > 2 || run.checkpoint() == middle;
            run.run({.phases = {{.steps = 4 - run.steps()}}});
            bool const same = run.checkpoint() == end;
            INFO("way " << what << ", allocation " << k);
            REQUIRE(as_before);
            REQUIRE(same);
        }
        tafoni_test::allocations_left = -1;
        REQUIRE(!failed);
    }
}

TEST_CASE("C3: when memory runs out at any point, the run stays usable and ends in the same bytes") {
    sparse_grid const rock = ruin();
    auto const process = voxel_weathering{.durability = constant_field{.value = 0.01}};
    for (bool const more : {false, true}) {
        voxel_options options;
        if (more) {
            options.colluvium = repose_rule{};
            options.rockfall = rockfall_options{};
        }
        voxel_run whole(rock, process, options);
        whole.run({.phases = {{.steps = 5}}});
        auto const end = whole.checkpoint();
        bool failed = true;
        long k = 0;
        for (; failed && k < 20000; k += 1 + k / 50) {
            voxel_run run(rock, process, options);
            failed = false;
            tafoni_test::allocations_left = k;
            try {
                run.run({.phases = {{.steps = 5}}});
            } catch (std::bad_alloc const&) {
                failed = true;
            }
            if (failed) {  // once more at once, from whatever was left behind
                tafoni_test::allocations_left = k / 2;
                try {
                    run.run({.phases = {{.steps = 5 - run.steps()}}});
                } catch (std::bad_alloc const&) {
                }
            }
            tafoni_test::allocations_left = -1;
            run.run({.phases = {{.steps = 5 - run.steps()}}});
            bool const same = run.checkpoint() == end;
            INFO("allocation " << k);
            REQUIRE(same);
        }
        REQUIRE(!failed);
        REQUIRE(k > 40);
    }
}
