// Shards of a box, of the paper's hill and of a scanned statue, without and with both graphs.
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/decomposition/random_sites.hpp>
#include <tafoni/decomposition/shard_surface.hpp>
#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/graph/make_link_graph.hpp>
#include <tafoni/io/read_mesh.hpp>

#include <support/shapes.hpp>
#include <support/test_data.hpp>

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

namespace {

using namespace tafoni;

template <class T>
std::size_t bytes_in(std::vector<T> const& v) {
    return v.capacity() * sizeof(T);
}

std::size_t bytes_of(shard_complex const& c) {
    return bytes_in(c.vertices) + bytes_in(c.corners) + bytes_in(c.loop_begin) + bytes_in(c.face_begin) +
           bytes_in(c.faces) + bytes_in(c.cell_faces) + bytes_in(c.cell_begin) + bytes_in(c.volumes) +
           bytes_in(c.centroids) + bytes_in(c.site_of) + bytes_in(c.sites) + bytes_in(c.shards_of_site) +
           bytes_in(c.site_begin) + bytes_in(c.polygon_of) + bytes_in(c.skin_sources) + bytes_in(c.skin_patches);
}

solid load(char const* name) {
    auto const path = tafoni_test::find(std::string("meshes/") + name);
    return path.empty() ? solid{} : make_solid(read_mesh(path).mesh);
}

void cut(benchmark::State& state, solid const& body, std::size_t threads, bool graphs) {
    if (body.triangles.empty()) {
        state.SkipWithError("needs the real data");
        return;
    }
    auto const sites = random_sites{.count = static_cast<std::size_t>(state.range(0))}(body, 1);
    thread_pool const pool(threads);
    std::size_t bytes = 0;
    for (auto _ : state) {
        auto const c = voronoi_shards(body, sites, {}, pool);
        bytes = bytes_of(c);
        if (graphs) {
            auto const g = make_link_graph(c);
            bytes += g.bytes();
        }
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
    state.SetComplexityN(state.range(0));
    state.counters["bytes_per_cell"] = static_cast<double>(bytes) / static_cast<double>(state.range(0));
}

void box(benchmark::State& state) { cut(state, make_solid(tafoni_test::unit_box()), 1, true); }
void box_threads(benchmark::State& state) { cut(state, make_solid(tafoni_test::unit_box()), static_cast<std::size_t>(state.range(1)), false); }
void hill(benchmark::State& state) { cut(state, load("hill3d_1.9k_quads.obj"), 1, true); }
void nefertiti(benchmark::State& state) { cut(state, load("nefertiti_35k.ply"), 1, true); }
void nefertiti_threads(benchmark::State& state) { cut(state, load("nefertiti_35k.ply"), static_cast<std::size_t>(state.range(1)), false); }

/// Memory held by the shards and both graphs at once: at most 1.5 KB per cell at 1e6 cells.
void held(benchmark::State& state) {
    solid const body = make_solid(tafoni_test::unit_box());
    auto const sites = random_sites{.count = static_cast<std::size_t>(state.range(0))}(body, 1);
    double shards = 0;
    double graphs = 0;
    for (auto _ : state) {
        auto const c = voronoi_shards(body, sites);
        auto const g = make_link_graph(c);
        shards = static_cast<double>(bytes_of(c)) / static_cast<double>(c.cell_count());
        graphs = static_cast<double>(g.bytes()) / static_cast<double>(c.cell_count());
    }
    state.counters["shard_bytes_per_cell"] = shards;
    state.counters["graph_bytes_per_cell"] = graphs;
    state.counters["held_bytes_per_cell"] = shards + graphs;
    state.counters["of_limit"] = (shards + graphs) / 1536;
    state.SetItemsProcessed(state.iterations() * state.range(0));
}

void surface(benchmark::State& state) {
    solid const body = make_solid(tafoni_test::unit_box());
    auto const c = voronoi_shards(body, random_sites{.count = static_cast<std::size_t>(state.range(0))}(body, 1));
    std::vector<std::uint8_t> inside(c.cell_count());
    for (std::size_t k = 0; k < inside.size(); ++k) inside[k] = k % 3 != 0;
    for (auto _ : state) benchmark::DoNotOptimize(extract_surface(c, inside));
    state.SetItemsProcessed(state.iterations() * state.range(0));
}

BENCHMARK(hill)->Name("decomposition/voronoi_shards/hill_with_graphs/double/n")->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(nefertiti)->Name("decomposition/voronoi_shards/nefertiti_with_graphs/double/n")->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK(box)->Name("decomposition/voronoi_shards/box_with_graphs/double/n")->RangeMultiplier(10)->Range(1000, 1000000)->Unit(benchmark::kMillisecond)->Complexity();
BENCHMARK(box_threads)->Name("decomposition/voronoi_shards/box_threads/double/n")->ArgsProduct({{100000}, {1, 2, 4}})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(nefertiti_threads)->Name("decomposition/voronoi_shards/nefertiti_threads/double/n")->ArgsProduct({{1000}, {1, 2, 4}})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(held)->Name("decomposition/voronoi_shards/memory_held/double/n")->Arg(100000)->Arg(1000000)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(surface)->Name("decomposition/shard_surface/two_thirds_of_a_box/double/n")->Arg(10000)->Unit(benchmark::kMillisecond);

}  // namespace
