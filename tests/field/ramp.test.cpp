#include <tafoni/field/ramp.hpp>

#include <catch2/catch.hpp>

#include <limits>

using namespace tafoni;

namespace {
double const nan_value = std::numeric_limits<double>::quiet_NaN();
}

TEST_CASE("a ramp is linear between its planes and constant behind them") {
    ramp_field const f{.start = {1, 0, 0}, .end = {3, 0, 0}, .at_start = 0.2, .at_end = 0.8};
    CHECK(f({0, 5, 5}) == 0.2);
    CHECK(f({2, -9, 1}) == Approx(0.5));
    CHECK(f({4, 0, 0}) == 0.8);
    CHECK_THROWS_AS((ramp_field{.start = {1, 1, 1}, .end = {1, 1, 1}}.validate()), invalid_input);
}

TEST_CASE("a ramp never leaves the range of its ends, whatever rounding does") {
    for (int i = 1; i < 400; ++i) {
        double const low = 0.1 / i;
        ramp_field const up{.end = {0, 0, 3}, .at_start = low, .at_end = 1};
        ramp_field const down{.end = {0, 0, 3}, .at_start = 1, .at_end = low};
        for (double const z : {1e-300, 1e-17, 0.7 * i / 400, 3 * (1 - 0x1p-53), 3.0}) {
            REQUIRE((up({0, 0, z}) >= low && up({0, 0, z}) <= 1));
            REQUIRE((down({0, 0, z}) >= low && down({0, 0, z}) <= 1));
        }
    }
}

TEST_CASE("a ramp refuses what is not finite, and a point or NaN for an axis gives its start [Q1]") {
    CHECK_NOTHROW(ramp_field{}.validate());
    for (double const bad : {nan_value, 1e301, -std::numeric_limits<double>::infinity()}) {
        CHECK_THROWS_AS((ramp_field{.start = {bad, 0, 0}}.validate()), invalid_input);
        CHECK_THROWS_AS((ramp_field{.end = {0, bad, 0}}.validate()), invalid_input);
        CHECK_THROWS_AS((ramp_field{.at_start = bad}.validate()), invalid_input);
        CHECK_THROWS_AS((ramp_field{.at_end = bad}.validate()), invalid_input);
    }
    CHECK(ramp_field{.end = {0, 0, 0}, .at_start = 0.25}({1, 2, 3}) == 0.25);
}
