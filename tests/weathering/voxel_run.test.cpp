#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/field/durability_profile.hpp>
#include <tafoni/voxel/bubble_profile.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/weathering/voxel_run.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <string>
#include <vector>

using namespace tafoni;

namespace {

/// A box of rock with a margin of air, eaten by noise from a hash; some of it colluvium when asked.
sparse_grid lump(std::array<std::size_t, 3> size, std::uint64_t seed, grid_border border = {}, double loose = 0) {
    sparse_grid g({.size = size}, up_axis::plus_z, border);
    stream random(seed, stage::user, 0);
    for (std::int32_t z = 0; z < static_cast<std::int32_t>(size[2]); ++z) {
        for (std::int32_t y = 0; y < static_cast<std::int32_t>(size[1]); ++y) {
            for (std::int32_t x = 0; x < static_cast<std::int32_t>(size[0]); ++x) {
                double const u = random.uniform01();
                double const w = random.uniform01();
                if (u < 0.05) continue;
                g.set({x, y, z}, w < loose ? voxel_state::colluvium : voxel_state::rock);
            }
        }
    }
    return g;
}

constexpr grid_border ground{{border_kind::air, border_kind::air, border_kind::air, border_kind::air,
                              border_kind::rock, border_kind::air}};

std::vector<voxel_state> states(sparse_grid const& g) {
    auto const n = g.user_frame().size;
    std::vector<voxel_state> out;
    for (std::size_t k = 0; k < n[2]; ++k) {
        for (std::size_t j = 0; j < n[1]; ++j) {
            for (std::size_t i = 0; i < n[0]; ++i) out.push_back(grid_access<sparse_grid>::state(g, i, j, k));
        }
    }
    return out;
}

template <class Run>
void check_ledger(Run const& run) {
    auto const r = run.report();
    REQUIRE(r.voxels_rock == run.grid().count(voxel_plane::rock));
    REQUIRE(r.voxels_colluvium == run.grid().count(voxel_plane::colluvium));
    REQUIRE(r.voxels_rock + r.voxels_colluvium + r.voxels_vanished + r.voxels_fallen + r.voxels_left ==
            r.voxels_initial);
}

/// Skin, counts and rates found anew, by definition.
template <class Run>
void check_recomputed(Run const& run) {
    sparse_grid const& g = run.grid();
    auto const skin = run.skin();
    std::size_t at = 0;
    constexpr voxel sides[6] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
    auto const near_air = [&](voxel v) {
        return std::any_of(sides, sides + 6, [&](voxel s) { return !g.is_solid(v + s); });
    };
    auto const& n = g.size();
    for (std::int32_t z = 0; z < static_cast<std::int32_t>(n[2]); ++z) {
        for (std::int32_t y = 0; y < static_cast<std::int32_t>(n[1]); ++y) {
            for (std::int32_t x = 0; x < static_cast<std::int32_t>(n[0]); ++x) {
                voxel const v{x, y, z};
                bool bare = g.is_solid(v) && near_air(v);
                if (run.options().skin_depth > 1 && g.is_solid(v)) {
                    bare = bare || std::any_of(sides, sides + 6, [&](voxel s) {
                               return g.is_solid(v + s) && near_air(v + s);
                           });
                }
                if (!bare) {
                    if (run.at(v)) FAIL("a voxel is of the skin that should not be");
                    continue;
                }
                if (at >= skin.size() || skin[at].at != v) FAIL("a voxel is missing from the skin");
                std::size_t const b = run.process().bubbles.choose(g.centre(v));
                if (skin[at].bubble != b) FAIL("another bubble");
                auto const& stencil = run.process().bubbles.stencils()[b];
                std::uint32_t air = 0;
                for (auto const& row : stencil.rows()) {
                    for (int dz = -stencil.reach(); dz <= stencil.reach(); ++dz) {
                        auto const k = static_cast<unsigned>(dz + bubble_stencil::widest);
                        bool const inside = (row.bits[k / 64] >> (k % 64) & 1) != 0;
                        if (inside && !g.is_solid(v + voxel{row.dx, row.dy, dz})) ++air;
                    }
                }
                double const size = stencil.size();
                if (skin[at].air_share != air / size) FAIL("another count of air");
                if (skin[at].state != g.state(v)) FAIL("another state");
                double const durability = std::max(run.process().durability(g.centre(v)), 1e-3);
                if (skin[at].durability != durability) FAIL("another durability");
                double const rock = (stencil.size() - air) / size;
                if (run.spheroidal_rate(skin[at]) != run.process().rate(air / size) / durability) FAIL("another rate");
                if (run.cavernous_rate(skin[at]) != run.process().rate(rock) / durability) FAIL("another rate");
                ++at;
            }
        }
    }
    REQUIRE(at == skin.size());
    REQUIRE(run.report().surface_voxels == skin.size());
}

}  // namespace

