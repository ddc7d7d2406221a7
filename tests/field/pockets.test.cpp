#include <tafoni/field/pockets.hpp>

#include <tafoni/field/ramp.hpp>

#include <catch2/catch.hpp>

#include <limits>
#include <vector>

using namespace tafoni;

namespace {
double const nan_value = std::numeric_limits<double>::quiet_NaN();
}

TEST_CASE("pockets hide the base and later pockets hide earlier ones") {
    pockets const f{ramp_field{.at_start = 0.5, .at_end = 0.5},
                    std::vector<pocket>{{.radii = {2, 2, 2}, .value = 0.9}, {.radii = {1, 3, 1}, .value = 0.1}}};
    CHECK(f({0, 0, 0}) == 0.1);
    CHECK(f({1.5, 0, 0}) == 0.9);
    CHECK(f({0, 2.5, 0}) == 0.1);
    CHECK(f({2.5, 0, 0}) == 0.5);
    CHECK_THROWS_AS((pockets<>{.bodies = {{.radii = {1, 0, 1}}}}.validate()), invalid_input);
}

TEST_CASE("a pocket is closed, and a ball holds what is within its radius") {
    pocket const ball{.centre = {1, 2, 3}, .radii = {0.5, 0.5, 0.5}};
    CHECK(ball.contains({1.5, 2, 3}));
    CHECK(ball.contains({1, 2, 2.5}));
    CHECK_FALSE(ball.contains({1.5 + 0x1p-51, 2, 3}));
    CHECK_FALSE(ball.contains({1.4, 2.4, 3}));
}

TEST_CASE("pockets refuse what is not finite, also in their base [Q1]") {
    CHECK_NOTHROW(pockets<>{}.validate());
    CHECK(pockets<>{}({0, 0, 0}) == 0.5);
    for (double const bad : {nan_value, 1e301}) {
        CHECK_THROWS_AS((pockets<>{.bodies = {{.centre = {0, bad, 0}}}}.validate()), invalid_input);
        CHECK_THROWS_AS((pockets<>{.bodies = {{.radii = {1, bad, 1}}}}.validate()), invalid_input);
        CHECK_THROWS_AS((pockets<>{.bodies = {{.value = bad}}}.validate()), invalid_input);
        CHECK_THROWS_AS((pockets<>{.base = {.value = bad}}.validate()), invalid_input);
    }
}
