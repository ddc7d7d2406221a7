#include "percolation/box_network.hpp"
#include "support/code_of.hpp"
#include "support/shapes.hpp"

#include <tafoni/tafoni.hpp>

#include <catch2/catch.hpp>

#include <functional>
#include <limits>

using namespace tafoni;
using namespace tafoni_test;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double huge_value = 1e301;  ///< beyond every range that is not bounded by doubles alone

/// A parameter, how to try a value, and values that are refused beside NaN and the infinities.
struct parameter {
    char const* name;
    std::function<void(double)> attempt;
    std::vector<double> refused;
    std::vector<double> accepted;
};

template <class T>
std::function<void(double)> validated(T prototype, auto set) {
    return [prototype, set](double v) {
        T t = prototype;
        set(t, v);
        t.validate();
    };
}

#define FIELD(T, member) validated(T, [](auto& t, double v) { t.member = v; })

std::vector<parameter> fields() {
    strata const two{.tops = {1.0}, .values = {0.0, 1.0}};
    pockets<> const one{.bodies = {pocket{}}};
    static std::vector<float> const samples(8, 1.0F);
    grid_field<float> const grid{.samples = samples, .size = {2, 2, 2}};
    return {
        {"fractal_noise.frequency", FIELD(fractal_noise{}, frequency), {-1, huge_value}, {0, 1e30}},
        {"fractal_noise.lacunarity", FIELD(fractal_noise{}, lacunarity), {0.99, 17}, {1, 16}},
        {"fractal_noise.gain", FIELD(fractal_noise{}, gain), {-0.1, 1.1}, {0, 1}},
        {"gradient_noise.frequency", FIELD(gradient_noise{}, frequency), {-1, huge_value}, {0, 1e30}},
        {"grid_field.origin", FIELD(grid, origin[1]), {huge_value}, {-1e10}},
        {"grid_field.spacing", FIELD(grid, spacing[2]), {0, -1, huge_value}, {1e-10}},
        {"jittered.amplitude", FIELD((jittered<constant_field>{}), amplitude), {-1, huge_value}, {0, 1}},
        {"jittered.noise", FIELD((jittered<constant_field>{}), noise.gain), {2}, {0.3}},
        {"pocket.centre", FIELD(one, bodies[0].centre[0]), {huge_value}, {-5}},
        {"pocket.radii", FIELD(one, bodies[0].radii[1]), {0, -1, huge_value}, {0.1}},
        {"pocket.value", FIELD(one, bodies[0].value), {huge_value}, {0.1}},
        {"ramp_field.start", FIELD(ramp_field{}, start[2]), {1}, {0}},
        {"ramp_field.end", FIELD(ramp_field{}, end[2]), {0}, {3}},
        {"ramp_field.at_start", FIELD(ramp_field{}, at_start), {huge_value}, {0.3}},
        {"ramp_field.at_end", FIELD(ramp_field{}, at_end), {huge_value}, {0.3}},
        {"remapped.from_low", FIELD((remapped<constant_field>{}), from_low), {1, 2}, {0}},
        {"remapped.from_high", FIELD((remapped<constant_field>{}), from_high), {-1, -2}, {0}},
        {"remapped.to_low", FIELD((remapped<constant_field>{}), to_low), {huge_value}, {0.5}},
        {"remapped.to_high", FIELD((remapped<constant_field>{}), to_high), {huge_value}, {0.5}},
        {"sine_field.wave", FIELD(sine_field{}, wave[0]), {huge_value}, {0.5}},
        {"sine_field.phase", FIELD(sine_field{}, phase), {huge_value}, {0.5}},
        {"sine_field.mean", FIELD(sine_field{}, mean), {huge_value}, {0.5}},
        {"sine_field.amplitude", FIELD(sine_field{}, amplitude), {huge_value}, {0.5}},
        {"strata.up", FIELD(two, up[2]), {0, 0.5, -2}, {-1}},
        {"strata.tops", FIELD(two, tops[0]), {huge_value}, {-5}},
        {"strata.values", FIELD(two, values[1]), {huge_value}, {-5}},
    };
}

