#include <tafoni/core/random.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/voxel/detail/air_counter.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <vector>

using namespace tafoni;
using detail::kernel_set;

namespace {

struct brick_skin {
    std::size_t brick = 0;
    std::vector<detail::brick_position> position{};
    std::vector<std::uint32_t> air{};
};

/// A column of 256^3 voxels with a waist and shoulders; 179,000 voxels of its rock have a face to the air.
struct hoodoo {
    static constexpr int n = 256;
    static constexpr int pad = 48;
    static constexpr int wide = n + 2 * pad;

    sparse_grid grid{grid_frame{.size = {n, n, n}}};
    std::vector<brick_skin> skins{};
    std::vector<voxel> surface{};
    std::vector<std::uint8_t> air_around{};  ///< for the peers: a byte per voxel, padded so that no index is checked

    hoodoo() {
        for (std::size_t b = 0; b < grid.brick_count(); ++b) {
            grid.fill_brick(b, [](voxel v) { return is_rock(v) ? voxel_state::rock : voxel_state::air; });
        }
        for (std::size_t b = 0; b < grid.brick_count(); ++b) {
            brick_skin skin{.brick = b};
            for (int i = 0; i < 32768; ++i) {
                auto const p = static_cast<detail::brick_position>(i);
                voxel const v = detail::at_position(grid.brick_corner(b), p);
                if (is_skin(v)) skin.position.push_back(p);
            }
            if (skin.position.empty()) continue;
            for (auto const p : skin.position) surface.push_back(detail::at_position(grid.brick_corner(b), p));
            skin.air.resize(skin.position.size());
            skins.push_back(std::move(skin));
        }
        air_around.assign(static_cast<std::size_t>(wide) * wide * wide, 1);
        for (int z = 0; z < n; ++z) {
            for (int y = 0; y < n; ++y) {
                for (int x = 0; x < n; ++x) {
                    if (grid.is_solid({x, y, z})) air_around[index({x, y, z})] = 0;
                }
            }
        }
    }

    static bool is_rock(voxel v) {
        double const x = v.x - 127.5;
        double const y = v.y - 127.5;
        double const radius = 86 + 4 * ((v.z / 64) % 2) + (v.z > 230 ? 3 : 0);
        return v.z < 250 && x * x + y * y < radius * radius;
    }
    [[nodiscard]] bool is_skin(voxel v) const {
        return grid.is_solid(v) && !(grid.is_solid(v + voxel{1, 0, 0}) && grid.is_solid(v + voxel{-1, 0, 0}) &&
                                     grid.is_solid(v + voxel{0, 1, 0}) && grid.is_solid(v + voxel{0, -1, 0}) &&
                                     grid.is_solid(v + voxel{0, 0, 1}) && grid.is_solid(v + voxel{0, 0, -1}));
    }
    static std::size_t index(voxel v) {
        return static_cast<std::size_t>(v.x + pad + wide * (v.y + pad + wide * (v.z + pad)));
    }

    void recount(detail::air_counter& counter, bubble_stencil const& bubble) {
        for (brick_skin& s : skins) counter.recount(grid, s.brick, {&bubble, 1}, {s.position, {}, s.air});
    }
    [[nodiscard]] std::uint64_t total() const {
        std::uint64_t sum = 0;
        for (brick_skin const& s : skins) {
            for (std::uint32_t const a : s.air) sum += a;
        }
        return sum;
    }
};

hoodoo& column() {
    static hoodoo one;
    return one;
}

/// The paper's: three loops over a cube of Booleans [Jones et al., sections 4.1 and 4.2].
std::uint64_t loops_over_cube(hoodoo const& h, bubble_stencil const& bubble) {
    int const r = bubble.reach();
    int const edge = 2 * r + 1;
    std::vector<std::uint8_t> cube(static_cast<std::size_t>(edge * edge * edge));
    for (int z = -r; z <= r; ++z) {
        for (int y = -r; y <= r; ++y) {
            for (int x = -r; x <= r; ++x) {
                cube[static_cast<std::size_t>(x + r + edge * (y + r + edge * (z + r)))] =
                    bubble.contains(x, y, z) ? 1 : 0;
            }
        }
    }
    std::uint64_t total = 0;
    for (voxel const v : h.surface) {
        std::uint32_t air = 0;
        for (int z = 0; z < edge; ++z) {
            for (int y = 0; y < edge; ++y) {
                for (int x = 0; x < edge; ++x) {
                    if (cube[static_cast<std::size_t>(x + edge * (y + edge * z))] == 0) continue;
                    if (h.air_around[hoodoo::index(v + voxel{x - r, y - r, z - r})] != 0) ++air;
                }
            }
        }
        benchmark::DoNotOptimize(air);
        total += air;
    }
    return total;
}

/// A list of the offsets that are inside.
std::uint64_t offset_list(hoodoo const& h, bubble_stencil const& bubble) {
    std::vector<std::ptrdiff_t> offsets;
    int const r = bubble.reach();
    for (int z = -r; z <= r; ++z) {
        for (int y = -r; y <= r; ++y) {
            for (int x = -r; x <= r; ++x) {
                if (bubble.contains(x, y, z)) offsets.push_back(x + hoodoo::wide * (y + hoodoo::wide * z));
            }
        }
    }
    std::uint64_t total = 0;
    for (voxel const v : h.surface) {
        std::uint8_t const* const at = h.air_around.data() + hoodoo::index(v);
        std::uint32_t air = 0;
        for (std::ptrdiff_t const o : offsets) air += at[o];
        benchmark::DoNotOptimize(air);
        total += air;
    }
    return total;
}

bubble_stencil sphere(benchmark::State const& state) { return sphere_bubble{.radius = double(state.range(0))}; }

void recount(benchmark::State& state, kernel_set kernels) {
    if (kernels > detail::best_kernel_set()) return state.SkipWithError("this machine lacks the instructions");
    hoodoo& h = column();
    bubble_stencil const bubble = sphere(state);
    detail::air_counter counter(kernels);
    for (auto _ : state) h.recount(counter, bubble);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(h.surface.size()));
    state.counters["surface"] = double(h.surface.size());
}
BENCHMARK_CAPTURE(recount, portable, kernel_set::portable)
    ->Name("voxel/bubble/recount/portable/r")
    ->Arg(3)
    ->Arg(7)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(recount, popcnt, kernel_set::popcnt)
    ->Name("voxel/bubble/recount/popcnt/r")
    ->Arg(3)
    ->Arg(7)
    ->Arg(16)
    ->Arg(32)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(recount, avx2, kernel_set::avx2)
    ->Name("voxel/bubble/recount/avx2/r")
    ->Arg(3)
    ->Arg(7)
    ->Arg(16)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(recount, avx512, kernel_set::avx512)
    ->Name("voxel/bubble/recount/avx512/r")
    ->Arg(3)
    ->Arg(5)
    ->Arg(7)
    ->Arg(9)
    ->Arg(12)
    ->Arg(16)
    ->Arg(32)
    ->Unit(benchmark::kMillisecond);

