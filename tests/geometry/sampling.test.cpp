#include <tafoni/geometry/sampling.hpp>

#include <tafoni/geometry/bvh.hpp>
#include <tafoni/geometry/make_solid.hpp>

#include <support/shapes.hpp>

#include <catch2/catch.hpp>

#include <array>
#include <cmath>

using namespace tafoni;

TEST_CASE("sampled points lie on the surface and in the bounds") {
    for (indexed_mesh const& mesh : {tafoni_test::l_shape(), tafoni_test::torus(2, 0.5, 14, 9), tafoni_test::thin_limbs()}) {
        solid const s = make_solid(mesh);
        surface_sampler const sample(s);
        bvh const tree(s);
        stream random(1, stage::user, 3);
        for (int i = 0; i < 2000; ++i) {
            vec3 const p = sample(random);
            REQUIRE(s.bounds.contains(p));
            REQUIRE(tree.nearest_point(p)->distance <= 1e-15 * s.bounds.diagonal());
        }
    }
}

TEST_CASE("every face of a box is hit in proportion to its area, and evenly within") {
    solid const s = make_solid(tafoni_test::box({0, 0, 0}, {1, 2, 4}));
    surface_sampler const sample(s);
    stream random(4, stage::user, 0);
    int const n = 56000;
    std::array<std::array<int, 16>, 6> hits{};  // per face, on a grid of 4 x 4
    for (int i = 0; i < n; ++i) {
        vec3 const p = sample(random);
        std::size_t face = 6;
        for (std::size_t a = 0; a < 3; ++a) {
            auto const axis = static_cast<Eigen::Index>(a);
            if (p[axis] == s.bounds.lo[axis]) face = 2 * a;
            if (p[axis] == s.bounds.hi[axis]) face = 2 * a + 1;
        }
        REQUIRE(face < 6);
        auto const cell = [&](std::size_t a) {
            auto const axis = static_cast<Eigen::Index>(a % 3);
            auto const k = static_cast<std::size_t>(4 * p[axis] / s.bounds.hi[axis]);
            return k < 4 ? k : std::size_t{3};
        };
        ++hits[face][4 * cell(face / 2 + 1) + cell(face / 2 + 2)];
    }
    double chi_squared = 0;
    std::array<double, 3> const area{8, 4, 2};
    for (std::size_t face = 0; face < 6; ++face) {
        double const expected = n * area[face / 2] / 28 / 16;
        for (int const h : hits[face]) chi_squared += (h - expected) * (h - expected) / expected;
    }
    CHECK(chi_squared < 172);  // 95 degrees of freedom, alpha 1e-6
    CHECK(chi_squared > 40);
}

TEST_CASE("equal streams give equal points in three draws") {
    solid const s = make_solid(tafoni_test::unit_box());
    surface_sampler const sample(s);
    stream a(7, stage::user, 1);
    stream b = a;
    for (int i = 0; i < 100; ++i) REQUIRE(sample(a) == sample(b));
    stream c(7, stage::user, 1);
    for (int i = 0; i < 300; ++i) (void)c.bits();
    CHECK(a.bits() == c.bits());
}