std::vector<parameter> policies() {
    return {
        {"directional_rain.direction", FIELD(directional_rain{}, direction[2]), {0, 1.1, -0.5}, {1}},
        {"cone_rain.axis", FIELD(cone_rain{}, axis[2]), {0, 2}, {1}},
        {"cone_rain.spread", FIELD(cone_rain{}, spread), {-1, 181}, {0, 180}},
        {"facing_infiltration.cutoff", FIELD(facing_infiltration{}, cutoff), {-0.1, 1}, {0, 0.5}},
        {"gravity_flow.down", FIELD(gravity_flow{}, down[2]), {0, -3}, {1}},
        {"gravity_flow.alignment_cutoff", FIELD(gravity_flow{}, alignment_cutoff), {-0.1, 1}, {0, 0.9}},
        {"gravity_flow.resistance_weight", FIELD(gravity_flow{}, resistance_weight), {-0.1, 11}, {0, 10}},
        {"gravity_flow.passage_floor", FIELD(gravity_flow{}, passage_floor), {-0.1, 1.1}, {0, 1}},
        {"gravity_flow.exit_weight", FIELD(gravity_flow{}, exit_weight), {-0.1, 1.1}, {0, 1}},
        {"surface_absorption.k_solid", FIELD(surface_absorption{}, k_solid), {-1, 2e6}, {0, 1}},
        {"surface_absorption.k_air", FIELD(surface_absorption{}, k_air), {-1, 2e6}, {0, 1}},
        {"surface_absorption.k_res", FIELD(surface_absorption{}, k_res), {-1, 2e6}, {0, 1}},
        {"surface_absorption.resistance_weight", FIELD(surface_absorption{}, resistance_weight), {-1, 11}, {0, 1}},
        {"surface_damage.k_dmg", FIELD(surface_damage{}, k_dmg), {-1, 2e6}, {0, 1}},
        {"depletion_soaking.threshold", FIELD(depletion_soaking{}, threshold), {-0.1, 1.1}, {0, 1}},
        {"depletion_soaking.continue_chance", FIELD(depletion_soaking{}, continue_chance), {-0.1, 1.1}, {0, 1}},
        {"depletion_soaking.wearing", FIELD(depletion_soaking{}, wearing), {-0.1, 1.1}, {0, 1}},
        {"low_life_breakage.k_break", FIELD(low_life_breakage{}, k_break), {-0.1, 1.1}, {0, 1}},
        {"low_life_breakage.p_max", FIELD(low_life_breakage{}, p_max), {-0.1, 1.1}, {0, 1}},
        {"low_life_breakage.p_min", FIELD(low_life_breakage{}, p_min), {-0.1, 0.95}, {0, 0.9}},
        {"frost_options.water", FIELD(frost_options{}, water), {-1, 1025}, {0, 1024}},
        {"link_graph_options.tolerance", FIELD(link_graph_options{}, tolerance), {-1, 0.02}, {0, 1e-2}},
    };
}

