#include "percolation/box_network.hpp"

#include <tafoni/graph/surface_walk.hpp>
#include <tafoni/percolation/cone_rain.hpp>
#include <tafoni/testing/archetypes.hpp>
#include <tafoni/weathering/frost_presets.hpp>
#include <tafoni/weathering/frost_run.hpp>

#include <catch2/catch.hpp>

#include <limits>
#include <numeric>

using namespace tafoni;
using tafoni_test::box_network;

namespace {

auto slanting() {
    return frost_wedging{.rain = rainfall{.rain = directional_rain{.direction = normalized(vec3{1, -0.5, -0.5})}}};
}

/// Components of the cells that are not air, by bonds of life > 0: an oracle of its own.
template <class Run>
std::vector<std::uint32_t> components(Run const& run, std::vector<cell_state> const& cells) {
    auto const& n = run.network();
    std::vector<std::uint32_t> parent(n.cell_count());
    std::iota(parent.begin(), parent.end(), 0u);
    auto const root = [&](std::uint32_t c) {
        while (parent[c] != c) c = parent[c];
        return c;
    };
    for (std::size_t i = 0; i < n.link_count(); ++i) {
        auto const ends = n.link_cells(link_index{i});
        if (!ends[1].valid() || !(run.life(link_index{i}) > 0)) continue;
        if (cells[ends[0].value] == cell_state::air || cells[ends[1].value] == cell_state::air) continue;
        parent[root(ends[0].value)] = root(ends[1].value);
    }
    for (std::uint32_t c = 0; c < parent.size(); ++c) parent[c] = root(c);
    return parent;
}

template <class Run>
std::vector<cell_state> copy_cells(Run const& run) {
    return {run.cells().begin(), run.cells().end()};
}

}  // namespace

TEST_CASE("two cells and one bond: the life after n paths is a closed form") {
    archetypes::network const n;  // rain enters on top, meets the bond, leaves below
    auto const frost = frost_wedging{.absorb = uptake{.soaking = depletion_soaking{.threshold = 0}},
                                     .wear = wear{.breakage = low_life_breakage{.k_break = 0}}};
    frost_run run(n, frost, {.seed = 3});
    double life = 1;
    for (int k = 1; k <= 40; ++k) {
        run.run({.paths = 1});
        double const absorbed = 0.1 + life * 0.5 * 0.25;
        life = std::max(0.0, life - 0.5 * absorbed);
        REQUIRE(run.life(link_index{1u}) == Approx(life).margin(1e-12));
        if (life == 0) break;
    }
    CHECK(life == 0);
    CHECK(run.report().links_broken == 1);
    CHECK(run.report().cells_detached == 1);
    CHECK(run.cell(cell_index{0u}) != cell_state::air);  // equal volumes: the part without the lowest cell falls
    CHECK(run.cell(cell_index{1u}) == cell_state::air);
    CHECK(run.report().volume_detached == Approx(1));
    CHECK(run.state(link_index{1u}) == link_state::skin);
    CHECK(run.state(link_index{2u}) == link_state::gone);
    REQUIRE(run.blocks().size() == 1);
    CHECK(run.blocks()[0].path == run.paths());
}

TEST_CASE("law 10: inflow = absorbed + lost + drained over a whole run") {
    box_network const n(6, 6, 6);
    for (std::uint32_t const batch : {1u, 64u}) {
        auto const preset = addon_preset();
        frost_run run(n, preset.process, preset.options);
        auto const r = run.run({.paths = 5000, .batch = batch});
        CHECK(r.water_absorbed + r.water_lost + r.water_drained == Approx(r.water_in).epsilon(1e-14));
        CHECK(r.water_in == static_cast<double>(r.paths - r.paths_without_entry));
        CHECK(r.links_broken > 0);
    }
}

TEST_CASE("law 11: life never rises and what fell never returns") {
    box_network const n(5, 5, 5);
    frost_run run(n, slanting());
    std::vector<double> lives(n.link_count(), 1);
    auto cells = copy_cells(run);
    for (int k = 0; k < 400; ++k) {
        run.run({.paths = 10});
        for (std::size_t i = 0; i < lives.size(); ++i) {
            double const life = run.life(link_index{i});
            REQUIRE(life >= 0);
            REQUIRE(life <= lives[i]);
            lives[i] = life;
        }
        for (std::size_t c = 0; c < cells.size(); ++c) {
            if (cells[c] == cell_state::air) REQUIRE(run.cell(cell_index{c}) == cell_state::air);
        }
        cells = copy_cells(run);
    }
    CHECK(run.report().cells_detached > 50);
}

