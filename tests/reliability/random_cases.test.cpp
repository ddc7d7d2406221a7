#include "reliability/cases.hpp"

#include <tafoni/graph/connectivity.hpp>
#include <tafoni/graph/make_link_graph.hpp>
#include <tafoni/testing/structure_laws.hpp>
#include <tafoni/weathering/frost_run.hpp>

#include <catch2/catch.hpp>

#include <numeric>

using namespace tafoni;
using namespace tafoni_test;

namespace {

/// Which cells hang together over the bonds that are left, found anew.
std::vector<std::uint32_t> pieces(link_graph const& g, auto const& run) {
    std::vector<std::uint32_t> up(g.cell_count());
    std::iota(up.begin(), up.end(), 0U);
    auto const root = [&](std::uint32_t c) {
        while (up[c] != c) c = up[c] = up[up[c]];
        return c;
    };
    for (std::uint32_t l = 0; l < g.interior_link_count(); ++l) {
        if (run.state(link_index{l}) != link_state::bonded) continue;
        auto const ends = g.link_cells(link_index{l});
        up[root(ends[0].value)] = root(ends[1].value);
    }
    for (std::uint32_t c = 0; c < up.size(); ++c) up[c] = root(c);
    return up;
}

/// Laws 10, 11, 12 and 16 of a run on `g`.
std::vector<std::string> broken_run_laws(link_graph const& g, choices& c) {
    std::vector<std::string> broken;
    auto const law = [&](bool holds, char const* what) {
        if (!holds) broken.push_back(what);
    };
    frost_wedging<> process;
    process.rain.rain.direction = normalized(vec3{c.between(-1, 1), c.between(-1, 1), -0.5 - c.unit()});
    process.flow.resistance.value = c.unit();
    frost_options const options{.water = c.chance(0.1) ? 0.0 : c.between(0.01, 20), .seed = c.below(256)};
    auto const batch = static_cast<std::uint32_t>(1 + c.below(8));
    std::uint64_t const paths = batch * (1 + c.below(6));
    std::vector<cell_index> core;
    if (c.chance(0.5) && g.cell_count() > 0) core.push_back(cell_index{static_cast<std::size_t>(c.below(g.cell_count()))});

    auto const fresh = [&] {
        frost_run run(g, process, options);
        run.mark(core, cell_state::core);
        return run;
    };
    auto run = fresh();
    auto const start = run.checkpoint();
    run.run({.paths = 0, .batch = batch});
    law(run.checkpoint() == start, "law 16: zero paths are the identity");
    auto const before = pieces(g, run);
    std::vector<double> lives(g.link_count());
    for (std::uint32_t l = 0; l < lives.size(); ++l) lives[l] = run.life(link_index{l});
    frost_report const r = run.run({.paths = paths, .batch = batch});
    double const left = r.water_in - r.water_absorbed - r.water_lost - r.water_drained;
    law(std::fabs(left) <= 1e-12 * r.water_in, "law 10: the ledger of water closes");
    for (std::uint32_t l = 0; l < lives.size(); ++l) {
        law(run.life(link_index{l}) <= lives[l] && run.life(link_index{l}) >= 0, "law 11: life never rises");
    }
    // Among the cells that hung together at the start at most one piece without core stands, and none beside a core.
    auto const after = pieces(g, run);
    std::vector<std::uint32_t> loose(g.cell_count(), 0);
    std::vector<std::uint32_t> held(g.cell_count(), 0);
    std::vector<std::uint8_t> has_core(g.cell_count(), 0);
    for (std::uint32_t k = 0; k < after.size(); ++k) {
        if (run.cell(cell_index{k}) == cell_state::core) has_core[after[k]] = 1;
    }
    for (std::uint32_t k = 0; k < after.size(); ++k) {
        if (run.cell(cell_index{k}) == cell_state::air || after[k] != k) continue;
        ++(has_core[k] != 0 ? held : loose)[before[k]];
    }
    for (std::uint32_t k = 0; k < after.size(); ++k) {
        law(loose[k] + (held[k] > 0 ? 1U : 0U) <= 1, "law 12: what came loose has fallen");
    }
    auto halves = fresh();
    std::uint64_t const first = batch * c.below(paths / batch + 1);
    halves.run({.paths = first, .batch = batch});
    auto const middle = halves.checkpoint();
    auto resumed = fresh();
    resumed.resume(middle);
    law(resumed.checkpoint() == middle, "law 56: a checkpoint comes back as it was");
    resumed.run({.paths = paths - first, .batch = batch});
    law(resumed.checkpoint() == run.checkpoint(), "law 16: n then m paths are n + m");
    return broken;
}

void check_case(std::uint64_t seed) {
    choices c(seed);
    random_body const body = make_random_body(c);
    std::string sites_name;
    std::vector<std::string> broken;
    std::string stage = "solid";
    double min_volume = 0;
    try {
        solid const s = make_solid(body.mesh);
        std::vector<vec3> const sites = make_random_sites(s, c, sites_name);
        min_volume = c.chance(0.8) ? 1e-12 : 0.1 * c.unit();
        voronoi_shards_options const options{.duplicates = duplicate_sites::merge,
                                             .patch_angle = c.chance(0.5) ? 15.0 : 180 * c.unit(),
                                             .min_volume = min_volume};
        stage = "shards";
        shard_complex const shards = voronoi_shards(s, sites, options);
        broken = broken_laws(s, shards, laws_for(body, s, 10));
        stage = "graph";
        link_graph const graph = make_link_graph(shards);
        for (std::string const& law : laws::network(graph)) broken.push_back("network: " + law);
        stage = "run";
        for (std::string const& law : broken_run_laws(graph, c)) broken.push_back(law);
    } catch (std::exception const& e) {
        broken.push_back("unexpected: " + stage + ": " + e.what());
    }
    if (broken.empty()) return;
    INFO("seed " << seed << ": " << body.name << ", sites " << sites_name << ", slivers below " << min_volume);
    for (std::string const& law : broken) UNSCOPED_INFO(law);
    CHECK(broken.empty());
}

}  // namespace

TEST_CASE("laws of shards, graphs and runs hold on a thousand random models") {
    for (std::uint64_t seed = 0; seed < 1000; ++seed) check_case(seed);
}

TEST_CASE("laws of shards, graphs and runs hold on many random models", "[slow]") {
    for (std::uint64_t seed = 1000; seed < 20000; ++seed) check_case(seed);
}
