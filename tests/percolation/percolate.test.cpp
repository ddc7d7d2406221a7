#include "percolation/box_network.hpp"

#include <tafoni/percolation/percolate.hpp>
#include <tafoni/percolation/rainfall.hpp>
#include <tafoni/percolation/seepage.hpp>
#include <tafoni/rules/uptake.hpp>
#include <tafoni/testing/archetypes.hpp>

#include <catch2/catch.hpp>

#include <limits>

using namespace tafoni;
using tafoni_test::box_network;

namespace {

/// All bonds whole, skin open: what a run starts from.
template <class Network>
link_table<Network> fresh_table(Network const& n, double resistance = 0.5) {
    link_table<Network> table(n);
    for (std::size_t i = 0; i < n.link_count(); ++i) {
        link_record& r = table[link_index{i}];
        r.state = r.cells[1].valid() ? link_state::bonded : link_state::skin;
        r.resistance = resistance;
    }
    return table;
}

template <class Network>
entry_tree fresh_skin(link_table<Network> const& table) {
    entry_tree tree(table.size());
    for (std::size_t i = 0; i < table.size(); ++i) {
        if (table[link_index{i}].state == link_state::skin) tree.set(link_index{i}, 1 << 20);
    }
    return tree;
}

directional_rain const slanting{.direction = normalized(vec3{1, -0.5, -0.5})};
facing_infiltration const facing{};
gravity_flow const gravity{};
surface_absorption const drinking{};
depletion_soaking const soaking{};

path_options numbers(double water = 1) { return {.seed = 42, .inflow = water_unit::from(water)}; }

template <class A, class B, class C, class D, class E>
auto policies(A const& a, B const& b, C const& c, D const& d, E const& e) {
    return path_policies<A, B, C, D, E>{a, b, c, d, e};
}

}  // namespace

TEST_CASE("law 10: every path's water is absorbed, lost or drained, to the last unit") {
    box_network const n(5, 5, 5);
    auto const table = fresh_table(n);
    auto const skin = fresh_skin(table);
    depletion_soaking const wasteful{.threshold = 0.25, .continue_chance = 0.9, .wearing = 0.75};
    path_scratch memory;
    for (std::uint64_t path = 0; path < 3000; ++path) {
        std::vector<path_visit> visits;
        auto const t = percolate(table, skin, policies(slanting, facing, gravity, drinking, wasteful), numbers(1.3), path,
                                 visits, memory);
        REQUIRE(t.entry.valid());
        REQUIRE(t.visits == visits.size());
        std::int64_t sum = t.lost + t.drained;
        for (path_visit const& v : visits) {
            REQUIRE(v.absorbed >= 0);
            sum += v.absorbed;
        }
        REQUIRE(sum == t.inflow);
        REQUIRE(t.inflow == water_unit::from(1.3));
    }
}

TEST_CASE("a path runs over neighbours only, downhill, and starts on skin that faces the rain") {
    box_network const n(6, 6, 6);
    auto const table = fresh_table(n);
    auto const skin = fresh_skin(table);
    path_scratch memory;
    for (std::uint64_t path = 0; path < 500; ++path) {
        std::vector<path_visit> visits;
        auto const t =
            percolate(table, skin, policies(slanting, facing, gravity, drinking, soaking), numbers(), path, visits, memory);
        CHECK(dot(table.view(t.entry).normal, slanting.direction) < 0);
        link_index here = t.entry;
        for (path_visit const& v : visits) {
            bool neighbour = false;
            n.for_each_neighbor(here, [&](link_index l) { neighbour = neighbour || l == v.link; });
            REQUIRE(neighbour);
            REQUIRE(n.link_centroid(v.link)[2] < n.link_centroid(here)[2]);
            here = v.link;
        }
    }
}