TEST_CASE("law 12: what falls hangs on no core cell, or is not in the largest part; what stands does") {
    box_network const n(6, 6, 6);
    for (bool const with_core : {false, true}) {
        for (std::uint32_t const batch : {1u, 200u}) {
            INFO("core " << with_core << ", batch " << batch);
            frost_run run(n, slanting(), {.seed = 5});
            if (with_core) {
                for (int x = 0; x < 6; ++x) run.mark(n.at(x, 5, 5), cell_state::core);
                run.mark(n.at(0, 0, 0), cell_state::core);
            }
            std::size_t falls = 0;
            for (int k = 0; k < 3000; ++k) {
                auto const before = copy_cells(run);
                auto const old_components = components(run, before);
                run.run({.paths = batch, .batch = batch});
                auto const after = copy_cells(run);
                if (after != before) {
                    ++falls;
                    // Lives are final and cells are not: the parts as they were when the rule was asked.
                    auto const parts = components(run, before);
                    std::vector<std::size_t> size(parts.size(), 0);
                    std::vector<std::size_t> cores(parts.size(), 0);
                    std::vector<std::size_t> largest(parts.size(), 0);
                    std::vector<std::size_t> old_cores(parts.size(), 0);
                    for (std::size_t c = 0; c < parts.size(); ++c) {
                        if (before[c] == cell_state::air) continue;
                        ++size[parts[c]];
                        if (before[c] == cell_state::core) ++cores[parts[c]], ++old_cores[old_components[c]];
                    }
                    for (std::size_t c = 0; c < parts.size(); ++c) {
                        if (before[c] != cell_state::air) {
                            largest[old_components[c]] = std::max(largest[old_components[c]], size[parts[c]]);
                        }
                    }
                    for (std::size_t c = 0; c < parts.size(); ++c) {
                        if (before[c] == cell_state::air) continue;
                        bool const fell = after[c] == cell_state::air;
                        if (old_cores[old_components[c]] > 0) {
                            REQUIRE(fell == (cores[parts[c]] == 0));
                        } else if (fell) {
                            REQUIRE(size[parts[c]] <= largest[old_components[c]]);
                        } else {
                            REQUIRE(size[parts[c]] == largest[old_components[c]]);
                        }
                    }
                }
                if (run.paths() > 8000) break;
            }
            CHECK(falls > 10);
        }
    }
}

TEST_CASE("link states are what cells, lives and a flood from outside say") {
    box_network const n(6, 6, 6);
    frost_run run(n, slanting(), {.seed = 8});
    run.mark(n.at(3, 3, 3), cell_state::air);  // a pocket
    for (int k = 0; k < 100; ++k) {
        run.run({.paths = 50});
        std::vector<char> open(n.cell_count(), 0);
        for (bool grown = true; grown;) {
            grown = false;
            for (std::size_t c = 0; c < open.size(); ++c) {
                if (open[c] != 0 || run.cell(cell_index{c}) != cell_state::air) continue;
                n.for_each_cell_link(cell_index{c}, [&](link_index l) {
                    auto const ends = n.link_cells(l);
                    if (!ends[1].valid() || open[ends[0].value] != 0 || open[ends[1].value] != 0) {
                        open[c] = 1;
                        grown = true;
                    }
                });
            }
        }
        for (std::size_t i = 0; i < n.link_count(); ++i) {
            link_index const l{i};
            auto const ends = n.link_cells(l);
            bool const first = run.cell(ends[0]) != cell_state::air;
            bool const second = ends[1].valid() && run.cell(ends[1]) != cell_state::air;
            link_state expected = link_state::gone;
            if (first && second) expected = run.life(l) > 0 ? link_state::bonded : link_state::broken;
            if (first != second) {
                bool const reached = !ends[1].valid() || open[ends[first ? 1 : 0].value] != 0;
                expected = reached ? link_state::skin : link_state::pocket;
                vec3 const outward = run.view(l).normal;
                REQUIRE(dot(outward, n.link_normal(l)) == (first ? 1 : -1));
            }
            REQUIRE(run.state(l) == expected);
        }
        for (std::uint64_t path = 0; path < 20; ++path) {
            std::vector<path_visit> visits;
            auto const t = run.trace(run.paths() + path, visits);
            if (t.entry.valid()) REQUIRE(run.state(t.entry) == link_state::skin);
            for (path_visit const& v : visits) REQUIRE(run.state(v.link) != link_state::gone);
        }
    }
    CHECK(run.report().cells_detached > 20);
}

