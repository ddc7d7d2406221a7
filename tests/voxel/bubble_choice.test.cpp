#include <tafoni/field/ramp.hpp>
#include <tafoni/testing/bubble_archetypes.hpp>
#include <tafoni/testing/bubble_laws.hpp>
#include <tafoni/voxel/bubble_mixture.hpp>
#include <tafoni/voxel/bubble_profile.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/voxel/single_bubble.hpp>

#include <catch2/catch.hpp>

#include <array>
#include <limits>
#include <vector>

using namespace tafoni;

namespace {

/// A field whose value is x.
struct along_x {
    double operator()(vec3 const& p) const { return p[0]; }
};

}  // namespace

TEST_CASE("shipped choices keep the laws of choices") {
    CHECK(laws::bubble_choice(single_bubble{disc_bubble{.radius = 3}}).empty());
    CHECK(laws::bubble_choice(bubble_mixture{.bubbles = {sphere_bubble{3}, disc_bubble{.radius = 4}, sphere_bubble{6}},
                                             .field = gradient_noise{.seed = 4, .frequency = 0.3}})
              .empty());
    CHECK(laws::bubble_choice(
              bubble_profile{.bubbles = {sphere_bubble{3}, disc_bubble{.radius = 4}},
                             .layers = {{.top = -1, .mix = {1}}, {.top = 2, .mix = {0, 1}}, {.mix = {0}}}})
              .empty());
    CHECK(laws::bubble_choice(archetypes::bubble_choice(1)).empty());
}

TEST_CASE("laws::bubble_choice names what a broken choice breaks") {
    struct beyond : single_bubble {
        [[nodiscard]] std::size_t choose(vec3 const& p) const { return p[0] > 0 ? 1 : 0; }
    };
    CHECK(laws::bubble_choice(beyond{}).size() == 1);
    CHECK_FALSE(laws::bubble_choice(bubble_mixture<>{}).empty());
}

TEST_CASE("a mixture gives each bubble an equal interval of the field's range, the ends open") {
    bubble_mixture const m{.bubbles = {sphere_bubble{2}, sphere_bubble{3}, sphere_bubble{4}, sphere_bubble{5}},
                           .field = along_x{}};
    CHECK(m.choose({-7, 0, 0}) == 0);
    CHECK(m.choose({-1, 0, 0}) == 0);
    CHECK(m.choose({-0.51, 0, 0}) == 0);
    CHECK(m.choose({-0.5, 0, 0}) == 1);
    CHECK(m.choose({0, 0, 0}) == 2);
    CHECK(m.choose({0.49, 0, 0}) == 2);
    CHECK(m.choose({0.5, 0, 0}) == 3);
    CHECK(m.choose({1, 0, 0}) == 3);
    CHECK(m.choose({1e300, 0, 0}) == 3);
    CHECK(m.choose({std::numeric_limits<double>::quiet_NaN(), 0, 0}) == 0);
    bubble_mixture wide = m;
    wide.lowest = 0;
    wide.highest = 400;
    CHECK(wide.choose({99, 0, 0}) == 0);
    CHECK(wide.choose({301, 0, 0}) == 3);
}

TEST_CASE("noise spreads the bubbles of a mixture over space") {
    bubble_mixture const m{.bubbles = {sphere_bubble{2}, sphere_bubble{3}}, .field = gradient_noise{.frequency = 0.37}};
    std::array<int, 2> seen{};
    for (int i = 0; i < 1000; ++i) ++seen[m.choose({0.31 * i, 0.17 * i, 0.05 * i})];
    CHECK(seen[0] > 300);
    CHECK(seen[1] > 300);
}

TEST_CASE("a profile chooses by altitude, and by its field where a layer mixes") {
    bubble_profile p{.bubbles = {sphere_bubble{2}, sphere_bubble{3}, sphere_bubble{4}},
                     .layers = {{.top = 10, .mix = {2}}, {.top = 20, .mix = {0, 1}}, {.mix = {1}}},
                     .field = along_x{}};
    p.validate();
    CHECK(p.choose({0, 0, -1e9}) == 2);
    CHECK(p.choose({0, 0, 9.999}) == 2);
    CHECK(p.choose({-0.5, 0, 10}) == 0);
    CHECK(p.choose({0.5, 0, 10}) == 1);
    CHECK(p.choose({-0.5, 0, 20}) == 1);
    CHECK(p.choose({-0.5, 0, 1e9}) == 1);
    p.up = {0, 1, 0};
    CHECK(p.choose({-0.5, 15, 0}) == 0);
    p.layers.back().top = 30;  // the last layer holds all above, whatever its top
    CHECK(p.choose({0, 40, 0}) == 1);
    p.layers[1].top = 25;  // edited while a simulation runs
    p.bubbles.push_back(disc_bubble{.radius = 3});
    p.layers[2].mix = {3};
    CHECK(p.choose({-0.5, 22, 0}) == 0);
    CHECK(p.choose({-0.5, 25, 0}) == 3);
}

TEST_CASE("choices that cannot be made are refused") {
    double const nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(bubble_mixture<>{}.validate(), invalid_input);
    bubble_mixture const mix{.bubbles = {sphere_bubble{2}}, .field = along_x{}};
    CHECK_NOTHROW(mix.validate());
    for (double const bad : {-1.0, -2.0, nan, std::numeric_limits<double>::infinity()}) {
        auto m = mix;
        m.highest = bad;
        CHECK_THROWS_AS(m.validate(), invalid_input);
    }
    bubble_profile const good{.bubbles = {sphere_bubble{2}, sphere_bubble{3}}, .layers = {{.top = 1}, {.mix = {1, 0}}}};
    CHECK_NOTHROW(good.validate());
    auto p = good;
    p.layers.clear();
    CHECK_THROWS_AS(p.validate(), invalid_input);
    p = good;
    p.layers[1].mix = {2};
    CHECK_THROWS_AS(p.validate(), invalid_input);
    p.layers[1].mix.clear();
    CHECK_THROWS_AS(p.validate(), invalid_input);
    for (double const bad : {1.0, 0.0, nan}) {
        p = good;
        p.layers[1].top = bad;
        CHECK_THROWS_AS(p.validate(), invalid_input);
    }
    p = good;
    p.up = {0, 0, 2};
    CHECK_THROWS_AS(p.validate(), invalid_input);
    p = good;
    p.field.frequency = -1;
    CHECK_THROWS_AS(p.validate(), invalid_input);
}