std::vector<parameter> sites() {
    solid const s = make_solid(unit_box());
    auto const placed = [s](auto prototype, auto set) {
        return [=](double v) {
            auto t = prototype;
            set(t, v);
            (void)t(s, 1);
        };
    };
    slab_sites const slabs{.spacings = {0.5}, .across = 0.5};
    return {
        {"grid_sites.jitter", placed(grid_sites{.count = 5}, [](auto& t, double v) { t.jitter = v; }), {-0.1, 1.1}, {0, 1}},
        {"hexagonal_sites.jitter", placed(hexagonal_sites{.count = 5}, [](auto& t, double v) { t.jitter = v; }), {-0.1, 1.1}, {0, 1}},
        {"hexagonal_sites.vertical_jitter", placed(hexagonal_sites{.count = 5}, [](auto& t, double v) { t.vertical_jitter = v; }), {-0.1, 11}, {0, 10}},
        {"hexagonal_sites.axis", placed(hexagonal_sites{.count = 5}, [](auto& t, double v) { t.axis[2] = v; }), {0, 2}, {-1}},
        {"poisson_sites.radius", placed(poisson_sites<>{}, [](auto& t, double v) { t.radius.value = v; }), {0, -1, 1e-5, 100}, {0.5}},
        {"slab_sites.spacings", placed(slabs, [](auto& t, double v) { t.spacings[0] = v; }), {0, -1, 1e-9}, {0.3, 5}},
        {"slab_sites.across", placed(slabs, [](auto& t, double v) { t.across = v; }), {0, -1, 1e-9}, {0.3, 5}},
        {"slab_sites.up", placed(slabs, [](auto& t, double v) { t.up[2] = v; }), {0, 3}, {-1}},
        {"slab_sites.jitter", placed(slabs, [](auto& t, double v) { t.jitter = v; }), {-0.1, 1.1}, {0, 1}},
        {"given_sites.points", placed(given_sites{{vec3{0, 0, 0}}}, [](auto& t, double v) { t.points[0][1] = v; }), {}, {5}},
        {"vertex_sites.vertices", placed(vertex_sites{.count = 1, .vertices = {vec3{0, 0, 0}}}, [](auto& t, double v) { t.vertices[0][1] = v; }), {}, {5}},
        {"voronoi_shards.sites", [s](double v) { (void)voronoi_shards(s, std::vector<vec3>{{0.5, v, 0.5}}); }, {-0.1, 1.1}, {0, 1, 0.5}},
        {"voronoi_shards_options.patch_angle", [s](double v) { (void)voronoi_shards(s, std::vector<vec3>{{0.5, 0.5, 0.5}}, {.patch_angle = v}); }, {-1, 181}, {0, 180}},
        {"voronoi_shards_options.min_volume", [s](double v) { (void)voronoi_shards(s, std::vector<vec3>{{0.5, 0.5, 0.5}}, {.min_volume = v}); }, {-1, 1.1}, {0, 1}},
        {"voxelize spacing", [s](double v) { (void)voxelize(s, v); }, {0, -1, 1e-9}, {0.5, 3}},
        {"voxel_cells_options.spacing", [s](double v) { (void)voxelize(s, {.size = {2, 2, 2}, .spacing = {0.5, v, 0.5}}); }, {0, -1, 1e101}, {0.5}},
        {"voxel_cells_options.origin", [s](double v) { (void)voxelize(s, {.size = {2, 2, 2}, .spacing = {0.5, 0.5, 0.5}, .origin = {0, v, 0}}); }, {1e101}, {-5}},
        {"displaced_faces_options.edge_length", [s](double v) {
             auto const c = voronoi_shards(s, std::vector<vec3>{{0.2, 0.5, 0.5}, {0.7, 0.5, 0.5}});
             std::vector<cell_index> const one{cell_index{0U}};
             (void)displaced_faces(extract_surface(c, one), field_displacement{constant_field{0.5}, 0.01}, {.edge_length = v});
         }, {0, -1}, {0.5}},
    };
}

std::vector<parameter> terrain() {
    height_grid const grid{.columns = 2, .rows = 2, .heights = {1, 2, 3, 4}};
    auto const solid_of = [grid](auto set) {
        return [=](double v) {
            height_grid g = grid;
            set(g, v);
            (void)terrain_solid(g);
        };
    };
    return {
        {"height_grid.cell_size_x", solid_of([](height_grid& g, double v) { g.cell_size_x = v; }), {0, -1}, {0.1}},
        {"height_grid.cell_size_y", solid_of([](height_grid& g, double v) { g.cell_size_y = v; }), {0, -1}, {0.1}},
        {"height_grid.lower_left_x", solid_of([](height_grid& g, double v) { g.lower_left_x = v; }), {}, {-5}},
        {"height_grid.lower_left_y", solid_of([](height_grid& g, double v) { g.lower_left_y = v; }), {}, {-5}},
        {"height_grid.heights", solid_of([](height_grid& g, double v) { g.heights[2] = v; }), {1e200}, {-5}},
        {"terrain_options.depth", [grid](double v) { (void)terrain_solid(grid, {.depth = v}); }, {-1, 1e200}, {0, 3}},
        {"frost resistance", [](double v) {
             box_network const n(2, 1, 1);
             frost_wedging<> p;
             p.flow.resistance.value = v;
             frost_run const run(n, p);
         }, {-0.1, 1.1}, {0, 1}},
        {"mesh coordinate", [](double v) {
             indexed_mesh m = unit_box();
             m.positions[7][2] = v;
             (void)make_solid(m);
         }, {1e300}, {1.5}},
    };
}

