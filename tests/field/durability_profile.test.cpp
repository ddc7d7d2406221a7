#include <tafoni/field/durability_profile.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/field/constant.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace tafoni;

namespace {

double const nan_value = std::numeric_limits<double>::quiet_NaN();
double const infinity = std::numeric_limits<double>::infinity();

struct hard_below_zero {
    double operator()(vec3 const& p) const { return p.x() < 0 ? 5.0 : 0.0; }
};
static_assert(scalar_field<durability_profile<hard_below_zero>>);

}  // namespace

TEST_CASE("a durability profile runs straight between its corners and level beyond them") {
    durability_profile<> const f{.points = {{.altitude = 1, .durability = 2}, {.altitude = 3, .durability = 6}, {.altitude = 4, .durability = 0.5}}};
    f.validate();
    CHECK(f({7, -9, 1}) == 2);
    CHECK(f({0, 0, -100}) == 2);
    CHECK(f({0, 0, 2}) == 4);
    CHECK(f({0, 0, 2.5}) == 5);
    CHECK(f({0, 0, 3}) == 6);
    CHECK(f({0, 0, 3.5}) == 3.25);
    CHECK(f({0, 0, 4}) == 0.5);
    CHECK(f({0, 0, 400}) == 0.5);
}

TEST_CASE("altitude is measured along the profile's own up, and two corners of one altitude make a step") {
    durability_profile<> const f{.up = {0, -1, 0},
                                 .points = {{.altitude = 0, .durability = 1},
                                            {.altitude = 2, .durability = 3},
                                            {.altitude = 2, .durability = 7},
                                            {.altitude = 2, .durability = 9},
                                            {.altitude = 4, .durability = 9}}};
    f.validate();
    CHECK(f({5, -1, 5}) == 2);
    CHECK(f({5, -1.5, 5}) == 2.5);
    CHECK(f({5, -2, 5}) == 9);
    CHECK(f({5, 1, 5}) == 1);
}

TEST_CASE("noise stays within its amplitude, holds from its corner to the next, and moves with the seed") {
    durability_profile<> f{.points = {{.altitude = 0, .durability = 10, .amplitude = 2, .frequency = 3},
                                      {.altitude = 1, .durability = 10},
                                      {.altitude = 2, .durability = 10, .amplitude = 0.5, .frequency = 0.7}},
                           .seed = 4};
    durability_profile<> other = f;
    other.seed = 5;
    f.validate();
    gradient_noise const low{.seed = 4, .frequency = 3};
    gradient_noise const high{.seed = 4, .frequency = 0.7};
    stream random(1, stage::user, 0);
    double largest = 0;
    int different = 0;
    for (int i = 0; i < 3000; ++i) {
        double const x = random.uniform(-9, 9);
        double const y = random.uniform(-9, 9);
        double const z = random.uniform(-1, 3);
        vec3 const p{x, y, z};
        double const deviation = f(p) - 10;
        if (z >= 1 && z < 2) CHECK(deviation == 0);
        if (z < 1) CHECK(std::fabs(deviation - 2 * low(p)) < 1e-13);
        if (z >= 2) CHECK(std::fabs(deviation - 0.5 * high(p)) < 1e-13);
        if (z < 1) largest = std::fmax(largest, std::fabs(deviation));
        if (z < 1 && f(p) != other(p)) ++different;
    }
    CHECK(largest <= 2);
    CHECK(largest > 0.8);
    CHECK(different > 1000);
}

TEST_CASE("a corner put on the line with the noise of its segment changes nothing") {
    durability_profile<> const f{.points = {{.altitude = 0, .durability = 2, .amplitude = 1, .frequency = 5}, {.altitude = 8, .durability = 6}}, .seed = 9};
    durability_profile<> g = f;
    g.points.insert(g.points.begin() + 1, {.altitude = 4, .durability = 4, .amplitude = 1, .frequency = 5});
    stream random(2, stage::user, 0);
    for (int i = 0; i < 500; ++i) {
        double const x = random.uniform(-3, 3);
        double const z = random.uniform(-1, 9);
        CHECK(std::fabs(f({x, 1, z}) - g({x, 1, z})) < 1e-12);
    }
}

TEST_CASE("a field on top is added, and nothing falls below the floor") {
    durability_profile const f{.up = vec3{0, 0, 1},
                               .points = std::vector<durability_point>{{.altitude = 0, .durability = 1}, {.altitude = 10, .durability = 0}},
                               .seed = std::uint64_t{0},
                               .floor = 0.25,
                               .extra = hard_below_zero{}};
    f.validate();
    CHECK(f({-1, 0, 5}) == 5.5);
    CHECK(f({1, 0, 5}) == 0.5);
    CHECK(f({1, 0, 9}) == 0.25);
    durability_profile<constant_field> const negative{.points = {{.durability = 3}}, .extra = {.value = -50}};
    CHECK(negative({0, 0, 0}) == 1e-3);
    CHECK(durability_profile<>{}({3, 4, 5}) == 1);
}

TEST_CASE("shares of a height become lengths, and frequencies count over the height") {
    auto const points = scaled_durability({{.altitude = 0, .durability = 3, .amplitude = 1, .frequency = 12}, {.altitude = 0.5, .durability = 4}, {.altitude = 1, .durability = 5}}, -2, 6);
    CHECK(points[0] == durability_point{-2, 3, 1, 1.5});
    CHECK(points[1] == durability_point{2, 4, 0, 0});
    CHECK(points[2].altitude == 6);
    CHECK_THROWS_AS(scaled_durability({}, 1, 1), invalid_input);
    CHECK_THROWS_AS(scaled_durability({}, 2, 1), invalid_input);
    CHECK_THROWS_AS(scaled_durability({}, nan_value, 1), invalid_input);
    CHECK_THROWS_AS(scaled_durability({}, 0, infinity), invalid_input);
}

TEST_CASE("profiles that mean nothing are refused by name [Q1]") {
    auto const what = [](durability_profile<> const& f) -> std::string {
        try {
            f.validate();
        } catch (invalid_input const& e) {
            return e.what();
        }
        return {};
    };
    CHECK(what({.points = {}}).find("points") != std::string::npos);
    CHECK(what({.up = {0, 0, 2}}).find("up") != std::string::npos);
    CHECK(what({.up = {0, nan_value, 1}}).find("up") != std::string::npos);
    CHECK(what({.points = {{.altitude = 1}, {.altitude = 0.5}}}).find("points[1].altitude") != std::string::npos);
    for (double const bad : {-1e-9, nan_value, infinity}) {
        CHECK(what({.points = {{.durability = bad}}}).find("points[0].durability") != std::string::npos);
        CHECK(what({.points = {{.amplitude = bad}}}).find("points[0].amplitude") != std::string::npos);
        CHECK(what({.points = {{}, {.frequency = bad}}}).find("points[1].frequency") != std::string::npos);
        CHECK(what({.floor = bad}).find("floor") != std::string::npos);
    }
    CHECK(what({.points = {{.altitude = nan_value}}}).find("points[0].altitude") != std::string::npos);
    CHECK(what({.floor = 0}).find("floor") != std::string::npos);
    CHECK(what({.points = {{.altitude = -4}, {.altitude = -4}}}).empty());
}
