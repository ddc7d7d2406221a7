#include <tafoni/field/blend.hpp>

#include <tafoni/field/constant.hpp>
#include <tafoni/field/ramp.hpp>

#include <catch2/catch.hpp>

#include <limits>

using namespace tafoni;

TEST_CASE("a blend is its first field, its second, or between, as the weight says") {
    constant_field const low{.value = 0.2};
    constant_field const high{.value = 0.6};
    blend const b{low, high, ramp_field{.start = {0, 0, -1}, .end = {0, 0, 1}}};
    CHECK(b({0, 0, -5}) == 0.2);
    CHECK(b({0, 0, 0}) == Approx(0.4));
    CHECK(b({0, 0, 5}) == 0.6);
}

TEST_CASE("weights outside of 0 to 1 are clamped, NaN is 0, and rounding leads nowhere else") {
    struct free_weight {
        double operator()(vec3 const& p) const { return p[0]; }
    };
    for (int i = 1; i < 300; ++i) {
        constant_field const a{.value = 0.1 / i};
        constant_field const z{.value = 1.0};
        blend const up{a, z, free_weight{}};
        blend const down{z, a, free_weight{}};
        REQUIRE(up({7, 0, 0}) == 1.0);
        REQUIRE(up({-7, 0, 0}) == a.value);
        REQUIRE(down({1, 0, 0}) == a.value);
        REQUIRE(up({std::numeric_limits<double>::quiet_NaN(), 0, 0}) == a.value);
        for (double const t : {1e-300, 0x1p-53, i / 300.0, 1 - 0x1p-53}) {
            REQUIRE((up({t, 0, 0}) >= a.value && up({t, 0, 0}) <= 1.0));
            REQUIRE((down({t, 0, 0}) >= a.value && down({t, 0, 0}) <= 1.0));
        }
    }
}

TEST_CASE("a blend asks each of its fields whether it is sound") {
    constant_field const bad{.value = std::numeric_limits<double>::infinity()};
    constant_field const good{};
    CHECK_NOTHROW((blend{good, good, good}.validate()));
    CHECK_THROWS_AS((blend{bad, good, good}.validate()), invalid_input);
    CHECK_THROWS_AS((blend{good, bad, good}.validate()), invalid_input);
    CHECK_THROWS_AS((blend{good, good, bad}.validate()), invalid_input);
}
