// What refinement under water adds leads back to the input.
#include <tafoni/weathering/hydraulic_run.hpp>

#include <tafoni/fluid/rain_particles.hpp>

#include <catch2/catch.hpp>

#include "support/water_scenes.hpp"

#include <vector>

using namespace tafoni;

namespace {

vec3 twice_area(std::vector<vec3> const& p, std::array<std::uint32_t, 3> const& t) {
    return cross(vec3{p[t[1]] - p[t[0]]}, vec3{p[t[2]] - p[t[0]]});
}

}  // namespace

TEST_CASE("vertices and faces that are added under water lead back to those of the input, after a break too") {
    triangle_surface const input = tafoni_test::slope(12, 5);
    rain_particles const rain({.box = tafoni_test::between({1.5, 1.5, -0.3}, {3, 8.5, 0.2})}, {.keep = tafoni_test::between({1, 1, -6}, {9, 9, 5})},
                              {.particles = 150, .radius = 0.4, .lifetime = 1.1});
    hydraulic_options const refining{.refine_length = 0.5, .refine_every = 5};
    hydraulic_run run(input, rain, partheniades_erosion{.coefficient = 2e-3, .critical = 3}, refining);
    CHECK(run.origins().midpoints.empty());
    REQUIRE(run.origins().face.size() == input.triangles.size());
    for (std::size_t f = 0; f < input.triangles.size(); ++f) CHECK(run.origins().face[f] == face_index{f});
    run.run(25);

    refined_origins const& origins = run.origins();
    REQUIRE(run.report().vertices_added > 100);
    CHECK(origins.midpoints.size() == run.report().vertices_added);
    REQUIRE(origins.face.size() == run.surface().triangles.size());
    // As if nothing had worn, every face lies in the one that it comes from, and together they cover it.
    std::vector<vec3> const flat = origins.carried(input.positions);
    REQUIRE(flat.size() == run.surface().positions.size());
    std::vector<double> covered(input.triangles.size(), 0.0);
    for (std::size_t f = 0; f < origins.face.size(); ++f) {
        vec3 const part = twice_area(flat, run.surface().triangles[f]);
        CHECK(dot(part, twice_area(input.positions, input.triangles[origins.face[f].value])) > 0);
        covered[origins.face[f].value] += length(part);
    }
    for (std::size_t f = 0; f < covered.size(); ++f) {
        CHECK(covered[f] == Approx(length(twice_area(input.positions, input.triangles[f]))).epsilon(1e-12));
    }

    hydraulic_run other(input, rain, partheniades_erosion{.coefficient = 2e-3, .critical = 3}, refining);
    other.resume(run.checkpoint());
    CHECK(other.origins().midpoints == origins.midpoints);
    CHECK(other.origins().face == origins.face);
}
