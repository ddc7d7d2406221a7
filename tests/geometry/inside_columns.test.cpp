#include <tafoni/geometry/inside_columns.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/geometry/make_solid.hpp>

#include <support/shapes.hpp>

#include <catch2/catch.hpp>

using namespace tafoni;

TEST_CASE("columns give the winding number of every point, on the grid of the vertices too") {
    indexed_mesh both = tafoni_test::box_with_cavity();
    tafoni_test::append(both, tafoni_test::box({2, 2, 2}, {5, 4, 6}));
    for (indexed_mesh const& mesh : {tafoni_test::l_shape(), tafoni_test::frame(), both}) {
        solid const s = make_solid(mesh);
        inside_columns const columns(s);
        stream random(3, stage::user, 0);
        vec3 const extent = s.bounds.extent();
        for (int n = 0; n < 20000; ++n) {
            vec3 p{0, 0, 0};
            for (int a = 0; a < 3; ++a) {
                double const u = random.uniform(-0.1, 1.1);
                p[a] = s.bounds.lo[a] + extent[a] * (n % 4 == 0 ? std::floor(u * 12) / 12 : u);
            }
            REQUIRE(columns.winding(p) == winding_number(s, p));
        }
    }
}