TEST_CASE("a single voxel is gone after the steps that its durability promises") {
    sparse_grid g({.size = {1, 1, 1}});
    g.set({0, 0, 0}, voxel_state::rock);
    // A sphere of radius 2 holds 27 voxels, 26 of them air: f = 26 / 27.
    voxel_run run(g, voxel_weathering{.bubbles = single_bubble{sphere_bubble{.radius = 2}}, .rate = linear_rate{},
                                      .durability = constant_field{.value = 0.1}});
    double const rate = 26.0 / 27.0 / 0.1;
    int step = 0;
    double left = 100;
    while (left - rate > 0) {
        left -= rate;
        ++step;
        run.run({.phases = {{.steps = 1}}});
        REQUIRE(run.at({0, 0, 0})->decimation == left);
    }
    run.run({.phases = {{.steps = 1}}});
    REQUIRE(run.report().voxels_rock == 0);
    REQUIRE(run.report().voxels_vanished == 1);
    REQUIRE(run.report().surface_voxels == 0);
    REQUIRE(step == 10);
}

TEST_CASE("no voxel is lost, and the skin and every count are those of the grid, at every step") {
    for (int kind = 0; kind < 6; ++kind) {
        INFO("kind " << kind);
        voxel_options options{.skin_depth = 1 + kind % 2, .seed = 5};
        if (kind % 3 > 0) options.colluvium = repose_rule{};
        if (kind % 3 > 1) options.rockfall = rockfall_options{};
        voxel_run run(lump({37, 14, 35}, static_cast<std::uint64_t>(kind), ground, kind % 3 > 0 ? 0.1 : 0.0),
                      voxel_weathering{.bubbles = single_bubble{sphere_bubble{.radius = 2.0 + kind}},
                                       .durability = constant_field{.value = 0.02}},
                      options);
        check_recomputed(run);
        for (int k = 0; k < 5; ++k) {
            run.run({.phases = {{.steps = 2, .spheroidal = 1, .cavernous = kind * 0.5}}});
            check_ledger(run);
            check_recomputed(run);
        }
        REQUIRE(run.report().voxels_rock < run.report().voxels_initial);
    }
}

TEST_CASE("whatever lies beyond the border, rates equal recomputed ones after deposits and falls") {
    stream random(12, stage::user, 0);
    std::size_t fallen = 0;
    std::size_t deposited = 0;
    for (auto const& size : std::vector<std::array<std::size_t, 3>>{{33, 6, 20}, {7, 34, 21}, {40, 1, 33}, {1, 1, 40}, {34, 33, 3}}) {
        for (int k = 0; k < 3; ++k) {
            grid_border border;
            for (border_kind& side : border.sides) side = static_cast<border_kind>(random.index_below(3));
            if (k == 0) border.sides.fill(border_kind::extend);
            double const radius = 2.0 + static_cast<double>(random.index_below(4));
            voxel_run run(lump(size, random.index_below(1000), border, 0.1),
                          voxel_weathering{.bubbles = single_bubble{gumdrop_bubble{.radius = radius}},
                                           .durability = constant_field{.value = 0.02}},
                          {.skin_depth = 1 + k % 2, .colluvium = repose_rule{}, .rockfall = rockfall_options{}});
            check_recomputed(run);
            for (int step = 0; step < 4; ++step) {
                run.run({.phases = {{.steps = 1, .spheroidal = 4, .cavernous = 1}},
                         .clock = step == 2 ? voxel_clock::events : voxel_clock::steps});
                check_ledger(run);
                check_recomputed(run);
            }
            fallen += run.report().voxels_fallen;
            deposited += run.report().voxels_colluvium;
        }
    }
    REQUIRE(fallen > 100);
    REQUIRE(deposited > 1000);
}

