#include <tafoni/io/voxel_channels.hpp>

#include <tafoni/io/read_ply.hpp>
#include <tafoni/io/write_ply.hpp>
#include <tafoni/voxel/fill_from_predicate.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <utility>
#include <vector>

using namespace tafoni;

TEST_CASE("weathered voxels go through PLY with curvature, durability, decimation and cavernous on their vertices") {
    sparse_grid ball(grid_frame{.size = {14, 14, 14}});
    fill_from_predicate(ball, [](vec3 const& p) { return squared_length(vec3{p - vec3{7, 7, 7}}) < 25; });
    voxel_run run(std::move(ball), voxel_weathering{.bubbles = single_bubble{sphere_bubble{3}}, .durability = constant_field{0.25}});
    run.run({.phases = {{.steps = 2}}});
    weathered_voxels const left = extract_weathered_voxels(run);
    CHECK(channels_of(left.rock).face_channels.empty());

    mesh_file const back = read_ply(encode_ply(left.surface.rock.mesh, channels_of(left.rock)), "memory");
    auto const& channels = back.attributes.vertex_channels;
    REQUIRE(channels.size() == 4);
    auto const same = [&](char const* name, std::vector<double> const& numbers) {
        auto const* const c = mesh_attributes::find(channels, name);
        REQUIRE(c != nullptr);
        return std::equal(c->values.begin(), c->values.end(), numbers.begin(), numbers.end(),
                          [](double read, double made) { return read == static_cast<double>(static_cast<float>(made)); });
    };
    CHECK(!left.rock.curvature.empty());
    CHECK(same("curvature", left.rock.curvature));
    CHECK(same("durability", left.rock.durability));
    CHECK(same("decimation", left.rock.decimation));
    CHECK(same("cavernous", left.rock.cavernous));
    for (mesh_channel const& none : channels_of(left.colluvium).vertex_channels) CHECK(none.values.empty());
}
