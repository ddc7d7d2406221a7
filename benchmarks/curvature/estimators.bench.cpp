// Mean curvature per vertex: 35,000 vertices of the bust (an icosphere where it is not there), and three sizes for the
// cost per vertex. Beside them what Debian packages, CGAL's jet fitting over two rings, and the loop with angles and
// lists of neighbours that everybody writes first. Ratios are ours / theirs, both timed in turn in one run.
#include "support/curved_surfaces.hpp"
#include "support/test_data.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/curvature/bubble_ratio.hpp>
#include <tafoni/curvature/cotangent.hpp>
#include <tafoni/curvature/quadric_fit.hpp>
#include <tafoni/curvature/tensor_fit.hpp>
#include <tafoni/io/read_mesh.hpp>

#include <benchmark/benchmark.h>

#ifdef TAFONI_HAVE_CGAL
#define CGAL_EIGEN3_ENABLED
#include <CGAL/Monge_via_jet_fitting.h>
#include <CGAL/Simple_cartesian.h>
#endif

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <vector>

namespace {

using namespace tafoni;

struct model {
    triangle_surface mesh{};
    vertex_rings rings{};

    explicit model(triangle_surface s) : mesh(std::move(s)), rings(mesh.positions.size(), mesh.triangles) {}
    [[nodiscard]] surface_view view() const { return {.positions = mesh.positions, .triangles = mesh.triangles, .rings = &rings}; }
};

model const& bust() {
    static model const m([] {
        auto const path = tafoni_test::find("meshes/nefertiti_35k.ply");
        return tafoni_test::triangles_of(path.empty() ? tafoni_test::icosphere(6) : read_mesh(path).mesh);
    }());
    return m;
}
model const& ball(int level) {
    static model const m[] = {model(tafoni_test::sphere(5).mesh), model(tafoni_test::sphere(6).mesh),
                              model(tafoni_test::sphere(7).mesh)};
    return m[level - 5];
}

template <class Estimator>
void estimate(benchmark::State& state, model const& m, std::size_t threads) {
    thread_pool const pool(threads);
    std::vector<double> mean(m.mesh.positions.size());
    estimator_room room;
    surface_view view = m.view();
    view.room = &room;
    for (auto _ : state) {
        if (threads == 1) Estimator{}(view, mean, inline_executor{});
        else Estimator{}(view, mean, pool);
        benchmark::DoNotOptimize(mean.data());
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mean.size()));
    state.SetComplexityN(static_cast<benchmark::IterationCount>(mean.size()));
}
template <class Estimator>
void on_bust(benchmark::State& state) { estimate<Estimator>(state, bust(), static_cast<std::size_t>(state.range(0))); }
template <class Estimator>
void on_ball(benchmark::State& state) { estimate<Estimator>(state, ball(static_cast<int>(state.range(0))), 1); }
void rings(benchmark::State& state) {
    model const& m = bust();
    for (auto _ : state) {
        vertex_rings const r(m.mesh.positions.size(), m.mesh.triangles);
        benchmark::DoNotOptimize(r.vertex_count());
    }
}

/// Cotangents from angles, barycentric areas, a list of neighbours per vertex.
std::vector<double> plain_loop(triangle_surface const& s, std::vector<std::vector<std::uint32_t>> const& faces_at) {
    std::vector<double> mean(s.positions.size());
    for (std::size_t v = 0; v < mean.size(); ++v) {
        vec3 sum{0, 0, 0};
        vec3 normal{0, 0, 0};
        double area = 0;
        for (std::uint32_t const f : faces_at[v]) {
            auto const& t = s.triangles[f];
            std::size_t const k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
            vec3 const& p = s.positions[v];
            vec3 const& q = s.positions[t[(k + 1) % 3]];
            vec3 const& r = s.positions[t[(k + 2) % 3]];
            auto const cot = [](vec3 const& at, vec3 const& a, vec3 const& b) {
                vec3 const x{a - at};
                vec3 const y{b - at};
                return 1 / std::tan(std::acos(dot(x, y) / (length(x) * length(y))));
            };
            sum += cot(r, p, q) * (p - q) + cot(q, r, p) * (p - r);
            normal += cross(q - p, r - p);
            area += length(cross(q - p, r - p)) / 6;
        }
        mean[v] = area > 0 ? dot(sum, normal) / length(normal) / (4 * area) : 0;
    }
    return mean;
}

