// Whole iterations of hydraulic erosion: the bust under 17,700 particles, and rolling ground of three sizes with as
// many drops as vertices / 2; and the search for the faces and vertices that two particles per vertex affect. No package
// of Debian erodes meshes by particles; the thesis took 291 ms for the bust, and 35 to 371 ms for the search.
#include "support/test_data.hpp"

#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/fluid/rain_particles.hpp>
#include <tafoni/fluid/sph.hpp>
#include <tafoni/io/read_mesh.hpp>
#include <tafoni/weathering/hydraulic_run.hpp>

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <vector>

using namespace tafoni;

namespace {

box3 between(vec3 const& lo, vec3 const& hi) {
    box3 b;
    b.lo = lo;
    b.hi = hi;
    return b;
}

template <class Fluid>
Fluid over(box3 const& box, std::uint32_t particles, int up, double reach) {
    double const size = box.extent().maxCoeff();
    box_emitter from{.box = between(box.centre() - 0.25 * box.extent(), box.centre() + 0.25 * box.extent())};
    from.box.lo[up] = box.hi[up] + 0.02 * size;
    from.box.hi[up] = box.hi[up] + 0.3 * size;
    box_sink const keep{.keep = between(box.lo - vec3::Constant(0.1 * size), box.hi + vec3::Constant(0.4 * size))};
    vec3 down{0, 0, 0};
    down[up] = -9.81 * size;
    if constexpr (std::is_same_v<Fluid, rain_particles>) {
        return rain_particles(from, keep, {.particles = particles, .radius = reach, .gravity = down});
    } else {
        return Fluid(from, keep, {.particles = particles, .spacing = reach, .gravity = down});
    }
}

triangle_surface rolling_ground(std::uint32_t n) {
    triangle_surface mesh;
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) mesh.positions.push_back(vec3{1.0 * i, 1.0 * j, 3 * std::sin(0.13 * i) * std::cos(0.11 * j)});
    }
    for (std::uint32_t j = 0; j + 1 < n; ++j) {
        for (std::uint32_t i = 0; i + 1 < n; ++i) {
            std::uint32_t const a = i + n * j;
            mesh.triangles.push_back({a, a + 1, a + n + 1});
            mesh.triangles.push_back({a, a + n + 1, a + n});
        }
    }
    return mesh;
}
std::uint32_t side_of(benchmark::State const& state) { return static_cast<std::uint32_t>(std::sqrt(static_cast<double>(state.range(0)))); }

/// Particles that stand still over rolling ground, no higher than `height`; they reach 0.5.
struct hanging {
    std::vector<vec3> at{};
    explicit hanging(std::uint32_t n, std::uint32_t count, double height) {
        stream random(3, 0, 0);
        for (std::uint32_t k = 0; k < count; ++k) {
            double const x = random.uniform(1, n - 2.0);
            double const y = random.uniform(1, n - 2.0);
            double const z = random.uniform(0, height);
            at.push_back(vec3{x, y, 3 * std::sin(0.13 * x) * std::cos(0.11 * y) + z});
        }
    }
    std::size_t particle_count() const { return at.size(); }
    vec3 position(std::size_t i) const { return at[i]; }
    vec3 velocity(std::size_t) const { return {0, 0, 0}; }
    double reach() const { return 0.5; }
};

void affected(benchmark::State& state, double particles, double height) {
    std::uint32_t const n = side_of(state);
    triangle_surface const mesh = rolling_ground(n);
    hanging const water(n, static_cast<std::uint32_t>(particles * n * n), height);
    mesh_boundary const walls(mesh.positions, mesh.triangles, water.reach());
    thread_pool const pool(static_cast<std::size_t>(state.range(1)));
    detail::water_contacts contacts;
    detail::near_water near_by;
    std::vector<double> square(mesh.positions.size());
    for (auto _ : state) {
        contacts.find(curvature_erosion<>{}, water, walls, {}, {}, 1, pool);
        near_by.find(contacts.points(), mesh.positions, 1, square, pool);
        benchmark::DoNotOptimize(square.data());
    }
    state.counters["vertices"] = static_cast<double>(mesh.positions.size());
    state.counters["particles"] = static_cast<double>(water.particle_count());
    state.counters["contacts"] = static_cast<double>(contacts.count());
    if (state.range(1) == 1) state.SetComplexityN(static_cast<std::int64_t>(n) * n);
}