TEST_CASE("law 14: entry frequency is area times max(-n . d, 0)") {
    box_network n(4, 3, 2);
    std::uint32_t turn = 0;
    for (auto& l : n.links) l.area = 0.25 + 0.5 * (turn++ % 4);
    auto const table = fresh_table(n);
    entry_tree skin(table.size());
    for (std::size_t i = 0; i < table.size(); ++i) {
        if (table[link_index{i}].state == link_state::skin) {
            skin.set(link_index{i}, static_cast<std::int64_t>(table[link_index{i}].area * 4096));
        }
    }
    std::vector<double> expected(table.size(), 0);
    double total = 0;
    for (std::size_t i = 0; i < table.size(); ++i) {
        if (table[link_index{i}].state != link_state::skin) continue;
        expected[i] = n.links[i].area * std::max(-dot(n.links[i].normal, slanting.direction), 0.0);
        total += expected[i];
    }
    int const paths = 60000;
    std::vector<double> seen(table.size(), 0);
    path_scratch memory;
    std::vector<path_visit> visits;
    for (int path = 0; path < paths; ++path) {
        visits.clear();
        auto const t = percolate(table, skin, policies(slanting, facing, gravity, drinking, soaking), numbers(),
                                 static_cast<std::uint64_t>(path), visits, memory);
        seen[t.entry.value] += 1;
    }
    for (double& v : expected) v *= paths / total;
    CHECK(tafoni_test::chi_square_passes(seen, expected));
}

TEST_CASE("law 15: steps from a link follow the flow weights") {
    box_network const n(5, 5, 5);
    auto table = fresh_table(n);
    link_index const here = n.near_to({2, 2.5, 2.5});
    std::vector<link_index> around;
    std::vector<double> weight;
    std::uint32_t turn = 0;
    n.for_each_neighbor(here, [&](link_index l) {
        table[l].resistance = 0.1 * (turn++ % 7);
        around.push_back(l);
    });
    double total = 0;
    for (link_index const l : around) {
        weight.push_back(gravity.weight(table.view(here), table.view(l), water{}));
        total += weight.back();
    }
    int const draws = 100000;
    std::vector<double> seen(around.size(), 0);
    path_scratch memory;
    for (int k = 0; k < draws; ++k) {
        stream random(5, stage::flow, static_cast<std::uint64_t>(k));
        link_index const l = detail::next_link(table, gravity, here, water{}, random, memory);
        seen[static_cast<std::size_t>(std::find(around.begin(), around.end(), l) - around.begin())] += 1;
    }
    for (double& w : weight) w *= draws / total;
    CHECK(tafoni_test::chi_square_passes(seen, weight));
}

TEST_CASE("law 15: with all weights zero the path ends at once and all water drains") {
    box_network const n(3, 3, 3);
    auto const table = fresh_table(n, 1.0);  // resistance 1 and life 1: 1 - f_r = 0
    auto const skin = fresh_skin(table);
    struct only_bonds {
        double weight(link_view const& here, link_view const& there, water const& w) const {
            return there.state == link_state::bonded ? gravity_flow{}.weight(here, there, w) : 0.0;
        }
    } const flow;
    path_scratch memory;
    for (std::uint64_t path = 0; path < 100; ++path) {
        std::vector<path_visit> visits;
        auto const t = percolate(table, skin, policies(slanting, facing, flow, drinking, soaking), numbers(), path, visits,
                                 memory);
        CHECK(visits.empty());
        CHECK(t.drained == t.inflow);
    }
}

TEST_CASE("law 17: an extra draw in the rain shifts no other policy's draws") {
    box_network const n(5, 5, 5);
    auto const table = fresh_table(n);
    auto const skin = fresh_skin(table);
    struct wasteful_rain {
        vec3 draw(stream& random) const {
            for (int k = 0; k < 5; ++k) (void)random.bits();
            return slanting.direction;
        }
    } const wasteful;
    path_scratch memory;
    for (std::uint64_t path = 0; path < 300; ++path) {
        std::vector<path_visit> a;
        std::vector<path_visit> b;
        auto const one =
            percolate(table, skin, policies(slanting, facing, gravity, drinking, soaking), numbers(), path, a, memory);
        auto const two =
            percolate(table, skin, policies(wasteful, facing, gravity, drinking, soaking), numbers(), path, b, memory);
        REQUIRE(one.entry == two.entry);
        REQUIRE(a.size() == b.size());
        for (std::size_t k = 0; k < a.size(); ++k) {
            REQUIRE(a[k].link == b[k].link);
            REQUIRE(a[k].absorbed == b[k].absorbed);
        }
    }
}

