/// \file
/// Runs small scenarios and prints one line `name hash` for each; the hashes must be the same on every
/// compiler, optimisation level, instruction set and number of threads (tests/determinism/run.sh).
/// A new scenario is a function that feeds its result into a `fingerprint`, and one line in `main`.
#include "support/shapes.hpp"

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/random_normal.hpp>
#include <tafoni/core/sum.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/curvature/bubble_ratio.hpp>
#include <tafoni/curvature/cotangent.hpp>
#include <tafoni/curvature/estimate_curvature.hpp>
#include <tafoni/curvature/quadric_fit.hpp>
#include <tafoni/decomposition/grid_sites.hpp>
#include <tafoni/decomposition/hexagonal_sites.hpp>
#include <tafoni/decomposition/poisson_sites.hpp>
#include <tafoni/decomposition/random_sites.hpp>
#include <tafoni/decomposition/surface_sites.hpp>
#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/decomposition/voxel_cells.hpp>
#include <tafoni/field/fractal_noise.hpp>
#include <tafoni/field/noise.hpp>
#include <tafoni/fluid/mesh_boundary.hpp>
#include <tafoni/fluid/rain_particles.hpp>
#include <tafoni/fluid/sph.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/graph/make_link_graph.hpp>
#include <tafoni/percolation/cone_rain.hpp>
#include <tafoni/field/durability_profile.hpp>
#include <tafoni/voxel/bubble_mixture.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/weathering/curvature_run.hpp>
#include <tafoni/weathering/frost_presets.hpp>
#include <tafoni/weathering/frost_run.hpp>
#include <tafoni/weathering/hydraulic_run.hpp>
#include <tafoni/weathering/weathered_voxels.hpp>
#include <tafoni/weathering/wrinkles.hpp>

#include <bit>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <type_traits>
#include <vector>

