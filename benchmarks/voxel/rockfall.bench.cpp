// Rockfall while the skin of a column goes: what a removed voxel costs must not grow with the grid. Beside it a
// look at the whole grid by bricks, and the flood by voxels that everybody writes first.
#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/voxel/rockfall.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace {

using namespace tafoni;

constexpr grid_border on_the_ground{{border_kind::air, border_kind::air, border_kind::air, border_kind::air,
                                     border_kind::rock, border_kind::air}};

/// A column with a cap, its skin two voxels deep full of holes.
sparse_grid column(std::int32_t n) {
    auto const size = static_cast<std::size_t>(n);
    sparse_grid g({.size = {size, size, size}}, up_axis::plus_z, on_the_ground);
    for (std::size_t b = 0; b < g.brick_count(); ++b) {
        g.fill_brick(b, [&](voxel v) {
            double const x = v.x + 0.5 - 0.5 * n;
            double const y = v.y + 0.5 - 0.5 * n;
            double const r = n * (v.z > n * 3 / 4 ? 0.4 : 0.3);
            double const inner = r - 2;
            if (x * x + y * y < inner * inner && v.z < n - 4) return voxel_state::rock;
            stream rough(7, stage::user,
                         static_cast<std::uint64_t>(v.x) +
                             4096 * (static_cast<std::uint64_t>(v.y) + 4096 * static_cast<std::uint64_t>(v.z)));
            return x * x + y * y < r * r && v.z < n - 2 && rough.uniform01() > 0.2 ? voxel_state::rock
                                                                                   : voxel_state::air;
        });
        g.compact(b);
    }
    return g;
}

