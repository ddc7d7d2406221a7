// One step of the particle fluid, whole and in parts, in float and double, with and without AVX2, on one and more
// threads. No package of Debian has a fluid of particles: the peer is the obvious loop over the same neighbours.
#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/fluid/detail/visit_order.hpp>
#include <tafoni/fluid/mesh_boundary.hpp>
#include <tafoni/fluid/sph.hpp>

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

using namespace tafoni;

namespace {

/// A cloud of about n particles at rest density, each moved by up to a fifth of the spacing.
std::vector<fluid_particle> cloud(double n) {
    auto const side = static_cast<int>(std::cbrt(n) + 0.5);
    std::vector<fluid_particle> all;
    stream random(1, 0, 0);
    for (int k = 0; k < side; ++k) {
        for (int j = 0; j < side; ++j) {
            for (int i = 0; i < side + 1; ++i) {
                double const a = random.uniform(-0.2, 0.2);
                double const b = random.uniform(-0.2, 0.2);
                double const c = random.uniform(-0.2, 0.2);
                all.push_back({.id = all.size(), .position = vec3{i + a, j + b, k + c}, .velocity = vec3{a, b, c}});
            }
        }
    }
    return all;
}
box_sink everywhere() {
    box_sink s;
    s.keep.lo = vec3{-1e4, -1e4, -1e4};
    s.keep.hi = vec3{1e4, 1e4, 1e4};
    return s;
}

/// Sorted as `sph` sorts, for its kernels alone.
template <class Scalar>
struct sorted_cloud {
    static constexpr std::size_t pad = detail::sph_lane_count<Scalar>;
    std::size_t n = 0;
    std::array<std::vector<Scalar>, 6> x{};
    std::array<std::vector<Scalar>, 5> out{};
    std::vector<detail::sph_spans> spans{};
    double neighbours = 0;

    explicit sorted_cloud(double size) {
        auto const all = cloud(size);
        n = all.size();
        std::array<std::vector<Scalar>, 6> home;
        for (auto const& p : all) {
            for (std::size_t d = 0; d < 3; ++d) {
                home[d].push_back(static_cast<Scalar>(p.position[static_cast<int>(d)]));
                home[3 + d].push_back(static_cast<Scalar>(p.velocity[static_cast<int>(d)]));
            }
        }
        detail::particle_grid<Scalar> grid;
        grid.build(std::span<Scalar const>(home[0]), std::span<Scalar const>(home[1]), std::span<Scalar const>(home[2]), inline_executor{});
        for (auto& a : x) a.resize(n + pad);
        for (auto& a : out) a.resize(n + pad);
        spans.resize(n);
        for (std::size_t k = 0; k < n; ++k) {
            for (std::size_t d = 0; d < 6; ++d) x[d][k] = home[d][grid.order()[k]];
            grid.around(x[0][k], x[1][k], x[2][k], spans[k]);
            out[1][k] = static_cast<Scalar>(0.01);
        }
        for (std::size_t i = 0; i < n; ++i) {
            for_each_near(i, [&](std::size_t j, Scalar) { neighbours += i == j ? 0.0 : 1.0; });
        }
        neighbours /= static_cast<double>(n);
    }
    template <class F>
    void for_each_near(std::size_t i, F const& f) const {
        for (std::uint32_t r = 0; r < spans[i].count; ++r) {
            for (std::size_t k = spans[i].row[r].begin; k < spans[i].row[r].end; ++k) {
                Scalar const a = x[0][i] - x[0][k];
                Scalar const b = x[1][i] - x[1][k];
                Scalar const c = x[2][i] - x[2][k];
                Scalar const s = a * a + b * b + c * c;
                if (s < 4) f(k, s);
            }
        }
    }
    [[nodiscard]] detail::sph_arrays<Scalar> arrays() {
        return {.x = x[0].data(), .y = x[1].data(), .z = x[2].data(), .u = x[3].data(), .v = x[4].data(), .w = x[5].data(),
                .density = out[0].data(), .pressure = out[1].data(), .spans = spans.data(), .ax = out[2].data(), .ay = out[3].data(),
                .az = out[4].data()};
    }
    /// Density, then pressure and viscosity, as one would write them down.
    void obvious() {
        for (std::size_t i = 0; i < n; ++i) {
            Scalar sum = 0;
            for_each_near(i, [&](std::size_t, Scalar s) {
                Scalar const q = std::sqrt(s);
                Scalar const two = 2 - q;
                Scalar const one = 1 - q;
                sum += Scalar(0.25) * two * two * two - (one > 0 ? one * one * one : Scalar(0));
            });
            out[0][i] = Scalar(0.3) * sum;
        }
        for (std::size_t i = 0; i < n; ++i) {
            std::array<Scalar, 3> f{};
            for_each_near(i, [&](std::size_t j, Scalar s) {
                if (i == j) return;
                Scalar const q = std::sqrt(s);
                Scalar const two = 2 - q;
                Scalar const one = q < 1 ? 1 - q : Scalar(0);
                Scalar const slope = 3 * one * one - Scalar(0.75) * two * two;
                std::array<Scalar, 3> const d{x[0][i] - x[0][j], x[1][i] - x[1][j], x[2][i] - x[2][j]};
                Scalar const along = d[0] * (x[3][i] - x[3][j]) + d[1] * (x[4][i] - x[4][j]) + d[2] * (x[5][i] - x[5][j]);
                Scalar const p = out[1][i] + out[1][j] - Scalar(0.7) * along / ((out[0][i] + out[0][j]) * (s + Scalar(0.01)));
                for (std::size_t a = 0; a < 3; ++a) f[a] += slope * p / q * d[a];
            });
            for (std::size_t a = 0; a < 3; ++a) out[2 + a][i] = Scalar(-0.3) * f[a];
        }
    }
};

enum class kernel { obvious, plain, avx2 };

template <class Scalar>
void sums(benchmark::State& state) {
    auto const with = static_cast<kernel>(state.range(0));
    static sorted_cloud<Scalar> all(70000);
    if (with == kernel::avx2 && !detail::sph_has_avx2()) return state.SkipWithError("this machine has no AVX2, or the program was built for it");
    for (auto _ : state) {
        if (with == kernel::obvious) {
            all.obvious();
        } else {
            auto const a = all.arrays();
            detail::sph_densities<Scalar>(a, 0, all.n, Scalar(0.3), with == kernel::avx2);
            detail::sph_forces<Scalar>(a, 0, all.n, Scalar(0.3), Scalar(0.7), with == kernel::avx2);
        }
        benchmark::ClobberMemory();
    }
    state.counters["particles"] = static_cast<double>(all.n);
    state.counters["neighbours"] = all.neighbours;
}

template <class Scalar>
void step(benchmark::State& state) {
    auto const all = cloud(static_cast<double>(state.range(0)));
    sph<Scalar> water(std::vector<box_emitter>{}, everywhere(),
                      {.particles = 1u << 24, .spacing = 1, .sound_speed = 100, .gravity = vec3{0, 0, 0}, .largest_step = 1e-7});
    water.place(all);
    thread_pool const pool(static_cast<std::size_t>(state.range(1)));
    for (auto _ : state) benchmark::DoNotOptimize(water.step(open_space{}, pool));
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.size()));
    state.counters["particles"] = static_cast<double>(all.size());
    if (state.range(1) == 1) state.SetComplexityN(static_cast<std::int64_t>(all.size()));
}

