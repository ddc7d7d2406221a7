#include <tafoni/core/thread_pool.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/weathering/weathered_voxels.hpp>

#include <catch2/catch.hpp>

#include <algorithm>

using namespace tafoni;

TEST_CASE("the surface of a run tells curvature, durability, decimation and what caverns will take") {
    grid_border const ground{{border_kind::air, border_kind::air, border_kind::air, border_kind::air, border_kind::rock,
                              border_kind::air}};
    sparse_grid g({.size = {40, 40, 40}, .spacing = {0.5, 0.5, 0.5}}, up_axis::plus_z, ground);
    for (std::int32_t z = 0; z < 30; ++z) {  // an L: one edge that is hollow, others that protrude
        for (std::int32_t y = 4; y < 36; ++y) {
            for (std::int32_t x = 4; x < 36; ++x) {
                if (x < 18 || z < 12) g.set({x, y, z}, voxel_state::rock);
            }
        }
    }
    auto const height = [](vec3 const& p) { return 0.01 + 0.001 * p[2]; };
    voxel_run run(g, voxel_weathering{.bubbles = single_bubble{sphere_bubble{.radius = 4}}, .durability = height},
                  {.colluvium = repose_rule{}});
    run.run({.phases = {{.steps = 6}}});
    auto const out = extract_weathered_voxels(run);
    REQUIRE(out.surface.rock.mesh.positions.size() > 1000);
    REQUIRE(out.surface.colluvium.mesh.positions.size() > 100);
    double hollow = 0;
    double proud = 0;
    for (auto const& [mesh, numbers] : {std::pair{&out.surface.rock, &out.rock}, std::pair{&out.surface.colluvium, &out.colluvium}}) {
        std::size_t const n = mesh->mesh.positions.size();
        REQUIRE(numbers->curvature.size() == n);
        for (std::size_t i = 0; i < n; ++i) {
            voxel const v = mesh->vertex_voxel[i];
            double const c = numbers->curvature[i];
            REQUIRE(numbers->durability[i] == height(run.grid().centre(v)));
            REQUIRE(numbers->cavernous[i] == std::max(0.0, -c) * numbers->durability[i]);
            REQUIRE(numbers->decimation[i] > 0);
            REQUIRE(numbers->decimation[i] <= 100);
            if (auto const s = run.at(v)) REQUIRE(c == 2 * s->air_share - 1);
            hollow = std::min(hollow, c);
            proud = std::max(proud, c);
        }
    }
    REQUIRE(hollow < -0.3);
    REQUIRE(proud > 0.3);
    thread_pool const pool(3);
    auto const again = extract_weathered_voxels(run, {}, pool);
    REQUIRE(again.surface == out.surface);
    REQUIRE(again.rock.curvature == out.rock.curvature);
}