#ifdef TAFONI_HAVE_CGAL
/// A quadric through two rings: what `quadric_fit` does, by CGAL.
std::vector<double> jets(model const& m) {
    using kernel = CGAL::Simple_cartesian<double>;
    using fitting = CGAL::Monge_via_jet_fitting<kernel>;
    std::vector<double> mean(m.mesh.positions.size());
    std::vector<std::uint32_t> near_by;
    std::vector<kernel::Point_3> points;
    for (std::size_t v = 0; v < mean.size(); ++v) {
        near_by.assign(1, static_cast<std::uint32_t>(v));
        for (std::uint32_t const w : m.rings.neighbors(v)) {
            near_by.push_back(w);
            for (std::uint32_t const u : m.rings.neighbors(w)) near_by.push_back(u);
        }
        std::sort(near_by.begin() + 1, near_by.end());
        near_by.erase(std::unique(near_by.begin() + 1, near_by.end()), near_by.end());
        points.clear();
        for (std::size_t k = 0; k < near_by.size(); ++k) {
            if (k > 0 && near_by[k] == v) continue;
            vec3 const& p = m.mesh.positions[near_by[k]];
            points.emplace_back(p[0], p[1], p[2]);
        }
        if (points.size() < 6) continue;
        fitting fit;
        auto const form = fit(points.begin(), points.end(), 2, 2);
        mean[v] = -(form.principal_curvatures(0) + form.principal_curvatures(1)) / 2;
    }
    return mean;
}
#endif

template <class F>
double seconds(F const& f) {
    auto const start = std::chrono::steady_clock::now();
    f();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <class Estimator, class Peer>
void ratio(benchmark::State& state, Peer const& peer) {
    model const& m = bust();
    std::vector<double> mean(m.mesh.positions.size());
    double ours = 1e9;
    double theirs = 1e9;
    for (auto _ : state) {
        ours = std::min(ours, seconds([&] { Estimator{}(m.view(), mean, inline_executor{}); }));
        theirs = std::min(theirs, seconds([&] { benchmark::DoNotOptimize(peer(m)); }));
    }
    state.counters["ours_ms"] = 1e3 * ours;
    state.counters["peer_ms"] = 1e3 * theirs;
    state.counters["ratio"] = ours / theirs;
}
template <class Estimator>
void to_plain_loop(benchmark::State& state) {
    model const& m = bust();
    std::vector<std::vector<std::uint32_t>> faces_at(m.mesh.positions.size());
    for (std::size_t f = 0; f < m.mesh.triangles.size(); ++f) {
        for (std::uint32_t const v : m.mesh.triangles[f]) faces_at[v].push_back(static_cast<std::uint32_t>(f));
    }
    ratio<Estimator>(state, [&](model const& x) { return plain_loop(x.mesh, faces_at); });
}

/// The table of curvature/README.md: RMS and largest error in per cent of H.
template <class Estimator>
void error(benchmark::State& state) {
    static char const* const names[] = {"icosphere 4", "icosphere 5", "icosphere 6", "torus", "jittered torus"};
    auto const k = static_cast<int>(state.range(0));
    tafoni_test::curved_surface const s =
        k < 3 ? tafoni_test::sphere(4 + k) : tafoni_test::torus_surface(200, 80, k == 3 ? 0 : 0.25);
    model const m(s.mesh);
    std::vector<double> mean(s.mean.size());
    for (auto _ : state) Estimator{}(m.view(), mean, inline_executor{});
    auto const e = tafoni_test::error_of(s, mean);
    state.counters["rms_percent"] = 100 * e.rms;
    state.counters["largest_percent"] = 100 * e.largest;
    state.SetLabel(names[k]);
}

#define TAFONI_BENCH_ESTIMATOR(estimator)                                                                   \
    BENCHMARK_TEMPLATE(on_bust, estimator)                                                                  \
        ->Name("curvature/" #estimator "/bust")->ArgName("threads")->Arg(1)->Arg(2)->Arg(4)                  \
        ->Unit(benchmark::kMillisecond)->UseRealTime();                                                     \
    BENCHMARK_TEMPLATE(on_ball, estimator)                                                                  \
        ->Name("curvature/" #estimator "/icosphere")->ArgName("level")->DenseRange(5, 7)                     \
        ->Unit(benchmark::kMillisecond)->Complexity(benchmark::oN);                                         \
    BENCHMARK_TEMPLATE(error, estimator)                                                                    \
        ->Name("curvature/" #estimator "/error")->ArgName("surface")->DenseRange(0, 4)->Iterations(1)

TAFONI_BENCH_ESTIMATOR(tensor_fit);
TAFONI_BENCH_ESTIMATOR(cotangent);
TAFONI_BENCH_ESTIMATOR(quadric_fit);
TAFONI_BENCH_ESTIMATOR(bubble_ratio);
BENCHMARK(rings)->Name("curvature/vertex_rings/bust")->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(to_plain_loop, tensor_fit)->Name("curvature/tensor_fit/ratio_to_plain_loop")->Iterations(9);
BENCHMARK_TEMPLATE(to_plain_loop, cotangent)->Name("curvature/cotangent/ratio_to_plain_loop")->Iterations(9);
#ifdef TAFONI_HAVE_CGAL
void to_cgal(benchmark::State& state) { ratio<quadric_fit>(state, jets); }
BENCHMARK(to_cgal)->Name("curvature/quadric_fit/ratio_to_cgal_jets")->Iterations(3);
#endif

}  // namespace