TEST_CASE("law 16: zero paths and dry paths change nothing") {
    box_network const n(4, 4, 4);
    frost_run run(n, slanting());
    auto const before = run.checkpoint();
    run.run({.paths = 0});
    CHECK((run.checkpoint() == before));
    frost_run dry(n, slanting(), {.water = 0});
    auto const r = dry.run({.paths = 100});
    CHECK(r.paths == 100);
    CHECK(r.links_traversed == 0);
    CHECK(r.water_in == 0);
    for (std::size_t i = 0; i < n.link_count(); ++i) CHECK(dry.life(link_index{i}) == run.life(link_index{i}));
}

TEST_CASE("law 16: n paths then m equal n + m, and a batch of one is the sequential run") {
    box_network const n(6, 6, 6);
    frost_run whole(n, slanting(), {.seed = 1});
    frost_run split(n, slanting(), {.seed = 1});
    whole.run({.paths = 4000});
    split.run({.paths = 1});
    split.run({.paths = 1234});
    split.run({.paths = 2765, .batch = 1});
    CHECK((whole.checkpoint() == split.checkpoint()));

    frost_run batched(n, slanting(), {.seed = 1});
    frost_run halves(n, slanting(), {.seed = 1});
    batched.run({.paths = 4096, .batch = 32});
    halves.run({.paths = 1024, .batch = 32});
    halves.run({.paths = 3072, .batch = 32});
    CHECK((batched.checkpoint() == halves.checkpoint()));
    CHECK_FALSE((batched.checkpoint() == whole.checkpoint()));
}

TEST_CASE("another seed, another history; the same seed, the same") {
    box_network const n(4, 4, 4);
    auto const end = [&](std::uint64_t seed) {
        frost_run run(n, slanting(), {.seed = seed});
        run.run({.paths = 500});
        return run.report().links_traversed;
    };
    CHECK(end(0) == end(0));
    CHECK(end(0) != end(1));
    CHECK(end(std::numeric_limits<std::uint64_t>::max()) == end(std::numeric_limits<std::uint64_t>::max()));
}

TEST_CASE("nothing falls at the start, whatever the number of components") {
    box_network n(4, 1, 1);
    frost_run run(n, slanting());
    run.mark(n.at(2, 0, 0), cell_state::air);
    CHECK(run.report().cells_detached == 0);
    CHECK(run.cell(n.at(3, 0, 0)) == cell_state::solid);
    CHECK(run.drop_loose() == 0);  // no core: nothing is loose
    run.mark(n.at(0, 0, 0), cell_state::core);
    CHECK(run.cell(n.at(3, 0, 0)) == cell_state::solid);
    CHECK(run.drop_loose() == 1);
    CHECK(run.cell(n.at(3, 0, 0)) == cell_state::air);
    CHECK(run.cell(n.at(1, 0, 0)) == cell_state::solid);
    CHECK(run.report().cells_detached == 1);
}

TEST_CASE("a bond broken by hand lets the smaller part fall at once") {
    box_network const n(5, 1, 1);
    frost_run run(n, slanting());
    CHECK(run.break_link(n.near_to({2, 0.5, 0.5})));
    CHECK_FALSE(run.break_link(n.near_to({2, 0.5, 0.5})));
    CHECK_FALSE(run.break_link(n.near_to({0, 0.5, 0.5})));  // skin
    CHECK(run.cell(n.at(0, 0, 0)) == cell_state::air);
    CHECK(run.cell(n.at(1, 0, 0)) == cell_state::air);
    CHECK(run.cell(n.at(2, 0, 0)) == cell_state::solid);
    REQUIRE(run.blocks().size() == 1);
    CHECK(run.blocks()[0].cells == std::vector<cell_index>{n.at(0, 0, 0), n.at(1, 0, 0)});
    CHECK(run.blocks()[0].volume == Approx(2));
    CHECK_THROWS_AS(run.break_link(link_index{9999u}), invalid_input);
}

