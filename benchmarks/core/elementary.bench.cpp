#include <tafoni/core/elementary.hpp>

#include <tafoni/core/random.hpp>

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

namespace {

/// Ours beside libm's, over the same arguments.
template <class F>
void over(benchmark::State& state, double lo, double hi, F const& f) {
    tafoni::stream random(1, tafoni::stage::user, 0);
    std::vector<double> x(4096);
    for (double& v : x) v = random.uniform(lo, hi);
    for (auto _ : state) {
        double sum = 0;
        for (double const v : x) sum += f(v);
        benchmark::DoNotOptimize(sum);
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(x.size()));
}

namespace el = tafoni::elementary;

void exp_ours(benchmark::State& s) { over(s, -20, 20, [](double v) { return el::exp(v); }); }
void exp_libm(benchmark::State& s) { over(s, -20, 20, [](double v) { return std::exp(v); }); }
void log_ours(benchmark::State& s) { over(s, 1e-3, 1e3, [](double v) { return el::log(v); }); }
void log_libm(benchmark::State& s) { over(s, 1e-3, 1e3, [](double v) { return std::log(v); }); }
void pow_ours(benchmark::State& s) { over(s, 1e-3, 1e3, [](double v) { return el::pow(v, 1.7); }); }
void pow_libm(benchmark::State& s) { over(s, 1e-3, 1e3, [](double v) { return std::pow(v, 1.7); }); }
void sin_ours(benchmark::State& s) { over(s, -50, 50, [](double v) { return el::sin(v); }); }
void sin_libm(benchmark::State& s) { over(s, -50, 50, [](double v) { return std::sin(v); }); }
void acos_ours(benchmark::State& s) { over(s, -1, 1, [](double v) { return el::acos(v); }); }
void acos_libm(benchmark::State& s) { over(s, -1, 1, [](double v) { return std::acos(v); }); }

}  // namespace

BENCHMARK(exp_ours)->Name("core/elementary/exp/double");
BENCHMARK(exp_libm)->Name("core/elementary/exp/libm");
BENCHMARK(log_ours)->Name("core/elementary/log/double");
BENCHMARK(log_libm)->Name("core/elementary/log/libm");
BENCHMARK(pow_ours)->Name("core/elementary/pow/double");
BENCHMARK(pow_libm)->Name("core/elementary/pow/libm");
BENCHMARK(sin_ours)->Name("core/elementary/sin/double");
BENCHMARK(sin_libm)->Name("core/elementary/sin/libm");
BENCHMARK(acos_ours)->Name("core/elementary/acos/double");
BENCHMARK(acos_libm)->Name("core/elementary/acos/libm");
