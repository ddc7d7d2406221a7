#include <tafoni/field/remapped.hpp>

#include <tafoni/field/constant.hpp>
#include <tafoni/field/noise.hpp>

#include <catch2/catch.hpp>

#include <limits>

using namespace tafoni;

TEST_CASE("noise is brought into the range that is asked for") {
    remapped const r{gradient_noise{.seed = 3}, -1.0, 1.0, 0.25, 0.75};
    for (int i = 0; i < 200; ++i) {
        vec3 const p{0.13 * i, 0.3, 0.7};
        CHECK((r(p) >= 0.25 && r(p) <= 0.75));
        CHECK(r(p) == Approx(0.5 + 0.25 * gradient_noise{.seed = 3}(p)));
    }
    CHECK(remapped{gradient_noise{}}({0, 0, 0}) == 0.5);
}

TEST_CASE("what lies beyond the range that is read is clamped, and ranges may be turned round") {
    auto const at = [](double value) { return remapped<constant_field>{{value}, 2, 4, 0.9, 0.1}({0, 0, 0}); };
    CHECK(at(1) == 0.9);
    CHECK(at(2) == 0.9);
    CHECK(at(3) == Approx(0.5));
    CHECK(at(4) == 0.1);
    CHECK(at(99) == 0.1);
    CHECK(at(std::numeric_limits<double>::quiet_NaN()) == 0.9);
}

TEST_CASE("a remapped field refuses an empty range and what is not finite [Q1]") {
    double const nan_value = std::numeric_limits<double>::quiet_NaN();
    CHECK_NOTHROW(remapped<constant_field>{}.validate());
    CHECK_THROWS_AS((remapped<constant_field>{.from_low = 1, .from_high = 1}.validate()), invalid_input);
    CHECK_THROWS_AS((remapped<constant_field>{.from_low = 1, .from_high = 0}.validate()), invalid_input);
    CHECK_THROWS_AS((remapped<constant_field>{.from_low = nan_value}.validate()), invalid_input);
    CHECK_THROWS_AS((remapped<constant_field>{.to_low = nan_value}.validate()), invalid_input);
    CHECK_THROWS_AS((remapped<constant_field>{.to_high = nan_value}.validate()), invalid_input);
    CHECK_THROWS_AS((remapped<constant_field>{.base = {.value = nan_value}}.validate()), invalid_input);
}
