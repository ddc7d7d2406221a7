// The Voronoi diagram of points in a box: ours and, where found, voro++ in the same binary.
#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/voronoi_diagram.hpp>

#include <benchmark/benchmark.h>

#if defined(TAFONI_HAVE_VOROPP)
#include <voro++.hh>
#endif

#include <cmath>
#include <cstddef>
#include <ctime>
#include <span>
#include <vector>

namespace {

using namespace tafoni;

enum class scene { uniform, dense_corner, cubic_lattice, bcc_lattice };

std::vector<vec3> points(scene what, std::size_t n) {
    stream random(1, stage::user, 0);
    std::vector<vec3> p;
    p.reserve(n);
    if (what == scene::cubic_lattice || what == scene::bcc_lattice) {
        bool const bcc = what == scene::bcc_lattice;
        auto const m = static_cast<int>(std::lround(std::cbrt(static_cast<double>(n) / (bcc ? 2 : 1))));
        for (int x = 0; x < m; ++x) {
            for (int y = 0; y < m; ++y) {
                for (int z = 0; z < m; ++z) {
                    double const low = bcc ? 0.25 : 0.5;
                    p.push_back(vec3{(x + low) / m, (y + low) / m, (z + low) / m});
                    if (bcc) p.push_back(vec3{(x + 0.75) / m, (y + 0.75) / m, (z + 0.75) / m});
                }
            }
        }
        return p;
    }
    // 90 % of the points in a cube of 1 % of the volume.
    double const side = 0.21544346900318842;
    for (std::size_t k = 0; k < n; ++k) {
        bool const inside = what == scene::dense_corner && k % 10 != 0;
        double const x = random.uniform01();
        double const y = random.uniform01();
        double const z = random.uniform01();
        p.push_back(inside ? vec3{0.3 + side * x, 0.3 + side * y, 0.3 + side * z} : vec3{x, y, z});
    }
    return p;
}

box3 unit_box() {
    box3 b;
    b.lo = vec3{0, 0, 0};
    b.hi = vec3{1, 1, 1};
    return b;
}

// Everything in doubles in memory: neighbours, vertices, and per face an area and a normal.
struct stored {
    voronoi_diagram diagram;
    std::vector<double> area;
    std::vector<vec3> normal;
};

stored build(std::vector<vec3> const& p) {
    stored s{make_voronoi_diagram(unit_box(), std::span<vec3 const>(p)), {}, {}};
    s.area.resize(s.diagram.face_count());
    s.normal.resize(s.diagram.face_count());
    for (std::size_t f = 0; f < s.area.size(); ++f) {
        vec3 const a = s.diagram.face_area(f);
        double const l = length(a);
        s.area[f] = l;
        double const inverse = l > 0 ? 1 / l : 0;
        s.normal[f] = vec3{a[0] * inverse, a[1] * inverse, a[2] * inverse};
    }
    return s;
}

void tafoni_cells(benchmark::State& state, scene what) {
    auto const p = points(what, static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(build(p));
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(p.size()));
}

#ifdef TAFONI_HAVE_VOROPP
// What voro++ offers for the same answer; the results of one cell at a time, not kept.
void voropp_run(std::vector<vec3> const& p) {
    int const blocks = static_cast<int>(std::cbrt(static_cast<double>(p.size()) / 5.0) + 1);
    voro::container box(0, 1, 0, 1, 0, 1, blocks, blocks, blocks, false, false, false, 8);
    for (std::size_t k = 0; k < p.size(); ++k) box.put(static_cast<int>(k), p[k][0], p[k][1], p[k][2]);
    voro::voronoicell_neighbor cell;
    voro::c_loop_all loop(box);
    std::vector<int> neighbours;
    std::vector<int> faces;
    std::vector<double> areas;
    std::vector<double> normals;
    std::vector<double> vertices;
    if (!loop.start()) return;
    do {
        if (!box.compute_cell(cell, loop)) continue;
        double x = 0;
        double y = 0;
        double z = 0;
        loop.pos(x, y, z);
        cell.neighbors(neighbours);
        cell.face_vertices(faces);
        cell.face_areas(areas);
        cell.normals(normals);
        cell.vertices(x, y, z, vertices);
        benchmark::DoNotOptimize(vertices.data());
    } while (loop.inc());
}

void voropp_cells(benchmark::State& state, scene what) {
    auto const p = points(what, static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) voropp_run(p);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(p.size()));
}

// Both in turn, so that the ratio comes from one run on one machine.
void ratio(benchmark::State& state, scene what) {
    // Time on the processor, so that what else runs on the machine counts less.
    auto const now = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
    auto const p = points(what, static_cast<std::size_t>(state.range(0)));
    double ours = 1e30;
    double theirs = 1e30;
    for (auto _ : state) {
        double const t0 = now();
        benchmark::DoNotOptimize(build(p));
        double const t1 = now();
        voropp_run(p);
        double const t2 = now();
        ours = std::min(ours, t1 - t0);
        theirs = std::min(theirs, t2 - t1);
    }
    auto const n = static_cast<double>(p.size());
    state.counters["us_per_cell"] = 1e6 * ours / n;
    state.counters["voropp_us_per_cell"] = 1e6 * theirs / n;
    state.counters["ratio"] = ours / theirs;
}

BENCHMARK_CAPTURE(ratio, uniform, scene::uniform)
    ->Name("decomposition/voronoi_diagram/ratio_to_voropp/uniform/n")
    ->Arg(100000)
    ->Iterations(5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(voropp_cells, uniform, scene::uniform)
    ->Name("decomposition/voronoi_diagram/voropp/uniform/n")
    ->Arg(100000)
    ->Unit(benchmark::kMillisecond);
#endif

BENCHMARK_CAPTURE(tafoni_cells, uniform, scene::uniform)
    ->Name("decomposition/voronoi_diagram/tafoni/uniform/n")
    ->Arg(1000)
    ->Arg(10000)
    ->Arg(100000)
    ->Arg(1000000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tafoni_cells, dense_corner, scene::dense_corner)
    ->Name("decomposition/voronoi_diagram/tafoni/dense_corner/n")
    ->Arg(100000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tafoni_cells, cubic_lattice, scene::cubic_lattice)
    ->Name("decomposition/voronoi_diagram/tafoni/cubic_lattice/n")
    ->Arg(100000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tafoni_cells, bcc_lattice, scene::bcc_lattice)
    ->Name("decomposition/voronoi_diagram/tafoni/bcc_lattice/n")
    ->Arg(100000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
