// Surfaces: marching cubes on samples (OpenVDB in the same binary where found) and on the bits of a grid.
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/field/noise.hpp>
#include <tafoni/voxel/dual_surface.hpp>
#include <tafoni/voxel/isosurface.hpp>
#include <tafoni/voxel/voxel_surface.hpp>

#include <benchmark/benchmark.h>

#if defined(TAFONI_HAVE_OPENVDB)
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/global_control.h>
#endif

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <vector>

namespace {

using namespace tafoni;

/// A sphere with smooth bumps of noise, positive inside.
struct bumpy_sphere {
    double centre;
    double radius;
    gradient_noise bumps;
    double operator()(vec3 const& p) const {
        vec3 const d{p[0] - centre, p[1] - centre, p[2] - centre};
        return radius - length(d) + 0.25 * radius * bumps(p);
    }
};

template <class Sample>
std::vector<Sample> const& samples(std::size_t n) {
    static std::size_t made = 0;
    static std::vector<Sample> s;
    if (made == n) return s;
    auto const side = static_cast<double>(n);
    bumpy_sphere const f{0.5 * side, 0.35 * side, {.seed = 7, .frequency = 12 / side}};
    s.resize(n * n * n);
    std::size_t at = 0;
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t j = 0; j < n; ++j) {
            for (std::size_t i = 0; i < n; ++i) {
                s[at++] = static_cast<Sample>(f(vec3{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)}));
            }
        }
    }
    made = n;
    return s;
}

template <class Sample>
void tafoni_isosurface(benchmark::State& state) {
    auto const n = static_cast<std::size_t>(state.range(0));
    auto const& s = samples<Sample>(n);
    grid_field<Sample> const grid{.samples = s, .size = {n, n, n}};
    std::size_t triangles = 0;
    for (auto _ : state) {
        auto const mesh = isosurface(grid, 0.0);
        triangles = mesh.face_count();
        benchmark::DoNotOptimize(triangles);
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(n * n * n));
    state.counters["triangles"] = static_cast<double>(triangles);
}
BENCHMARK(tafoni_isosurface<double>)->Name("voxel/isosurface/tafoni/double/n")->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(tafoni_isosurface<float>)->Name("voxel/isosurface/tafoni/float/n")->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);

void tafoni_isosurface_threads(benchmark::State& state) {
    std::size_t const n = 256;
    auto const& s = samples<float>(n);
    thread_pool const pool(static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) {
        auto const mesh = isosurface(grid_field<float>{.samples = s, .size = {n, n, n}}, 0.0, {}, pool);
        benchmark::DoNotOptimize(mesh.corners.data());
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(n * n * n));
}
BENCHMARK(tafoni_isosurface_threads)->Name("voxel/isosurface/tafoni/float/n:256/threads")->Arg(2)->Arg(4)->UseRealTime()->Unit(benchmark::kMillisecond);

#if defined(TAFONI_HAVE_OPENVDB)
/// The peer on a grid in which every node is active, on one thread.
void openvdb_dense(benchmark::State& state) {
    openvdb::initialize();
    tbb::global_control const one(tbb::global_control::max_allowed_parallelism, 1);
    auto const n = static_cast<std::size_t>(state.range(0));
    auto const& s = samples<float>(n);
    auto const last = static_cast<int>(n) - 1;
    openvdb::tools::Dense<float const, openvdb::tools::LayoutXYZ> const dense(
        openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(last)), s.data());
    auto const grid = openvdb::FloatGrid::create(-1e3F);
    openvdb::tools::copyFromDense(dense, *grid, 0.0F, true);
    std::size_t triangles = 0;
    for (auto _ : state) {
        std::vector<openvdb::Vec3s> points;
        std::vector<openvdb::Vec4I> quads;
        openvdb::tools::volumeToMesh(*grid, points, quads, 0.0);
        triangles = 2 * quads.size();
        benchmark::DoNotOptimize(triangles);
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(n * n * n));
    state.counters["triangles"] = static_cast<double>(triangles);
}
BENCHMARK(openvdb_dense)->Name("voxel/isosurface/openvdb/float/n")->Arg(128)->Arg(256)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
#endif

void tafoni_dual(benchmark::State& state) {
    auto const n = static_cast<std::size_t>(state.range(0));
    auto const& s = samples<double>(n);
    grid_frame const nodes{.size = {n, n, n}};
    auto const field = [f = grid_field<double>{.samples = s, .size = nodes.size, .origin = nodes.centre({0, 0, 0})}](vec3 const& p) { return f(p); };
    for (auto _ : state) {
        auto const mesh = dual_surface(field, nodes, 0.0);
        benchmark::DoNotOptimize(mesh.corners.data());
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(n * n * n));
}
BENCHMARK(tafoni_dual)->Name("voxel/dual_surface/tafoni/double/n")->Arg(128)->Unit(benchmark::kMillisecond);

/// A head on a neck with a bumpy skin, and a heap of colluvium at its foot.
sparse_grid bust(std::size_t height) {
    std::size_t const width = height / 2;
    auto const h = static_cast<double>(height);
    gradient_noise const bumps{.seed = 3, .frequency = 24 / h};
    gradient_noise const grain{.seed = 4, .frequency = 160 / h};
    sparse_grid grid({.size = {width, width, height}});
    for (std::size_t b = 0; b < grid.brick_count(); ++b) {
        voxel const low = grid.brick_corner(b);
        auto const solid = [&](vec3 const& p) {
            double const x = p[0] - 0.25 * h;
            double const y = p[1] - 0.25 * h;
            double const z = p[2] / h;
            double const profile = z > 0.45 ? 0.20 * h * std::sqrt(std::fmax(0.0, 1 - (z - 0.70) * (z - 0.70) / 0.0676))
                                            : h * (0.09 + 0.5 * (z - 0.38) * (z - 0.38));
            return profile - std::sqrt(x * x + y * y);
        };
        grid.fill_brick(b, [&](voxel v) {
            vec3 const p = grid.centre(v);
            double const d = solid(p);
            if (d < -8 - 0.06 * h) return voxel_state::air;
            if (d > 0.02 * h) return voxel_state::rock;
            if (d + 0.012 * h * bumps(p) + 0.7 * grain(p) > 0) return voxel_state::rock;
            return p[2] < 0.05 * h + d * 0.7 ? voxel_state::colluvium : voxel_state::air;
        });
        benchmark::DoNotOptimize(low);
    }
    return grid;
}

void voxel_surface_of_bust(benchmark::State& state) {
    auto const grid = bust(static_cast<std::size_t>(state.range(0)));
    std::size_t rock = 0;
    std::size_t colluvium = 0;
    for (auto _ : state) {
        auto const s = extract_voxel_surface(grid, {.smoothing = static_cast<int>(state.range(1))});
        rock = s.rock.mesh.face_count();
        colluvium = s.colluvium.mesh.face_count();
        benchmark::DoNotOptimize(rock);
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(rock + colluvium));
    state.counters["rock"] = static_cast<double>(rock);
    state.counters["colluvium"] = static_cast<double>(colluvium);
    state.counters["grid_MiB"] = static_cast<double>(grid.bytes()) / 1048576;
    state.counters["blocks_MiB"] = static_cast<double>(detail::surface_blocks(grid, inline_executor{}).bytes()) / 1048576;
}
BENCHMARK(voxel_surface_of_bust)
    ->Name("voxel/voxel_surface/bust/height/smoothing")
    ->ArgsProduct({{128, 256, 512}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
