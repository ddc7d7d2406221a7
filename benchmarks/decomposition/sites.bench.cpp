#include <tafoni/decomposition/grid_sites.hpp>
#include <tafoni/decomposition/poisson_sites.hpp>
#include <tafoni/decomposition/random_sites.hpp>
#include <tafoni/decomposition/surface_sites.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/field/outcrop.hpp>

#include <benchmark/benchmark.h>

namespace {

tafoni::solid const& rock() {
    static tafoni::solid const s = tafoni::make_solid(tafoni::make_outcrop(1, 100));
    return s;
}

template <class Pattern>
void place(benchmark::State& state, Pattern const& pattern) {
    tafoni::solid const& s = rock();
    std::size_t sites = 0;
    for (auto _ : state) {
        auto const p = pattern(s, 1);
        sites += p.size();
        benchmark::DoNotOptimize(p.data());
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(sites));
}

std::size_t count(benchmark::State const& state) { return static_cast<std::size_t>(state.range(0)); }

void in_random(benchmark::State& state) { place(state, tafoni::random_sites{.count = count(state)}); }
void on_surface(benchmark::State& state) { place(state, tafoni::surface_sites{.count = count(state)}); }
void in_grid(benchmark::State& state) { place(state, tafoni::grid_sites{.count = count(state)}); }
void poisson(benchmark::State& state) {
    double const radius = tafoni::elementary::pow(0.7 * rock().volume / static_cast<double>(state.range(0)), 1.0 / 3);
    place(state, tafoni::poisson_sites{tafoni::constant_field{.value = radius}});
}

}  // namespace

BENCHMARK(in_random)->Name("decomposition/sites/random_sites/double/n")->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(on_surface)->Name("decomposition/sites/surface_sites/double/n")->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(in_grid)->Name("decomposition/sites/grid_sites/double/n")->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(poisson)->Name("decomposition/sites/poisson_sites/double/n")->Arg(10000)->Unit(benchmark::kMillisecond);
