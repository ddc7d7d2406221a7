#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/voxel/colluvium.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

using namespace tafoni;

namespace {

/// What falls from a bust in 20 steps: a head on a neck on shoulders, rough, 256 high, on the ground.
struct crumbling_bust {
    static constexpr int n = 256;
    static constexpr std::size_t steps = 20;

    sparse_grid grid;
    std::vector<std::vector<voxel>> released{};
    std::vector<std::vector<voxel>> opened{};
    std::size_t grains = 0;

    crumbling_bust()
        : grid({.size = {n, n, n}}, up_axis::plus_z,
               {{border_kind::air, border_kind::air, border_kind::air, border_kind::air, border_kind::rock, border_kind::air}}) {
        for (std::size_t b = 0; b < grid.brick_count(); ++b) {
            grid.fill_brick(b, [](voxel v) { return is_stone(v) ? voxel_state::rock : voxel_state::air; });
        }
        sparse_grid g = grid;
        std::vector<voxel_change> changes;
        for (std::size_t s = 0; s < steps; ++s) {
            released.push_back(skin(g, s));
            opened.push_back(released.back());
            for (std::size_t b = 0; b < g.brick_count(); ++b) {
                voxel const low = g.brick_corner(b);
                for (int i = 0; i < 32768; ++i) {
                    voxel const v{low.x + i % 32, low.y + i / 32 % 32, low.z + i / 1024};
                    if (g.state(v) != voxel_state::colluvium) continue;
                    if (g.state({v.x, v.y, v.z + 1}) != voxel_state::air) continue;
                    stream draw(s, stage::user + 1, detail::voxel_key(v));
                    if (draw.chance(0.1)) opened.back().push_back(v);
                }
            }
            std::sort(opened.back().begin(), opened.back().end());
            for (voxel const v : opened.back()) g.set(v, voxel_state::air);
            changes.clear();
            settle(g, released.back(), opened.back(), {}, 1, s, inline_executor{}, changes);
            grains += released.back().size();
        }
    }

    static bool is_stone(voxel v) {
        auto const square = [](double a) { return a * a; };
        double const x = v.x - 128 + 3 * static_cast<double>(detail::scatter(static_cast<std::uint64_t>((v.x >> 3) + 64 * (v.y >> 3) + 4096 * (v.z >> 3))) >> 40) * 0x1p-24;
        double const y = v.y - 128;
        double const z = v.z;
        double const neck = z < 170 ? 30 : 0;
        double const r = square(x) + square(y);
        return (square(x) / square(95) + square(y) / square(60) + square(z) / square(110) < 1) || r < square(neck) ||
               (r + square(z - 190) * 0.8 < square(55));
    }
    static std::vector<voxel> skin(sparse_grid const& g, std::uint64_t step) {
        std::vector<voxel> out;
        for (std::size_t b = 0; b < g.brick_count(); ++b) {
            voxel const low = g.brick_corner(b);
            if (g.stored(b) == nullptr) continue;
            for (int i = 0; i < 32768; ++i) {
                voxel const v{low.x + i % 32, low.y + i / 32 % 32, low.z + i / 1024};
                if (!g.is_rock(v)) continue;
                bool open = false;
                for (voxel const d : {voxel{1, 0, 0}, voxel{-1, 0, 0}, voxel{0, 1, 0}, voxel{0, -1, 0}, voxel{0, 0, 1}, voxel{0, 0, -1}}) {
                    open = open || !g.is_solid(v + d);
                }
                stream draw(step, stage::user, detail::voxel_key(v));
                if (open && draw.chance(0.4)) out.push_back(v);
            }
        }
        std::sort(out.begin(), out.end());
        return out;
    }
};

crumbling_bust const& bust() {
    static crumbling_bust const scene;
    return scene;
}

void settle_bust(benchmark::State& state) {
    auto const& scene = bust();
    thread_pool const pool(static_cast<std::size_t>(state.range(0)));
    repose_rule const rule{.angle = 45, .baseline = static_cast<int>(state.range(1))};
    settle_report total;
    for (auto _ : state) {
        sparse_grid g = scene.grid;
        total = {};
        double seconds = 0;
        for (std::size_t s = 0; s < crumbling_bust::steps; ++s) {
            std::vector<voxel> released;
            for (voxel const v : scene.opened[s]) {
                if (g.is_rock(v)) released.push_back(v);
                g.set(v, voxel_state::air);
            }
            std::vector<voxel_change> changes;
            auto const begin = std::chrono::steady_clock::now();
            auto const r = settle(g, released, scene.opened[s], rule, 1, s, pool, changes);
            seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
            total.deposited += r.deposited;
            total.left += r.left;
            total.moved += r.moved;
        }
        state.SetIterationTime(seconds);
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(scene.grains));
    state.counters["grains"] = static_cast<double>(scene.grains);
    state.counters["left"] = static_cast<double>(total.left);
    state.counters["moved"] = static_cast<double>(total.moved);
}

}  // namespace

BENCHMARK(settle_bust)
    ->Name("voxel/colluvium/bust/threads:baseline")
    ->Args({1, 1})->Args({2, 1})->Args({4, 1})->Args({1, 4})->Args({4, 4})
    ->UseManualTime()->Unit(benchmark::kMillisecond);
