// Figures 8, 9, 11 and 12: what the user steers with: rain, resistance, core cells; and air pockets.
#include "scene.hpp"

#include <tafoni/decomposition/grid_sites.hpp>
#include <tafoni/decomposition/voxel_cells.hpp>

#include <catch2/catch.hpp>

using namespace tafoni_test;

namespace {

scene plate() {
    solid const body = make_solid(box({0, 0, 0}, {10, 1.5, 10}));
    return make_scene(body, grid_sites{.count = 400, .jitter = 0.8}(body, 8));
}

/// Share of the damage that lies where the predicate holds.
template <class Run>
double share_of_damage(Run const& run, link_graph const& links, std::function<bool(vec3 const&)> const& where) {
    double there = 0;
    double all = 0;
    for (std::size_t l = 0; l < links.interior_link_count(); ++l) {
        double const harm = 1 - run.life(link_index{l});
        all += harm;
        if (where(links.link_centroid(link_index{l}))) there += harm;
    }
    return all > 0 ? there / all : 0;
}

}  // namespace

TEST_CASE("Figure 8: the side that faces the rain erodes more", "[paper]") {
    scene const s = plate();
    auto const left_share = [&](vec3 const& travel) {
        frost_run run(s.links, frost_wedging{.rain = directional_rain{.direction = normalized(travel)}}, {.seed = 8});
        (void)run.run({.paths = 500});
        return share_of_damage(run, s.links, [](vec3 const& x) { return x[0] < 5; });
    };
    double const straight = left_share({0, 0, -1});
    double const from_left = left_share({1, 0, -0.5});
    double const from_right = left_share({-1, 0, -0.5});
    CHECK(straight > 0.35);
    CHECK(straight < 0.65);
    CHECK(from_left > 0.65);
    CHECK(from_right < 0.35);
}

TEST_CASE("Figure 9: water keeps to where the resistance is low", "[paper]") {
    scene const s = plate();
    // Bands across the way of the water: 0 at the bottom of the wave, 1 on its crest.
    auto const rho = [](vec3 const& x) { return std::fmod(x[0] + 20, 2.5) < 1.25 ? 0.05 : 0.95; };
    auto const soft = [&](vec3 const& x) { return rho(x) < 0.5; };
    auto const visits = [&](auto const& process) {
        frost_run run(s.links, process, {.seed = 9});
        std::vector<path_visit> seen;
        std::uint64_t in_soft = 0;
        for (std::uint64_t path = 0; path < 3000; ++path) (void)run.trace(path, seen);
        for (path_visit const& v : seen) in_soft += soft(s.links.link_centroid(v.link)) ? 1u : 0u;
        return static_cast<double>(in_soft) / static_cast<double>(seen.size());
    };
    double const uniform = visits(frost_wedging{});
    double const steered = visits(frost_wedging{.flow = seepage{.flow = gravity_flow{}, .resistance = rho}});
    CHECK(steered > uniform + 0.1);
}

TEST_CASE("Figure 11: the smaller part of a split falls, unless it holds a core cell", "[paper]") {
    // A bar of five voxels; the bond between the second and the third breaks.
    auto const bar = voxel_cells::from_indices({.size = {5, 1, 1}}, [](std::size_t, std::size_t, std::size_t) { return true; });
    auto const cell_at = [&](double x) {
        for (std::uint32_t c = 0; c < bar.cell_count(); ++c) {
            if (std::fabs(bar.cell_centroid(cell_index{c})[0] - x) < 0.1) return cell_index{c};
        }
        return cell_index{};
    };
    auto const bond = [&](cell_index a, cell_index b) {
        link_index found{};
        bar.for_each_cell_link(a, [&](link_index l) {
            auto const cells = bar.link_cells(l);
            if (cells[0] == b || cells[1] == b) found = l;
        });
        return found;
    };
    frost_run run(bar);
    CHECK(run.break_link(bond(cell_at(1.5), cell_at(2.5))));
    CHECK(run.cell(cell_at(0.5)) == cell_state::air);
    CHECK(run.cell(cell_at(1.5)) == cell_state::air);
    CHECK(run.cell(cell_at(2.5)) == cell_state::solid);

    frost_run kept(bar);
    kept.mark(cell_at(0.5), cell_state::core);
    CHECK(kept.break_link(bond(cell_at(1.5), cell_at(2.5))));
    CHECK(kept.cell(cell_at(1.5)) == cell_state::solid);
    for (double const x : {2.5, 3.5, 4.5}) CHECK(kept.cell(cell_at(x)) == cell_state::air);

    frost_run both(bar);
    both.mark(cell_at(0.5), cell_state::core);
    both.mark(cell_at(4.5), cell_state::core);
    CHECK(both.break_link(bond(cell_at(1.5), cell_at(2.5))));
    for (double const x : {1.5, 2.5, 3.5}) CHECK(both.cell(cell_at(x)) == cell_state::solid);
}

TEST_CASE("Figure 12: the walls of an air pocket become skin only when the outside reaches it", "[paper]") {
    auto const block = voxel_cells::from_indices({.size = {7, 7, 7}}, [](std::size_t, std::size_t, std::size_t) { return true; });
    auto const at = [&](double x, double y, double z) {
        for (std::uint32_t c = 0; c < block.cell_count(); ++c) {
            vec3 const p = block.cell_centroid(cell_index{c});
            if (std::fabs(p[0] - x) + std::fabs(p[1] - y) + std::fabs(p[2] - z) < 0.1) return cell_index{c};
        }
        return cell_index{};
    };
    auto const count = [&](auto const& run, link_state state) {
        std::size_t n = 0;
        for (std::size_t l = 0; l < block.link_count(); ++l) {
            n += block.has_link(link_index{l}) && run.state(link_index{l}) == state ? 1u : 0u;
        }
        return n;
    };
    frost_run run(block);
    REQUIRE(count(run, link_state::skin) == 6 * 49);
    run.mark(at(3.5, 3.5, 3.5), cell_state::air);
    CHECK(count(run, link_state::pocket) == 6);
    CHECK(count(run, link_state::skin) == 6 * 49);
    // A shaft of three voxels from above reaches it.
    for (double const z : {6.5, 5.5}) run.mark(at(3.5, 3.5, z), cell_state::air);
    CHECK(count(run, link_state::pocket) == 6);
    run.mark(at(3.5, 3.5, 4.5), cell_state::air);
    CHECK(count(run, link_state::pocket) == 0);
    // One face of the old skin is gone; the shaft is 4 deep: 16 walls and a bottom.
    CHECK(count(run, link_state::skin) == 6 * 49 - 1 + 4 * 4 + 1);
}
