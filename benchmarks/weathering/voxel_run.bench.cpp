// Voxel weathering: a step of the paper's column (23,452 voxels at or one below the surface) beside the paper's
// times and its loop, the bust of Nefertiti, and how a step grows with the resolution.
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/io/read_ply.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/voxel/fill_from_predicate.hpp>
#include <tafoni/voxel/fill_from_solid.hpp>
#include <tafoni/voxel/frame_for.hpp>
#include <tafoni/weathering/voxel_run.hpp>

#include <support/test_data.hpp>

#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace {

using namespace tafoni;

constexpr grid_border on_ground{{border_kind::air, border_kind::air, border_kind::air, border_kind::air,
                                 border_kind::rock, border_kind::air}};

/// A column with a waist, about 23,450 voxels of it at the surface or one below.
sparse_grid column() {
    sparse_grid g({.size = {80, 80, 100}}, up_axis::plus_z, on_ground);
    for (std::size_t b = 0; b < g.brick_count(); ++b) {
        g.fill_brick(b, [](voxel v) {
            double const x = v.x - 39.5;
            double const y = v.y - 39.5;
            double const h = v.z / 46.0 - 1;
            double const r = 19.6 + 6 * h * h;
            return v.z < 92 && x * x + y * y < r * r ? voxel_state::rock : voxel_state::air;
        });
    }
    return g;
}

voxel_weathering<> process(double radius) {
    return {.bubbles = {sphere_bubble{.radius = radius}}, .durability = {.value = 0.03}};
}

/// One cycle as the paper describes it: a Boolean cube per bubble, asked for every voxel of the surface; seconds.
double paper_loop(voxel_run<> const& run) {
    sparse_grid const& grid = run.grid();
    bubble_stencil const& b = run.process().bubbles.stencils()[0];
    int const r = b.reach();
    int const wide = 2 * r + 1;
    std::vector<char> inside(static_cast<std::size_t>(wide * wide * wide));
    auto const at = [=](int x, int y, int z) { return static_cast<std::size_t>(x + r + wide * (y + r + wide * (z + r))); };
    for (int z = -r; z <= r; ++z) {
        for (int y = -r; y <= r; ++y) {
            for (int x = -r; x <= r; ++x) inside[at(x, y, z)] = b.contains(x, y, z) ? 1 : 0;
        }
    }
    auto const& n = grid.size();
    auto const stride_y = n[0] + 2 * static_cast<std::size_t>(r);
    auto const stride_z = stride_y * (n[1] + 2 * static_cast<std::size_t>(r));
    std::vector<char> rock(stride_z * (n[2] + 2 * static_cast<std::size_t>(r)));
    auto const index = [=](int x, int y, int z) {
        return static_cast<std::size_t>(x + r) + stride_y * static_cast<std::size_t>(y + r) + stride_z * static_cast<std::size_t>(z + r);
    };
    for (int z = -r; z < static_cast<int>(n[2]) + r; ++z) {
        for (int y = -r; y < static_cast<int>(n[1]) + r; ++y) {
            for (int x = -r; x < static_cast<int>(n[0]) + r; ++x) rock[index(x, y, z)] = grid.is_solid({x, y, z}) ? 1 : 0;
        }
    }
    auto const skin = run.skin();
    std::vector<double> left(skin.size());
    auto const start = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < skin.size(); ++i) {
        int air = 0;
        voxel const v = skin[i].at;
        for (int z = -r; z <= r; ++z) {
            for (int y = -r; y <= r; ++y) {
                for (int x = -r; x <= r; ++x) {
                    if (inside[at(x, y, z)] != 0 && rock[index(v.x + x, v.y + y, v.z + z)] == 0) ++air;
                }
            }
        }
        double const c = air / static_cast<double>(b.size());
        left[i] = skin[i].decimation - 3 * c * c * c / skin[i].durability;
    }
    benchmark::DoNotOptimize(left.data());
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Arguments: radius, colluvium. Times 15 steps of the column.
void column_step(benchmark::State& state) {
    constexpr std::uint64_t steps = 15;
    sparse_grid const rock = column();
    voxel_options options{.skin_depth = 2};
    if (state.range(1) != 0) options.colluvium = repose_rule{};
    auto const radius = static_cast<double>(state.range(0));
    double total = 0;
    std::uint64_t skin = 0;
    for (auto _ : state) {
        voxel_run<> run(rock, process(radius), options);
        skin = run.report().surface_voxels;
        double const took = run.run({.phases = {{.steps = steps}}}).seconds.run;
        state.SetIterationTime(took / steps);
        total += took / steps;
    }
    double const mean = total / static_cast<double>(state.iterations());
    state.counters["surface_voxels"] = static_cast<double>(skin);
    state.counters["x_faster_than_paper"] = (radius < 5 ? 0.2 : 3.0) / mean;
    voxel_run<> const fresh(rock, process(radius), options);
    state.counters["x_faster_than_its_loop_here"] = paper_loop(fresh) / mean;
}
BENCHMARK(column_step)->Name("weathering/voxel_run/column_step/double/radius/colluvium")->ArgsProduct({{3, 7}, {0, 1}})->UseManualTime()->Unit(benchmark::kMillisecond);

/// The bust where the data is there, else an egg.
sparse_grid const& bust(std::size_t resolution) {
    static std::map<std::size_t, sparse_grid> made;
    if (auto const at = made.find(resolution); at != made.end()) return at->second;
    auto const path = tafoni_test::find("meshes/nefertiti_35k.ply");
    grid_border const ground{{border_kind::air, border_kind::air, border_kind::rock, border_kind::air, border_kind::air, border_kind::air}};
    if (path.empty()) {
        auto const n = static_cast<double>(resolution);
        sparse_grid g({.size = {resolution / 2, resolution, resolution / 2}}, up_axis::plus_y, ground);
        fill_from_predicate(g, [n](vec3 const& p) {
            double const x = (p[0] - n / 4) / (n / 4.2);
            double const y = (p[1] - n / 2) / (n / 2.1);
            double const z = (p[2] - n / 4) / (n / 4.2);
            return x * x + y * y + z * z < 1;
        });
        return made.emplace(resolution, std::move(g)).first->second;
    }
    solid const body = make_solid(read_ply(path).mesh);
    sparse_grid g(frame_for(body.bounds, resolution), up_axis::plus_y, ground);
    fill_from_solid(g, body);
    return made.emplace(resolution, std::move(g)).first->second;
}

/// Arguments: resolution, threads, colluvium. Times 50 steps, r = 5.
void bust_run(benchmark::State& state) {
    sparse_grid const& rock = bust(static_cast<std::size_t>(state.range(0)));
    thread_pool const pool(static_cast<std::size_t>(state.range(1)));
    voxel_report r;
    for (auto _ : state) {
        voxel_options options;
        if (state.range(2) != 0) options.colluvium = repose_rule{};
        voxel_run<> run(rock, process(5), options, pool);
        r = run.run({.phases = {{.steps = 50}}}, {}, pool);
        state.SetIterationTime(r.seconds.run);
    }
    state.counters["surface_voxels"] = static_cast<double>(r.surface_voxels);
    state.counters["ns_per_surface_voxel_and_step"] = r.seconds.run * 1e9 / 50 / static_cast<double>(r.surface_voxels);
    state.counters["settle_share"] = r.seconds.settle / r.seconds.run;
    state.counters["notify_share"] = r.seconds.notify / r.seconds.run;
}
BENCHMARK(bust_run)->Name("weathering/voxel_run/bust_50_steps/double/n/threads/colluvium")->ArgsProduct({{128, 256, 512}, {1, 2, 4}, {0, 1}})->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
