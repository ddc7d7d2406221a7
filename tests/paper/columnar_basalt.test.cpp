// Figure 15: a wall of about 300 hexagonal columns, the last row of them core, 4,000 paths.
#include "scene.hpp"

#include <tafoni/decomposition/hexagonal_sites.hpp>

#include <catch2/catch.hpp>

using namespace tafoni_test;

namespace {

scene basalt(double vertical_jitter) {
    solid const wall = make_solid(box({0, 0, 0}, {20, 10, 8}));
    auto const sites = hexagonal_sites{.count = 300, .jitter = 0.3, .vertical_jitter = vertical_jitter}(wall, 15);
    return make_scene(wall, sites);
}

auto const slanting_rain = frost_wedging{.rain = directional_rain{.direction = normalized({0, 1, -0.7})}};

}  // namespace

TEST_CASE("columnar basalt: columns fall and the last row stands", "[paper]") {
    for (double const vertical_jitter : {0.15, 0.3}) {
        CAPTURE(vertical_jitter);
        scene const s = basalt(vertical_jitter);
        CHECK(s.shards.cell_count() >= 270);
        CHECK(s.shards.cell_count() <= 340);
        frost_run run(s.links, slanting_rain, {.seed = 4});
        auto const last_row = cells_where(s.shards, [](vec3 const& x) { return x[1] > 9.2; });
        REQUIRE(last_row.size() >= 15);
        run.mark(last_row, cell_state::core);

        auto const report = run.run({.paths = 4000});
        CHECK(report.links_broken > s.links.interior_link_count() / 8);
        CHECK(report.blocks >= 3);
        CHECK(report.cells_detached < s.shards.cell_count() / 2);
        for (cell_index const c : last_row) CHECK(run.cell(c) == cell_state::core);
        CHECK(all_solid_hangs_on_core(run));
        // The rain beats on the front: what falls lies in front of the middle of the wall.
        CHECK(mean_place_fallen(run, s.shards, 0, report.paths)[1] < 5);
    }
}

TEST_CASE("columnar basalt: walls of equal height pass no water on to each other", "[paper]") {
    // The erratum: with all sites in one plane the links lie at one height and gravity prefers none of
    // them. Water only enters from the lid and runs out where it came in; hardly a bond breaks.
    auto const broken = [](double vertical_jitter) {
        scene const s = basalt(vertical_jitter);
        frost_run run(s.links, slanting_rain, {.seed = 4});
        return run.run({.paths = 4000}).links_broken;
    };
    std::uint64_t const flat = broken(0);
    CHECK(broken(0.15) > 5 * (flat + 1));
    CHECK(broken(0.3) > 5 * (flat + 1));
}

TEST_CASE("columnar basalt: the vertical jitter of the paper gives its number of links", "[paper]") {
    // 300 cells with 1,497 internal links.
    scene const s = basalt(0.3);
    double const per_cell =
        static_cast<double>(s.links.interior_link_count()) / static_cast<double>(s.shards.cell_count());
    CHECK(per_cell == Approx(1497.0 / 300).margin(0.25));
}
