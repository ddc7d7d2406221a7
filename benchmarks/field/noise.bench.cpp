#include <tafoni/field/fractal_noise.hpp>

#include <tafoni/core/random.hpp>

#include <benchmark/benchmark.h>

#include <vector>

namespace {

std::vector<tafoni::vec3> points() {
    tafoni::stream random(1, tafoni::stage::user, 0);
    std::vector<tafoni::vec3> p(4096);
    for (tafoni::vec3& v : p) {
        for (int a = 0; a < 3; ++a) v[a] = random.uniform(-100, 100);
    }
    return p;
}

template <class Field>
void evaluate(benchmark::State& state, Field const& field) {
    auto const p = points();
    for (auto _ : state) {
        double sum = 0;
        for (tafoni::vec3 const& v : p) sum += field(v);
        benchmark::DoNotOptimize(sum);
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(p.size()));
}

void noise(benchmark::State& state) { evaluate(state, tafoni::gradient_noise{.seed = 1}); }
void fractal(benchmark::State& state) {
    evaluate(state, tafoni::fractal_noise{.seed = 1, .octaves = static_cast<unsigned>(state.range(0))});
}

}  // namespace

BENCHMARK(noise)->Name("field/noise/gradient_noise/double");
BENCHMARK(fractal)->Name("field/noise/fractal_noise/double/octaves")->Arg(1)->Arg(5);
