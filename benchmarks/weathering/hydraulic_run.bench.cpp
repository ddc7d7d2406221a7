// Whole iterations of hydraulic erosion: the bust under 17,700 particles, and rolling ground of three sizes with as
// many drops as vertices / 2. No package of Debian erodes meshes by particles; the thesis took 291 ms for the bust.
#include "support/test_data.hpp"

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

template <class Process, class Fluid>
void measure(benchmark::State& state, triangle_surface const& mesh, Fluid fluid, Process const& process, std::uint64_t before) {
    hydraulic_run run(mesh, std::move(fluid), process);
    run.run(before);
    std::uint64_t const contacts = run.report().contacts;
    for (auto _ : state) run.run(1);
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
    measure(state, mesh, over<Fluid>(box, 17700, 1, rain ? reach : 0.8 * reach), Process{}, rain ? 150 : 1500);
}

template <class Process>
void ground(benchmark::State& state) {
    triangle_surface mesh;
    auto const n = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(state.range(0))));
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
    double const side = n - 1;
    box_emitter const from{.box = between(vec3{1, 1, 4}, vec3{side - 1, side - 1, 12})};
    box_sink const keep{.keep = between(vec3{0.5, 0.5, -9}, vec3{side - 0.5, side - 0.5, 20})};
    measure(state, mesh, rain_particles(from, keep, {.particles = n * n / 2, .radius = 0.5}), Process{}, 60);
    state.SetComplexityN(static_cast<std::int64_t>(n) * n);
}

}  // namespace

BENCHMARK(bust<partheniades_erosion, rain_particles>)->Name("weathering/hydraulic_run/bust/shear/rain")->Unit(benchmark::kMillisecond);
BENCHMARK(bust<curvature_erosion<>, rain_particles>)->Name("weathering/hydraulic_run/bust/curvature/rain")->Unit(benchmark::kMillisecond);
BENCHMARK(bust<partheniades_erosion, sph<float>>)->Name("weathering/hydraulic_run/bust/shear/sph")->Unit(benchmark::kMillisecond);
BENCHMARK(bust<curvature_erosion<>, sph<float>>)->Name("weathering/hydraulic_run/bust/curvature/sph")->Unit(benchmark::kMillisecond);
BENCHMARK(ground<curvature_erosion<>>)->Name("weathering/hydraulic_run/ground/curvature/rain")->ArgName("n")
    ->Arg(16000)->Arg(32000)->Arg(64000)->Complexity(benchmark::oN)->Unit(benchmark::kMillisecond);
BENCHMARK(ground<partheniades_erosion>)->Name("weathering/hydraulic_run/ground/shear/rain")->ArgName("n")
    ->Arg(16000)->Arg(32000)->Arg(64000)->Complexity(benchmark::oN)->Unit(benchmark::kMillisecond);
