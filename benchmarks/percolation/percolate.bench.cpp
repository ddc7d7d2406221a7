// One path over a frozen state, without wear: the cost of the water alone.
#include <tafoni/decomposition/voxel_cells.hpp>
#include <tafoni/percolation/percolate.hpp>
#include <tafoni/percolation/rainfall.hpp>
#include <tafoni/percolation/seepage.hpp>
#include <tafoni/rules/uptake.hpp>

#include <benchmark/benchmark.h>

namespace {

using namespace tafoni;

void voxels(benchmark::State& state) {
    auto const edge = static_cast<std::size_t>(state.range(0));
    auto const n = voxel_cells::from_indices({.size = {edge, edge, edge}}, [](auto, auto, auto) { return true; });
    link_table<voxel_cells> table(n);
    entry_tree skin(n.link_count());
    for (std::size_t i = 0; i < n.link_count(); ++i) {
        link_index const l{i};
        if (!n.has_link(l)) continue;
        bool const inside = table[l].cells[1].valid();
        table[l].state = inside ? link_state::bonded : link_state::skin;
        table[l].resistance = 0.5;
        if (!inside) skin.set(l, 1 << 20);
    }
    rainfall const rain{.rain = directional_rain{.direction = normalized(vec3{0.3, 0.4, -1})}};
    seepage const flow{};
    uptake const absorb{};
    path_policies const policies{rain, rain, flow, absorb, absorb};
    path_options const options{.seed = 1, .inflow = water_unit::from(1), .scale = {table.mean_area(false)}};
    path_scratch memory;
    std::vector<path_visit> visits;
    std::uint64_t path = 0;
    std::uint64_t steps = 0;
    for (auto _ : state) {
        visits.clear();
        steps += percolate(table, skin, policies, options, path++, visits, memory).visits;
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(steps));
    state.counters["links_per_path"] = static_cast<double>(steps) / static_cast<double>(path);
}

BENCHMARK(voxels)->Name("percolation/percolate/paper/double/edge")->Arg(22)->Arg(100);

}  // namespace
