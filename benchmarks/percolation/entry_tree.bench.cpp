// Entry of a path among n skin links: the tree, and the exact sum over all links that it replaces.
#include <tafoni/percolation/entry_tree.hpp>

#include <benchmark/benchmark.h>

namespace {

using namespace tafoni;

double accept(link_index l) { return (l.value * 37 % 101) * 0.005; }  // a quarter on average, as rain on a ball

void tree(benchmark::State& state) {
    auto const n = static_cast<std::size_t>(state.range(0));
    entry_tree t(n);
    for (std::size_t i = 0; i < n; ++i) t.set(link_index{i}, 1000 + static_cast<std::int64_t>(i % 977));
    entry_tree::scratch memory;
    double const key[3] = {0, 0, 0};
    std::uint64_t path = 0;
    for (auto _ : state) {
        stream random(1, stage::entry, path++);
        benchmark::DoNotOptimize(t.draw(random, key, accept, memory));
    }
    state.SetItemsProcessed(state.iterations());
    state.SetComplexityN(state.range(0));
}

void sum(benchmark::State& state) {
    auto const n = static_cast<std::size_t>(state.range(0));
    std::uint64_t path = 0;
    for (auto _ : state) {
        stream random(1, stage::entry, path++);
        double total = 0;
        for (std::uint32_t i = 0; i < n; ++i) total += (1000.0 + i % 977) * accept(link_index{i});
        double const u = random.uniform01() * total;
        double at = 0;
        std::uint32_t chosen = 0;
        for (std::uint32_t i = 0; i < n && at <= u; ++i) {
            at += (1000.0 + i % 977) * accept(link_index{i});
            chosen = i;
        }
        benchmark::DoNotOptimize(chosen);
    }
    state.SetItemsProcessed(state.iterations());
    state.SetComplexityN(state.range(0));
}

void update(benchmark::State& state) {
    auto const n = static_cast<std::size_t>(state.range(0));
    entry_tree t(n);
    std::size_t i = 0;
    for (auto _ : state) {
        t.set(link_index{i % n}, static_cast<std::int64_t>(i % 5));
        i += 7919;
    }
    benchmark::DoNotOptimize(t.total());
    state.SetItemsProcessed(state.iterations());
}

BENCHMARK(tree)->Name("percolation/entry_tree/draw/double/n")->RangeMultiplier(10)->Range(100, 1000000)->Complexity();
BENCHMARK(sum)->Name("percolation/entry_tree/reference_sum/double/n")->RangeMultiplier(10)->Range(100, 100000)->Complexity();
BENCHMARK(update)->Name("percolation/entry_tree/set/double/n")->Arg(1000)->Arg(1000000);

}  // namespace