void check(std::vector<parameter> const& all) {
    for (parameter const& p : all) {
        std::vector<double> refused{not_a_number, infinite, -infinite};
        refused.insert(refused.end(), p.refused.begin(), p.refused.end());
        for (double const v : refused) {
            INFO(p.name << " = " << v);
            try {
                p.attempt(v);
                FAIL_CHECK("accepted");
            } catch (invalid_input const& e) {
                CHECK(e.code() != errc{});
                CHECK(std::string(e.what()).size() > 10);
            }
        }
        for (double const v : p.accepted) {
            INFO(p.name << " = " << v);
            CHECK_NOTHROW(p.attempt(v));
        }
    }
}

}  // namespace

TEST_CASE("Q1: every real parameter of a field refuses NaN, infinities and what lies out of its range") { check(fields()); }
TEST_CASE("Q1: every real parameter of a policy refuses NaN, infinities and what lies out of its range") { check(policies()); }
TEST_CASE("Q1: every real parameter of sites and shards refuses NaN, infinities and what lies out of its range") { check(sites()); }
TEST_CASE("Q1: every real parameter of terrain, runs and meshes refuses NaN, infinities and what lies out of its range") { check(terrain()); }

TEST_CASE("Q4: counts of zero and counts beyond all memory are refused before anything is allocated") {
    solid const s = make_solid(unit_box());
    std::size_t const huge = std::numeric_limits<std::size_t>::max();
    CHECK(code_of([&] { (void)random_sites{.count = 0}(s, 1); }) == errc::no_sites);
    CHECK(code_of([&] { (void)grid_sites{.count = 0}(s, 1); }) == errc::no_sites);
    CHECK(code_of([&] { (void)hexagonal_sites{.count = 0}(s, 1); }) == errc::no_sites);
    CHECK(code_of([&] { (void)surface_sites{.count = 0}(s, 1); }) == errc::no_sites);
    CHECK(code_of([&] { (void)vertex_sites{.count = 0}(s, 1); }) == errc::no_sites);
    CHECK(code_of([&] { (void)given_sites{}(s, 1); }) == errc::no_sites);
    CHECK(code_of([&] { (void)random_sites{.count = huge}(s, 1); }) == errc::bad_parameter);
    CHECK(code_of([&] { (void)grid_sites{.count = huge}(s, 1); }) == errc::bad_parameter);
    CHECK(code_of([&] { (void)hexagonal_sites{.count = huge}(s, 1); }) == errc::bad_parameter);
    CHECK(code_of([&] { (void)hexagonal_sites{.count = 4, .layers = huge}(s, 1); }) == errc::bad_parameter);
    CHECK(code_of([&] { (void)surface_sites{.count = huge}(s, 1); }) == errc::bad_parameter);
    CHECK(code_of([&] { (void)vertex_sites{.count = 9}(s, 1); }) == errc::bad_parameter);
    CHECK(code_of([&] { (void)slab_sites{}(s, 1); }) == errc::bad_parameter);
    CHECK(code_of([&] { (void)poisson_sites<>{.radius = {0.4}, .attempts = 0}(s, 1); }) == errc::bad_parameter);
    CHECK(code_of([&] { (void)poisson_sites<>{.radius = {0.01}, .most = 10}(s, 1); }) == errc::size_overflow);
    CHECK(code_of([&] { frost_schedule{.batch = 0}.validate(); }) == errc::bad_parameter);
    CHECK(code_of([&] { frost_schedule{.batch = 0xFFFFFFFFU}.validate(); }) == errc::bad_parameter);
    CHECK(code_of([&] { frost_options{.longest_path = 0}.validate(); }) == errc::bad_parameter);
    CHECK(code_of([&] { fractal_noise{.octaves = 65}.validate(); }) == errc::bad_parameter);
}

