#include <tafoni/geometry/bvh.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/geometry/self_intersections.hpp>
#include <tafoni/geometry/terrain_solid.hpp>
#include <tafoni/geometry/winding_number.hpp>

#include <benchmark/benchmark.h>

#include <support/shapes.hpp>

namespace {

using tafoni::vec3;

tafoni::indexed_mesh torus_of(std::int64_t quads) {
    auto const n = static_cast<std::size_t>(std::sqrt(static_cast<double>(quads)));
    return tafoni_test::torus(2, 0.7, n, n);
}

void make_solid_quads(benchmark::State& state) {
    auto const mesh = torus_of(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(tafoni::make_solid(mesh).volume);
    state.SetItemsProcessed(state.iterations() * state.range(0));
    state.SetComplexityN(state.range(0));
}
BENCHMARK(make_solid_quads)
    ->Name("geometry/make_solid/quads/double/n")
    ->RangeMultiplier(10)
    ->Range(1000, 1000000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

void terrain_grid(benchmark::State& state) {
    tafoni::height_grid g;
    g.columns = g.rows = static_cast<std::size_t>(state.range(0));
    for (std::size_t i = 0; i < g.columns * g.rows; ++i) {
        double const x = static_cast<double>(i % g.columns) / 16;
        double const y = static_cast<double>(i / g.columns) / 16;
        g.heights.push_back(20 * tafoni_test::lattice_noise(x, y, 3));
    }
    for (auto _ : state) benchmark::DoNotOptimize(tafoni::terrain_solid(g).volume);
    state.SetItemsProcessed(state.iterations() * state.range(0) * state.range(0));
}
BENCHMARK(terrain_grid)->Name("geometry/terrain_solid/grid/double/side")->Arg(64)->Arg(256)->Unit(benchmark::kMillisecond);

void triangulate_star(benchmark::State& state) {
    auto const n = static_cast<std::size_t>(state.range(0));
    std::vector<vec3> star;
    for (std::size_t i = 0; i < n; ++i) {
        auto const p = tafoni_test::circle_point(i, n);
        double const r = i % 2 == 0 ? 1 : 0.6;
        star.push_back(vec3{r * p[0], r * p[1], 0});
    }
    for (auto _ : state) benchmark::DoNotOptimize(tafoni::triangulate(star).data());
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(triangulate_star)->Name("geometry/triangulate/star/double/n")->Arg(4)->Arg(32)->Arg(1024);

void build_tree(benchmark::State& state) {
    auto const s = tafoni::make_solid(torus_of(state.range(0) / 2));
    for (auto _ : state) benchmark::DoNotOptimize(tafoni::bvh(s).size());
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(build_tree)->Name("geometry/bvh/build/double/n")->Arg(20000)->Arg(200000)->Unit(benchmark::kMillisecond);

template <class Query>
void query_tree(benchmark::State& state, Query const& query) {
    auto const s = tafoni::make_solid(torus_of(state.range(0) / 2));
    tafoni::bvh const tree(s);
    tafoni::stream draw(1, tafoni::stage::user, 0);
    std::vector<vec3> points;
    for (int i = 0; i < 1024; ++i) {
        double const x = draw.uniform(-3, 3);
        double const y = draw.uniform(-3, 3);
        double const z = draw.uniform(-1, 1);
        points.push_back(vec3{x, y, z});
    }
    std::size_t i = 0;
    for (auto _ : state) query(s, tree, points[i++ % points.size()]);
    state.SetItemsProcessed(state.iterations());
}
void nearest_point(benchmark::State& state) {
    query_tree(state, [](auto const&, auto const& tree, vec3 const& p) {
        benchmark::DoNotOptimize(tree.nearest_point(p)->distance);
    });
}
void first_hit(benchmark::State& state) {
    query_tree(state, [](auto const&, auto const& tree, vec3 const& p) {
        benchmark::DoNotOptimize(tree.first_hit(p, vec3{0.3, 0.2, 0.9}).has_value());
    });
}
void tree_winding(benchmark::State& state) {
    query_tree(state, [](auto const&, auto const& tree, vec3 const& p) {
        benchmark::DoNotOptimize(tree.winding_number(p));
    });
}
void plain_winding(benchmark::State& state) {
    query_tree(state, [](auto const& s, auto const&, vec3 const& p) {
        benchmark::DoNotOptimize(tafoni::winding_number(s, p));
    });
}
BENCHMARK(nearest_point)->Name("geometry/bvh/nearest_point/double/n")->Arg(20000)->Arg(200000);
BENCHMARK(first_hit)->Name("geometry/bvh/first_hit/double/n")->Arg(20000)->Arg(200000);
BENCHMARK(tree_winding)->Name("geometry/bvh/winding_number/double/n")->Arg(20000)->Arg(200000);
BENCHMARK(plain_winding)->Name("geometry/winding_number/plain/double/n")->Arg(20000);

void list_intersections(benchmark::State& state) {
    auto const s = tafoni::make_solid(torus_of(state.range(0) / 2));
    for (auto _ : state) benchmark::DoNotOptimize(tafoni::self_intersections(s).size());
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(list_intersections)
    ->Name("geometry/self_intersections/torus/double/n")
    ->Arg(20000)
    ->Arg(200000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
