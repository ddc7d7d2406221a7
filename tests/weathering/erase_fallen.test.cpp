#include <catch2/catch.hpp>

#include <tafoni/testing/archetypes.hpp>
#include <tafoni/testing/voxel_laws.hpp>
#include <tafoni/voxel/copy_states.hpp>
#include <tafoni/voxel/dense_grid.hpp>
#include <tafoni/weathering/erase_fallen.hpp>
#include <tafoni/weathering/voxel_run.hpp>

using namespace tafoni;

namespace {

/// A ball of rock, a quarter of it under colluvium, in a grid that is no cube.
dense_grid boulder() {
    grid_frame const frame{.size = {14, 12, 10}, .spacing = {0.5, 0.5, 1}, .origin = {3, -2, 1}};
    dense_grid g(frame);
    for (int z = 0; z < 10; ++z) {
        for (int y = 0; y < 12; ++y) {
            for (int x = 0; x < 14; ++x) {
                int const dx = 2 * x - 13, dy = 2 * y - 11, dz = 2 * z - 9;
                if (dx * dx + dy * dy + dz * dz < 90) g.set({x, y, z}, voxel_state::rock);
                else if (x < 7 && z < 3) g.set({x, y, z}, voxel_state::colluvium);
            }
        }
    }
    return g;
}

template <class G>
std::vector<std::uint8_t> states_of(G const& grid) {
    dense_grid out({.size = grid_access<G>::size(grid)});
    copy_states(grid, out);
    return {out.states().begin(), out.states().end()};
}

}  // namespace

TEST_CASE("the cells of a grid are its rock, where the grid says that they are") {
    dense_grid const rock = boulder();
    voxel_cells const cells = voxel_cells::from_grid(rock, {false, false, false, false, true, false});
    CHECK(cells.cell_count() == rock.count(voxel_state::rock));
    CHECK(cells.grid().artificial == std::array<bool, 6>{false, false, false, false, true, false});
    for (std::size_t c = 0; c < cells.cell_count(); ++c) {
        auto const v = cells.voxel_of(cell_index{c});
        voxel const at{static_cast<std::int32_t>(v[0]), static_cast<std::int32_t>(v[1]), static_cast<std::int32_t>(v[2])};
        REQUIRE(rock.at(at) == voxel_state::rock);
        REQUIRE(cells.cell_centroid(cell_index{c}) == rock.frame().centre(at));
    }
    // The same cells from a turned copy of the grid: indices are the user's.
    voxel_cells const turned = voxel_cells::from_grid(sparse_grid::copy_of(rock, up_axis::minus_x));
    REQUIRE(turned.cell_count() == cells.cell_count());
    for (std::size_t c = 0; c < cells.cell_count(); ++c) REQUIRE(turned.voxel_of(cell_index{c}) == cells.voxel_of(cell_index{c}));
}

