#include <tafoni/field/noise.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/field/fractal_noise.hpp>

#include <catch2/catch.hpp>

#include <bit>
#include <limits>

using tafoni::vec3;

namespace {

vec3 draw_point(tafoni::stream& random, double size) {
    double const x = random.uniform(-size, size);
    double const y = random.uniform(-size, size);
    double const z = random.uniform(-size, size);
    return {x, y, z};
}

template <class Noise>
void check_statistics(Noise const& noise, double slope) {
    tafoni::stream random(1, tafoni::stage::user, 0);
    int const n = 200000;
    double sum = 0;
    double squares = 0;
    double largest = 0;
    for (int i = 0; i < n; ++i) {
        vec3 const p = draw_point(random, 1000);
        double const v = noise(p);
        sum += v;
        squares += v * v;
        largest = std::max(largest, std::fabs(v));
        vec3 const d = draw_point(random, 0.1);
        vec3 const q = p + d;
        REQUIRE(std::fabs(noise(q) - v) <= slope * tafoni::length(q - p) + 1e-12);
    }
    double const deviation = std::sqrt(squares / n);
    CHECK(largest <= 1);
    CHECK(largest > 0.5);
    CHECK(deviation > 0.1);
    CHECK(std::fabs(sum / n) < 5 * deviation / std::sqrt(double{n}));  // law 47, alpha below 1e-6
}

template <class Noise>
void check_gradient(Noise const& noise) {
    tafoni::stream random(2, tafoni::stage::user, 0);
    double const h = 1e-4;
    for (int i = 0; i < 2000; ++i) {
        vec3 const p = draw_point(random, 20);
        auto const s = noise.sample(p);
        REQUIRE(s.value == noise(p));
        for (int a = 0; a < 3; ++a) {
            vec3 up = p;
            vec3 down = p;
            up[a] += h;
            down[a] -= h;
            REQUIRE(std::fabs((noise(up) - noise(down)) / (2 * h) - s.gradient[a]) < 5e-6);
        }
    }
}

}  // namespace

TEST_CASE("noise is bounded, has mean zero and a bounded slope") {
    check_statistics(tafoni::gradient_noise{.seed = 4}, 4);
    check_statistics(tafoni::fractal_noise{.seed = 4, .octaves = 4}, 4 * 4 / 1.875);  // octaves of half the height and twice the frequency
}

TEST_CASE("the gradient of noise is its finite difference") {
    check_gradient(tafoni::gradient_noise{.seed = 9, .frequency = 0.7});
    check_gradient(tafoni::fractal_noise{.seed = 9, .frequency = 0.3, .octaves = 3});
}

TEST_CASE("the largest value of noise stays below one where the bound is tightest") {
    tafoni::gradient_noise const noise{.seed = 1};
    tafoni::stream random(6, tafoni::stage::user, 0);
    double largest = 0;
    for (int i = 0; i < 300000; ++i) {
        vec3 p = draw_point(random, 1e6);
        for (int a = 0; a < 3; ++a) p[a] = std::floor(p[a]) + 0.5 + random.uniform(-0.1, 0.1);
        largest = std::max(largest, std::fabs(noise(p)));
    }
    CHECK(largest <= 1);
    CHECK(largest > 0.85);
}

TEST_CASE("periodic noise repeats exactly and other noise does not") {
    tafoni::gradient_noise const periodic{.seed = 3, .frequency = 1, .period = {4, 5, 6}};
    tafoni::gradient_noise const endless{.seed = 3};
    tafoni::stream random(8, tafoni::stage::user, 0);
    int same = 0;
    for (int i = 0; i < 2000; ++i) {
        vec3 p = draw_point(random, 8);
        for (int a = 0; a < 3; ++a) p[a] = std::floor(p[a] * 1024) / 1024;
        REQUIRE(periodic(p) == periodic(p + vec3{4, 0, 0}));
        REQUIRE(periodic(p) == periodic(p + vec3{0, 5, 0}));
        REQUIRE(periodic(p) == periodic(p + vec3{-8, 10, 6}));
        same += endless(p) == endless(p + vec3{4, 0, 0}) ? 1 : 0;
    }
    CHECK(same < 20);
}

TEST_CASE("seeds give unrelated noise and equal seeds equal bits") {
    tafoni::stream random(8, tafoni::stage::user, 1);
    double product = 0;
    double squares = 0;
    for (int i = 0; i < 50000; ++i) {
        vec3 const p = draw_point(random, 500);
        double const a = tafoni::gradient_noise{.seed = 1}(p);
        double const b = tafoni::gradient_noise{.seed = 2}(p);
        REQUIRE(a == tafoni::gradient_noise{.seed = 1}(p));
        product += a * b;
        squares += a * a;
    }
    CHECK(std::fabs(product / squares) < 0.03);
}

TEST_CASE("noise has golden bits, the same for every compiler and level") {
    std::uint64_t hash = 0;
    tafoni::stream random(77, tafoni::stage::user, 0);
    tafoni::fractal_noise const noise{.seed = 5, .frequency = 0.9, .octaves = 6, .lacunarity = 2.1, .gain = 0.55};
    for (int i = 0; i < 10000; ++i) {
        double const v = noise(draw_point(random, 50));
        hash = (hash ^ std::bit_cast<std::uint64_t>(v)) * 0x100000001B3ULL;
    }
    CHECK(hash == 0xf724d2df44453de2ULL);
}

TEST_CASE("extreme parameters give finite noise in range") {
    double const nan = std::numeric_limits<double>::quiet_NaN();
    vec3 const p{0.3, -7.7, 12.1};
    for (unsigned const octaves : {0u, 1u, 64u}) {
        for (double const frequency : {0.0, 1e-30, 1.0, 1e30, 1e300}) {
            for (double const lacunarity : {1.0, 2.0, 16.0, nan}) {
                tafoni::fractal_noise const noise{.frequency = frequency, .octaves = octaves, .lacunarity = lacunarity};
                double const v = noise(p);
                CHECK((v >= -1 && v <= 1));
                CHECK(tafoni::is_finite(noise.sample(p).gradient));
            }
        }
    }
    CHECK(tafoni::fractal_noise{.octaves = 0}(p) == 0);
    CHECK_THROWS_AS(tafoni::fractal_noise{.lacunarity = nan}.validate(), tafoni::invalid_input);
    CHECK_THROWS_AS(tafoni::fractal_noise{.octaves = 65}.validate(), tafoni::invalid_input);
    CHECK_THROWS_AS(tafoni::fractal_noise{.gain = -0.1}.validate(), tafoni::invalid_input);
    CHECK_THROWS_AS(tafoni::gradient_noise{.frequency = nan}.validate(), tafoni::invalid_input);
    CHECK_NOTHROW(tafoni::fractal_noise{}.validate());
}