TEST_CASE("law 17: draws of the soaking shift no step") {
    box_network const n(5, 5, 5);
    auto const table = fresh_table(n);
    auto const skin = fresh_skin(table);
    struct {
        double soak_chance(link_view const&, water const&) const { return 1e-300; }  // drawn, never met
    } const hardly;
    depletion_soaking const never{.threshold = 0};
    path_scratch memory;
    for (std::uint64_t path = 0; path < 300; ++path) {
        std::vector<path_visit> a;
        std::vector<path_visit> b;
        (void)percolate(table, skin, policies(slanting, facing, gravity, drinking, never), numbers(), path, a, memory);
        (void)percolate(table, skin, policies(slanting, facing, gravity, drinking, hardly), numbers(), path, b, memory);
        REQUIRE(a.size() == b.size());
        for (std::size_t k = 0; k < a.size(); ++k) REQUIRE(a[k].link == b[k].link);
    }
}

TEST_CASE("law 17: a mirrored model and rain give mirrored statistics") {
    box_network const n(6, 6, 6);
    auto const table = fresh_table(n);
    auto const skin = fresh_skin(table);
    directional_rain const mirrored{.direction = normalized(vec3{-1, -0.5, -0.5})};
    auto const profile = [&](directional_rain const& rain, bool mirror, std::uint64_t seed) {
        std::vector<double> columns(12, 0);
        path_scratch memory;
        auto o = numbers();
        o.seed = seed;
        for (std::uint64_t path = 0; path < 20000; ++path) {
            std::vector<path_visit> visits;
            auto const t = percolate(table, skin, policies(rain, facing, gravity, drinking, soaking), o, path, visits, memory);
            double x = table[visits.empty() ? t.entry : visits.front().link].x;  // one independent count per path
            if (mirror) x = 6 - x;
            columns[static_cast<std::size_t>(std::min(11.0, x * 2))] += 1;
        }
        return columns;
    };
    auto const a = profile(slanting, false, 1);
    auto const b = profile(mirrored, true, 2);
    // Two samples of the same size: the variance of the difference is the sum.
    double x = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        if (a[k] + b[k] > 0) x += (a[k] - b[k]) * (a[k] - b[k]) / (a[k] + b[k]);
    }
    CHECK(x < 55);  // 11 degrees of freedom, alpha 1e-6: 51.6
}

TEST_CASE("paths that would never end are cut, and their water is lost") {
    archetypes::network const n;
    auto const table = fresh_table(n);
    auto const skin = fresh_skin(table);
    archetypes::rain const rain(0);
    archetypes::infiltration const infiltration(0);
    archetypes::flow const flow(0);
    archetypes::soaking const dry(0);
    struct {
        double absorbed(link_view const&, water const&, link_scale const&) const { return 0; }
    } const nothing;
    path_scratch memory;
    std::vector<path_visit> visits;
    auto o = numbers();
    o.longest_path = 50;
    auto const t = percolate(table, skin, policies(rain, infiltration, flow, nothing, dry), o, 0, visits, memory);
    CHECK(t.visits == 50);
    CHECK(t.lost == t.inflow);
}

TEST_CASE("percolate compiles with the least policies and the least network") {
    archetypes::network const n;
    auto const table = fresh_table(n);
    auto const skin = fresh_skin(table);
    archetypes::rain const rain(0);
    archetypes::infiltration const infiltration(0);
    archetypes::flow const flow(0);
    archetypes::absorption const absorption(0);
    archetypes::soaking const dry(0);
    path_scratch memory;
    std::vector<path_visit> visits;
    auto const t = percolate(table, skin, policies(rain, infiltration, flow, absorption, dry), numbers(), 0, visits, memory);
    CHECK(t.visits == 8);  // an eighth per link
}