TEST_CASE("a rock that frost has weathered goes on as a grid: what fell is air, all else is as it was") {
    dense_grid const before = boulder();
    voxel_cells const cells = voxel_cells::from_grid(before);
    frost_run run(cells, frost_wedging{}, {.seed = 3});
    for (std::size_t c = 0; c < cells.cell_count(); ++c) {
        if (cells.voxel_of(cell_index{c})[2] < 3) run.mark(cell_index{c}, cell_state::core);
    }
    frost_report const report = run.run({.paths = 20'000});
    REQUIRE(report.cells_detached > 20);
    REQUIRE(report.cells_detached < cells.cell_count());

    sparse_grid work = sparse_grid::copy_of(before, up_axis::plus_y);
    std::size_t const erased = erase_fallen(run, work);
    CHECK(erased == report.cells_detached);
    CHECK(work.count(voxel_plane::rock) == before.count(voxel_state::rock) - erased);
    CHECK(work.count(voxel_plane::colluvium) == before.count(voxel_state::colluvium));

    dense_grid expected = before;
    for (detached_block const& block : run.blocks()) {
        for (cell_index const c : block.cells) {
            auto const v = cells.voxel_of(c);
            expected.set({static_cast<std::int32_t>(v[0]), static_cast<std::int32_t>(v[1]), static_cast<std::int32_t>(v[2])},
                         voxel_state::air);
        }
    }
    CHECK(states_of(work) == states_of(expected));
    CHECK(erase_fallen(run, work) == 0);

    // And on: frost over what is left finds those cells and no others.
    CHECK(voxel_cells::from_grid(work).cell_count() == cells.cell_count() - erased);
}

TEST_CASE("one rock weathers by frost, then by bubbles, then by frost again") {
    dense_grid rock({.size = {20, 20, 16}}, voxel_state::air);
    for (int z = 0; z < 12; ++z) {
        for (int y = 4; y < 16; ++y) {
            for (int x = 4; x < 16; ++x) rock.set({x, y, z}, voxel_state::rock);
        }
    }
    std::size_t left = rock.count(voxel_state::rock);
    auto const by_frost = [&](std::uint64_t seed) {
        voxel_cells const cells = voxel_cells::from_grid(rock, {false, false, false, false, true, false});
        REQUIRE(cells.cell_count() == left);
        frost_run run(cells, frost_wedging{}, {.seed = seed});
        for (std::size_t c = 0; c < cells.cell_count(); ++c) {
            if (cells.voxel_of(cell_index{c})[2] < 4) run.mark(cell_index{c}, cell_state::core);
        }
        frost_report const report = run.run({.paths = 6'000});
        REQUIRE(report.cells_detached > 20);
        left -= report.cells_detached;
        CHECK(erase_fallen(run, rock) == report.cells_detached);
        CHECK(rock.count(voxel_state::rock) == left);
    };
    by_frost(1);

    grid_border border;
    border.sides[4] = border_kind::rock;
    voxel_run bubbles(rock, voxel_weathering{}, {.border = border, .colluvium = repose_rule{}, .rockfall = rockfall_options{}});
    CHECK(bubbles.report().voxels_initial == left);
    voxel_report const report = bubbles.run({.phases = {{.steps = 20, .spheroidal = 4}}});
    CHECK(report.voxels_rock < left);
    CHECK(report.voxels_rock + report.voxels_colluvium + report.voxels_vanished + report.voxels_fallen + report.voxels_left == left);
    dense_grid const before = rock;
    copy_states(bubbles.grid(), rock);
    for (std::size_t n = 0; n < before.states().size(); ++n) {  // no process makes rock
        REQUIRE((rock.states()[n] != 1 || before.states()[n] == 1));
    }
    left = rock.count(voxel_state::rock);
    CHECK(left == report.voxels_rock);
    CHECK(rock.count(voxel_state::colluvium) == report.voxels_colluvium);
    by_frost(2);
    CHECK(rock.count(voxel_state::colluvium) == report.voxels_colluvium);
}

TEST_CASE("voxels that are rock no more keep what they hold") {
    archetypes::editable_voxel_grid mine;
    voxel_cells const cells = voxel_cells::from_grid(mine);
    frost_run run(cells, frost_wedging{});
    run.mark(cells.cell_at(1, 1, 3), cell_state::air);
    run.mark(cells.cell_at(2, 2, 3), cell_state::air);
    grid_access<archetypes::editable_voxel_grid>::set(mine, 1, 1, 3, voxel_state::colluvium);
    CHECK(erase_fallen(run, mine) == 1);
    CHECK(states_of(mine)[1 + 4 * (1 + 3 * 3)] == 2);
    CHECK(states_of(mine)[2 + 4 * (2 + 3 * 3)] == 0);
}

TEST_CASE("the least grid weathers by frost and by bubbles: nothing asks for more than its concept") {
    archetypes::voxel_grid const grid;
    voxel_run run(grid, voxel_weathering{}, {.up = up_axis::plus_z, .colluvium = repose_rule{}});
    CHECK(run.report().voxels_initial == 48);
    CHECK(run.run({.phases = {{.steps = 3, .spheroidal = 100}}}).voxels_rock < 48);
    voxel_cells const cells = voxel_cells::from_grid(grid);
    frost_run frost(cells, frost_wedging{});
    frost.mark(cells.cell_at(0, 0, 3), cell_state::air);
    archetypes::editable_voxel_grid mine;
    CHECK(erase_fallen(frost, mine) == 1);
    copy_states(run.grid(), mine);
    CHECK(laws::editable_voxel_grid(mine).empty());
}

TEST_CASE("a grid of another size than the run's is refused") {
    voxel_cells const cells = voxel_cells::from_grid(boulder());
    frost_run run(cells, frost_wedging{});
    dense_grid other({.size = {12, 14, 10}}, voxel_state::rock);
    try {
        (void)erase_fallen(run, other);
        FAIL("accepted");
    } catch (invalid_input const& e) {
        CHECK(e.code() == errc::attribute_length);
    }
    CHECK(other.count(voxel_state::rock) == 12 * 14 * 10);
}