/// `count` voxels of the skin, anywhere.
std::vector<voxel> bite(sparse_grid const& g, stream& draw, std::size_t count) {
    std::vector<voxel> out;
    auto const n = g.size()[0];
    while (out.size() < count) {
        voxel v;
        v.x = static_cast<std::int32_t>(draw.index_below(n));
        v.y = static_cast<std::int32_t>(draw.index_below(n));
        v.z = static_cast<std::int32_t>(draw.index_below(n));
        auto const dir = static_cast<std::int32_t>(draw.index_below(2)) * 2 - 1;  // on, along x, to the next skin
        while (g.contains(v) &&
               !(g.is_rock(v) && (!g.is_rock(v + voxel{dir, 0, 0}) || !g.is_rock(v - voxel{dir, 0, 0}))))
            v.x += dir;
        if (g.contains(v)) out.push_back(v);
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

void take(sparse_grid& g, std::span<voxel const> gone) {
    for (voxel const v : gone) g.set(v, voxel_state::air);
}

/// A dozen discs as wide as half of the grid.
rockfall_options jointed(std::int64_t n, double friction) {
    rockfall_options out{.friction_angle = friction};
    stream draw(3, stage::user, 0);
    auto const edge = static_cast<double>(n);
    for (std::int64_t i = 0; i < 12; ++i) {
        vec3 const normal = draw.unit_vector();
        double const x = draw.uniform(0.2, 0.8);
        double const y = draw.uniform(0.2, 0.8);
        double const z = draw.uniform(0.1, 0.9);
        out.joints.discs.push_back({.centre = {x * edge, y * edge, z * edge}, .normal = normal, .radius = edge / 4});
    }
    return out;
}

void followed(benchmark::State& state, double friction) {
    rockfall_options const options = friction < 0 ? rockfall_options{} : jointed(state.range(0), friction);
    sparse_grid g = column(static_cast<std::int32_t>(state.range(0)));
    rockfall fall(options);
    std::vector<voxel_change> changes;
    fall.fall(g, {}, 0, inline_executor{}, changes);
    stream draw(1, stage::user, 0);
    std::size_t removed = 0;
    std::size_t fallen = 0;
    std::uint64_t step = 1;
    auto const before = fall.effort();
    for (auto _ : state) {
        state.PauseTiming();
        auto const gone = bite(g, draw, static_cast<std::size_t>(state.range(1)));
        take(g, gone);
        removed += gone.size();
        changes.clear();
        state.ResumeTiming();
        benchmark::DoNotOptimize(fall.fall(g, gone, step++, inline_executor{}, changes));
        fallen += changes.size();
    }
    auto const after = fall.effort();
    auto const per = [&](std::size_t a, std::size_t b) {
        return static_cast<double>(a - b) / static_cast<double>(removed);
    };
    state.counters["per_removed"] =
        benchmark::Counter(static_cast<double>(removed), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    state.counters["fallen"] = static_cast<double>(fallen) / static_cast<double>(removed);
    state.counters["open"] = per(after.voxels_searched, before.voxels_searched);
    state.counters["bricks"] = per(after.bricks_labelled, before.bricks_labelled);
    state.counters["faces"] = per(after.faces_passed, before.faces_passed);
}

void by_bricks(benchmark::State& state, std::size_t threads) {
    sparse_grid g = column(static_cast<std::int32_t>(state.range(0)));
    thread_pool pool(threads);
    std::vector<voxel_change> changes;
    rockfall fall;
    for (auto _ : state) {
        fall.restart();
        benchmark::DoNotOptimize(fall.fall(g, {}, 0, pool, changes));
    }
}

void by_voxels(benchmark::State& state) {
    sparse_grid const g = column(static_cast<std::int32_t>(state.range(0)));
    auto const n = static_cast<std::int32_t>(state.range(0));
    for (auto _ : state) {
        std::vector<bool> seen(static_cast<std::size_t>(n) * static_cast<std::size_t>(n) * static_cast<std::size_t>(n));
        auto const at = [&](voxel v) {
            return static_cast<std::size_t>(v.x) +
                   static_cast<std::size_t>(n) *
                       (static_cast<std::size_t>(v.y) + static_cast<std::size_t>(n) * static_cast<std::size_t>(v.z));
        };
        std::vector<voxel> due;
        for (std::int32_t y = 0; y < n; ++y) {
            for (std::int32_t x = 0; x < n; ++x) {
                if (!g.is_rock({x, y, 0})) continue;
                seen[at({x, y, 0})] = true;
                due.push_back({x, y, 0});
            }
        }
        while (!due.empty()) {
            voxel const v = due.back();
            due.pop_back();
            for (voxel const d :
                 {voxel{1, 0, 0}, voxel{-1, 0, 0}, voxel{0, 1, 0}, voxel{0, -1, 0}, voxel{0, 0, 1}, voxel{0, 0, -1}}) {
                voxel const w = v + d;
                if (!g.contains(w) || seen[at(w)] || !g.is_rock(w)) continue;
                seen[at(w)] = true;
                due.push_back(w);
            }
        }
        benchmark::DoNotOptimize(seen.size());
    }
}

BENCHMARK_CAPTURE(followed, whole_rock, -1.0)
    ->Name("voxel/rockfall/followed")
    ->ArgNames({"n", "removed"})
    ->ArgsProduct({{64, 128, 256, 512}, {100, 2000}})
    ->Iterations(40)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(followed, jointed, 30.0)
    ->Name("voxel/rockfall/followed/joints:12/friction:30")
    ->ArgNames({"n", "removed"})
    ->ArgsProduct({{64, 128, 256, 512}, {2000}})
    ->Iterations(40)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(by_bricks, one, 1)
    ->Name("voxel/rockfall/whole/bricks")
    ->ArgName("n")
    ->RangeMultiplier(2)
    ->Range(64, 512)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(by_bricks, four, 4)
    ->Name("voxel/rockfall/whole/bricks/threads:4")
    ->ArgName("n")
    ->RangeMultiplier(2)
    ->Range(64, 512)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(by_voxels)
    ->Name("voxel/rockfall/whole/voxels")
    ->ArgName("n")
    ->RangeMultiplier(2)
    ->Range(64, 512)
    ->Unit(benchmark::kMillisecond);

}  // namespace
