#include <tafoni/field/strata.hpp>

#include <catch2/catch.hpp>

#include <limits>

using namespace tafoni;

namespace {
double const nan_value = std::numeric_limits<double>::quiet_NaN();
}

TEST_CASE("strata answer by altitude along their own up") {
    strata const f{.up = {0, 1, 0}, .tops = {1, 2}, .values = {0.1, 0.2, 0.3}};
    f.validate();
    CHECK(f({9, 0.5, -9}) == 0.1);
    CHECK(f({0, 1, 0}) == 0.2);
    CHECK(f({0, 2.5, 0}) == 0.3);
    CHECK_THROWS_AS((strata{.tops = {1, 2}, .values = {1, 2}}.validate()), invalid_input);
    CHECK_THROWS_AS((strata{.tops = {2, 1}, .values = {1, 2, 3}}.validate()), invalid_input);
    CHECK_THROWS_AS((strata{.up = {0, 0, 2}, .values = {1}}.validate()), invalid_input);
}

TEST_CASE("strata with equal tops have a layer of no thickness, and refuse what is not finite [Q1]") {
    strata const f{.tops = {1, 1}, .values = {0.1, 0.2, 0.3}};
    CHECK_NOTHROW(f.validate());
    CHECK(f({0, 0, 0.999}) == 0.1);
    CHECK(f({0, 0, 1}) == 0.3);
    CHECK(strata{.values = {0.7}}({0, 0, 5}) == 0.7);
    CHECK_NOTHROW(strata{.values = {0.7}}.validate());
    CHECK_THROWS_AS(strata{}.validate(), invalid_input);
    CHECK_THROWS_AS((strata{.tops = {nan_value}, .values = {0, 1}}.validate()), invalid_input);
    CHECK_THROWS_AS((strata{.tops = {1}, .values = {0, nan_value}}.validate()), invalid_input);
    CHECK_THROWS_AS((strata{.up = {0, nan_value, 1}, .values = {0}}.validate()), invalid_input);
}
