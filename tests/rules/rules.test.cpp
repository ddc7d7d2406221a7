#include <tafoni/weathering/frost_wedging.hpp>
#include <tafoni/rules/uptake.hpp>
#include <tafoni/rules/wear.hpp>
#include <tafoni/testing/laws.hpp>
#include <tafoni/weathering/frost_wedging.hpp>

#include <catch2/catch.hpp>

#include <functional>
#include <limits>
#include <type_traits>

using namespace tafoni;

namespace {

link_view bond(double life, double resistance, double area = 1) {
    link_view l;
    l.area = area;
    l.life = life;
    l.resistance = resistance;
    l.state = link_state::bonded;
    return l;
}

link_view bare(link_state state, double area = 1) {
    link_view l = bond(0, 0, area);
    l.state = state;
    return l;
}

}  // namespace

TEST_CASE("a bond drinks by its area and its resistance, other links by their area alone") {
    surface_absorption const rule{};
    water const w{};
    CHECK(rule.absorbed(bond(1, 0.5, 2), w, {4}) == Approx(2.0 / 4 * 0.1 + 0.5 * 0.25));
    CHECK(rule.absorbed(bond(0.2, 0.5), w, {1}) == Approx(0.1 + 0.1 * 0.25));
    CHECK(rule.absorbed(bare(link_state::broken, 2), w, {4}) == Approx(0.5 * 0.05));
    CHECK(rule.absorbed(bare(link_state::skin), w, {1}) == Approx(0.05));
    CHECK(rule.absorbed(bare(link_state::pocket), w, {1}) == Approx(0.05));
    surface_absorption const addon{.resistance_weight = 0.75};
    CHECK(addon.absorbed(bond(1, 1), w, {1}) == Approx(0.1 + 0.75 * 0.25));
}

TEST_CASE("the paper's soaking grows with the water that is gone") {
    depletion_soaking const rule{};
    CHECK(rule.soak_chance(bond(1, 1), {2, 2, 0}) == 0);
    CHECK(rule.soak_chance(bond(1, 1), {0.5, 2, 3}) == Approx(0.75));
    CHECK(rule.soaked_share(bond(1, 1)) == 1);
}

TEST_CASE("the add-on soaks only below a quarter, and a quarter of that is lost") {
    depletion_soaking const rule{.threshold = 0.25, .continue_chance = 0.9, .wearing = 0.75};
    CHECK(rule.soak_chance(bond(1, 1), {0.26, 1, 3}) == 0);
    CHECK(rule.soak_chance(bond(1, 1), {0.25, 1, 3}) == 0);
    CHECK(rule.soak_chance(bond(1, 1), {0.125, 1, 3}) == Approx(1 - 0.9 * 0.5));
    CHECK(rule.soaked_share(bond(1, 1)) == 0.75);
    CHECK(depletion_soaking{.threshold = 0}.soak_chance(bond(1, 1), {0.1, 1, 3}) == 0);
}

TEST_CASE("damage is spread over the link's area") {
    surface_damage const rule{};
    CHECK(rule.damage(bond(1, 1, 2), 0.3, {4}) == Approx(0.5 * 0.3 * 4 / 2));
    CHECK(rule.damage(bond(1, 1, 2), 0, {4}) == 0);
}

TEST_CASE("bonds break early below a life of 0.4, by the paper's chance and by the add-on's") {
    low_life_breakage const paper{};
    CHECK(paper.break_chance(bond(0.4, 1)) == 0);
    CHECK(paper.break_chance(bond(0.2, 1)) == Approx(0.9 * 0.5));
    CHECK(paper.break_chance(bond(0, 1)) == Approx(0.9));
    low_life_breakage const addon{.k_break = 0.4, .p_max = 1, .p_min = 0.1};
    CHECK(addon.break_chance(bond(0.2, 1)) == Approx(1 - 0.9 * 0.5));
    CHECK(addon.break_chance(bond(0.41, 1)) == 0);
    CHECK(low_life_breakage{.k_break = 0}.break_chance(bond(1e-9, 1)) == 0);
}

TEST_CASE("the smaller part falls unless a core holds it") {
    smaller_part_falls const rule{};
    part const small{.volume = 1, .core_cells = 0, .lowest_cell = cell_index{5u}};
    part const large{.volume = 2, .core_cells = 0, .lowest_cell = cell_index{7u}};
    part const held{.volume = 1, .core_cells = 1, .lowest_cell = cell_index{9u}};
    CHECK(rule.decide(small, large) == falling::first);
    CHECK(rule.decide(large, small) == falling::second);
    CHECK(rule.decide(held, large) == falling::second);
    CHECK(rule.decide(large, held) == falling::first);
    CHECK(rule.decide(held, held) == falling::neither);
    part const twin{.volume = 1, .core_cells = 0, .lowest_cell = cell_index{6u}};
    CHECK(rule.decide(small, twin) == falling::second);
    CHECK(rule.decide(twin, small) == falling::first);
}

