// Figure 17: terrain from an elevation model, cells outside it air beforehand, 15,000 paths of slanting rain.
#include "scene.hpp"

#include <support/test_data.hpp>
#include <tafoni/decomposition/grid_sites.hpp>
#include <tafoni/geometry/terrain_solid.hpp>
#include <tafoni/io/esri_ascii.hpp>
#include <tafoni/percolation/cone_rain.hpp>

#include <catch2/catch.hpp>

using namespace tafoni_test;

namespace {

height_grid ridge() {
    height_grid g;
    g.columns = 60;
    g.rows = 50;
    g.cell_size_x = g.cell_size_y = 10;
    for (std::size_t r = 0; r < g.rows; ++r) {
        for (std::size_t c = 0; c < g.columns; ++c) {
            double const x = static_cast<double>(c) / 59 - 0.5;
            double const y = static_cast<double>(r) / 49 - 0.5;
            g.heights.push_back(260 * (1 - 3 * x * x) * (1 - 2 * y * y) + 40 * std::floor(6 * (x + y)) / 6);
        }
    }
    return g;
}

void weather_terrain(height_grid const& grid, std::size_t count) {
    solid const block = terrain_solid(grid);
    scene const s = make_scene(block, grid_sites{.count = count, .jitter = 0.9}(block, 17));
    frost_run run(s.links, frost_wedging{.rain = cone_rain{.axis = normalized({0.4, 0, -1}), .spread = 10}}, {.seed = 17});
    double const base = block.bounds.lo[2];
    double const height = block.bounds.hi[2] - base;
    // The foot is core; a bite out of one corner is air beforehand.
    run.mark(cells_where(s.shards, [&](vec3 const& x) { return x[2] < base + 0.2 * height; }), cell_state::core);
    auto const bite = cells_where(s.shards, [&](vec3 const& x) {
        return x[0] > block.bounds.lo[0] + 0.85 * block.bounds.extent()[0] && x[2] > base + 0.2 * height;
    });
    REQUIRE(!bite.empty());
    run.mark(bite, cell_state::air);
    double const given_away = volume_of(run, cell_state::air);

    (void)run.drop_loose();  // what the bite has cut off

    auto const report = run.run({.paths = 15000});
    CHECK(report.blocks > 10);
    CHECK(report.volume_detached > 0);
    CHECK(all_solid_hangs_on_core(run));
    for (cell_index const c : bite) CHECK(run.cell(c) == cell_state::air);
    // Only carving: what stands, what fell and what was given away make up the terrain.
    double const standing = volume_of(run, cell_state::solid) + volume_of(run, cell_state::core);
    CHECK(standing + report.volume_detached + given_away == Approx(block.volume).epsilon(1e-9));
    // No water through sides and base: their cells have no link there, so nothing enters from below.
    for (std::size_t l = s.links.interior_link_count(); l < s.links.link_count(); ++l) {
        CHECK(s.links.link_normal(link_index{l})[2] > 0);
    }
}

}  // namespace

TEST_CASE("terrain: rain carves a procedural ridge from above only", "[paper]") { weather_terrain(ridge(), 3000); }

TEST_CASE("terrain: rain carves the Stubai Alps from above only", "[paper][slow]") {
    auto const path = find("dems/stubai_10m.asc");
    if (path.empty()) {
        WARN("skipped: no stubai_10m.asc");
        return;
    }
    weather_terrain(read_esri_ascii(path), 8000);
}
