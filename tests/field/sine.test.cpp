#include <tafoni/field/sine.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace tafoni;

namespace {
double const nan_value = std::numeric_limits<double>::quiet_NaN();
}

TEST_CASE("a sine field swings around its mean") {
    sine_field const f{.wave = {0, 0, 2}, .mean = 0.5, .amplitude = 0.25};
    CHECK(f({3, 4, 0}) == 0.5);
    CHECK(f({0, 0, 0.78539816339744831}) == Approx(0.75));
    CHECK(f({0, 0, -0.78539816339744831}) == Approx(0.25));
    CHECK_THROWS_AS(sine_field{.phase = nan_value}.validate(), invalid_input);
}

TEST_CASE("a sine field repeats along its wave, is level across it and keeps its range") {
    sine_field const f{.wave = {3, 0, 4}, .phase = 0.4, .mean = 0.5, .amplitude = 0.5};
    double const period = 6.283185307179586 / 25;
    for (int i = -100; i < 100; ++i) {
        vec3 const p{0.37 * i, -1.1 * i, 0.05 * i};
        double const v = f(p);
        REQUIRE((v >= 0 && v <= 1));
        REQUIRE(v == Approx(0.5 + 0.5 * std::sin(3 * p[0] + 4 * p[2] + 0.4)).margin(1e-14));
        REQUIRE(f(vec3{p[0] + 3 * period, p[1], p[2] + 4 * period}) == Approx(v).margin(1e-12));
        REQUIRE(f(vec3{p[0] + 4, p[1] + 9, p[2] - 3}) == Approx(v).margin(1e-12));
    }
}

TEST_CASE("a sine field refuses what is not finite [Q1]") {
    CHECK_NOTHROW(sine_field{}.validate());
    for (double const bad : {nan_value, 1e301, -std::numeric_limits<double>::infinity()}) {
        CHECK_THROWS_AS((sine_field{.wave = {0, bad, 0}}.validate()), invalid_input);
        CHECK_THROWS_AS((sine_field{.phase = bad}.validate()), invalid_input);
        CHECK_THROWS_AS((sine_field{.mean = bad}.validate()), invalid_input);
        CHECK_THROWS_AS((sine_field{.amplitude = bad}.validate()), invalid_input);
    }
}
