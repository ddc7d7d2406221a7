// Reading and writing from memory, in bytes per second: no disk in the loop.
#include <tafoni/core/random.hpp>
#include <tafoni/io/esri_ascii.hpp>
#include <tafoni/io/obj.hpp>
#include <tafoni/io/ply.hpp>
#include <tafoni/io/stl.hpp>
#include <tafoni/io/vtk_xml.hpp>

#include <benchmark/benchmark.h>

#include <map>

namespace {

using namespace tafoni;

/// A rough sheet of n x n vertices, two triangles per square.
indexed_mesh const& sheet(std::size_t n) {
    static std::map<std::size_t, indexed_mesh> made;
    indexed_mesh& mesh = made[n];
    if (!mesh.positions.empty()) return mesh;
    stream random(7, stage::user, n);
    for (std::size_t i = 0; i < n * n; ++i) {
        double const z = random.uniform(-1, 1);
        // Seven digits, as scanners and modellers write.
        auto const digits = [](double x) { return std::floor(x * 1e6) / 1e6; };
        mesh.add_vertex({digits(0.01 * static_cast<double>(i % n)), digits(0.01 * static_cast<double>(i / n)), digits(z)});
    }
    for (std::size_t y = 0; y + 1 < n; ++y) {
        for (std::size_t x = 0; x + 1 < n; ++x) {
            auto const v = static_cast<std::uint32_t>(y * n + x);
            auto const above = static_cast<std::uint32_t>(v + n);
            mesh.add_face({v, v + 1, above});
            mesh.add_face({v + 1, above + 1, above});
        }
    }
    return mesh;
}

void report(benchmark::State& state, std::size_t bytes) {
    state.SetBytesProcessed(static_cast<std::int64_t>(bytes) * state.iterations());
    state.counters["MB"] = static_cast<double>(bytes) / 1e6;
}

template <class Encode, class Decode>
void read(benchmark::State& state, Encode encode, Decode decode) {
    std::string const bytes = encode(sheet(static_cast<std::size_t>(state.range(0))));
    for (auto _ : state) benchmark::DoNotOptimize(decode(bytes));
    report(state, bytes.size());
}

template <class Encode>
void write(benchmark::State& state, Encode encode) {
    indexed_mesh const& mesh = sheet(static_cast<std::size_t>(state.range(0)));
    std::size_t bytes = 0;
    for (auto _ : state) {
        std::string const out = encode(mesh);
        benchmark::DoNotOptimize(out.data());
        bytes = out.size();
    }
    report(state, bytes);
}

auto const obj = [](indexed_mesh const& m) { return encode_obj(m); };
auto const ply_binary = [](indexed_mesh const& m) { return encode_ply(m, {}, {.coordinates = coordinate_type::float32}); };
auto const ply_ascii = [](indexed_mesh const& m) { return encode_ply(m, {}, {.encoding = ply_encoding::ascii}); };
auto const stl = [](indexed_mesh const& m) { return encode_stl(m); };
auto const vtp = [](indexed_mesh const& m) { return encode_vtp(m); };
auto const grid = [](indexed_mesh const& m) {
    std::size_t const n = static_cast<std::size_t>(std::sqrt(static_cast<double>(m.vertex_count())));
    std::string out = "ncols " + std::to_string(n) + "\nnrows " + std::to_string(n) + "\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
    for (std::size_t i = 0; i < n * n; ++i) {
        detail::append_number(out, m.positions[i][2]);
        out += i % n == n - 1 ? '\n' : ' ';
    }
    return out;
};

void read_obj_bench(benchmark::State& s) { read(s, obj, [](std::string const& b) { return read_obj(b, "b"); }); }
void read_ply_binary_bench(benchmark::State& s) { read(s, ply_binary, [](std::string const& b) { return read_ply(b, "b"); }); }
void read_ply_ascii_bench(benchmark::State& s) { read(s, ply_ascii, [](std::string const& b) { return read_ply(b, "b"); }); }
void read_stl_bench(benchmark::State& s) { read(s, stl, [](std::string const& b) { return read_stl(b, "b"); }); }
void read_grid_bench(benchmark::State& s) { read(s, grid, [](std::string const& b) { return read_esri_ascii(b, "b"); }); }
void write_obj_bench(benchmark::State& s) { write(s, obj); }
void write_ply_bench(benchmark::State& s) { write(s, ply_binary); }
void write_stl_bench(benchmark::State& s) { write(s, stl); }
void write_vtp_bench(benchmark::State& s) { write(s, vtp); }

BENCHMARK(read_obj_bench)->Name("io/read_obj/text/double/n")->Arg(190)->Arg(1400)->Unit(benchmark::kMillisecond);
BENCHMARK(read_ply_binary_bench)->Name("io/read_ply/little_endian/float/n")->Arg(190)->Arg(1400)->Unit(benchmark::kMillisecond);
BENCHMARK(read_ply_ascii_bench)->Name("io/read_ply/ascii/double/n")->Arg(190)->Arg(1400)->Unit(benchmark::kMillisecond);
BENCHMARK(read_stl_bench)->Name("io/read_stl/binary/float/n")->Arg(190)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK(read_grid_bench)->Name("io/read_esri_ascii/text/double/n")->Arg(190)->Arg(1400)->Unit(benchmark::kMillisecond);
BENCHMARK(write_obj_bench)->Name("io/write_obj/text/double/n")->Arg(190)->Arg(1400)->Unit(benchmark::kMillisecond);
BENCHMARK(write_ply_bench)->Name("io/write_ply/little_endian/float/n")->Arg(190)->Arg(1400)->Unit(benchmark::kMillisecond);
BENCHMARK(write_stl_bench)->Name("io/write_stl/binary/float/n")->Arg(190)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK(write_vtp_bench)->Name("io/write_vtp/raw/double/n")->Arg(190)->Arg(1400)->Unit(benchmark::kMillisecond);

}  // namespace
