// A step of rain over rolling ground of 35,000 vertices once it runs off, of three sizes, on one and more threads.
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/fluid/mesh_boundary.hpp>
#include <tafoni/fluid/rain_particles.hpp>

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

using namespace tafoni;

namespace {

void step(benchmark::State& state) {
    constexpr std::uint32_t n = 187;
    std::vector<vec3> ground;
    std::vector<std::array<std::uint32_t, 3>> faces;
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) ground.push_back(vec3{1.0 * i, 1.0 * j, 3 * std::sin(0.13 * i) * std::cos(0.11 * j)});
    }
    for (std::uint32_t j = 0; j + 1 < n; ++j) {
        for (std::uint32_t i = 0; i + 1 < n; ++i) {
            std::uint32_t const a = i + n * j;
            faces.push_back({a, a + 1, a + n + 1});
            faces.push_back({a, a + n + 1, a + n});
        }
    }
    mesh_boundary const walls(ground, faces, 1);
    box_emitter const from{.box = {.lo = {3, 3, 4}, .hi = {183, 183, 20}}};
    box_sink const keep{.keep = {.lo = {1, 1, -9}, .hi = {185, 185, 30}}};
    rain_particles rain(from, keep, {.particles = static_cast<std::uint32_t>(state.range(0)), .lifetime = 20});
    thread_pool const pool(static_cast<std::size_t>(state.range(1)));
    for (int k = 0; k < 150; ++k) rain.step(walls, pool);
    for (auto _ : state) benchmark::DoNotOptimize(rain.step(walls, pool));
    state.SetItemsProcessed(state.iterations() * state.range(0));
    if (state.range(1) == 1) state.SetComplexityN(state.range(0));
}

}  // namespace

BENCHMARK(step)->Name("fluid/rain_particles/step")->ArgNames({"n", "threads"})
    ->Args({17700, 1})->Args({35400, 1})->Args({70800, 1})->Complexity(benchmark::oN)->Unit(benchmark::kMillisecond);
BENCHMARK(step)->Name("fluid/rain_particles/step_on_threads")->ArgNames({"n", "threads"})
    ->Args({70800, 1})->Args({70800, 2})->Args({70800, 4})->Unit(benchmark::kMillisecond)->UseRealTime();
