#include <tafoni/decomposition/locate.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/geometry/winding_number.hpp>

#include <catch2/catch.hpp>

#include "support/shapes.hpp"

using namespace tafoni;

TEST_CASE("a point lies in a shard of its nearest site, by brute force over all sites") {
    solid const body = make_solid(tafoni_test::torus(2, 0.6, 24, 12));
    stream draw(3, stage::user, 0);
    auto const point = [&] {
        vec3 p{0, 0, 0};
        for (int a = 0; a < 3; ++a) p[a] = draw.uniform(body.bounds.lo[a], body.bounds.hi[a]);
        return p;
    };
    std::vector<vec3> sites;
    for (int k = 0; k < 200; ++k) sites.push_back(point());
    auto const c = voronoi_shards(body, sites);
    shard_locator const locator(c);
    int inside = 0;
    for (int k = 0; k < 2000; ++k) {
        vec3 const p = point();
        cell_index const shard = locator(p);
        REQUIRE(shard.valid() == (winding_number(body, p) != 0));
        if (!shard.valid()) continue;
        ++inside;
        std::size_t best = 0;
        for (std::size_t s = 1; s < sites.size(); ++s) {
            if (squared_length(vec3(p - sites[s])) < squared_length(vec3(p - sites[best]))) best = s;
        }
        CHECK(c.site_of[shard.value].value == best);
    }
    CHECK(inside > 300);
}

TEST_CASE("of two shards of one site the one around the point is found") {
    auto const c = voronoi_shards(make_solid(tafoni_test::two_boxes()), std::vector<vec3>{vec3{0.4, 0.5, 0.5}});
    REQUIRE(c.cell_count() == 2);
    cell_index const a = locate(c, vec3{0.5, 0.3, 0.6});
    cell_index const b = locate(c, vec3{2.5, 0.3, 0.6});
    REQUIRE(a.valid());
    REQUIRE(b.valid());
    CHECK(a != b);
    CHECK(std::fabs(c.cell_centroid(a)[0] - 0.5) < 1e-12);
    CHECK(std::fabs(c.cell_centroid(b)[0] - 2.5) < 1e-12);
    CHECK_FALSE(locate(c, vec3{1.5, 0.5, 0.5}).valid());
}

TEST_CASE("centroids of convex shards lie in their shards") {
    solid const body = make_solid(tafoni_test::unit_box());
    stream draw(4, stage::user, 0);
    std::vector<vec3> sites;
    for (int k = 0; k < 100; ++k) {
        double const x = draw.uniform01();
        double const y = draw.uniform01();
        sites.push_back(vec3{x, y, draw.uniform01()});
    }
    auto const c = voronoi_shards(body, sites);
    shard_locator const locator(c);
    for (std::uint32_t k = 0; k < c.cell_count(); ++k) CHECK(locator(c.centroids[k]) == cell_index{k});
}
