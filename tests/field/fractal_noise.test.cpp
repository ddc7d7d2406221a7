#include <tafoni/field/fractal_noise.hpp>

#include <catch2/catch.hpp>

#include <cstdint>

using namespace tafoni;

TEST_CASE("one octave is gradient noise, and each further one adds its share") {
    for (int i = 0; i < 50; ++i) {
        vec3 const p{0.31 * i, 0.77, -0.13 * i};
        gradient_noise const first{.seed = 8, .frequency = 0.5};
        gradient_noise const second{.seed = 8 + 0xD1B54A32D192ED03ULL, .frequency = 1.5};
        fractal_noise const one{.seed = 8, .frequency = 0.5, .octaves = 1};
        fractal_noise const two{.seed = 8, .frequency = 0.5, .octaves = 2, .lacunarity = 3, .gain = 0.25};
        REQUIRE(one(p) == first(p));
        REQUIRE(two(p) == Approx((first(p) + 0.25 * second(p)) / 1.25).margin(1e-15));
    }
}

TEST_CASE("without gain only the first octave is heard, and octaves beyond 64 are not") {
    vec3 const p{0.3, 0.2, 0.9};
    CHECK(fractal_noise{.octaves = 7, .gain = 0}(p) == fractal_noise{.octaves = 1}(p));
    CHECK(fractal_noise{.octaves = 100}(p) == fractal_noise{.octaves = 64}(p));
}