// All in turn, so that the ratios come from one run on one machine; counts are compared as well.
void ratio(benchmark::State& state) {
    // Time on the processor, so that what else runs on the machine counts less.
    auto const now = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
    hoodoo& h = column();
    bubble_stencil const bubble = sphere(state);
    detail::air_counter counter;
    double ours = 1e30;
    double cube = 1e30;
    double list = 1e30;
    for (auto _ : state) {
        double const t0 = now();
        for (int k = 0; k < 20; ++k) h.recount(counter, bubble);
        double const t1 = now();
        std::uint64_t const a = loops_over_cube(h, bubble);
        double const t2 = now();
        std::uint64_t const b = offset_list(h, bubble);
        double const t3 = now();
        if (a != h.total() || b != a) state.SkipWithError("the counts differ");
        ours = std::min(ours, (t1 - t0) / 20);
        cube = std::min(cube, t2 - t1);
        list = std::min(list, t3 - t2);
    }
    double const millions = 1e-6 * double(h.surface.size());
    state.counters["M_per_s"] = millions / ours;
    state.counters["cube_M_per_s"] = millions / cube;
    state.counters["offsets_M_per_s"] = millions / list;
    state.counters["ratio_to_cube"] = cube / ours;
    state.counters["ratio_to_offsets"] = list / ours;
}
BENCHMARK(ratio)
    ->Name("voxel/bubble/ratio_to_loops/r")
    ->Arg(3)
    ->Arg(5)
    ->Arg(7)
    ->Iterations(5)
    ->Unit(benchmark::kMillisecond);

// Where telling the neighbours of what has changed costs as much as counting again: so many of 1000 voxels
// of the surface open.
void notify(benchmark::State& state) {
    hoodoo const& h = column();
    bubble_stencil const bubble = sphere(state);
    auto const share = 1e-3 * double(state.range(1));
    std::vector<std::vector<voxel_change>> near(h.skins.size());
    std::vector<voxel_change> changes;
    for (std::size_t i = 0; i < h.surface.size(); ++i) {
        stream draw(1, stage::user, i);
        if (draw.chance(share)) changes.push_back({h.surface[i], voxel_state::rock, voxel_state::air});
    }
    std::size_t told = 0;
    for (std::size_t s = 0; s < h.skins.size(); ++s) {
        for (voxel_change const& c : changes) {
            if (detail::air_counter::concerns(c, h.grid.brick_corner(h.skins[s].brick), bubble.reach()))
                near[s].push_back(c);
        }
        told += near[s].size();
    }
    auto skins = h.skins;
    detail::air_counter counter;
    double notifying = 0;
    double recounting = 0;
    auto const now = [] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    };
    for (auto _ : state) {
        double const t0 = now();
        for (std::size_t s = 0; s < skins.size(); ++s) {
            counter.notify(h.grid, skins[s].brick, {&bubble, 1}, {skins[s].position, {}, skins[s].air}, near[s]);
        }
        double const t1 = now();
        for (auto& s : skins) counter.recount(h.grid, s.brick, {&bubble, 1}, {s.position, {}, s.air});
        double const t2 = now();
        notifying += t1 - t0;
        recounting += t2 - t1;
    }
    state.counters["changes"] = double(changes.size());
    state.counters["changes_near_per_record"] = double(told) / double(h.surface.size());
    state.counters["ns_per_change_near"] =
        1e9 * notifying / double(state.iterations()) / double(std::max<std::size_t>(told, 1));
    state.counters["notify_over_recount"] = notifying / recounting;
    std::size_t recounted = 0;
    for (std::size_t s = 0; s < skins.size(); ++s) {
        detail::skin_view const view{skins[s].position, {}, skins[s].air};
        if (counter.recount_is_cheaper({&bubble, 1}, view, near[s].size())) ++recounted;
    }
    state.counters["bricks_recounted"] = double(recounted) / double(skins.size());
}
BENCHMARK(notify)
    ->Name("voxel/bubble/notify/r/permille")
    ->ArgsProduct({{3, 5, 7, 12}, {3, 10, 20, 40, 80}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
