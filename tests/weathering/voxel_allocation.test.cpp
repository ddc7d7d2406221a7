#include "reliability/failing_new.hpp"

#include <tafoni/core/random.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/weathering/voxel_run.hpp>

#include <catch2/catch.hpp>

using namespace tafoni;

TEST_CASE("C3: when memory runs out at any point, the run stays usable and ends in the same bytes") {
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
