// Frost wedging: mean time of a path (walk, wear, detachment, exposure) as in Table 1 of the paper, on
// shards and on voxels, the cave of Figure 14, and batches on several threads.
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/decomposition/random_sites.hpp>
#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/decomposition/voxel_cells.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/graph/make_link_graph.hpp>
#include <tafoni/io/read_obj.hpp>
#include <tafoni/weathering/frost_run.hpp>

#include <support/shapes.hpp>
#include <support/test_data.hpp>

#include <benchmark/benchmark.h>

#include <map>

namespace {

using namespace tafoni;

/// hill3d where the data is there, else a box.
solid const& hill() {
    static solid const body = [] {
        auto const path = tafoni_test::find("meshes/hill3d_1.9k_quads.obj");
        return path.empty() ? make_solid(tafoni_test::unit_box()) : make_solid(read_obj(path).mesh);
    }();
    return body;
}

link_graph const& hill_links(std::size_t shards) {
    static std::map<std::size_t, link_graph> made;
    auto const at = made.find(shards);
    if (at != made.end()) return at->second;
    auto const sites = random_sites{.count = shards}(hill(), 1);
    return made.emplace(shards, make_link_graph(voronoi_shards(hill(), sites))).first->second;
}

auto slanting() {
    return frost_wedging{.rain = rainfall{.rain = directional_rain{.direction = normalized(vec3{0.3, 0.4, -1})}}};
}

void per_path(benchmark::State& state, std::uint64_t paths) {
    auto const done = static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(paths);
    state.SetItemsProcessed(done);
    state.counters["per_path"] = benchmark::Counter(static_cast<double>(done),
                                                    benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

template <class Network>
void fresh_paths(benchmark::State& state, Network const& n, std::uint64_t paths) {
    frost_run run(n, slanting());
    for (auto _ : state) {
        state.PauseTiming();
        run.reset();
        state.ResumeTiming();
        benchmark::DoNotOptimize(run.run({.paths = paths}));
    }
    per_path(state, paths);
}

void shards(benchmark::State& state) {
    fresh_paths(state, hill_links(static_cast<std::size_t>(state.range(0))), 10000);
    state.SetComplexityN(state.range(0));
}

void voxels(benchmark::State& state) {
    auto const edge = static_cast<std::size_t>(state.range(0));
    auto const n = voxel_cells::from_indices({.size = {edge, edge, edge}}, [](auto, auto, auto) { return true; });
    fresh_paths(state, n, 100000);
}

/// 2,900 shards, the exterior core but for the front, 70,000 paths (the authors: 209 s).
void cave(benchmark::State& state) {
    link_graph const& g = hill_links(2900);
    std::vector<cell_index> core;
    for (std::size_t l = g.interior_link_count(); l < g.link_count(); ++l) {
        if (!(g.link_normal(link_index{l})[1] < -0.3)) core.push_back(g.link_cells(link_index{l})[0]);
    }
    frost_run run(g, frost_wedging{.rain = rainfall{.rain = directional_rain{.direction = normalized(vec3{0, 1, -0.3})}}});
    run.mark(core, cell_state::core);
    for (auto _ : state) {
        state.PauseTiming();
        run.reset();
        state.ResumeTiming();
        benchmark::DoNotOptimize(run.run({.paths = 70000}));
    }
    per_path(state, 70000);
    state.counters["cells_detached"] = static_cast<double>(run.report().cells_detached);
}

void batches(benchmark::State& state) {
    thread_pool const pool(static_cast<std::size_t>(state.range(0)));
    frost_run run(hill_links(10000), slanting());
    for (auto _ : state) {
        state.PauseTiming();
        run.reset();
        state.ResumeTiming();
        benchmark::DoNotOptimize(run.run({.paths = 64000, .batch = 4000}, {}, pool));
    }
    per_path(state, 64000);
}

void checkpoints(benchmark::State& state) {
    frost_run run(hill_links(10000), slanting());
    run.run({.paths = 10000});
    for (auto _ : state) {
        auto const bytes = run.checkpoint();
        run.resume(bytes);
        benchmark::DoNotOptimize(bytes.data());
    }
}

BENCHMARK(shards)->Name("weathering/frost_run/paper/double/n")->Arg(100)->Arg(500)->Arg(1000)->Arg(5000)->Arg(10000)
    ->Unit(benchmark::kMillisecond)->Complexity();
BENCHMARK(voxels)->Name("weathering/frost_run/voxels/double/edge")->Arg(22)->Arg(100)->Iterations(3)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(cave)->Name("weathering/frost_run/cave/double/n:2900")->Unit(benchmark::kMillisecond);
BENCHMARK(batches)->Name("weathering/frost_run/batch4000/double/threads")->Arg(1)->Arg(2)->Arg(4)->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(checkpoints)->Name("weathering/frost_run/checkpoint/double/n:10000")->Unit(benchmark::kMillisecond);

}  // namespace