/// The faces that 70,000 drops over rolling ground of 35,000 vertices touch.
void affected(benchmark::State& state) {
    std::vector<vec3> ground;
    std::vector<std::array<std::uint32_t, 3>> faces;
    constexpr std::uint32_t n = 187;
    auto const height = [](double x, double y) { return 3 * std::sin(0.13 * x) * std::cos(0.11 * y); };
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) ground.push_back(vec3{1.0 * i, 1.0 * j, height(i, j)});
    }
    for (std::uint32_t j = 0; j + 1 < n; ++j) {
        for (std::uint32_t i = 0; i + 1 < n; ++i) {
            std::uint32_t const a = i + n * j;
            faces.push_back({a, a + 1, a + n + 1});
            faces.push_back({a, a + n + 1, a + n});
        }
    }
    std::vector<vec3> drops;
    stream random(3, 0, 0);
    for (int k = 0; k < 70000; ++k) {
        double const x = random.uniform(1, 185);
        double const y = random.uniform(1, 185);
        double const z = random.uniform(0, 4);  // an eighth of them within reach
        drops.push_back(vec3{x, y, height(x, y) + z});
    }
    mesh_boundary const walls(ground, faces, 0.5);
    detail::visit_order order;
    std::size_t contacts = 0;
    for (auto _ : state) {
        contacts = 0;
        order.sort(walls, drops.size(), [&](std::size_t i) -> vec3 const& { return drops[i]; }, inline_executor{});
        for (std::size_t k = 0; k < drops.size(); ++k) {
            order.look_ahead(walls, k);
            walls.for_each_contact(drops[order[k]], 0.5, [&](boundary_contact const&) { ++contacts; });
        }
        benchmark::DoNotOptimize(contacts);
    }
    state.counters["contacts"] = static_cast<double>(contacts);
}

}  // namespace

BENCHMARK(sums<float>)->Name("fluid/sph/sums/obvious_loop/float")->ArgName("kernel")->Arg(static_cast<int>(kernel::obvious))->Unit(benchmark::kMillisecond);
BENCHMARK(sums<float>)->Name("fluid/sph/sums/this_build/float")->ArgName("kernel")->Arg(static_cast<int>(kernel::plain))->Unit(benchmark::kMillisecond);
BENCHMARK(sums<float>)->Name("fluid/sph/sums/avx2/float")->ArgName("kernel")->Arg(static_cast<int>(kernel::avx2))->Unit(benchmark::kMillisecond);
BENCHMARK(sums<double>)->Name("fluid/sph/sums/obvious_loop/double")->ArgName("kernel")->Arg(static_cast<int>(kernel::obvious))->Unit(benchmark::kMillisecond);
BENCHMARK(sums<double>)->Name("fluid/sph/sums/this_build/double")->ArgName("kernel")->Arg(static_cast<int>(kernel::plain))->Unit(benchmark::kMillisecond);
BENCHMARK(sums<double>)->Name("fluid/sph/sums/avx2/double")->ArgName("kernel")->Arg(static_cast<int>(kernel::avx2))->Unit(benchmark::kMillisecond);
BENCHMARK(step<float>)->Name("fluid/sph/step/float")->ArgNames({"n", "threads"})
    ->Args({17500, 1})->Args({35000, 1})->Args({70000, 1})->Complexity(benchmark::oN)->Unit(benchmark::kMillisecond);
BENCHMARK(step<float>)->Name("fluid/sph/step_on_threads/float")->ArgNames({"n", "threads"})
    ->Args({70000, 1})->Args({70000, 2})->Args({70000, 4})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(step<double>)->Name("fluid/sph/step/double")->ArgNames({"n", "threads"})->Args({70000, 1})->Unit(benchmark::kMillisecond);
BENCHMARK(affected)->Name("fluid/mesh_boundary/affected/n:70000")->Unit(benchmark::kMillisecond);