namespace {

/// FNV-1a over the bytes of values, least significant byte first.
class fingerprint {
public:
    template <class T>
        requires std::is_integral_v<T>
    void add(T value) {
        auto const bits = static_cast<std::uint64_t>(value);
        for (int shift = 0; shift < 64; shift += 8) {
            hash_ = (hash_ ^ (bits >> shift & 0xff)) * 0x100000001b3ULL;
        }
    }
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
    void add(tafoni::vec3 const& v) {
        for (int axis = 0; axis < 3; ++axis) add(v[axis]);
    }
    template <class T>
    void add(std::span<T const> values) {
        add(values.size());
        for (auto const& value : values) add(value);
    }
    [[nodiscard]] std::uint64_t value() const { return hash_; }

private:
    std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

void print(char const* name, void (*scenario)(fingerprint&)) {
    fingerprint f;
    scenario(f);
    std::printf("%s %016" PRIx64 "\n", name, f.value());
}

void random_streams(fingerprint& f) {
    for (std::uint64_t index = 0; index < 100; ++index) {
        tafoni::stream s(42, tafoni::stage::user, index);
        for (int draw = 0; draw < 100; ++draw) {
            f.add(s.bits());
            f.add(s.uniform(-3, 5));
            f.add(s.index_below(1000 + index));
            f.add(s.unit_vector());
        }
    }
}

void vector_algebra(fingerprint& f) {
    tafoni::stream s(43, tafoni::stage::user, 0);
    for (int i = 0; i < 1000; ++i) {
        tafoni::vec3 const a = s.unit_vector();
        tafoni::vec3 const b = s.unit_vector();
        f.add(tafoni::dot(a, b));
        f.add(tafoni::cross(a, b));
        f.add(tafoni::length(a));
        f.add(tafoni::normalized(tafoni::vec3{a[0] + b[0], a[1] + b[1], a[2] + b[2]}));
    }
}

void sums(fingerprint& f) {
    for (std::size_t n = 1; n < 5000; n += 37) {
        f.add(tafoni::pairwise_sum(0, n, [](std::size_t i) { return 1.0 / static_cast<double>(i + 1); }));
    }
}

void elementary_functions(fingerprint& f) {
    tafoni::stream s(44, tafoni::stage::user, 0);
    for (int i = 0; i < 5000; ++i) {
        double const x = s.uniform(-40, 40);
        double const y = s.uniform(-3, 3);
        f.add(tafoni::elementary::exp(x));
        f.add(tafoni::elementary::log(x * x + 1e-9));
        f.add(tafoni::elementary::pow(std::fabs(x), y));
        f.add(tafoni::elementary::sin(x));
        f.add(tafoni::elementary::cos(1000 * x));
        f.add(tafoni::elementary::acos(y / 3));
        f.add(tafoni::random_normal(s));
    }
}

void noise(fingerprint& f) {
    tafoni::gradient_noise const plain{.seed = 3, .frequency = 1.7};
    tafoni::fractal_noise const fractal{.seed = 4, .frequency = 0.8, .octaves = 5};
    tafoni::stream s(45, tafoni::stage::user, 0);
    for (int i = 0; i < 2000; ++i) {
        tafoni::vec3 const direction = s.unit_vector();
        tafoni::vec3 const p{direction[0] * i, direction[1] * i, direction[2] * i};
        f.add(plain(p));
        f.add(fractal(p));
    }
}

template <class Complex>
void add_complex(fingerprint& f, Complex const& c) {
    f.add(c.cell_count());
    f.add(c.face_count());
    for (std::size_t i = 0; i < c.cell_count(); ++i) {
        tafoni::cell_index const cell{i};
        f.add(c.cell_volume(cell));
        f.add(c.cell_centroid(cell));
    }
    for (std::size_t i = 0; i < c.vertex_count(); ++i) f.add(c.position(tafoni::vertex_index{i}));
    for (std::size_t i = 0; i < c.face_count(); ++i) {
        tafoni::face_index const face{i};
        for (tafoni::cell_index const cell : c.face_cells(face)) f.add(cell.value);
        f.add(c.face_patch(face).value);
        for (std::size_t loop = 0; loop < c.loop_count(face); ++loop) {
            for (tafoni::vertex_index const v : c.face_loop(face, loop)) f.add(v.value);
        }
    }
}

template <class Network>
void add_network(fingerprint& f, Network const& n) {
    for (std::size_t i = 0; i < n.link_count(); ++i) {
        tafoni::link_index const l{i};
        if (!n.has_link(l)) continue;
        for (tafoni::cell_index const cell : n.link_cells(l)) f.add(cell.value);
        f.add(n.link_area(l));
        f.add(n.link_centroid(l));
        f.add(n.link_normal(l));
        n.for_each_neighbor(l, [&](tafoni::link_index other) { f.add(other.value); });
    }
}

template <class Run>
void add_run(fingerprint& f, Run const& run) {
    for (std::size_t i = 0; i < run.network().link_count(); ++i) {
        tafoni::link_index const l{i};
        if (run.network().has_link(l)) f.add(run.life(l));
    }
    for (tafoni::cell_state const c : run.cells()) f.add(static_cast<int>(c));
    for (tafoni::detached_block const& b : run.blocks()) {
        f.add(b.path);
        f.add(b.volume);
        for (tafoni::cell_index const c : b.cells) f.add(c.value);
    }
    tafoni::frost_report const r = run.report();
    f.add(r.paths);
    f.add(r.links_traversed);
    f.add(r.links_broken);
    f.add(r.cells_detached);
    f.add(r.water_absorbed);
}

/// The hash of `scenario(threads)`, which must not depend on the number of threads.
template <class Scenario>
void on_any_threads(fingerprint& f, Scenario const& scenario) {
    fingerprint one;
    scenario(one, tafoni::thread_pool(1));
    for (std::size_t const threads : {2U, 7U}) {
        fingerprint more;
        scenario(more, tafoni::thread_pool(threads));
        if (more.value() != one.value()) {
            std::printf("other bits with %zu threads\n", threads);
            std::exit(1);
        }
    }
    f.add(one.value());
}

tafoni::solid l_body() { return tafoni::make_solid(tafoni_test::l_shape()); }

void site_patterns(fingerprint& f) {
    tafoni::solid const body = tafoni::make_solid(tafoni_test::torus(2, 0.8, 24, 16));
    auto const add = [&](std::vector<tafoni::vec3> const& sites) { f.add(std::span<tafoni::vec3 const>(sites)); };
    add(tafoni::random_sites{.count = 300}(body, 1));
    add(tafoni::surface_sites{.count = 300}(body, 2));
    add(tafoni::grid_sites{.count = 300, .jitter = 0.5}(body, 3));
    add(tafoni::hexagonal_sites{}(body, 4));
    add(tafoni::poisson_sites{}(body, 5));
}

void shards_of_an_l(fingerprint& f) {
    tafoni::solid const body = l_body();
    std::vector<tafoni::vec3> const sites = tafoni::random_sites{.count = 400}(body, 7);
    on_any_threads(f, [&](fingerprint& g, tafoni::thread_pool const& pool) {
        tafoni::shard_complex const shards = tafoni::voronoi_shards(body, sites, {}, pool);
        add_complex(g, shards);
        add_network(g, tafoni::make_link_graph(shards, {}, pool));
    });
}

void shards_of_a_grid(fingerprint& f) {
    tafoni::solid const body = tafoni::make_solid(tafoni_test::box_with_cavity());
    auto const shards = tafoni::voronoi_shards(body, tafoni::grid_sites{.count = 216, .jitter = 0}(body, 1));
    add_complex(f, shards);
    add_network(f, tafoni::make_link_graph(shards));
}

void shards_of_limbs(fingerprint& f) {
    tafoni::solid const body = tafoni::make_solid(tafoni_test::thin_limbs());
    add_complex(f, tafoni::voronoi_shards(body, tafoni::surface_sites{.count = 200}(body, 8)));
}

void frost(fingerprint& f, tafoni::frost_preset const& preset, std::uint32_t batch) {
    tafoni::solid const body = l_body();
    auto const shards = tafoni::voronoi_shards(body, tafoni::random_sites{.count = 400}(body, 9));
    auto const links = tafoni::make_link_graph(shards);
    on_any_threads(f, [&](fingerprint& g, tafoni::thread_pool const& pool) {
        tafoni::frost_run run(links, preset.process, preset.options);
        run.run({.paths = 3000, .batch = batch}, {}, pool);
        add_run(g, run);
        for (std::byte const b : run.checkpoint()) g.add(static_cast<int>(b));
    });
}

void frost_of_the_paper(fingerprint& f) { frost(f, tafoni::paper_preset(), 1); }
void frost_of_the_addon(fingerprint& f) { frost(f, tafoni::addon_preset(), 1); }
void frost_in_batches(fingerprint& f) { frost(f, tafoni::paper_preset(), 64); }

void frost_on_voxels(fingerprint& f) {
    auto const ball = tafoni::voxel_cells::from_indices({.size = {12, 12, 12}}, [](auto i, auto j, auto k) {
        auto const from = [](std::size_t a) { return (static_cast<double>(a) - 5.5) * (static_cast<double>(a) - 5.5); };
        return from(i) + from(j) + from(k) < 36;
    });
    tafoni::frost_run run(ball, tafoni::frost_wedging{.rain = tafoni::cone_rain{}}, {.seed = 5});
    run.run({.paths = 4000});
    add_run(f, run);
}

/// A crumbling knoll under everything that voxel weathering has.
auto knoll(tafoni::curvature_measure measure) {
    tafoni::gradient_noise const rough{.seed = 8, .frequency = 0.15};
    tafoni::sparse_grid g({.size = {44, 40, 38}}, tafoni::up_axis::plus_z,
                          {{tafoni::border_kind::air, tafoni::border_kind::extend, tafoni::border_kind::air,
                            tafoni::border_kind::air, tafoni::border_kind::rock, tafoni::border_kind::air}});
    for (std::size_t b = 0; b < g.brick_count(); ++b) {
        g.fill_brick(b, [&](tafoni::voxel v) {
            double const x = v.x - 30;
            double const y = v.y - 20;
            bool const inside = x * x + y * y + v.z * v.z < 700 + 300 * rough(tafoni::vec3{1.0 * v.x, 1.0 * v.y, 1.0 * v.z});
            return inside ? tafoni::voxel_state::rock : tafoni::voxel_state::air;
        });
    }
    auto const process = tafoni::voxel_weathering{
        .bubbles = tafoni::bubble_mixture{.bubbles = {tafoni::sphere_bubble{.radius = 4}, tafoni::gumdrop_bubble{.radius = 6}},
                                          .field = tafoni::gradient_noise{.seed = 9, .frequency = 0.1}},
        .durability = tafoni::durability_profile<>{.points = {{0, 0.02, 0.01, 0.2}, {20, 0.01}}}};
    return tafoni::voxel_run(std::move(g), process,
                             {.measure = measure,
                              .skin_depth = measure == tafoni::curvature_measure::air_share ? 1 : 2,
                              .colluvium = tafoni::repose_rule{.angle = 40, .baseline = 2},
                              .rockfall = tafoni::rockfall_options{},
                              .seed = 11});
}
template <class Run>
void add_voxels(fingerprint& f, Run const& run) {
    for (std::byte const b : run.checkpoint()) f.add(std::to_integer<unsigned>(b));
    auto const out = tafoni::extract_weathered_voxels(run);
    for (auto const* numbers : {&out.rock, &out.colluvium}) {
        for (auto const* values : {&numbers->curvature, &numbers->durability, &numbers->decimation, &numbers->cavernous}) {
            for (double const v : *values) f.add(v);
        }
    }
    for (auto const* mesh : {&out.surface.rock.mesh, &out.surface.colluvium.mesh}) {
        for (auto const& p : mesh->positions) f.add(p);
        for (auto const c : mesh->corners) f.add(c);
    }
}

void voxels_by_steps(fingerprint& f) {
    auto run = knoll(tafoni::curvature_measure::air_share);
    run.run({.phases = {{.steps = 8}, {.steps = 4, .spheroidal = 0.25, .cavernous = 1}}});
    add_voxels(f, run);
}
void voxels_on_threads(fingerprint& f) {
    tafoni::thread_pool const pool(3);
    auto run = knoll(tafoni::curvature_measure::signed_excess);
    run.run({.phases = {{.steps = 30}, {.steps = 20, .spheroidal = 1, .cavernous = 1}}}, {}, pool);
    add_voxels(f, run);
}
void voxels_by_events(fingerprint& f) {
    auto run = knoll(tafoni::curvature_measure::air_share);
    run.run({.phases = {{.steps = 5, .spheroidal = 1, .cavernous = 0.5}}, .clock = tafoni::voxel_clock::events});
    add_voxels(f, run);
}

/// A dented ball, from roots and our own noise only.
tafoni::triangle_surface dented(int level) {
    tafoni::gradient_noise const rough{.seed = 21, .frequency = 2.3};
    auto const ball = tafoni_test::icosphere(level);
    tafoni::triangle_surface s{.positions = ball.positions, .triangles = {}};
    for (auto& p : s.positions) {
        double const r = 1 + 0.3 * rough(p);
        p = tafoni::vec3{r * p[0], r * p[1], r * p[2]};
    }
    for (std::size_t f = 0; f < ball.face_count(); ++f) s.triangles.push_back({ball.face(f)[0], ball.face(f)[1], ball.face(f)[2]});
    return s;
}
void add_surface(fingerprint& f, tafoni::triangle_surface const& s) {
    for (auto const& p : s.positions) f.add(p);
    for (auto const& t : s.triangles) {
        for (auto const c : t) f.add(c);
    }
}

void curvature_by_estimators(fingerprint& f) {
    tafoni::thread_pool const pool(3);
    auto s = dented(3);
    s.triangles.resize(s.triangles.size() - 37);  // open
    auto const add = [&](auto const& estimator, auto const& threads) {
        for (double const h : tafoni::estimate_curvature(s, estimator, threads)) f.add(h);
    };
    add(tafoni::tensor_fit{}, tafoni::inline_executor{});
    add(tafoni::tensor_fit{}, pool);
    add(tafoni::cotangent{}, tafoni::inline_executor{});
    add(tafoni::cotangent{}, pool);
    add(tafoni::quadric_fit{}, pool);
    add(tafoni::bubble_ratio{}, pool);
}
void weathered_by_curvature(fingerprint& f) {
    tafoni::thread_pool const pool(3);
    tafoni::curvature_run run(dented(4),
                              tafoni::curvature_weathering{.direction = tafoni::blended_direction{},
                                                           .durability = tafoni::gradient_noise{.seed = 4, .frequency = 3}},
                              {.power = 2.5, .small_edge = 0.4, .check_every = 8});
    run.run(20, {}, pool);
    add_surface(f, run.surface());
    for (double const w : run.wear()) f.add(w);
    for (auto const v : run.new_vertex()) f.add(v.value);
    f.add(run.report().edges_collapsed);
    f.add(run.report().removed_volume);
    tafoni::curvature_run cubed(dented(3));
    cubed.run(15);
    for (std::byte const b : cubed.checkpoint()) f.add(std::to_integer<unsigned>(b));
}
void wrinkles(fingerprint& f) {
    auto const s = dented(3);
    std::vector<tafoni::wrinkle> const lines{
        {.controls = {tafoni::vertex_index{0U}, tafoni::vertex_index{40U}, tafoni::vertex_index{7U}}, .radius = 0.2},
        {.controls = {tafoni::vertex_index{3U}, tafoni::vertex_index{9U}}, .radius = 0.15, .strength = -2,
         .profile = tafoni::wrinkle_profile::groove}};
    std::vector<tafoni::enlargement> const swellings{{.centre = tafoni::vertex_index{100U}, .radius = 0.4}};
    tafoni::wrinkle_pattern const pattern(s, lines, swellings);
    add_surface(f, pattern.wear(s.positions, 3));
    for (double const d : pattern.displacement()) f.add(d);
}

template <class Fluid>
void add_fluid(fingerprint& f, Fluid const& fluid) {
    tafoni::detail::byte_writer out;
    fluid.save(out);
    for (std::byte const b : out.bytes()) f.add(std::to_integer<unsigned>(b));
}
/// What falls on the dented ball from above it, and is gone below.
tafoni::box_emitter const above{.box = {.lo = {-0.4, -0.5, 1.3}, .hi = {0.5, 0.4, 1.8}}, .velocity = {0.1, 0, -1}};
tafoni::box_sink const around{.keep = {.lo = {-2, -2, -1.5}, .hi = {2, 2, 2}}};
tafoni::rain_particles shower() {
    return {above, around, {.particles = 120, .radius = 0.08, .friction = 0.5, .lifetime = 2, .seed = 6}};
}

template <class Scalar>
void water(fingerprint& f) {
    tafoni::thread_pool const pool(3);
    auto const ball = dented(3);
    tafoni::sph<Scalar> water(above, around, {.particles = 400, .spacing = 0.1, .smoothing = 1.1, .sound_speed = 20, .viscosity = 0.01, .toward = 3});
    tafoni::mesh_boundary const walls(ball.positions, ball.triangles, water.reach());
    for (int k = 0; k < 60; ++k) f.add(k % 2 == 0 ? water.step(walls, pool) : water.step(walls, tafoni::inline_executor{}));
    add_fluid(f, water);
}
void water_by_frames(fingerprint& f) {
    auto const ball = dented(3);
    tafoni::sph<float> water(above, around, {.particles = 200, .spacing = 0.1, .sound_speed = 20, .frame = 0.02});
    tafoni::mesh_boundary const walls(ball.positions, ball.triangles, water.reach());
    for (int k = 0; k < 10; ++k) f.add(water.step(walls, tafoni::inline_executor{}));
    add_fluid(f, water);
}
void rain(fingerprint& f) {
    tafoni::thread_pool const pool(3);
    auto const ball = dented(3);
    tafoni::mesh_boundary const walls(ball.positions, ball.triangles, 0.08);
    auto drops = shower();
    for (int k = 0; k < 400; ++k) f.add(drops.step(walls, pool));
    add_fluid(f, drops);
    tafoni::rain_particles framed(above, around, {.particles = 120, .radius = 0.08, .adhesion = 0.5, .frame = 0.05});
    for (int k = 0; k < 20; ++k) f.add(framed.step(walls, pool));
    add_fluid(f, framed);
}

template <class Run>
void add_water_wear(fingerprint& f, Run const& run) {
    add_surface(f, run.surface());
    for (double const w : run.wear()) f.add(w);
    for (double const v : run.sediment()) f.add(v);
    for (auto const n : run.flow()) f.add(n);
    f.add(run.report().ledger.eroded);
}
void worn_by_shear(fingerprint& f) {
    tafoni::thread_pool const pool(3);
    tafoni::hydraulic_run run(dented(3), shower(), tafoni::partheniades_erosion{.coefficient = 1e-4, .critical = 2, .exponent = 1.5, .power = 0.7},
                              {.refine_length = 0.12});
    run.run(60, {}, pool);
    add_water_wear(f, run);
}
void worn_by_curvature_and_water(fingerprint& f) {
    tafoni::thread_pool const pool(3);
    tafoni::hydraulic_run run(dented(3), shower(), tafoni::curvature_erosion<>{.power = 1.5, .influence = 0.2});
    run.run(60, {}, pool);
    add_water_wear(f, run);
}

}  // namespace

int main() {
    print("random_streams", random_streams);
    print("vector_algebra", vector_algebra);
    print("sums", sums);
    print("elementary_functions", elementary_functions);
    print("noise", noise);
    print("site_patterns", site_patterns);
    print("shards_of_an_l", shards_of_an_l);
    print("shards_of_a_grid", shards_of_a_grid);
    print("shards_of_limbs", shards_of_limbs);
    print("frost_of_the_paper", frost_of_the_paper);
    print("frost_of_the_addon", frost_of_the_addon);
    print("frost_in_batches", frost_in_batches);
    print("frost_on_voxels", frost_on_voxels);
    print("voxels_by_steps", voxels_by_steps);
    print("voxels_on_threads", voxels_on_threads);
    print("voxels_by_events", voxels_by_events);
    print("curvature_by_estimators", curvature_by_estimators);
    print("weathered_by_curvature", weathered_by_curvature);
    print("wrinkles", wrinkles);
    print("water_float", water<float>);
    print("water_double", water<double>);
    print("water_by_frames", water_by_frames);
    print("rain", rain);
    print("worn_by_shear", worn_by_shear);
    print("worn_by_curvature_and_water", worn_by_curvature_and_water);
}
