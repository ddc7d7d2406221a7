#include <tafoni/decomposition/source_barycentrics.hpp>

#include <tafoni/decomposition/random_sites.hpp>
#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/geometry/make_solid.hpp>

#include <catch2/catch.hpp>

#include "support/shapes.hpp"

using namespace tafoni;

TEST_CASE("skin corners are found again from their shares, and an attribute of the input is carried over") {
    for (double scale : {1.0, 0x1p-90, 0x1p90}) {
        auto mesh = tafoni_test::torus(2, 0.6, 24, 12);
        for (vec3& p : mesh.positions) p = vec3{p[0] * scale, p[1] * scale, p[2] * scale};
        solid const body = make_solid(mesh);
        auto const c = voronoi_shards(body, random_sites{.count = 50}(body, 3));
        std::vector<std::uint8_t> inside(c.cell_count(), 0);
        for (std::size_t k = 0; k < inside.size(); k += 2) inside[k] = 1;
        auto const s = extract_surface(c, inside);
        auto const shares = source_barycentrics(s, c, body);
        REQUIRE(shares.size() == s.mesh.corners.size());
        std::size_t vertices = 0;
        for (std::size_t k = 0; k < shares.size(); ++k) {
            if (s.fresh[k / 3] != 0) {
                REQUIRE(shares[k] == std::array<double, 3>{0, 0, 0});
                continue;
            }
            auto const& t = body.triangles[c.face_source(s.face[k / 3])];
            vec3 p{0, 0, 0};
            double sum = 0;
            for (std::size_t v = 0; v < 3; ++v) {
                REQUIRE((shares[k][v] >= 0 && shares[k][v] <= 1));
                sum += shares[k][v];
                for (int a = 0; a < 3; ++a) p[a] += shares[k][v] * body.positions[t[v]][a];
                vertices += shares[k][v] == 1 ? 1U : 0U;
            }
            CHECK(std::fabs(sum - 1) < 1e-15);
            CHECK(length(vec3(p - s.mesh.positions[s.mesh.corners[k]])) < 1e-14 * c.model_size());
        }
        CHECK(vertices > 100);
    }
}

TEST_CASE("shares on triangles without area are finite, and another solid is refused") {
    solid const body = make_solid(tafoni_test::l_shape());
    auto const c = voronoi_shards(body, std::vector<vec3>{vec3{0.5, 0.5, 0.5}});
    auto const s = extract_surface(c, std::vector<cell_index>{cell_index{std::uint32_t{0}}});
    CHECK_THROWS_AS(source_barycentrics(s, c, make_solid(tafoni_test::unit_box())), invalid_input);

    solid flat = body;
    for (vec3& p : flat.positions) p = vec3{p[0], 0, 0};
    for (auto const& w : source_barycentrics(s, c, flat)) {
        CHECK(w[0] + w[1] + w[2] == Approx(1));
        CHECK((w[0] >= 0 && w[1] >= 0 && w[2] >= 0));
    }
}