TEST_CASE("a core holds the smaller part, and heals nothing") {
    box_network const n(5, 1, 1);
    frost_run run(n, slanting());
    run.mark(n.at(0, 0, 0), cell_state::core);
    CHECK(run.break_link(n.near_to({2, 0.5, 0.5})));
    CHECK(run.cell(n.at(1, 0, 0)) == cell_state::solid);
    CHECK(run.cell(n.at(2, 0, 0)) == cell_state::air);
    double const life = run.life(n.near_to({2, 0.5, 0.5}));
    run.mark(n.at(1, 0, 0), cell_state::core);
    CHECK(run.life(n.near_to({2, 0.5, 0.5})) == life);
    CHECK(life == 0);
}

TEST_CASE("marks are checked: indices, and air that is air for good") {
    box_network const n(3, 3, 3);
    frost_run run(n, slanting());
    CHECK_THROWS_AS(run.mark(cell_index{27u}, cell_state::core), invalid_input);
    CHECK_THROWS_AS(run.mark(cell_index{}, cell_state::core), invalid_input);
    run.mark(cell_index{3u}, cell_state::air);
    run.mark(cell_index{3u}, cell_state::solid);  // before the first path a mark may be taken back
    run.mark(cell_index{4u}, cell_state::air);
    run.run({.paths = 1});
    auto const before = run.checkpoint();
    std::array<cell_index, 2> const both{cell_index{5u}, cell_index{4u}};
    CHECK_THROWS_AS(run.mark(both, cell_state::core), invalid_input);
    CHECK((run.checkpoint() == before));
}

TEST_CASE("reset goes back to the first path and keeps the marks") {
    box_network const n(5, 5, 5);
    frost_run run(n, slanting());
    run.mark(n.at(2, 2, 2), cell_state::core);
    run.mark(n.at(0, 0, 4), cell_state::air);
    auto const start = run.checkpoint();
    run.run({.paths = 2000});
    CHECK(run.report().cells_detached > 0);
    auto const end = run.checkpoint();
    run.reset();
    CHECK((run.checkpoint() == start));
    run.run({.paths = 2000});
    CHECK((run.checkpoint() == end));
}

TEST_CASE("policies, fields and options may be replaced between paths") {
    box_network const n(5, 5, 5);
    frost_run run(n, slanting());
    run.run({.paths = 100});
    auto changed = slanting();
    changed.flow.resistance.value = 0.9;
    changed.rain.rain.direction = vec3{0, 0, -1};
    run.replace(changed);
    CHECK(run.view(n.near_to({2, 2.5, 2.5})).resistance == 0.9);
    run.replace(frost_options{.water = 2, .seed = 9});
    auto const r = run.run({.paths = 100});
    CHECK(r.paths == 200);
    CHECK(r.water_in == 300);
    auto const before = run.checkpoint();
    changed.flow.resistance.value = 1.5;
    CHECK_THROWS_AS(run.replace(changed), invalid_input);
    changed.flow.resistance.value = 0.5;
    changed.rain.rain.direction = vec3{0, 0, 0};
    CHECK_THROWS_AS(run.replace(changed), invalid_input);
    CHECK_THROWS_AS(run.replace(frost_options{.water = -1}), invalid_input);
    CHECK((run.checkpoint() == before));
}

TEST_CASE("validate says when no water can enter") {
    box_network const n(3, 3, 3);
    CHECK_NOTHROW(frost_run(n, slanting()).validate());
    // Through bonds of resistance 1 nothing passes; a skin below a skin still leads on, so cover the sides.
    struct only_bonds {
        double weight(link_view const& here, link_view const& there, water const& w) const {
            return there.state == link_state::bonded ? gravity_flow{}.weight(here, there, w) : 0.0;
        }
    };
    auto const blocked = frost_wedging{.flow = seepage{only_bonds{}, constant_field{1.0}}};
    frost_run run(n, blocked);
    try {
        run.validate();
        FAIL("nothing was said");
    } catch (invalid_input const& e) {
        CHECK(e.code() == errc::no_entry);
    }
    auto const r = run.run({.paths = 50});
    CHECK(r.links_broken == 0);
    CHECK(r.water_drained == 50);
    for (int c = 0; c < 27; ++c) run.mark(cell_index{static_cast<std::uint32_t>(c)}, cell_state::air);
    CHECK(run.run({.paths = 5}).paths_without_entry == 5);
}

