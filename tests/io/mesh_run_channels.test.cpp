// The channels of the three processes on meshes.
#include <tafoni/io/curvature_channels.hpp>
#include <tafoni/io/hydraulic_channels.hpp>
#include <tafoni/io/wrinkle_channels.hpp>

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/curvature/cotangent.hpp>
#include <tafoni/fluid/rain_particles.hpp>
#include <tafoni/io/read_ply.hpp>
#include <tafoni/io/write_ply.hpp>

#include <catch2/catch.hpp>

#include "support/curved_surfaces.hpp"
#include "support/water_scenes.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

using namespace tafoni;

namespace {

/// What a file of this surface with these channels holds under a name, as it was before the rounding to float.
bool holds(mesh_file const& file, char const* name, auto const& numbers) {
    mesh_channel const* const c = mesh_attributes::find(file.attributes.vertex_channels, name);
    return c != nullptr && std::equal(c->values.begin(), c->values.end(), numbers.begin(), numbers.end(), [](double read, auto made) {
               return read == static_cast<double>(static_cast<float>(made));
           });
}
mesh_file through_ply(triangle_surface const& s, mesh_attributes const& a) {
    return read_ply(encode_ply(s, a), "memory");
}
bool moves(auto const& numbers) {
    return std::any_of(numbers.begin(), numbers.end(), [](auto x) { return static_cast<double>(x) != 0; });
}

}  // namespace

TEST_CASE("a curvature run goes through PLY with curvature and wear on its vertices, on any thread") {
    curvature_run run(tafoni_test::slab(8, 0.5), curvature_weathering{.estimator = cotangent{}});
    run.run(3);
    thread_pool const threads(2);
    mesh_attributes const a = channels_of(run, threads);
    CHECK(a.face_channels.empty());
    REQUIRE(a.vertex_channels.size() == 2);
    mesh_file const back = through_ply(run.surface(), a);
    CHECK(moves(run.wear()));
    CHECK(holds(back, "curvature", run.curvature()));
    CHECK(holds(back, "wear", run.wear()));
}

TEST_CASE("a hydraulic run goes through PLY with curvature, wear, flow and sediment on its vertices") {
    rain_particles const rain({.box = tafoni_test::between({1, 1, 0.3}, {9, 9, 0.8}), .velocity = {0, 0, -1}},
                              {.keep = tafoni_test::between({0, 0, -9}, {10, 10, 9})}, {.particles = 300, .radius = 0.4, .lifetime = 0.5});
    hydraulic_run run(tafoni_test::slope(12, 4), rain, partheniades_erosion{.coefficient = 1e-3, .critical = 0.01});
    run.run(30);
    mesh_attributes const a = channels_of(run);
    REQUIRE(a.vertex_channels.size() == 4);
    mesh_file const back = through_ply(run.surface(), a);
    CHECK((moves(run.flow()) && moves(run.wear()) && moves(run.sediment())));
    CHECK(holds(back, "curvature", estimate_curvature(run.surface())));
    CHECK(holds(back, "wear", run.wear()));
    CHECK(holds(back, "flow", run.flow()));
    CHECK(holds(back, "sediment", run.sediment()));
    mesh_file const other = through_ply(run.surface(), channels_of(run, cotangent{}));
    CHECK(holds(other, "curvature", estimate_curvature(run.surface(), cotangent{})));
}

TEST_CASE("a wrinkled mesh goes through PLY with curvature, wear and factor on its vertices") {
    triangle_surface const ground = tafoni_test::slope(10, 0);
    wrinkle const crack{.controls = {vertex_index{24U}, vertex_index{96U}}, .radius = 1, .strength = -1, .profile = wrinkle_profile::groove};
    wrinkle_pattern const pattern(ground, std::span(&crack, 1));
    triangle_surface const flat = pattern.wear(ground.positions, 0);
    triangle_surface const worn = pattern.wear_again(flat, 2);
    mesh_attributes const a = channels_of(pattern, flat, worn);
    REQUIRE(a.vertex_channels.size() == 3);
    mesh_file const back = through_ply(worn, a);
    std::vector<double> wear;
    for (std::size_t v = 0; v < worn.positions.size(); ++v) wear.push_back(length(vec3{worn.positions[v] - flat.positions[v]}));
    CHECK(moves(wear));
    CHECK(holds(back, "curvature", estimate_curvature(worn)));
    CHECK(holds(back, "wear", wear));
    CHECK(holds(back, "factor", pattern.displacement()));
    CHECK_THROWS_AS(channels_of(pattern, ground, worn), invalid_input);
    CHECK_THROWS_AS(channels_of(pattern, flat, ground), invalid_input);
}
