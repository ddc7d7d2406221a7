#include <tafoni/decomposition/surface_normals.hpp>

#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/geometry/make_solid.hpp>

#include <catch2/catch.hpp>

#include "support/shapes.hpp"

using namespace tafoni;

TEST_CASE("skin of a ball is shaded smoothly, a cut through it is flat") {
    auto const c = voronoi_shards(make_solid(tafoni_test::icosphere(3)), std::vector<vec3>{vec3{-0.5, 0, 0}, vec3{0.5, 0, 0}});
    auto const s = extract_surface(c, std::vector<cell_index>{cell_index{std::uint32_t{0}}});
    auto const normals = surface_normals(s, c);
    REQUIRE(normals.size() == s.mesh.corners.size());
    double const side = c.centroids[0][0] < 0 ? 1 : -1;
    std::size_t fresh = 0;
    std::size_t flat = 0;
    for (std::size_t k = 0; k < normals.size(); ++k) {
        if (length(normals[k]) == 0) {  // the cut runs through vertices and leaves pieces without area
            ++flat;
            continue;
        }
        CHECK(length(normals[k]) == Approx(1).epsilon(1e-12));
        vec3 const& p = s.mesh.positions[s.mesh.corners[k]];
        if (s.fresh[k / 3] != 0) {
            ++fresh;
            CHECK(dot(normals[k], vec3{side, 0, 0}) > 1 - 1e-12);
        } else if (std::fabs(p[0]) > 0.2) {
            CHECK(dot(normals[k], normalized(p)) > 0.999);
        }
    }
    CHECK(fresh > 10);
    CHECK(flat < 100);
}

TEST_CASE("edges between patches stay sharp") {
    auto const c = voronoi_shards(make_solid(tafoni_test::unit_box()), std::vector<vec3>{vec3{0.5, 0.5, 0.5}});
    auto const s = extract_surface(c, std::vector<cell_index>{cell_index{std::uint32_t{0}}});
    for (vec3 const& n : surface_normals(s, c)) {
        CHECK(std::fabs(n[0]) + std::fabs(n[1]) + std::fabs(n[2]) == Approx(1).epsilon(1e-14));
    }
}