template <class Process, class Fluid>
void measure(benchmark::State& state, triangle_surface const& mesh, Fluid fluid, Process const& process, std::uint64_t before, std::size_t threads = 1) {
    hydraulic_run run(mesh, std::move(fluid), process);
    thread_pool const pool(threads);
    run.run(before);
    std::uint64_t const contacts = run.report().contacts;
    for (auto _ : state) run.run(1, {}, pool);
    state.counters["vertices"] = static_cast<double>(mesh.positions.size());
    state.counters["particles"] = static_cast<double>(run.report().particles);
    state.counters["contacts"] =
        static_cast<double>(run.report().contacts - contacts) / static_cast<double>(run.report().iterations - before);
}

template <class Process, class Fluid>
void bust(benchmark::State& state) {
    auto const path = tafoni_test::find("meshes/nefertiti_35k.ply");
    if (path.empty()) return state.SkipWithError("nefertiti_35k.ply was not found");
    triangle_surface const mesh = triangle_surface::copy_of(read_mesh(path).mesh);
    box3 box;
    for (vec3 const& p : mesh.positions) box.include(p);
    double const reach = mesh.mean_edge_length();
    bool const rain = std::is_same_v<Fluid, rain_particles>;
    measure(state, mesh, over<Fluid>(box, 17700, 1, rain ? reach : 0.8 * reach), Process{}, rain ? 150 : 1500, static_cast<std::size_t>(state.range(0)));
}

template <class Process>
void ground(benchmark::State& state) {
    std::uint32_t const n = side_of(state);
    triangle_surface const mesh = rolling_ground(n);
    double const side = n - 1;
    box_emitter const from{.box = between(vec3{1, 1, 4}, vec3{side - 1, side - 1, 12})};
    box_sink const keep{.keep = between(vec3{0.5, 0.5, -9}, vec3{side - 0.5, side - 0.5, 20})};
    measure(state, mesh, rain_particles(from, keep, {.particles = n * n / 2, .radius = 0.5}), Process{}, 60);
    state.SetComplexityN(static_cast<std::int64_t>(n) * n);
}

}  // namespace

BENCHMARK(bust<partheniades_erosion, rain_particles>)->Name("weathering/hydraulic_run/bust/shear/rain")->ArgName("threads")->Arg(1)->Arg(2)->Arg(4)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(bust<curvature_erosion<>, rain_particles>)->Name("weathering/hydraulic_run/bust/curvature/rain")->ArgName("threads")->Arg(1)->Arg(2)->Arg(4)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(bust<partheniades_erosion, sph<float>>)->Name("weathering/hydraulic_run/bust/shear/sph")->ArgName("threads")->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(bust<curvature_erosion<>, sph<float>>)->Name("weathering/hydraulic_run/bust/curvature/sph")->ArgName("threads")->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(ground<curvature_erosion<>>)->Name("weathering/hydraulic_run/ground/curvature/rain")->ArgName("n")
    ->Arg(16000)->Arg(32000)->Arg(64000)->Complexity(benchmark::oN)->Unit(benchmark::kMillisecond);
BENCHMARK(ground<partheniades_erosion>)->Name("weathering/hydraulic_run/ground/shear/rain")->ArgName("n")
    ->Arg(16000)->Arg(32000)->Arg(64000)->Complexity(benchmark::oN)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(affected, , 2, 4)->Name("weathering/hydraulic_run/affected")->ArgNames({"n", "threads"})
    ->Args({17500, 1})->Args({35000, 1})->Args({70000, 1})->Complexity(benchmark::oN)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(affected, , 2, 4)->Name("weathering/hydraulic_run/affected_on_threads")->ArgNames({"n", "threads"})
    ->Args({35000, 2})->Args({35000, 4})->Unit(benchmark::kMillisecond)->UseRealTime();
// All particles touch; a twentieth of them does; ten times as many; a tenth.
BENCHMARK_CAPTURE(affected, , 2, 0.5)->Name("weathering/hydraulic_run/affected_under_water")->ArgNames({"n", "threads"})->Args({35000, 1})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(affected, , 2, 10)->Name("weathering/hydraulic_run/affected_by_rain")->ArgNames({"n", "threads"})->Args({35000, 1})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(affected, , 20, 4)->Name("weathering/hydraulic_run/affected_by_many")->ArgNames({"n", "threads"})->Args({35000, 1})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(affected, , 0.2, 4)->Name("weathering/hydraulic_run/affected_by_few")->ArgNames({"n", "threads"})->Args({35000, 1})->Unit(benchmark::kMillisecond);