TEST_CASE("the bubble profile and the durability profile are edited during a run, and everything is counted anew") {
    bubble_profile<> bubbles{.bubbles = {sphere_bubble{.radius = 3}, disc_bubble{.radius = 5, .thickness = 2}, sphere_bubble{.radius = 5}},
                             .layers = {{.top = 12, .mix = {0}}, {.top = 20, .mix = {0, 2}}, {.mix = {1}}},
                             .field = gradient_noise{.seed = 3, .frequency = 0.2}};
    durability_profile<> durability{.points = {{0, 0.02}, {18, 0.05, 0.01, 0.3}, {18, 0.015}, {36, 0.03}}};
    voxel_run run(lump({20, 5, 34}, 14, ground, 0.05), voxel_weathering{.bubbles = bubbles, .durability = durability},
                  {.colluvium = repose_rule{}, .rockfall = rockfall_options{}});
    auto const go_on = [&] {
        auto const before = run.checkpoint();
        check_recomputed(run);
        run.run({.phases = {{.steps = 2, .spheroidal = 1, .cavernous = 0.5}}});
        check_ledger(run);
        check_recomputed(run);
        REQUIRE(run.checkpoint() != before);
    };
    go_on();
    bubbles.layers[0].top = 8;  // a boundary is dragged
    run.replace(bubbles);
    go_on();
    bubbles.bubbles.push_back(gumdrop_bubble{.radius = 6});  // another bubble; and a layer mixes it
    bubbles.layers[2].mix = {3, 1};
    run.replace(bubbles);
    go_on();
    bubbles.bubbles[0] = sphere_bubble{.radius = 17.5};  // another size, of those that are counted by columns
    run.replace(bubbles);
    go_on();
    durability.points[1].durability = 0.01;
    durability.points[1].frequency = 0.1;
    run.replace(durability);
    go_on();
    bubbles.bubbles.erase(bubbles.bubbles.begin() + 1, bubbles.bubbles.end());
    bubbles.layers = {{.mix = {0}}};
    run.replace(bubbles);
    go_on();
    bubbles.layers[0].mix = {1};  // a bubble that is not there: nothing changes
    auto const before = run.checkpoint();
    REQUIRE_THROWS_AS(run.replace(bubbles), invalid_input);
    REQUIRE(run.checkpoint() == before);
    check_recomputed(run);
}

TEST_CASE("steps in one run, in two runs, and on any number of threads give the same state", "[threads]") {
    voxel_options const options{.colluvium = repose_rule{}, .rockfall = rockfall_options{}, .seed = 3};
    auto const process = voxel_weathering{.durability = constant_field{.value = 0.015}};
    auto const rock = lump({40, 40, 36}, 9, ground);
    voxel_run whole(rock, process, options);
    whole.run({.phases = {{.steps = 9}}});
    voxel_run parts(rock, process, options);
    parts.run({.phases = {{.steps = 4}}});
    parts.run({});
    parts.run({.phases = {{.steps = 5}}});
    REQUIRE(states(whole.grid()) == states(parts.grid()));
    for (std::size_t const threads : {2u, 3u, 7u}) {
        thread_pool const pool(threads);
        voxel_run other(rock, process, options, pool);
        other.run({.phases = {{.steps = 9}}}, {}, pool);
        REQUIRE(states(whole.grid()) == states(other.grid()));
        auto const a = whole.skin();
        auto const b = other.skin();
        REQUIRE(a.size() == b.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
            REQUIRE(a[i].at == b[i].at);
            REQUIRE(a[i].decimation == b[i].decimation);
        }
    }
}

TEST_CASE("a number of steps is a schedule of one default phase") {
    voxel_run few(lump({20, 20, 20}, 11), voxel_weathering{.bubbles = single_bubble{sphere_bubble{2}}});
    voxel_run same(lump({20, 20, 20}, 11), voxel_weathering{.bubbles = single_bubble{sphere_bubble{2}}});
    CHECK(few.run(80).steps == 80);
    same.run({.phases = {{.steps = 80}}});
    CHECK(few.report().voxels_vanished > 0);
    CHECK(states(few.grid()) == states(same.grid()));
}
