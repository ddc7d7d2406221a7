#include "percolation/box_network.hpp"

#include <tafoni/weathering/frost_presets.hpp>
#include <tafoni/weathering/frost_run.hpp>

#include <catch2/catch.hpp>

#include <limits>

using namespace tafoni;
using tafoni_test::box_network;

TEST_CASE("Q3: a network without cells, with one cell, or without skin") {
    box_network const nothing(0, 0, 0);
    frost_run empty(nothing, frost_wedging{});
    CHECK(empty.run({.paths = 3}).paths_without_entry == 3);
    CHECK_THROWS_AS(empty.validate(), invalid_input);

    box_network const one(1, 1, 1);
    frost_run single(one, frost_wedging{});
    auto const r = single.run({.paths = 100});
    CHECK(r.links_traversed > 0);  // over the sides and out
    CHECK(r.links_broken == 0);

    box_network inner(3, 3, 3);  // bonds only
    for (auto& links : inner.of_cell) {
        std::erase_if(links, [&](link_index l) { return !inner.links[l.value].cells[1].valid(); });
    }
    struct bonds_only : box_network {
        bool has_link(link_index l) const { return links[l.value].cells[1].valid(); }
    };
    bonds_only const closed{inner};
    frost_run dry(closed, frost_wedging{});
    CHECK(dry.run({.paths = 3}).paths_without_entry == 3);
    CHECK(dry.report().links_broken == 0);
    CHECK(dry.break_link(closed.near_to({1, 0.5, 0.5})));
}

TEST_CASE("Q3: two links between the same cells, and a link from a cell to itself") {
    box_network n(3, 1, 1);
    auto const first = n.near_to({1, 0.5, 0.5});
    link_index const twin{n.links.size()};
    n.links.push_back(n.links[first.value]);
    n.of_cell[0].push_back(twin);
    n.of_cell[1].push_back(twin);
    n.neighbors.push_back(n.neighbors[first.value]);
    link_index const self{n.links.size()};
    n.links.push_back(n.links[first.value]);
    n.links.back().cells = {n.at(2, 0, 0), n.at(2, 0, 0)};
    n.of_cell[2].push_back(self);
    n.neighbors.push_back({});
    frost_run run(n, frost_wedging{});
    CHECK(run.break_link(self));
    CHECK(run.report().cells_detached == 0);
    CHECK(run.break_link(first));
    CHECK(run.report().cells_detached == 0);  // the twin still holds
    CHECK(run.break_link(twin));
    CHECK(run.report().cells_detached == 1);
    CHECK(run.cell(n.at(0, 0, 0)) == cell_state::air);
}

TEST_CASE("Q2: a chance of 0 never happens and a chance of 1 always does") {
    box_network const n(4, 4, 4);
    auto never = frost_wedging{.absorb = uptake{.soaking = depletion_soaking{.threshold = 0}},
                               .wear = wear{.breakage = low_life_breakage{.k_break = 1, .p_max = 0, .p_min = 0}}};
    frost_run a(n, never, {.seed = 2});
    a.run({.paths = 20});
    CHECK(a.report().links_broken == 0);
    auto always = frost_wedging{.wear = wear{.breakage = low_life_breakage{.k_break = 1, .p_max = 1, .p_min = 1}}};
    frost_run b(n, always, {.seed = 2});
    b.run({.paths = 1});
    std::vector<path_visit> visits;
    frost_run c(n, always, {.seed = 2});
    auto const t = c.trace(0, visits);
    CHECK(t.visits == visits.size());
    std::uint64_t bonds = 0;
    for (auto const& v : visits) bonds += v.state == link_state::bonded && v.absorbed > 0 ? 1u : 0u;
    CHECK(b.report().links_broken == bonds);
}

TEST_CASE("Q2: without absorption every path ends and all water drains") {
    box_network const n(5, 5, 5);
    auto const thirstless =
        frost_wedging{.absorb = uptake{.absorption = surface_absorption{.k_solid = 0, .k_air = 0, .k_res = 0},
                                       .soaking = depletion_soaking{}}};
    frost_run run(n, thirstless);
    auto const r = run.run({.paths = 500});
    CHECK(r.water_drained == r.water_in);
    CHECK(r.water_absorbed == 0);
    CHECK(r.links_broken == 0);
}

