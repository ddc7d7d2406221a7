#include <tafoni/voxel/bit_grid.hpp>
#include <tafoni/voxel/copy_states.hpp>
#include <tafoni/voxel/dense_grid.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

#include <benchmark/benchmark.h>

namespace {

using namespace tafoni;

/// Head, chest, neck and plinth: balls and a slab, in a cube of n^3.
bool in_bust(std::int64_t n, std::int64_t x, std::int64_t y, std::int64_t z) {
    auto const ball = [&](std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t r) {  // in 1/512 of the cube
        std::int64_t const dx = 512 * x - a * n, dy = 512 * y - b * n, dz = 512 * z - c * n;
        return dx * dx + dy * dy + dz * dz < r * r * n * n;
    };
    return ball(256, 256, 370, 110) || ball(256, 250, 150, 140) || ball(256, 256, 260, 80) || 512 * z < 40 * n;
}

template <class Grid>
Grid bust(std::int64_t n) {
    auto const edge = static_cast<std::size_t>(n);
    Grid grid(grid_frame{.size = {edge, edge, edge}});
    for (std::size_t k = 0; k < edge; ++k) {
        for (std::size_t j = 0; j < edge; ++j) {
            for (std::size_t i = 0; i < edge; ++i) {
                if (in_bust(n, static_cast<std::int64_t>(i), static_cast<std::int64_t>(j), static_cast<std::int64_t>(k))) {
                    grid_access<Grid>::set(grid, i, j, k, voxel_state::rock);
                }
            }
        }
    }
    return grid;
}

void count_voxels(benchmark::State& state) {
    state.SetItemsProcessed(state.iterations() * state.range(0) * state.range(0) * state.range(0));
}

template <class Grid, up_axis Up>
void into_bricks(benchmark::State& state) {
    Grid const from = bust<Grid>(state.range(0));
    for (auto _ : state) {
        sparse_grid const grid = sparse_grid::copy_of(from, Up);
        benchmark::DoNotOptimize(grid.brick_count());
        state.counters["MiB"] = static_cast<double>(grid.bytes()) / 0x1p20;
    }
    count_voxels(state);
}

template <class Grid>
void out_of_bricks(benchmark::State& state) {
    Grid to = bust<Grid>(state.range(0));
    sparse_grid const from = sparse_grid::copy_of(to);
    for (auto _ : state) {
        copy_states(from, to);
        benchmark::ClobberMemory();
    }
    count_voxels(state);
}

}  // namespace

BENCHMARK(into_bricks<dense_grid, up_axis::plus_z>)->Name("voxel/grids/copy_of/dense_grid/n")->Arg(128)->Arg(256)->Arg(512)->Unit(benchmark::kMillisecond);
BENCHMARK(into_bricks<dense_grid, up_axis::plus_y>)->Name("voxel/grids/copy_of/dense_grid_y_up/n")->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(into_bricks<dense_grid, up_axis::plus_x>)->Name("voxel/grids/copy_of/dense_grid_x_up/n")->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(into_bricks<bit_grid, up_axis::plus_z>)->Name("voxel/grids/copy_of/bit_grid/n")->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(into_bricks<sparse_grid, up_axis::plus_y>)->Name("voxel/grids/copy_of/sparse_grid/n")->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(out_of_bricks<dense_grid>)->Name("voxel/grids/copy_states/dense_grid/n")->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(out_of_bricks<bit_grid>)->Name("voxel/grids/copy_states/bit_grid/n")->Arg(256)->Unit(benchmark::kMillisecond);