TEST_CASE("every shipped rule keeps its laws") {
    CHECK(laws::absorption(surface_absorption{}).empty());
    CHECK(laws::absorption(uptake{}).empty());
    CHECK(laws::soaking(depletion_soaking{}).empty());
    CHECK(laws::soaking(depletion_soaking{.threshold = 0.25, .continue_chance = 0.9, .wearing = 0.75}).empty());
    CHECK(laws::soaking(uptake{}).empty());
    CHECK(laws::damage(surface_damage{}).empty());
    CHECK(laws::damage(wear{}).empty());
    CHECK(laws::breakage(low_life_breakage{}).empty());
    CHECK(laws::breakage(low_life_breakage{.p_max = 1, .p_min = 0.1}).empty());
    CHECK(laws::detachment(smaller_part_falls{}).empty());
}

TEST_CASE("every parameter of every rule is checked against its range, and NaN fails") {
    double const nan = std::numeric_limits<double>::quiet_NaN();
    double const infinite = std::numeric_limits<double>::infinity();
    struct row {
        char const* name;
        std::function<void(double)> set;
        double lo;
        double hi;
    };
    std::vector<row> const table{
        {"k_solid", [](double v) { surface_absorption{.k_solid = v}.validate(); }, 0, 1e6},
        {"k_air", [](double v) { surface_absorption{.k_air = v}.validate(); }, 0, 1e6},
        {"k_res", [](double v) { surface_absorption{.k_res = v}.validate(); }, 0, 1e6},
        {"absorption weight", [](double v) { surface_absorption{.resistance_weight = v}.validate(); }, 0, 10},
        {"threshold", [](double v) { depletion_soaking{.threshold = v}.validate(); }, 0, 1},
        {"continue_chance", [](double v) { depletion_soaking{.continue_chance = v}.validate(); }, 0, 1},
        {"wearing", [](double v) { depletion_soaking{.wearing = v}.validate(); }, 0, 1},
        {"k_dmg", [](double v) { surface_damage{.k_dmg = v}.validate(); }, 0, 1e6},
        {"k_break", [](double v) { low_life_breakage{.k_break = v}.validate(); }, 0, 1},
        {"p_max", [](double v) { low_life_breakage{.p_max = v}.validate(); }, 0, 1},
        {"p_min", [](double v) { low_life_breakage{.p_max = 0.9, .p_min = v}.validate(); }, 0, 0.9},
    };
    for (row const& r : table) {
        INFO(r.name);
        CHECK_NOTHROW(r.set(r.lo));
        CHECK_NOTHROW(r.set(r.hi));
        for (double const bad : {nan, infinite, -infinite, r.lo - 1e-9, r.hi * 1.0001 + 1e-9}) {
            try {
                r.set(bad);
                FAIL("accepted " << bad);
            } catch (invalid_input const& e) {
                CHECK(e.code() == errc::bad_parameter);
                CHECK(e.place().kind == entity::parameter);
            }
        }
    }
}

namespace {

struct rain_and_flow {
    [[nodiscard]] vec3 draw(stream&) const { return {0, 0, -1}; }
    [[nodiscard]] double weight(link_view const&, link_view const&, water const&) const { return 1; }
};
struct all_of_wear {
    [[nodiscard]] double damage(link_view const&, double w, link_scale const&) const { return w; }
    [[nodiscard]] double break_chance(link_view const&) const { return 0; }
};

}  // namespace

TEST_CASE("a part of several roles plays the one of its member, when the others are taken or all are given") {
    auto const after = frost_wedging{.rain = directional_rain{}, .flow = rain_and_flow{}};
    STATIC_REQUIRE(std::is_same_v<decltype(after), frost_wedging<directional_rain, rain_and_flow> const>);
    auto const all = wear{.harm = all_of_wear{}, .breakage = all_of_wear{}, .detachment = smaller_part_falls{}};
    STATIC_REQUIRE(std::is_same_v<decltype(all), wear<all_of_wear, all_of_wear> const>);
    auto const copy = frost_wedging{after};
    STATIC_REQUIRE(std::is_same_v<decltype(copy), frost_wedging<directional_rain, rain_and_flow> const>);
}
