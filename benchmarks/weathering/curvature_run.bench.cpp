// One iteration of curvature weathering: curvature, Laplacian, displacement. The bust (34,835 vertices in the thesis's
// table 9.2, 182.7 ms there), beside the same iteration over lists of neighbours, and three sizes for linear cost.
#include "support/curved_surfaces.hpp"
#include "support/test_data.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/io/read_mesh.hpp>
#include <tafoni/weathering/curvature_run.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <vector>

namespace {

using namespace tafoni;

triangle_surface const& bust() {
    static triangle_surface const s = [] {
        auto const path = tafoni_test::find("meshes/nefertiti_35k.ply");
        return tafoni_test::triangles_of(path.empty() ? tafoni_test::icosphere(6) : read_mesh(path).mesh);
    }();
    return s;
}

void iterate(benchmark::State& state, triangle_surface const& s, curvature_options const& options, std::size_t threads) {
    thread_pool const pool(threads);
    curvature_run run(s, curvature_weathering{}, options);
    auto const once = [&] {
        if (threads == 1) benchmark::DoNotOptimize(run.run(1));
        else benchmark::DoNotOptimize(run.run(1, {}, pool));
    };
    once();
    for (auto _ : state) once();
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(s.positions.size()));
    state.SetComplexityN(static_cast<benchmark::IterationCount>(s.positions.size()));
    state.counters["collapsed"] = static_cast<double>(run.report().edges_collapsed);
}
void kept(benchmark::State& state) {
    iterate(state, bust(), {.topology = mesh_topology::keep}, static_cast<std::size_t>(state.range(0)));
}
void adapted(benchmark::State& state) { iterate(state, bust(), {}, static_cast<std::size_t>(state.range(0))); }
/// Only the iterations that collapse edges.
void collapsing(benchmark::State& state) {
    auto const threads = static_cast<std::size_t>(state.range(0));
    thread_pool const pool(threads);
    curvature_run run(bust());
    for (auto _ : state) {
        std::uint64_t const before = run.report().edges_collapsed;
        double seconds = 0;
        for (int k = 0; k < 1000 && run.report().edges_collapsed == before; ++k) {
            auto const start = std::chrono::steady_clock::now();
            if (threads == 1) benchmark::DoNotOptimize(run.run(1));
            else benchmark::DoNotOptimize(run.run(1, {}, pool));
            seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        }
        state.SetIterationTime(seconds);
    }
    state.counters["collapsed"] = static_cast<double>(run.report().edges_collapsed);
}
/// Ten iterations and a search.
void checked(benchmark::State& state) {
    curvature_run run(bust(), curvature_weathering{}, {.check_every = 10});
    for (auto _ : state) benchmark::DoNotOptimize(run.run(10));
}
void ball(benchmark::State& state) {
    iterate(state, tafoni_test::sphere(static_cast<int>(state.range(0))).mesh, {.topology = mesh_topology::keep}, 1);
}

/// Normals, curvature from the normals' change along each edge, uniform Laplacian: over lists, as it is written first.
struct plain_weathering {
    triangle_surface s;
    std::vector<std::vector<std::uint32_t>> faces_at{};
    std::vector<std::vector<std::uint32_t>> around{};

    explicit plain_weathering(triangle_surface const& input)
        : s(input), faces_at(s.positions.size()), around(s.positions.size()) {
        for (std::size_t f = 0; f < s.triangles.size(); ++f) {
            for (std::size_t k = 0; k < 3; ++k) {
                std::uint32_t const v = s.triangles[f][k];
                faces_at[v].push_back(static_cast<std::uint32_t>(f));
                for (std::size_t j = 1; j < 3; ++j) {
                    std::uint32_t const w = s.triangles[f][(k + j) % 3];
                    if (std::find(around[v].begin(), around[v].end(), w) == around[v].end()) around[v].push_back(w);
                }
            }
        }
    }
    void iterate() {
        std::size_t const n = s.positions.size();
        std::vector<vec3> normal(n, vec3{0, 0, 0});
        std::vector<double> h(n);
        double edges = 0;
        double count = 0;
        for (std::size_t v = 0; v < n; ++v) {
            for (std::uint32_t const f : faces_at[v]) {
                auto const& t = s.triangles[f];
                vec3 const c = cross(s.positions[t[1]] - s.positions[t[0]], s.positions[t[2]] - s.positions[t[0]]);
                normal[v] += c;
            }
            normal[v] = normalized(normal[v]);
        }
        double most = 0;
        for (std::size_t v = 0; v < n; ++v) {
            for (std::uint32_t const w : around[v]) {
                vec3 const d{s.positions[w] - s.positions[v]};
                double const l = length(d);
                h[v] += dot(vec3{normal[w] - normal[v]}, d) / (l * l);
                edges += l;
                count += 1;
            }
            if (!around[v].empty()) h[v] /= static_cast<double>(around[v].size());
            most = std::max(most, std::fabs(h[v]));
        }
        std::vector<vec3> next = s.positions;
        for (std::size_t v = 0; v < n; ++v) {
            if (!(h[v] > 0)) continue;
            vec3 l{0, 0, 0};
            for (std::uint32_t const w : around[v]) l += s.positions[w] - s.positions[v];
            next[v] += std::pow(h[v] / most, 1.0) * edges / count / 10 * normalized(l);
        }
        s.positions = std::move(next);
    }
};

void to_plain_loop(benchmark::State& state) {
    curvature_run run(bust(), curvature_weathering{}, {.topology = mesh_topology::keep});
    plain_weathering plain(bust());
    double ours = 1e9;
    double theirs = 1e9;
    auto const seconds = [](auto const& f) {
        auto const start = std::chrono::steady_clock::now();
        f();
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    for (auto _ : state) {
        ours = std::min(ours, seconds([&] { benchmark::DoNotOptimize(run.run(1)); }));
        theirs = std::min(theirs, seconds([&] { plain.iterate(); }));
    }
    state.counters["ours_ms"] = 1e3 * ours;
    state.counters["peer_ms"] = 1e3 * theirs;
    state.counters["ratio"] = ours / theirs;
}

BENCHMARK(kept)->Name("weathering/curvature_run/keep/bust")->ArgName("threads")->Arg(1)->Arg(2)->Arg(4)
    ->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(adapted)->Name("weathering/curvature_run/adapt/bust")->ArgName("threads")->Arg(1)->Arg(2)->Arg(4)
    ->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(collapsing)->Name("weathering/curvature_run/adapt/collapsing/bust")->ArgName("threads")->Arg(1)->Arg(4)
    ->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(30);
BENCHMARK(checked)->Name("weathering/curvature_run/check_every:10/ten/bust")->Iterations(3)->Unit(benchmark::kMillisecond);
BENCHMARK(ball)->Name("weathering/curvature_run/keep/icosphere")->ArgName("level")->DenseRange(5, 7)
    ->Unit(benchmark::kMillisecond)->Complexity(benchmark::oN);
BENCHMARK(to_plain_loop)->Name("weathering/curvature_run/ratio_to_plain_loop")->Iterations(20);

}  // namespace
