// Figure 14: the hill in about 2,900 shards, its skin core but for the front, rain into the front, 70,000 paths.
#include "scene.hpp"

#include <support/test_data.hpp>
#include <tafoni/decomposition/grid_sites.hpp>
#include <tafoni/io/read_mesh.hpp>

#include <catch2/catch.hpp>

using namespace tafoni_test;

namespace {

/// A bumpy dome for machines without the data: the same class of shape.
solid dome() {
    indexed_mesh m = icosphere(4);
    for (vec3& p : m.positions) {
        double const bump = 1 + 0.08 * std::floor(3 * p[0] * p[1] + 0.5);
        p = vec3{6 * p[0] * bump, 6 * p[1] * bump, p[2] < 0 ? 0.2 * p[2] : 5 * p[2]};
    }
    return make_solid(m);
}

void carve(solid const& body) {
    scene const s = make_scene(body, grid_sites{.count = 2900, .jitter = 0.8}(body, 14));
    CHECK(s.shards.cell_count() > 2500);
    vec3 const front = normalized({0, -1, 0.1});
    auto const hull = skin_cells_where(s.links, [&](vec3 const& n) { return dot(n, front) < 0.55; });
    auto const process = frost_wedging{.rain = directional_rain{.direction = normalized({0, 1, -0.25})}};
    frost_run run(s.links, process, {.seed = 14});
    run.mark(hull, cell_state::core);

    std::vector<double> fallen;
    for (int third = 0; third < 3; ++third) {
        (void)run.run({.paths = third == 0 ? 23000u : 23500u});
        fallen.push_back(volume_of(run, cell_state::air));
    }
    REQUIRE(run.paths() == 70000);
    // A cave grows from the front towards the inside, and the hull stands.
    CHECK(fallen[0] > 0);
    CHECK(fallen[0] < fallen[1]);
    CHECK(fallen[1] < fallen[2]);
    CHECK(fallen[2] > 0.02 * body.volume);
    CHECK(fallen[2] < 0.7 * body.volume);
    for (cell_index const c : hull) CHECK(run.cell(c) == cell_state::core);
    CHECK(all_solid_hangs_on_core(run));
    double const early = mean_place_fallen(run, s.shards, 0, 23000)[1];
    double const late = mean_place_fallen(run, s.shards, 46500, 70000)[1];
    CHECK(early < body.bounds.centre()[1]);
    CHECK(late > early);
}

}  // namespace

TEST_CASE("cave: it grows inwards from the one open side of a dome", "[paper]") { carve(dome()); }

TEST_CASE("cave: it grows inwards from the one open side of the paper's hill", "[paper]") {
    auto const path = find("meshes/hill3d_1.9k_quads.obj");
    if (path.empty()) {
        WARN("skipped: no hill3d_1.9k_quads.obj");
        return;
    }
    carve(make_solid(read_mesh(path).mesh));
}

TEST_CASE("Table 1: links per cell stay near 6 to 7, whatever the number of cells", "[paper]") {
    auto const path = find("meshes/hill3d_1.9k_quads.obj");
    if (path.empty()) {
        WARN("skipped: no hill3d_1.9k_quads.obj");
        return;
    }
    solid const hill = make_solid(read_mesh(path).mesh);
    CHECK(hill.volume == Approx(282.169).epsilon(1e-5));
    for (std::size_t const n : {100u, 1000u, 5000u}) {
        CAPTURE(n);
        scene const s = make_scene(hill, grid_sites{.count = n, .jitter = 1}(hill, 1));
        double const per_cell =
            static_cast<double>(s.links.interior_link_count()) / static_cast<double>(s.shards.cell_count());
        CHECK(per_cell > 4.5);
        CHECK(per_cell < 7.8);
    }
}
