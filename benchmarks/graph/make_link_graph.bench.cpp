// Links and neighbours of shards and of voxels: building them, walking over them, and the bytes that they take.
#include <tafoni/decomposition/random_sites.hpp>
#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/decomposition/voxel_cells.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/graph/air_flood.hpp>
#include <tafoni/graph/make_link_graph.hpp>

#include <support/shapes.hpp>

#include <benchmark/benchmark.h>

#include <map>

namespace {

using namespace tafoni;

shard_complex const& shards_of(std::size_t n) {
    static std::map<std::size_t, shard_complex> made;
    auto const at = made.find(n);
    if (at != made.end()) return at->second;
    solid const body = make_solid(tafoni_test::unit_box());
    return made.emplace(n, voronoi_shards(body, random_sites{.count = n}(body, 1))).first->second;
}

voxel_cells cube(std::int64_t n) {
    auto const edge = static_cast<std::size_t>(n);
    return voxel_cells::from_predicate({.size = {edge, edge, edge}}, [](vec3 const&) { return true; });
}

void build(benchmark::State& state) {
    shard_complex const& c = shards_of(static_cast<std::size_t>(state.range(0)));
    std::size_t bytes = 0;
    for (auto _ : state) {
        link_graph const g = make_link_graph(c);
        bytes = g.bytes();
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
    state.SetComplexityN(state.range(0));
    state.counters["bytes_per_cell"] = static_cast<double>(bytes) / static_cast<double>(state.range(0));
}

void build_voxels(benchmark::State& state) {
    std::size_t bytes = 0;
    std::size_t cells = 0;
    for (auto _ : state) {
        voxel_cells const v = cube(state.range(0));
        bytes = v.bytes();
        cells = v.cell_count();
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(cells));
    state.counters["bytes_per_cell"] = static_cast<double>(bytes) / static_cast<double>(cells);
}

template <class Network>
void visit_all(benchmark::State& state, Network const& n) {
    std::size_t visits = 0;
    for (auto _ : state) {
        double sum = 0;
        for (std::uint32_t l = 0; l < n.link_count(); ++l) {
            if (!n.has_link(link_index{l})) continue;
            n.for_each_neighbor(link_index{l}, [&](link_index m) {
                sum += n.link_centroid(m)[2];
                ++visits;
            });
        }
        benchmark::DoNotOptimize(sum);
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(visits));
}

void visit_shards(benchmark::State& state) {
    visit_all(state, make_link_graph(shards_of(static_cast<std::size_t>(state.range(0)))));
}
void visit_voxels(benchmark::State& state) { visit_all(state, cube(state.range(0))); }

/// All cells fall one by one from the top: what one fall costs.
void flood(benchmark::State& state) {
    voxel_cells const v = cube(state.range(0));
    for (auto _ : state) {
        std::vector<cell_state> cells(v.cell_count(), cell_state::solid);
        std::vector<link_state> links(v.link_count(), link_state::bonded);
        auto memory = air_flood{}.start(v, cells, links);
        exposure_change change;
        for (std::size_t c = v.cell_count(); c-- > 0;) {
            cells[c] = cell_state::air;
            air_flood{}.update(v, cells, std::array{cell_index{c}}, memory, links, change);
        }
        benchmark::DoNotOptimize(links.data());
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(v.cell_count()));
}

BENCHMARK(build)->Name("graph/make_link_graph/shards/double")->ArgName("n")->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(build_voxels)->Name("decomposition/voxel_cells/from_predicate/double")->ArgName("edge")->Arg(22)->Arg(100)->Unit(benchmark::kMillisecond);
BENCHMARK(visit_shards)->Name("graph/link_graph/for_each_neighbor/double")->ArgName("n")->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(visit_voxels)->Name("graph/voxel_cells/for_each_neighbor/double")->ArgName("edge")->Arg(22)->Arg(100)->Unit(benchmark::kMillisecond);
BENCHMARK(flood)->Name("graph/air_flood/update/double")->ArgName("edge")->Arg(22)->Arg(100)->Unit(benchmark::kMillisecond);

}  // namespace