TEST_CASE("all cells core: links wear and break, nothing falls") {
    box_network const n(4, 4, 4);
    frost_run run(n, slanting());
    std::vector<cell_index> all;
    for (std::uint32_t c = 0; c < 64; ++c) all.push_back(cell_index{c});
    run.mark(all, cell_state::core);
    auto const r = run.run({.paths = 5000});
    CHECK(r.links_broken == 144);  // every bond of 4 x 4 x 4
    CHECK(r.cells_detached == 0);
}

TEST_CASE("parameters of a run are checked, and a refused run is not made") {
    box_network n(2, 2, 2);
    double const nan = std::numeric_limits<double>::quiet_NaN();
    for (double const water : {-1.0, nan, 2000.0}) {
        CHECK_THROWS_AS(frost_run(n, slanting(), {.water = water}), invalid_input);
    }
    CHECK_THROWS_AS(frost_run(n, slanting(), {.longest_path = 0}), invalid_input);
    auto bad = slanting();
    bad.absorb.absorption.k_res = nan;
    CHECK_THROWS_AS(frost_run(n, bad), invalid_input);
    auto field = slanting();
    field.flow.resistance.value = nan;
    CHECK_THROWS_AS(frost_run(n, field), invalid_input);
    frost_run run(n, slanting());
    CHECK_THROWS_AS(run.run({.paths = 1, .batch = 0}), invalid_input);
    n.volumes[3] = 0;
    CHECK_THROWS_AS(frost_run(n, slanting()), invalid_input);
}

TEST_CASE("the run compiles and runs with the least policies, the least network and the paper's exposure") {
    archetypes::network const n;
    using rain = rainfall<archetypes::rain, archetypes::infiltration>;
    using flow = seepage<archetypes::flow, archetypes::field>;
    using absorb = uptake<archetypes::absorption, archetypes::soaking>;
    using rules = wear<archetypes::harm, archetypes::breakage, archetypes::detachment>;
    frost_wedging<rain, flow, absorb, rules> const least{
        .rain = {archetypes::rain(0), archetypes::infiltration(0)},
        .flow = {archetypes::flow(0), archetypes::field(0)},
        .absorb = {archetypes::absorption(0), archetypes::soaking(0)},
        .wear = {archetypes::harm(0), archetypes::breakage(0), archetypes::detachment(0)}};
    frost_run run(n, least, {}, surface_walk{});
    auto const r = run.run({.paths = 50, .batch = 2}, {}, archetypes::executor(0));
    CHECK(r.links_broken == 1);
    CHECK(r.cells_detached == 0);  // the archetype lets nothing fall
    CHECK_NOTHROW(run.validate());

    frost_wedging<archetypes::rain, archetypes::flow, archetypes::absorption, rules> const single{
        .rain = archetypes::rain(0), .flow = archetypes::flow(0), .absorb = archetypes::absorption(0), .wear = least.wear};
    frost_run bare(n, single);
    CHECK(bare.run({.paths = 10}).links_broken == 1);
}

TEST_CASE("presets are the paper's defaults and the add-on's") {
    auto const paper = paper_preset();
    CHECK(paper.process.absorb.absorption.k_solid == 0.1);
    CHECK(paper.process.wear.breakage.p_max == 0.9);
    CHECK(paper.options.mean == area_mean::interior);
    auto const addon = addon_preset();
    CHECK_NOTHROW(addon.process.validate());
    CHECK(addon.process.flow.flow.exit_weight == 0.75);
    CHECK(addon.process.absorb.soaking.threshold == 0.25);
    box_network const n(4, 4, 4);
    frost_run run(n, addon.process, addon.options);
    auto const r = run.run({.paths = 2000});
    CHECK(r.links_broken > 0);
    CHECK(r.water_lost > 0);  // a quarter of what is soaked
    CHECK(run.scale().mean_area == 1);
}
