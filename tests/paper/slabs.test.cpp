// Figure 16: 108 tilted slabs, rain from the left, gravity upwards, absorption doubled, 3,000 paths.
#include "scene.hpp"

#include <tafoni/decomposition/slab_sites.hpp>

#include <catch2/catch.hpp>

using namespace tafoni_test;

namespace {

scene slabs() {
    solid const prism = make_solid(box({0, 0, 0}, {12, 5, 8}));
    vec3 const up = normalized({-0.35, 0, 1});
    auto const sites = slab_sites{.spacings = {1.2, 2.0, 1.0, 1.6}, .across = 2.4, .up = up, .jitter = 0}(prism, 16);
    return make_scene(prism, sites);
}

}  // namespace

TEST_CASE("slabs: upward gravity and rain from the left carve from the upper left to the lower right", "[paper]") {
    scene const s = slabs();
    CHECK(s.shards.cell_count() > 80);
    CHECK(s.shards.cell_count() < 140);
    auto const process = frost_wedging{.rain = directional_rain{.direction = {1, 0, 0}},
                                       .flow = gravity_flow{.down = {0, 0, 1}},
                                       .absorb = surface_absorption{.k_solid = 0.2, .k_air = 0.1, .k_res = 0.5}};
    frost_run run(s.links, process, {.seed = 3});
    auto const foot = cells_where(s.shards, [](vec3 const& x) { return x[0] > 10.8; });
    REQUIRE(!foot.empty());
    run.mark(foot, cell_state::core);
    std::vector<double> fallen;
    for (std::uint64_t const paths : {500u, 1000u, 1500u}) {
        (void)run.run({.paths = paths});
        fallen.push_back(volume_of(run, cell_state::air));
    }
    CHECK(fallen[0] > 0);
    CHECK(fallen[0] < fallen[1]);
    CHECK(fallen[1] < fallen[2]);
    CHECK(all_solid_hangs_on_core(run));
    // The front moves to the right, and what falls first lies higher than the rock's middle.
    vec3 const first = mean_place_fallen(run, s.shards, 0, 500);
    vec3 const last = mean_place_fallen(run, s.shards, 1500, 3000);
    CHECK(first[0] < last[0]);
    CHECK(first[0] < 6);
    CHECK(first[2] > last[2] - 1);
}

TEST_CASE("slabs: with gravity downwards the lower half suffers, with gravity upwards the upper", "[paper]") {
    scene const s = slabs();
    auto const mean_height = [&](double direction) {
        auto const process = frost_wedging{.rain = directional_rain{.direction = {1, 0, 0}},
                                           .flow = gravity_flow{.down = {0, 0, direction}}};
        frost_run run(s.links, process, {.seed = 5});
        (void)run.run({.paths = 300});
        double sum = 0;
        double weight = 0;
        for (std::size_t l = 0; l < s.links.interior_link_count(); ++l) {
            double const harm = 1 - run.life(link_index{l});
            sum += harm * s.links.link_centroid(link_index{l})[2];
            weight += harm;
        }
        REQUIRE(weight > 0);
        return sum / weight;
    };
    CHECK(mean_height(1) > mean_height(-1) + 0.5);
}
