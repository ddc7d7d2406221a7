#include <tafoni/field/blend.hpp>
#include <tafoni/field/constant.hpp>
#include <tafoni/field/grid_field.hpp>
#include <tafoni/field/jittered.hpp>
#include <tafoni/field/masked.hpp>
#include <tafoni/field/pockets.hpp>
#include <tafoni/field/ramp.hpp>
#include <tafoni/field/remapped.hpp>
#include <tafoni/field/sine.hpp>
#include <tafoni/field/strata.hpp>

#include <tafoni/core/random.hpp>

#include <catch2/catch.hpp>

#include <limits>
#include <vector>

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

TEST_CASE("a sine field swings around its mean") {
    sine_field const f{.wave = {0, 0, 2}, .mean = 0.5, .amplitude = 0.25};
    CHECK(f({3, 4, 0}) == 0.5);
    CHECK(f({0, 0, 0.78539816339744831}) == Approx(0.75));
    CHECK(f({0, 0, -0.78539816339744831}) == Approx(0.25));
    CHECK_THROWS_AS(sine_field{.phase = nan_value}.validate(), invalid_input);
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

TEST_CASE("pockets hide the base and later pockets hide earlier ones") {
    pockets const f{ramp_field{.at_start = 0.5, .at_end = 0.5},
                    std::vector<pocket>{{.radii = {2, 2, 2}, .value = 0.9}, {.radii = {1, 3, 1}, .value = 0.1}}};
    CHECK(f({0, 0, 0}) == 0.1);
    CHECK(f({1.5, 0, 0}) == 0.9);
    CHECK(f({0, 2.5, 0}) == 0.1);
    CHECK(f({2.5, 0, 0}) == 0.5);
    CHECK_THROWS_AS((pockets<>{.bodies = {{.radii = {1, 0, 1}}}}.validate()), invalid_input);
}

TEST_CASE("a grid field gives its samples back and interpolates linear functions exactly") {
    std::array<std::size_t, 3> const size{4, 3, 5};
    vec3 const origin{-1, 2, 0.5};
    vec3 const spacing{0.5, 0.25, 2};
    auto const linear = [](vec3 const& p) { return 2 * p[0] - p[1] + 0.5 * p[2] + 1; };
    std::vector<double> samples;
    for (std::size_t k = 0; k < size[2]; ++k) {
        for (std::size_t j = 0; j < size[1]; ++j) {
            for (std::size_t i = 0; i < size[0]; ++i) {
                samples.push_back(linear({origin[0] + spacing[0] * double(i), origin[1] + spacing[1] * double(j),
                                          origin[2] + spacing[2] * double(k)}));
            }
        }
    }
    grid_field<double> const f{.samples = samples, .size = size, .origin = origin, .spacing = spacing};
    f.validate();
    stream random(1, stage::user, 0);
    for (int n = 0; n < 1000; ++n) {
        double const x = random.uniform(-1, 0.5);
        double const y = random.uniform(2, 2.5);
        double const z = random.uniform(0.5, 8.5);
        REQUIRE(f({x, y, z}) == Approx(linear({x, y, z})).margin(1e-12));
    }
    CHECK(f(origin) == samples.front());
    CHECK(f({1e30, 1e30, 1e30}) == samples.back());
    CHECK(f({-1e30, -1e30, -1e30}) == samples.front());
    CHECK_THROWS_AS((grid_field<double>{.samples = samples, .size = {4, 3, 4}}.validate()), invalid_input);
    CHECK_THROWS_AS((grid_field<double>{.samples = samples, .size = {1ull << 63, 1ull << 63, 60}}.validate()),
                    invalid_input);
    samples[7] = nan_value;
    CHECK_THROWS_AS(f.validate(), invalid_input);
    std::vector<std::uint8_t> const bytes{0, 255};
    grid_field<std::uint8_t> const g{.samples = bytes, .size = {2, 1, 1}};
    CHECK(g({0.5, 0, 0}) == 127.5);
}

TEST_CASE("decorators change where and how much, not what") {
    constant_field const low{.value = 0.2};
    constant_field const high{.value = 0.6};
    blend const b{low, high, ramp_field{.start = {0, 0, -1}, .end = {0, 0, 1}}};
    CHECK(b({0, 0, -5}) == Approx(0.2));
    CHECK(b({0, 0, 0}) == Approx(0.4));
    CHECK(b({0, 0, 5}) == Approx(0.6));
    masked const m{high, box3{{0, 0, 0}, {1, 1, 1}}, 0.1};
    CHECK(m({0.5, 0.5, 1}) == 0.6);
    CHECK(m({0.5, 0.5, 1.1}) == 0.1);
    strata const layers{.tops = {0}, .values = {0.1, 0.9}};
    jittered const j{layers, 0.5, fractal_noise{.frequency = 2}};
    j.validate();
    bool moved = false;
    for (int i = 0; i < 200; ++i) {
        double const x = 0.37 * i;
        CHECK(j({x, 0, 0.51}) == 0.9);
        CHECK(j({x, 0, -0.51}) == 0.1);
        moved = moved || j({x, 0, 0.05}) == 0.1;
    }
    CHECK(moved);
    CHECK(jittered{layers, 0.0}({1, 2, 3}) == layers({1, 2, 3}));
    remapped const r{gradient_noise{.seed = 3}, -1.0, 1.0, 0.25, 0.75};
    for (int i = 0; i < 200; ++i) {
        double const v = r({0.13 * i, 0.3, 0.7});
        CHECK((v >= 0.25 && v <= 0.75));
    }
    CHECK_THROWS_AS((remapped<constant_field>{.from_low = 1, .from_high = 1}.validate()), invalid_input);
}