TEST_CASE("much water and hardly any, coarse links and fine ones") {
    for (double const scale : {1e-9, 1.0, 1e9}) {
        box_network n(4, 4, 4);
        for (auto& l : n.links) {
            l.centroid = l.centroid * scale;
            l.area *= scale * scale;
        }
        for (double& v : n.volumes) v *= scale * scale * scale;
        frost_run run(n, frost_wedging{}, {.seed = 4});
        run.run({.paths = 300});
        static std::uint64_t traversed = 0;
        if (traversed == 0) traversed = run.report().links_traversed;
        CHECK(run.report().links_traversed == Approx(static_cast<double>(traversed)).epsilon(0.2));
        CHECK(run.report().links_broken > 0);
    }
    box_network const n(4, 4, 4);
    for (double const water : {1e-12, 1e-6, 1024.0}) {
        frost_run run(n, frost_wedging{}, {.water = water});
        auto const r = run.run({.paths = 50});
        CHECK(r.water_absorbed + r.water_lost + r.water_drained == Approx(r.water_in).epsilon(1e-13));
    }
}

TEST_CASE("a rain from below finds its few links, and rain that meets no skin finds none") {
    box_network const n(5, 5, 5);
    frost_run up(n, frost_wedging{.rain = rainfall{.rain = directional_rain{.direction = {0, 0, 1}}}});
    std::vector<path_visit> visits;
    for (std::uint64_t path = 0; path < 50; ++path) {
        auto const t = up.trace(path, visits);
        REQUIRE(t.entry.valid());
        REQUIRE(n.link_centroid(t.entry)[2] == 0);
    }
    CHECK(up.run({.paths = 10}).water_drained == 10);  // from the bottom nothing leads down
}

TEST_CASE("traces look and do not touch") {
    box_network const n(4, 4, 4);
    frost_run run(n, frost_wedging{});
    auto const before = run.checkpoint();
    std::vector<path_visit> visits;
    for (std::uint64_t path = 0; path < 20; ++path) (void)run.trace(path, visits);
    CHECK((run.checkpoint() == before));
    std::vector<path_visit> next;
    auto const t = run.trace(run.paths(), next);
    auto const r = run.run({.paths = 1});
    CHECK(r.links_traversed == t.visits);
}

namespace {

/// Cells in a row from top to bottom; rain enters the uppermost only.
struct column {
    std::size_t n;
    std::size_t cell_count() const { return n; }
    double cell_volume(cell_index) const { return 1; }
    std::size_t link_count() const { return n; }
    bool has_link(link_index) const { return true; }
    std::array<cell_index, 2> link_cells(link_index l) const {
        if (l.value == 0) return {cell_index{0U}, cell_index{}};
        return {cell_index{l.value}, cell_index{l.value - 1}};
    }
    double link_area(link_index) const { return 1; }
    vec3 link_centroid(link_index l) const { return {0, 0, -1.0 * l.value}; }
    vec3 link_normal(link_index) const { return {0, 0, 1}; }
    void for_each_cell_link(cell_index c, auto&& f) const {
        f(link_index{c.value});
        if (c.value + 1 < n) f(link_index{c.value + 1});
    }
    void for_each_neighbor(link_index l, auto&& f) const {
        if (l.value > 0) f(link_index{l.value - 1});
        if (l.value + 1 < n) f(link_index{l.value + 1});
    }
};

struct sip {
    double absorbed(link_view const&, water const&, link_scale const&) const { return 1e-9; }
    double soak_chance(link_view const&, water const&) const { return 0; }
};

struct shatter {
    double damage(link_view const&, double w, link_scale const&) const { return w > 0 ? 1.0 : 0.0; }
};

struct doubtful {
    double break_chance(link_view const&) const { return std::numeric_limits<double>::quiet_NaN(); }
};

}  // namespace

TEST_CASE("one path that breaks a hundred thousand bonds costs no more than their sum") {
    column const n{100000};
    frost_run run(n, frost_wedging{.absorb = sip{}, .wear = wear{.harm = shatter{}}});
    auto const r = run.run({.paths = 1});  // seconds would pass if a break looked at all pieces before it
    CHECK(r.links_broken == n.n - 1);
    CHECK(r.cells_detached == n.n - 1);
    CHECK(r.blocks == n.n - 1);
    CHECK(run.cell(cell_index{0U}) == cell_state::solid);  // all tie; the lowest stands
}

TEST_CASE("a break chance that is no chance is named, and the path did not happen") {
    box_network const n(3, 3, 3);
    frost_run run(n, frost_wedging{.wear = wear{.breakage = doubtful{}}});
    auto const before = run.checkpoint();
    CHECK_THROWS_AS(run.run({.paths = 20}), invalid_input);
    CHECK(run.paths() < 20);
    frost_run fresh(n, frost_wedging{.wear = wear{.breakage = doubtful{}}});
    CHECK((fresh.checkpoint() == before));
    CHECK(run.report().links_broken == 0);
}
