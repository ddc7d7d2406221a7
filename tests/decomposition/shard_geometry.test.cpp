#include <tafoni/decomposition/shard_geometry.hpp>

#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/geometry/make_solid.hpp>

#include <catch2/catch.hpp>

#include "support/shapes.hpp"

using namespace tafoni;

TEST_CASE("a square face has its area, normal and middle") {
    auto const c = voronoi_shards(make_solid(tafoni_test::unit_box()), std::vector<vec3>{vec3{0.25, 0.5, 0.5}, vec3{0.75, 0.5, 0.5}});
    REQUIRE(c.interior_face_count == 1);
    auto const m = measure_face(c, face_index{std::uint32_t{0}});
    CHECK(m.area() == Approx(1).epsilon(1e-14));
    CHECK(length(vec3(m.centroid - vec3{0.5, 0.5, 0.5})) < 1e-14);
    bool const forward = c.site_of[c.faces[0].front.value].value == 0;
    CHECK(length(vec3(m.normal() - vec3{forward ? 1.0 : -1.0, 0, 0})) < 1e-14);
}

TEST_CASE("holes are taken off a face's area and shift its centroid") {
    // The cut z = 0.5 through a frame with an off-centre part cut off: [0, 3] x [0, 3] without [1, 2]^2.
    auto const c = voronoi_shards(make_solid(tafoni_test::frame()), std::vector<vec3>{vec3{1.5, 1.5, 0.25}, vec3{1.5, 1.5, 0.75}});
    auto const m = measure_face(c, face_index{std::uint32_t{0}});
    CHECK(m.area() == Approx(8).epsilon(1e-13));
    CHECK(length(vec3(m.centroid - vec3{1.5, 1.5, 0.5})) < 1e-13);
}

TEST_CASE("faces of a shard have area vectors that cancel") {
    auto const c = voronoi_shards(make_solid(tafoni_test::l_shape()), std::vector<vec3>{vec3{0.3, 0.4, 0.5}, vec3{1.6, 0.5, 0.2}, vec3{0.2, 1.7, 0.9}});
    for (std::uint32_t k = 0; k < c.cell_count(); ++k) {
        vec3 sum{0, 0, 0};
        for (std::uint32_t f : c.faces_of(cell_index{k})) {
            sum += (c.faces[f].front.value == k ? 1.0 : -1.0) * measure_face(c, face_index{f}).area_vector;
        }
        CHECK(length(sum) < 1e-13);
    }
}
