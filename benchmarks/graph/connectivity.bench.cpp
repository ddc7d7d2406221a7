// Components of the cells graph of shards while bonds break: ours, a union-find recompute and Boost in one binary.
#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/random_sites.hpp>
#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/graph/boost_view.hpp>
#include <tafoni/graph/connectivity.hpp>
#include <tafoni/graph/make_link_graph.hpp>

#include <support/shapes.hpp>

#include <benchmark/benchmark.h>
#include <boost/graph/connected_components.hpp>

#include <map>
#include <numeric>

namespace {

using namespace tafoni;

link_graph const& graph_of(std::size_t shards) {
    static std::map<std::size_t, link_graph> made;
    auto const at = made.find(shards);
    if (at != made.end()) return at->second;
    solid const body = make_solid(tafoni_test::unit_box());
    auto const sites = random_sites{.count = shards}(body, 1);
    return made.emplace(shards, make_link_graph(voronoi_shards(body, sites))).first->second;
}

std::vector<link_index> random_order(link_graph const& g) {
    std::vector<link_index> order;
    for (std::uint32_t l = 0; l < g.interior_link_count(); ++l) order.push_back(link_index{l});
    stream random(1, stage::user, 0);
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.index_below(i)]);
    return order;
}

void breaks(benchmark::State& state, std::size_t batch) {
    link_graph const& g = graph_of(static_cast<std::size_t>(state.range(0)));
    auto const order = random_order(g);
    connectivity const whole(g);
    std::size_t broken = 0;
    for (auto _ : state) {
        state.PauseTiming();
        connectivity c = whole;
        state.ResumeTiming();
        for (std::size_t i = 0; i < order.size(); i += batch) {
            if (batch == 1) {
                benchmark::DoNotOptimize(c.break_link(g, order[i]));
            } else {
                benchmark::DoNotOptimize(c.break_links(g, std::span{order}.subspan(i, std::min(batch, order.size() - i))));
            }
        }
        broken += order.size();
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(broken));
    state.counters["per_break"] = benchmark::Counter(static_cast<double>(broken),
                                                     benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    state.SetComplexityN(state.range(0));
}

/// What one break costs who recomputes everything.
void union_find(benchmark::State& state) {
    link_graph const& g = graph_of(static_cast<std::size_t>(state.range(0)));
    std::vector<std::uint32_t> up(g.cell_count());
    for (auto _ : state) {
        std::iota(up.begin(), up.end(), 0U);
        auto const root = [&](std::uint32_t x) {
            while (up[x] != x) x = up[x] = up[up[x]];
            return x;
        };
        for (std::uint32_t l = 0; l < g.interior_link_count(); ++l) {
            auto const ends = g.link_cells(link_index{l});
            std::uint32_t const a = root(ends[0].value);
            std::uint32_t const b = root(ends[1].value);
            if (a != b) up[std::max(a, b)] = std::min(a, b);
        }
        benchmark::DoNotOptimize(up.data());
    }
    state.SetComplexityN(state.range(0));
}

void boost_components(benchmark::State& state) {
    link_graph const& g = graph_of(static_cast<std::size_t>(state.range(0)));
    std::vector<int> label(g.cell_count());
    for (auto _ : state) {
        benchmark::DoNotOptimize(boost::connected_components(cells_graph_view(g), label.data()));
    }
    state.SetComplexityN(state.range(0));
}

void construct(benchmark::State& state) {
    link_graph const& g = graph_of(static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(connectivity(g));
    state.SetItemsProcessed(state.iterations() * state.range(0));
}

void sizes(benchmark::internal::Benchmark* b) { b->ArgName("n")->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond); }

BENCHMARK_CAPTURE(breaks, one, std::size_t{1})->Name("graph/connectivity/break_link/double")->Apply(sizes);
BENCHMARK_CAPTURE(breaks, batch, std::size_t{32})->Name("graph/connectivity/break_links_32/double")->Apply(sizes);
BENCHMARK(construct)->Name("graph/connectivity/construct/double")->Apply(sizes);
BENCHMARK(union_find)->Name("graph/connectivity/peer_union_find_recompute/double")->Apply(sizes);
BENCHMARK(boost_components)->Name("graph/connectivity/peer_boost_connected_components/double")->Apply(sizes);

}  // namespace
