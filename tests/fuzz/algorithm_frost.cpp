// Bytes make a network, policies and a plan: the run keeps its ledger, its order and its parts.
#include "check_mesh_file.hpp"
#include "damaged_checkpoint.hpp"
#include "reliability/cases.hpp"

#include <tafoni/graph/surface_walk.hpp>
#include <tafoni/weathering/frost_presets.hpp>
#include <tafoni/weathering/frost_run.hpp>

#include <numeric>

namespace {

using namespace tafoni;
using tafoni_test::choices;
using tafoni_test::require;

/// Cells joined at random: double links, islands, cells without skin, any neighbours.
struct random_network {
    struct link {
        std::array<cell_index, 2> cells;
        vec3 centroid;
        vec3 normal;
        double area;
    };
    std::vector<link> links{};
    std::vector<std::vector<link_index>> of_cell{};
    std::vector<std::vector<link_index>> neighbors{};
    std::vector<double> volumes{};

    explicit random_network(choices& c) {
        std::size_t const cells = 1 + c.below(12);
        for (std::size_t k = 0; k < cells; ++k) volumes.push_back(c.chance(0.5) ? 1.0 : c.between(1e-3, 10));
        of_cell.resize(cells);
        std::size_t const n = c.below(40);
        for (std::size_t k = 0; k < n; ++k) {
            cell_index const a{static_cast<std::size_t>(c.below(cells))};
            cell_index b{static_cast<std::size_t>(c.below(cells))};
            if (c.chance(0.4) || a == b) b = cell_index{};
            link_index const l{links.size()};
            vec3 const normal = normalized(vec3{c.unit() - 0.5, c.unit() - 0.5, c.unit() + 0.01});
            links.push_back({{a, b}, vec3{c.unit(), c.unit(), c.unit()}, normal, c.chance(0.2) ? 1e-6 : c.between(0.1, 2)});
            of_cell[a.value].push_back(l);
            if (b.valid()) of_cell[b.value].push_back(l);
        }
        neighbors.resize(links.size());
        for (std::size_t i = 0; i < links.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                bool const touch = std::any_of(links[i].cells.begin(), links[i].cells.end(), [&](cell_index x) {
                    return x.valid() && (x == links[j].cells[0] || x == links[j].cells[1]);
                });
                if (!touch || c.chance(0.3)) continue;
                neighbors[i].push_back(link_index{j});
                neighbors[j].push_back(link_index{i});
            }
        }
    }
    std::size_t cell_count() const { return volumes.size(); }
    double cell_volume(cell_index c) const { return volumes[c.value]; }
    std::size_t link_count() const { return links.size(); }
    bool has_link(link_index l) const { return l.value < links.size(); }
    std::array<cell_index, 2> link_cells(link_index l) const { return links[l.value].cells; }
    double link_area(link_index l) const { return links[l.value].area; }
    vec3 link_centroid(link_index l) const { return links[l.value].centroid; }
    vec3 link_normal(link_index l) const { return links[l.value].normal; }
    template <class F>
    void for_each_cell_link(cell_index c, F const& f) const {
        for (auto const l : of_cell[c.value]) f(l);
    }
    template <class F>
    void for_each_neighbor(link_index l, F const& f) const {
        for (auto const m : neighbors[l.value]) f(m);
    }
};

/// Cells over unbroken bonds, found anew.
std::vector<std::uint32_t> pieces(random_network const& n, auto const& run) {
    std::vector<std::uint32_t> up(n.cell_count());
    std::iota(up.begin(), up.end(), 0U);
    auto const root = [&](std::uint32_t c) {
        while (up[c] != c) c = up[c] = up[up[c]];
        return c;
    };
    for (std::uint32_t l = 0; l < n.link_count(); ++l) {
        if (run.state(link_index{l}) != link_state::bonded) continue;
        up[root(n.links[l].cells[0].value)] = root(n.links[l].cells[1].value);
    }
    for (std::uint32_t c = 0; c < up.size(); ++c) up[c] = root(c);
    return up;
}

