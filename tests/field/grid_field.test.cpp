#include <tafoni/field/grid_field.hpp>

#include <tafoni/core/random.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

using namespace tafoni;

namespace {
double const nan_value = std::numeric_limits<double>::quiet_NaN();
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

TEST_CASE("a grid field stays within its samples, whatever rounding does") {
    stream random(5, stage::user, 0);
    for (int round = 0; round < 200; ++round) {
        std::vector<double> samples(8);
        double const same = random.uniform01();
        for (double& s : samples) s = round % 2 == 0 ? same : random.uniform01();
        grid_field<double> const f{.samples = samples, .size = {2, 2, 2}};
        auto const [low, high] = std::minmax_element(samples.begin(), samples.end());
        for (int n = 0; n < 50; ++n) {
            vec3 p{0, 0, 0};
            for (int a = 0; a < 3; ++a) p[a] = random.uniform(0, 1);
            REQUIRE((f(p) >= *low && f(p) <= *high));
        }
    }
}

TEST_CASE("a grid field refuses sizes beyond 32 bits, bad spacings and NaN gives the first sample [V13]") {
    std::vector<float> const one{0.25f};
    grid_field<> const f{.samples = one, .size = {1, 1, 1}};
    CHECK_NOTHROW(f.validate());
    CHECK(f({nan_value, 0, 0}) == 0.25);
    for (double const bad : {0.0, -1.0, nan_value, 1e301}) {
        CHECK_THROWS_AS((grid_field<>{.samples = one, .size = {1, 1, 1}, .spacing = {1, bad, 1}}.validate()), invalid_input);
    }
    CHECK_THROWS_AS((grid_field<>{.samples = one, .size = {1, 1, 1}, .origin = {nan_value, 0, 0}}.validate()), invalid_input);
    CHECK_THROWS_AS(grid_field<>{}.validate(), invalid_input);
    try {
        grid_field<>{.samples = one, .size = {1ull << 32, 1, 1}}.validate();
        FAIL("accepted");
    } catch (invalid_input const& e) {
        CHECK(e.code() == errc::size_overflow);
    }
}
