#include <tafoni/testing/bubble_archetypes.hpp>
#include <tafoni/testing/bubble_laws.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/voxel/bubble_stencil.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <string>

using namespace tafoni;

namespace {

double const not_a_number = std::numeric_limits<double>::quiet_NaN();
double const inf = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("shipped bubbles keep the laws of bubbles") {
    for (double const r : {0.3, 1.0, 2.5, 7.0, 16.0, 33.0, 48.0}) {
        CHECK(laws::bubble_shape(sphere_bubble{.radius = r}).empty());
        CHECK(laws::bubble_shape(ellipsoid_bubble{.semi_axes = {r, 1, r / 2}}).empty());
        CHECK(laws::bubble_shape(gumdrop_bubble{.radius = r}).empty());
        CHECK(laws::bubble_shape(gumdrop_bubble{.radius = 2, .base = r}).empty());
        CHECK(laws::bubble_shape(disc_bubble{.radius = r}).empty());
        CHECK(laws::bubble_shape(disc_bubble{.radius = 2, .thickness = r}).empty());
        CHECK(laws::bubble_shape(predicate_bubble{[r](vec3 const& o) { return o[0] + o[1] < r; }, r}).empty());
    }
    CHECK(laws::bubble_shape(archetypes::bubble(1)).empty());
    CHECK(bubble_stencil(archetypes::bubble(1)).size() == 25);
}

TEST_CASE("laws::bubble_shape names what a broken bubble breaks") {
    struct leaky {
        bool contains(vec3 const& o) const { return o[2] < 4; }
        double reach() const { return 2; }
    };
    struct empty {
        bool contains(vec3 const&) const { return false; }
        double reach() const { return 2; }
    };
    struct endless {
        bool contains(vec3 const&) const { return true; }
        double reach() const { return inf; }
    };
    struct moody {
        mutable int asked = 0;
        bool contains(vec3 const& o) const { return o[0] == 0 || ++asked % 2 == 0; }
        double reach() const { return 1; }
    };
    CHECK(laws::bubble_shape(leaky{}).size() == 1);
    CHECK(laws::bubble_shape(empty{}).size() == 1);
    CHECK(laws::bubble_shape(endless{}).size() == 1);
    CHECK_FALSE(laws::bubble_shape(moody{}).empty());
    CHECK_FALSE(laws::bubble_shape(sphere_bubble{.radius = -1}).empty());
}

TEST_CASE("a sphere holds what is nearer than its radius, as the paper has it") {
    sphere_bubble const s{.radius = 5};
    CHECK(s.contains({0, 0, 0}));
    CHECK(s.contains({3, 3, 2}));
    CHECK_FALSE(s.contains({3, 4, 0}));  // at the radius
    CHECK_FALSE(s.contains({0, 0, -5}));
    CHECK(bubble_stencil(sphere_bubble{.radius = 1}).size() == 1);
    CHECK(bubble_stencil(sphere_bubble{.radius = 1.01}).size() == 7);
    CHECK(bubble_stencil(sphere_bubble{.radius = 7}).size() == 1365);
    double const large = bubble_stencil(sphere_bubble{.radius = 30}).size();
    CHECK(large == Approx(4.0 / 3.0 * 3.14159265358979 * 27000).epsilon(0.002));
}

TEST_CASE("an ellipsoid is as long as each of its semi-axes") {
    bubble_stencil const e = ellipsoid_bubble{.semi_axes = {2.5, 4.5, 8.5}};
    CHECK((e.contains(2, 0, 0) && !e.contains(3, 0, 0)));
    CHECK((e.contains(0, -4, 0) && !e.contains(0, -5, 0)));
    CHECK((e.contains(0, 0, 8) && !e.contains(0, 0, 9)));
    CHECK_FALSE(e.contains(2, 4, 0));
    CHECK(e.reach() == 8);
    CHECK(bubble_stencil(ellipsoid_bubble{.semi_axes = {5, 5, 5}}) == bubble_stencil(sphere_bubble{.radius = 5}));
}

TEST_CASE("a gumdrop is a dome on a flat base with as much below its centre as above") {
    bubble_stencil const g = gumdrop_bubble{.radius = 9};
    CHECK((g.contains(0, 0, 8) && !g.contains(0, 0, 9)));    // the dome
    CHECK((g.contains(8, 3, -5) && !g.contains(8, 3, 5)));   // the base is as wide as the dome's foot
    CHECK((g.contains(0, 0, -5) && !g.contains(0, 0, -6)));  // flat side down
    CHECK((g.contains(8, 3, -5) && !g.contains(8, 3, -6)));
    std::uint32_t above = 0;
    std::uint32_t below = 0;
    bubble_stencil const fine = gumdrop_bubble{.radius = 45};
    for (auto const& row : fine.rows()) {
        for (int z = 1; z <= bubble_stencil::widest; ++z) {
            above += fine.contains(row.dx, row.dy, z) ? 1u : 0u;
            below += fine.contains(row.dx, row.dy, -z) ? 1u : 0u;
        }
    }
    CHECK(double(above) == Approx(double(below)).epsilon(0.02));
    CHECK_FALSE(bubble_stencil(gumdrop_bubble{.radius = 3, .base = 0}).contains(0, 0, -1));
}

TEST_CASE("a disc of thickness n has n layers") {
    CHECK(bubble_stencil(disc_bubble{.radius = 5, .thickness = 1}).rows()[0].bits[0] == std::uint64_t{1} << 48);
    for (int const n : {1, 3, 5, 7}) {
        bubble_stencil const d = disc_bubble{.radius = 5, .thickness = double(n)};
        CHECK(d.size() == static_cast<std::uint32_t>(n) * bubble_stencil(disc_bubble{.radius = 5}).size());
        CHECK((d.contains(4, 2, n / 2) && !d.contains(4, 2, n / 2 + 1) && !d.contains(4, 3, 0)));
    }
}

TEST_CASE("bubbles without a size, or too large to be counted, are refused by name") {
    for (double const r : {0.0, -1.0, not_a_number, inf, 48.5, 1e300}) {
        CHECK_THROWS_AS(sphere_bubble{.radius = r}.validate(), invalid_input);
        CHECK_THROWS_AS(bubble_stencil(sphere_bubble{.radius = r}), invalid_input);
        CHECK_THROWS_AS(bubble_stencil(ellipsoid_bubble{.semi_axes = {3, r, 3}}), invalid_input);
        CHECK_THROWS_AS(bubble_stencil(gumdrop_bubble{.radius = r}), invalid_input);
        CHECK_THROWS_AS(bubble_stencil(disc_bubble{.radius = r}), invalid_input);
    }
    CHECK_THROWS_AS(bubble_stencil(disc_bubble{.thickness = 0}), invalid_input);
    CHECK_THROWS_AS(bubble_stencil(gumdrop_bubble{.radius = 3, .base = not_a_number}), invalid_input);
    auto const everything = [](vec3 const&) { return true; };
    CHECK_THROWS_AS(bubble_stencil(predicate_bubble{everything, 49.0}), invalid_input);
    try {
        static_cast<void>(bubble_stencil(sphere_bubble{.radius = 50}));
        FAIL("a radius of 50 was taken");
    } catch (invalid_input const& e) {
        CHECK(e.code() == errc::bad_parameter);
        CHECK(std::string(e.what()).find("sphere_bubble.radius: got 50") != std::string::npos);
    }
}

TEST_CASE("laws::rate holds for the rates that ship and names what a broken one breaks") {
    CHECK(laws::rate(cubic_rate{}).empty());
    CHECK(laws::rate(linear_rate{.scale = 0.5}).empty());
    CHECK(laws::rate(quartic_rate{}).empty());
    CHECK(laws::rate(clamped_rate<>{.highest = 2}).empty());
    struct negative {
        double operator()(double c) const { return 0.5 - c; }
    };
    struct endless {
        double operator()(double c) const { return 1 / c; }
    };
    struct moody {
        int* asked;
        double operator()(double c) const { return c + ++*asked; }
    };
    int asked = 0;
    CHECK(laws::rate(negative{}) == std::vector<std::string>{"a rate is not negative"});
    CHECK(laws::rate(endless{}) == std::vector<std::string>{"a rate is finite for every share of air in [0, 1]"});
    CHECK(laws::rate(moody{&asked}) == std::vector<std::string>{"a rate is pure: equal questions get equal answers"});
    CHECK(laws::rate(linear_rate{.scale = -1}).size() == 2);
}
