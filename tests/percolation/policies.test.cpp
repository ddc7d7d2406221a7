#include "percolation/box_network.hpp"

#include <tafoni/percolation/cone_rain.hpp>
#include <tafoni/percolation/rainfall.hpp>
#include <tafoni/percolation/seepage.hpp>
#include <tafoni/testing/laws.hpp>

#include <catch2/catch.hpp>

#include <functional>
#include <limits>

using namespace tafoni;

namespace {

link_view at(vec3 const& p, link_state state = link_state::bonded, double life = 1, double resistance = 0) {
    link_view l;
    l.centroid = p;
    l.normal = vec3{0, 0, 1};
    l.area = 1;
    l.life = life;
    l.resistance = resistance;
    l.state = state;
    return l;
}

}  // namespace

TEST_CASE("directional rain always travels the same way") {
    stream random(1, stage::rain, 5);
    CHECK(directional_rain{.direction = {1, 0, 0}}.draw(random) == vec3(1, 0, 0));
    static_assert(std::is_same_v<fixed_rain, directional_rain>);
}

TEST_CASE("cone rain is uniform on its cap and keeps within the spread") {
    for (double const spread : {0.0, 5.0, 45.0, 90.0, 180.0}) {
        INFO("spread " << spread);
        cone_rain const rain{.axis = normalized(vec3{1, 2, -3}), .spread = spread};
        double const lowest = std::cos(spread * 3.14159265358979323846 / 180);
        int const n = 40000;
        std::vector<double> rings(10, 0);
        std::vector<double> sectors(8, 0);
        vec3 const u = normalized(cross(rain.axis, vec3{0, 0, 1}));
        vec3 const v = cross(rain.axis, u);
        for (int k = 0; k < n; ++k) {
            stream random(3, stage::rain, static_cast<std::uint64_t>(k));
            vec3 const d = rain.draw(random);
            REQUIRE(std::fabs(length(d) - 1) < 1e-12);
            double const c = dot(d, rain.axis);
            REQUIRE(c >= lowest - 1e-12);
            if (spread == 0) continue;
            auto const ring = static_cast<std::size_t>((1 - c) / (1 - lowest) * 10);
            rings[std::min<std::size_t>(ring, 9)] += 1;
            double const angle = std::atan2(dot(d, v), dot(d, u)) / (2 * 3.14159265358979323846) + 0.5;
            sectors[std::min<std::size_t>(static_cast<std::size_t>(angle * 8), 7)] += 1;
        }
        if (spread == 0) continue;
        CHECK(tafoni_test::chi_square_passes(rings, std::vector<double>(10, n / 10.0)));
        CHECK(tafoni_test::chi_square_passes(sectors, std::vector<double>(8, n / 8.0)));
    }
}

TEST_CASE("water enters where the rock faces the rain") {
    facing_infiltration const paper{};
    link_view l = at({0, 0, 0}, link_state::skin);
    CHECK(paper.acceptance(l, {0, 0, -1}) == 1);
    CHECK(paper.acceptance(l, {0, 0, 1}) == 0);
    CHECK(paper.acceptance(l, normalized(vec3{1, 0, -1})) == Approx(std::sqrt(0.5)));
    facing_infiltration const addon{.cutoff = 0.05};
    l.normal = vec3{std::sqrt(1 - 0.04 * 0.04), 0, 0.04};
    CHECK(addon.acceptance(l, {0, 0, -1}) == 0);
    l.normal = vec3{std::sqrt(0.75), 0, 0.5};
    CHECK(addon.acceptance(l, {0, 0, -1}) == Approx(0.45 / 0.95));
}

TEST_CASE("flow prefers what lies downhill and opposes least") {
    gravity_flow const paper{};
    water const w{};
    link_view const here = at({0, 0, 0});
    CHECK(paper.weight(here, at({0, 0, -2}), w) == 1);
    CHECK(paper.weight(here, at({0, 0, 2}), w) == 0);
    CHECK(paper.weight(here, at({1, 0, 0}), w) == 0);
    CHECK(paper.weight(here, here, w) == 0);
    CHECK(paper.weight(here, at({3, 0, -4}), w) == Approx(0.8));
    CHECK(paper.weight(here, at({3, 0, -4}, link_state::bonded, 0.5, 0.6), w) == Approx(0.8 * 0.7));
    CHECK(paper.weight(here, at({3, 0, -4}, link_state::bonded, 1, 1), w) == 0);
    CHECK(paper.weight(here, at({3, 0, -4}, link_state::broken), w) == Approx(0.8));
    CHECK(paper.weight(here, at({3, 0, -4}, link_state::skin), w) == Approx(0.8));
}

