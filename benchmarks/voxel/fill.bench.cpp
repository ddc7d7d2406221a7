// Filling grids: the time per resolution shows that it grows with the surface, not with the volume.
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/io/read_mesh.hpp>
#include <tafoni/io/read_nrrd.hpp>
#include <tafoni/voxel/dense_grid.hpp>
#include <tafoni/voxel/fill_from_heights.hpp>
#include <tafoni/voxel/fill_from_image.hpp>
#include <tafoni/voxel/fill_from_mesh.hpp>
#include <tafoni/voxel/fill_from_predicate.hpp>
#include <tafoni/voxel/fill_from_solid.hpp>
#include <tafoni/voxel/frame_for.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

#include <support/shapes.hpp>
#include <support/test_data.hpp>

#include <benchmark/benchmark.h>

namespace {

using namespace tafoni;

indexed_mesh mesh_of(char const* name) {
    auto const path = tafoni_test::find(name);
    return path.empty() ? tafoni_test::icosphere(5) : read_mesh(path).mesh;
}

/// The bust, or a sphere where there is no data.
solid const& bust() {
    static solid const s = make_solid(mesh_of("meshes/nefertiti_35k.ply"));
    return s;
}

void report(benchmark::State& state, std::size_t voxels, std::size_t rock, std::size_t bytes) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(voxels));
    state.counters["rock"] = static_cast<double>(rock);
    state.counters["MB"] = static_cast<double>(bytes) / 1e6;
}

void solid_sparse(benchmark::State& state) {
    grid_frame const frame = frame_for(bust().bounds, static_cast<std::size_t>(state.range(0)));
    std::size_t rock = 0;
    std::size_t bytes = 0;
    for (auto _ : state) {
        sparse_grid grid(frame);
        rock = fill_from_solid(grid, bust());
        bytes = grid.bytes();
    }
    report(state, frame.voxel_count(), rock, bytes);
}

void solid_dense(benchmark::State& state) {
    grid_frame const frame = frame_for(bust().bounds, static_cast<std::size_t>(state.range(0)));
    std::size_t rock = 0;
    for (auto _ : state) {
        dense_grid grid(frame);
        rock = fill_from_solid(grid, bust());
    }
    report(state, frame.voxel_count(), rock, frame.voxel_count());
}

/// The bust with about a hundred triangles gone: a few dozen small holes.
void holes_sparse(benchmark::State& state) {
    indexed_mesh const whole = mesh_of("meshes/nefertiti_35k.ply");
    indexed_mesh mesh;
    mesh.positions = whole.positions;
    for (std::size_t f = 0; f < whole.face_count(); ++f) {
        if (f % (whole.face_count() / 100 + 1) != 7) mesh.add_face(whole.face(f));
    }
    grid_frame const frame = frame_for(bust().bounds, static_cast<std::size_t>(state.range(0)));
    mesh_fill_report found;
    std::size_t bytes = 0;
    for (auto _ : state) {
        sparse_grid grid(frame);
        found = fill_from_mesh(grid, mesh);
        bytes = grid.bytes();
    }
    report(state, frame.voxel_count(), found.rock, bytes);
    state.counters["holes"] = static_cast<double>(found.holes);
}

void predicate_sparse(benchmark::State& state) {
    double const n = static_cast<double>(state.range(0));
    auto const size = static_cast<std::size_t>(state.range(0));
    std::size_t rock = 0;
    std::size_t bytes = 0;
    for (auto _ : state) {
        sparse_grid grid({.size = {size, size, size}, .origin = {-n / 2, -n / 2, -n / 2}});
        rock = fill_from_predicate(grid, [n](vec3 const& p) { return squared_length(p) < 0.2 * n * n; });
        bytes = grid.bytes();
    }
    report(state, size * size * size, rock, bytes);
}

void heights_sparse(benchmark::State& state) {
    height_grid g{.columns = 400, .rows = 400};
    for (std::size_t i = 0; i < 160000; ++i) g.heights.push_back(30 * tafoni_test::lattice_noise(0.02 * static_cast<double>(i % 400), 0.02 * static_cast<double>(i / 400), 3));
    sparse_grid grid;
    for (auto _ : state) grid = fill_from_heights(g, {.resolution = static_cast<std::size_t>(state.range(0))});
    report(state, grid.user_frame().voxel_count(), grid.count(voxel_plane::rock), grid.bytes());
}

void revolved_image(benchmark::State& state) {
    gray_image image{300, 512, {}};
    for (std::size_t i = 0; i < 300 * 512; ++i) {
        double const half = 60 + 40 * tafoni_test::lattice_noise(0.05 * static_cast<double>(i / 300), 0.5, 1);
        double const x = static_cast<double>(i % 300) + 0.5 - 150;
        image.pixels.push_back(x * x < half * half ? 0 : 255);
    }
    image_options const options{.resolution = static_cast<std::size_t>(state.range(0))};
    grid_frame const frame = frame_for_image(image, options);
    std::size_t rock = 0;
    std::size_t bytes = 0;
    for (auto _ : state) {
        sparse_grid grid(frame);
        rock = fill_from_image(grid, image, options);
        bytes = grid.bytes();
    }
    report(state, frame.voxel_count(), rock, bytes);
}

void nrrd_bytes(benchmark::State& state) {
    std::string const n = std::to_string(state.range(0));
    auto const count = static_cast<std::size_t>(state.range(0) * state.range(0) * state.range(0));
    std::string const bytes = "NRRD0004\ntype: short\ndimension: 3\nsizes: " + n + " " + n + " " + n +
                              "\nencoding: raw\nendian: little\n\n" + std::string(2 * count, 'a');
    for (auto _ : state) benchmark::DoNotOptimize(read_nrrd(bytes, "b").samples.data());
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes.size()));
}

BENCHMARK(solid_sparse)->Name("voxel/fill_from_solid/sparse/n")->Arg(128)->Arg(256)->Arg(512)->Arg(1024)->Unit(benchmark::kMillisecond);
BENCHMARK(solid_dense)->Name("voxel/fill_from_solid/dense/n")->Arg(128)->Arg(256)->Arg(512)->Unit(benchmark::kMillisecond);
BENCHMARK(holes_sparse)->Name("voxel/fill_from_mesh/sparse_100_holes/n")->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(predicate_sparse)->Name("voxel/fill_from_predicate/sparse_ball/n")->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(heights_sparse)->Name("voxel/fill_from_heights/sparse/n")->Arg(400)->Arg(800)->Unit(benchmark::kMillisecond);
BENCHMARK(revolved_image)->Name("voxel/fill_from_image/sparse_revolved/n")->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(nrrd_bytes)->Name("io/read_nrrd/raw/int16/n")->Arg(128)->Unit(benchmark::kMillisecond);

}  // namespace