TEST_CASE("Q9: grids larger than 32-bit numbers are refused with the number, in 128 bits") {
    std::size_t const huge = std::numeric_limits<std::size_t>::max();
    auto const never = [](auto, auto, auto) -> bool { throw 1; };
    for (std::array<std::size_t, 3> const size : {std::array<std::size_t, 3>{huge, huge, huge}, {1U << 16, 1U << 16, 1U << 16}, {1, 1, huge}}) {
        CHECK(code_of([&] { (void)voxel_cells::from_indices({.size = size}, never); }) == errc::size_overflow);
    }
    CHECK(code_of([&] { (void)voxel_cells::from_indices({.size = {0, 3, 3}}, never); }) == errc::bad_parameter);
    std::vector<float> const one(1, 1.0F);
    CHECK(code_of([&] { grid_field<float>{.samples = one, .size = {1U << 31, 1U << 31, 4}}.validate(); }) == errc::attribute_length);
    CHECK(code_of([&] { grid_field<float>{.samples = one, .size = {huge, 1, 1}}.validate(); }) == errc::size_overflow);
    CHECK(code_of([&] { grid_field<float>{.samples = one, .size = {0, 0, 0}}.validate(); }) == errc::attribute_length);
    CHECK(code_of([&] { (void)terrain_solid(height_grid{.columns = huge, .rows = huge}); }) == errc::size_overflow);
    CHECK(code_of([&] { (void)terrain_solid(height_grid{.columns = 1, .rows = 9, .heights = std::vector<double>(9)}); }) == errc::empty_input);
    CHECK(code_of([&] { (void)terrain_solid(height_grid{.columns = 3, .rows = 3, .heights = {1.0}}); }) == errc::attribute_length);
}

TEST_CASE("Q10: noise is finite and in range whatever its parameters and the place") {
    for (unsigned const octaves : {0U, 1U, 64U, 200U}) {
        for (double const frequency : {0.0, 1e-300, 1.0, 1e30, 1e300, not_a_number}) {
            for (double const lacunarity : {1.0, 2.0, 16.0, not_a_number}) {
                fractal_noise const n{.seed = ~std::uint64_t{0}, .frequency = frequency, .octaves = octaves, .lacunarity = lacunarity};
                for (vec3 const& p : {vec3{0, 0, 0}, vec3{1e300, -1e300, 1e-300}, vec3{0.3, 0.4, 1e15}, vec3{infinite, not_a_number, 0}}) {
                    double const v = n(p);
                    INFO(octaves << " octaves, frequency " << frequency << ", lacunarity " << lacunarity);
                    bool const in_range = v >= -1 && v <= 1;
                    CHECK(in_range);
                }
            }
        }
    }
}

TEST_CASE("Q7: seeds of 0 and of all ones, and runs of no paths or 2^63 that are stopped at once") {
    box_network const n(2, 2, 2);
    for (std::uint64_t const seed : {std::uint64_t{0}, ~std::uint64_t{0}}) {
        frost_run a(n, {}, {.seed = seed});
        frost_run b(n, {}, {.seed = seed});
        auto const start = a.checkpoint();
        a.run({.paths = 0});
        CHECK(a.checkpoint() == start);
        a.run({.paths = std::uint64_t{1} << 63}, {.on_progress = [](progress_event const&) { return step_control::stop; }});
        CHECK(a.checkpoint() == start);
        a.run({.paths = 64, .batch = 8});
        b.run({.paths = 64, .batch = 8});
        CHECK(a.checkpoint() == b.checkpoint());
    }
}

TEST_CASE("Q12: empty, default and moved-from things are refused or empty, never undefined") {
    solid const nothing;
    CHECK(code_of([&] { (void)voronoi_shards(nothing, std::vector<vec3>{{0, 0, 0}}); }) == errc::empty_input);
    solid const s = make_solid(unit_box());
    CHECK(code_of([&] { (void)voronoi_shards(s, std::span<vec3 const>{}); }) == errc::no_sites);
    CHECK(code_of([&] { (void)make_solid(indexed_mesh{}); }) == errc::empty_input);
    CHECK(make_link_graph(shard_complex{}).link_count() == 0);
    CHECK(extract_surface(shard_complex{}, std::span<std::uint8_t const>{}).mesh.face_count() == 0);
    CHECK(repair_mesh(indexed_mesh{}, {}).mesh.face_count() == 0);
    link_graph const g;
    frost_run run(g);
    run.run({.paths = 10});
    CHECK(run.paths() == 10);
}