template <class Run>
void check_run(random_network const& n, Run const& run, std::vector<std::uint32_t> const& before,
               std::vector<cell_state> const& former, std::vector<double> const& lives) {
    frost_report const r = run.report();
    require(std::fabs(r.water_in - r.water_absorbed - r.water_lost - r.water_drained) <= 1e-12 * r.water_in, "law 10: the ledger closes");
    for (std::uint32_t l = 0; l < lives.size(); ++l) {
        require(run.life(link_index{l}) <= lives[l] && run.life(link_index{l}) >= 0, "law 11: life never rises");
        auto const ends = n.links[l].cells;
        int const rock = (run.cell(ends[0]) != cell_state::air ? 1 : 0) + (ends[1].valid() && run.cell(ends[1]) != cell_state::air ? 1 : 0);
        link_state const s = run.state(link_index{l});
        if (rock == 0) require(s == link_state::gone, "a link without rock is gone");
        if (rock == 2) require(s == (run.life(link_index{l}) > 0 ? link_state::bonded : link_state::broken), "life makes a bond");
        if (rock == 1) require(s == link_state::skin || (s == link_state::pocket && ends[1].valid()), "rock beside air is skin or pocket");
    }
    auto const after = pieces(n, run);
    std::vector<std::uint32_t> loose(after.size(), 0);
    std::vector<std::uint32_t> held(after.size(), 0);
    std::vector<std::uint8_t> has_core(after.size(), 0);
    for (std::uint32_t k = 0; k < after.size(); ++k) {
        if (former[k] == cell_state::air) require(run.cell(cell_index{k}) == cell_state::air, "law 11: what fell never returns");
        if (run.cell(cell_index{k}) == cell_state::core) has_core[after[k]] = 1;
    }
    for (std::uint32_t k = 0; k < after.size(); ++k) {
        if (run.cell(cell_index{k}) != cell_state::air && after[k] == k) ++(has_core[k] != 0 ? held : loose)[before[k]];
    }
    for (std::uint32_t k = 0; k < after.size(); ++k) require(loose[k] + (held[k] > 0 ? 1U : 0U) <= 1, "law 12: what came loose has fallen");
}

template <class Exposure>
void weather(random_network const& n, choices& c, Exposure exposure) {
    frost_preset p = c.chance(0.5) ? paper_preset() : addon_preset();
    p.process.rain.rain.direction = normalized(vec3{c.unit() - 0.5, c.unit() - 0.5, -c.unit() - 0.01});
    p.process.flow.resistance.value = c.unit();
    p.process.absorb.absorption.k_solid = c.chance(0.1) ? 0.0 : c.unit();
    p.process.wear.harm.k_dmg = 4 * c.unit();
    p.process.wear.breakage.p_max = p.process.wear.breakage.p_min + (1 - p.process.wear.breakage.p_min) * c.unit();
    p.options.water = c.chance(0.1) ? 1e-15 : 30 * c.unit();
    p.options.seed = c.below(256);
    p.options.longest_path = static_cast<std::uint32_t>(1 + c.below(60));
    auto const batch = static_cast<std::uint32_t>(1 + c.below(20));
    frost_run run(n, p.process, p.options, exposure);
    frost_run same(n, p.process, p.options, exposure);  // stopped and resumed after every act
    std::size_t const acts = 1 + c.below(6);
    for (std::size_t act = 0; act < acts; ++act) {
        std::vector<cell_state> former(run.cells().begin(), run.cells().end());
        std::vector<double> lives;
        for (std::uint32_t l = 0; l < n.link_count(); ++l) lives.push_back(run.life(link_index{l}));
        std::uint64_t const kind = c.below(8);
        if (kind == 0) {
            cell_index const cell{static_cast<std::size_t>(c.below(n.cell_count()))};
            auto const as = static_cast<cell_state>(c.below(3));
            try {
                run.mark(cell, as);
                same.mark(cell, as);
            } catch (invalid_input const& e) {
                require(e.code() == errc::bad_parameter, "air is air for good");
            }
        } else if (kind == 1 && n.link_count() > 0) {
            link_index const l{static_cast<std::size_t>(c.below(n.link_count()))};
            auto const before = pieces(n, run);
            run.break_link(l);
            same.break_link(l);
            check_run(n, run, before, former, lives);
        } else if (kind == 2) {
            run.drop_loose();
            same.drop_loose();
        } else {
            std::uint64_t const paths = batch * (1 + c.below(6));
            auto const before = pieces(n, run);
            run.run({.paths = paths, .batch = batch});
            check_run(n, run, before, former, lives);
            std::uint64_t const first = c.below(paths + 1) / batch * batch;
            same.run({.paths = first, .batch = batch});
            auto const middle = same.checkpoint();
            same.resume(middle);
            require(same.checkpoint() == middle, "a checkpoint comes back as it was");
            same.run({.paths = paths - first, .batch = batch});
        }
        require(same.checkpoint() == run.checkpoint(), "law 16: n then m paths are n + m, also over checkpoints");
    }
    tafoni_test::resume_damaged(run, c);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size) {
    choices c(std::span(bytes, size));
    random_network const n(c);
    if (c.chance(0.5)) weather(n, c, air_flood{});
    else weather(n, c, surface_walk{});
    return 0;
}