TEST_CASE("the add-on cuts off level ways, weighs resistance, keeps a floor and avoids exits") {
    gravity_flow const addon{
        .alignment_cutoff = 0.05, .resistance_weight = 0.75, .passage_floor = 0.001, .exit_weight = 0.75};
    water const w{};
    link_view const here = at({0, 0, 0});
    CHECK(addon.weight(here, at({1, 0, -0.04}), w) == 0);
    double const a = (0.8 - 0.05) / 0.95;
    CHECK(addon.weight(here, at({3, 0, -4}, link_state::bonded, 1, 1), w) == Approx(a * 0.25));
    CHECK(addon.weight(here, at({3, 0, -4}, link_state::skin), w) == Approx(a * 0.75));
    gravity_flow const heavy{.resistance_weight = 5, .passage_floor = 0.001};
    CHECK(heavy.weight(here, at({3, 0, -4}, link_state::bonded, 1, 1), w) == Approx(0.8 * 0.001));
}

TEST_CASE("every shipped percolation policy keeps its laws") {
    CHECK(laws::rain(directional_rain{}).empty());
    CHECK(laws::rain(cone_rain{.spread = 60}).empty());
    CHECK(laws::rain(rainfall{.rain = cone_rain{}}).empty());
    CHECK(laws::infiltration(facing_infiltration{}).empty());
    CHECK(laws::infiltration(facing_infiltration{.cutoff = 0.05}).empty());
    CHECK(laws::infiltration(rainfall{}).empty());
    CHECK(laws::flow(gravity_flow{}).empty());
    CHECK(laws::flow(gravity_flow{.alignment_cutoff = 0.05, .resistance_weight = 3, .passage_floor = 0.001}).empty());
    CHECK(laws::flow(seepage{}).empty());
}

TEST_CASE("bundles find their parts in any selection") {
    auto const only_field = seepage{.resistance = constant_field{0.25}};
    CHECK(only_field.resistance_at({0, 0, 0}) == 0.25);
    auto const only_infiltration = rainfall{.infiltration = facing_infiltration{.cutoff = 0.5}};
    CHECK(only_infiltration.infiltration.cutoff == 0.5);
    static_assert(std::is_same_v<decltype(rainfall{.rain = cone_rain{}}), rainfall<cone_rain, facing_infiltration>>);
}

TEST_CASE("directions must have unit length and shares must keep their range") {
    double const nan = std::numeric_limits<double>::quiet_NaN();
    for (vec3 const& d : {vec3{0, 0, 0}, vec3{0, 0, -2}, vec3{nan, 0, 0}, vec3{1, 1, 0}}) {
        CHECK_THROWS_AS((directional_rain{.direction = d}.validate()), invalid_input);
        CHECK_THROWS_AS((cone_rain{.axis = d}.validate()), invalid_input);
        CHECK_THROWS_AS((gravity_flow{.down = d}.validate()), invalid_input);
    }
    struct row {
        std::function<void(double)> set;
        double lo;
        double hi;
    };
    std::vector<row> const table{
        {[](double v) { cone_rain{.spread = v}.validate(); }, 0, 180},
        {[](double v) { facing_infiltration{.cutoff = v}.validate(); }, 0, 0.999},
        {[](double v) { gravity_flow{.alignment_cutoff = v}.validate(); }, 0, 0.999},
        {[](double v) { gravity_flow{.resistance_weight = v}.validate(); }, 0, 10},
        {[](double v) { gravity_flow{.passage_floor = v}.validate(); }, 0, 1},
        {[](double v) { gravity_flow{.exit_weight = v}.validate(); }, 0, 1},
    };
    for (row const& r : table) {
        CHECK_NOTHROW(r.set(r.lo));
        CHECK_NOTHROW(r.set(r.hi));
        for (double const bad : {nan, r.lo - 1e-9, r.hi + 1e-6}) CHECK_THROWS_AS(r.set(bad), invalid_input);
    }
}