TEST_CASE("a policy that answers NaN, infinity or less than nothing is named") {
    box_network const n(3, 3, 3);
    auto const table = fresh_table(n);
    auto const skin = fresh_skin(table);
    for (double const bad : {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        struct {
            double answer;
            double weight(link_view const&, link_view const&, water const&) const { return answer; }
        } const flow{bad};
        path_scratch memory;
        std::vector<path_visit> visits;
        CHECK_THROWS_AS(
            percolate(table, skin, policies(slanting, facing, flow, drinking, soaking), numbers(), 0, visits, memory),
            invalid_input);
    }
    for (double const bad : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
        struct {
            double answer;
            double absorbed(link_view const&, water const&, link_scale const&) const { return answer; }
        } const thirsty{bad};
        path_scratch memory;
        std::vector<path_visit> visits;
        CHECK_THROWS_AS(
            percolate(table, skin, policies(slanting, facing, gravity, thirsty, soaking), numbers(), 0, visits, memory),
            invalid_input);
    }
}

TEST_CASE("an acceptance or a soaking chance outside [0, 1] is named, rounding aside") {
    box_network const n(3, 3, 3);
    auto const table = fresh_table(n);
    auto const skin = fresh_skin(table);
    path_scratch memory;
    std::vector<path_visit> visits;
    struct {
        double answer;
        double acceptance(link_view const&, vec3 const&) const { return answer; }
    } accepting{};
    struct {
        double answer;
        double soak_chance(link_view const&, water const&) const { return answer; }
    } greedy{};
    for (double const bad : {-0.01, 1.01, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
        accepting.answer = greedy.answer = bad;
        CHECK_THROWS_AS(
            percolate(table, skin, policies(slanting, accepting, gravity, drinking, soaking), numbers(), 0, visits, memory),
            invalid_input);
        CHECK_THROWS_AS(
            percolate(table, skin, policies(slanting, facing, gravity, drinking, greedy), numbers(), 0, visits, memory),
            invalid_input);
    }
    for (double const good : {-1e-12, 0.0, 1.0, 1 + 1e-12}) {
        accepting.answer = greedy.answer = good;
        CHECK_NOTHROW(
            percolate(table, skin, policies(slanting, accepting, gravity, drinking, greedy), numbers(), 0, visits, memory));
    }
}

TEST_CASE("a table refuses areas and centroids that are not numbers") {
    box_network n(2, 1, 1);
    n.links[3].area = 0;
    CHECK_THROWS_AS(link_table<box_network>(n), invalid_input);
    n.links[3].area = std::numeric_limits<double>::infinity();
    CHECK_THROWS_AS(link_table<box_network>(n), invalid_input);
    n.links[3].area = 1;
    n.links[3].centroid[1] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(link_table<box_network>(n), invalid_input);
}

TEST_CASE("a view shows no life and no resistance off the bonds, and normals out of the rock") {
    box_network const n(2, 1, 1);
    auto table = fresh_table(n);
    link_index const bond = n.near_to({1, 0.5, 0.5});
    table[bond].life = 0.25;
    CHECK(table.view(bond).life == 0.25);
    CHECK(table.view(bond).resistance == 0.5);
    table[bond].state = link_state::skin;
    table[bond].inward = true;
    CHECK(table.view(bond).life == 0);
    CHECK(table.view(bond).resistance == 0);
    CHECK(table.view(bond).normal == vec3(-1, 0, 0));
    CHECK(table.mean_area(false) == 1);
}

TEST_CASE("rain whose direction is not of unit length is refused") {
    struct strong_rain {
        double length = 1;
        [[nodiscard]] vec3 draw(stream&) const { return {0, 0, -length}; }
    };
    box_network const n(2, 2, 2);
    auto const table = fresh_table(n);
    auto const skin = fresh_skin(table);
    path_scratch memory;
    std::vector<path_visit> visits;
    auto const walk = [&](double length) {
        strong_rain const rain{length};
        return percolate(table, skin, policies(rain, facing, gravity, drinking, soaking), numbers(), 3, visits, memory);
    };
    CHECK(walk(1 + 0.9e-6).entry.valid());
    CHECK(walk(1 - 0.9e-6).entry.valid());
    for (double const bad : {0.0, 0.5, 1 + 2e-6, 1 - 2e-6, 2.0, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
        try {
            (void)walk(bad);
            FAIL("length " << bad << " passed");
        } catch (invalid_input const& e) {
            CHECK(e.code() == errc::out_of_range);
            CHECK(std::string(e.what()).find("path 3") != std::string::npos);
        }
    }
}
