#include <catch2/catch.hpp>

#include <support/shapes.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/voxelize.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/geometry/winding_number.hpp>

using namespace tafoni;

namespace {

double rock_volume(voxel_cells const& v) { return static_cast<double>(v.cell_count()) * v.cell_volume(cell_index{0U}); }

indexed_mesh turned(indexed_mesh m, stream& random) {
    // An orthonormal frame from two random directions.
    vec3 const a = random.unit_vector();
    vec3 const b = normalized(cross(a, random.unit_vector()));
    vec3 const c = cross(a, b);
    for (vec3& p : m.positions) p = vec3(p[0] * a + p[1] * b + p[2] * c);
    return m;
}

}  // namespace

TEST_CASE("a box on the lattice lines is exactly its voxels") {
    solid const body = make_solid(tafoni_test::box({1, 2, 3}, {4, 4, 8}));
    auto const v = voxelize(body, {.size = {6, 6, 10}});
    REQUIRE(v.cell_count() == 3 * 2 * 5);
    for (std::size_t i = 1; i < 4; ++i) REQUIRE(v.cell_at(i, 2, 3).valid());
    REQUIRE_FALSE(v.cell_at(0, 2, 3).valid());
    REQUIRE_FALSE(v.cell_at(4, 2, 3).valid());
    auto const fitted = voxelize(body, 0.5);
    REQUIRE(fitted.cell_count() == 8 * 30);
    REQUIRE(rock_volume(fitted) == body.volume);
}

TEST_CASE("a box whose faces pass through the centres of voxels takes one of two neighbours, without leaks") {
    solid const body = make_solid(tafoni_test::box({0.5, 0.5, 0.5}, {3.5, 3.5, 3.5}));
    REQUIRE(voxelize(body, {.size = {5, 5, 5}}).cell_count() == 27);
}

TEST_CASE("every centre away from the surface is rock where its winding number is positive") {
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
        INFO("seed " << seed);
        stream random(seed, stage::user, 0);
        indexed_mesh const shapes[] = {tafoni_test::l_shape(), tafoni_test::box_with_cavity(), tafoni_test::frame(),
                                       tafoni_test::two_boxes()};
        solid const body = make_solid(turned(shapes[seed % 4], random));
        auto const v = voxelize(body, body.bounds.diagonal() / 23);
        auto const& g = v.grid();
        double const shift = 1e-4 * g.spacing[0];
        for (std::size_t k = 0; k < g.size[2]; ++k) {
            for (std::size_t j = 0; j < g.size[1]; ++j) {
                for (std::size_t i = 0; i < g.size[0]; ++i) {
                    vec3 const p = voxel_cells::centre(g, i, j, k);
                    bool same = true;
                    bool const in = point_in_solid(body, p);
                    for (int d = 0; d < 3; ++d) {
                        vec3 q = p;
                        q[d] += shift;
                        same = same && point_in_solid(body, q) == in;
                        q[d] -= 2 * shift;
                        same = same && point_in_solid(body, q) == in;
                    }
                    if (same) REQUIRE(v.cell_at(i, j, k).valid() == in);
                }
            }
        }
    }
}

TEST_CASE("the volume of voxels tends to the solid's") {
    stream random(3, stage::user, 1);
    solid const body = make_solid(turned(tafoni_test::box_with_cavity(), random));
    REQUIRE(rock_volume(voxelize(body, body.bounds.diagonal() / 150)) == Approx(body.volume).epsilon(0.01));
}

TEST_CASE("voxelize refuses bad spacings and grids that do not fit the solid") {
    solid const body = make_solid(tafoni_test::unit_box());
    for (double const bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        REQUIRE_THROWS_AS(voxelize(body, bad), invalid_input);
    }
    REQUIRE_THROWS_AS(voxelize(body, 1e-9), invalid_input);
    REQUIRE_THROWS_AS(voxelize(body, {.size = {2, 2, 2}, .spacing = {1e-14, 1, 1}}), invalid_input);
    REQUIRE(voxelize(body, {.size = {2, 2, 2}, .origin = {5, 5, 5}}).cell_count() == 0);
}
