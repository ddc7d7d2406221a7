#include <tafoni/field/jittered.hpp>

#include <tafoni/field/constant.hpp>
#include <tafoni/field/strata.hpp>

#include <catch2/catch.hpp>

#include <limits>

using namespace tafoni;

TEST_CASE("layers are folded, but no further than the amplitude") {
    strata const layers{.tops = {0}, .values = {0.1, 0.9}};
    jittered const j{layers, 0.5, fractal_noise{.frequency = 2}};
    CHECK_NOTHROW(j.validate());
    bool moved = false;
    for (int i = 0; i < 200; ++i) {
        double const x = 0.37 * i;
        CHECK(j({x, 0, 0.51}) == 0.9);
        CHECK(j({x, 0, -0.51}) == 0.1);
        moved = moved || j({x, 0, 0.05}) == 0.1;
    }
    CHECK(moved);
    CHECK(jittered{layers, 0.0}({1, 2, 3}) == layers({1, 2, 3}));
}

TEST_CASE("the three axes are displaced by noises of their own") {
    struct along {
        int axis;
        double operator()(vec3 const& p) const { return p[axis]; }
    };
    fractal_noise const noise{.seed = 3, .frequency = 1.3};
    vec3 const p{0.3, 0.4, 0.8};
    double const x = jittered{along{0}, 1.0, noise}(p) - p[0];
    double const y = jittered{along{1}, 1.0, noise}(p) - p[1];
    double const z = jittered{along{2}, 1.0, noise}(p) - p[2];
    CHECK(x == Approx(noise(p)));
    CHECK(std::fabs(x - y) > 1e-3);
    CHECK(std::fabs(y - z) > 1e-3);
    CHECK(std::fabs(z - x) > 1e-3);
}

TEST_CASE("a jittered field refuses bad parameters, also of its noise and its base [Q1]") {
    double const nan_value = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS((jittered{constant_field{}, -1.0}.validate()), invalid_input);
    CHECK_THROWS_AS((jittered{constant_field{}, nan_value}.validate()), invalid_input);
    CHECK_THROWS_AS((jittered{constant_field{.value = nan_value}, 1.0}.validate()), invalid_input);
    CHECK_THROWS_AS((jittered{constant_field{}, 1.0, fractal_noise{.gain = 2}}.validate()), invalid_input);
}
