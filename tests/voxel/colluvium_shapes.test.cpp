#include <catch2/catch.hpp>

#include <tafoni/voxel/colluvium.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

using namespace tafoni;

namespace {

constexpr auto air = voxel_state::air;
constexpr auto rock = voxel_state::rock;
constexpr auto loose = voxel_state::colluvium;

grid_border floor_of(border_kind sides) {
    return {{sides, sides, sides, sides, border_kind::rock, border_kind::air}};
}
sparse_grid box(std::size_t nx, std::size_t ny, std::size_t nz, grid_border const& border = floor_of(border_kind::rock),
                vec3 spacing = {1, 1, 1}) {
    return sparse_grid({.size = {nx, ny, nz}, .spacing = spacing}, up_axis::plus_z, border);
}

settle_report drop(sparse_grid& g, std::vector<voxel> const& released, std::vector<voxel> const& opened = {},
                   repose_rule const& rule = {}, std::uint64_t seed = 1, std::uint64_t step = 1) {
    std::vector<voxel_change> changes;
    return settle(g, released, opened, rule, seed, step, inline_executor{}, changes);
}

/// Grains let go one after the other high above a point.
sparse_grid pile(int count, int n, repose_rule const& rule, std::uint64_t seed = 1, vec3 spacing = {1, 1, 1}) {
    auto g = box(static_cast<std::size_t>(n), static_cast<std::size_t>(n), 200, floor_of(border_kind::rock), spacing);
    for (int i = 0; i < count; ++i) {
        settle_report const r = drop(g, {{n / 2, n / 2, 199}}, {}, rule, seed, static_cast<std::uint64_t>(i));
        REQUIRE(r == settle_report{1, 0, 0});
    }
    return g;
}

int top(sparse_grid const& g, int x, int y) {
    int z = 0;
    while (g.is_solid({x, y, z})) ++z;
    return z;
}

}  // namespace

TEST_CASE("grains from a point pile up to the half of an octahedron at 45 degrees", "[colluvium]") {
    int const height = 14;
    int count = 0;
    for (int k = 1; k <= height; ++k) count += 2 * k * k - 2 * k + 1;
    sparse_grid const g = pile(count, 41, {.angle = 45});
    for (int x = 0; x < 41; ++x) {
        for (int y = 0; y < 41; ++y) {
            int const expected = std::max(0, height - std::abs(x - 20) - std::abs(y - 20));
            CAPTURE(x, y);
            REQUIRE(std::abs(top(g, x, y) - expected) <= 1);
        }
    }
}

TEST_CASE("a pile leans to no side although every choice between equal sides is a single one", "[colluvium]") {
    for (std::uint64_t seed = 1; seed < 5; ++seed) {
        sparse_grid const g = pile(900, 41, {}, seed);
        double mx = 0;
        double my = 0;
        for (int x = 0; x < 41; ++x) {
            for (int y = 0; y < 41; ++y) {
                mx += top(g, x, y) * (x - 20) / 900.0;
                my += top(g, x, y) * (y - 20) / 900.0;
            }
        }
        CAPTURE(seed, mx, my);
        CHECK(std::abs(mx) < 0.15);
        CHECK(std::abs(my) < 0.15);
    }
    // Of 400 lone grains on a tip about a quarter goes down each side.
    std::array<int, 4> sides{};
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        auto g = box(9, 9, 9);
        for (int z = 0; z < 3; ++z) g.set({4, 4, z}, rock);
        drop(g, {{4, 4, 8}}, {}, {}, seed);
        sides[0] += g.is_solid({3, 4, 0}) ? 1 : 0;
        sides[1] += g.is_solid({5, 4, 0}) ? 1 : 0;
        sides[2] += g.is_solid({4, 3, 0}) ? 1 : 0;
        sides[3] += g.is_solid({4, 5, 0}) ? 1 : 0;
    }
    for (int const n : sides) CHECK((n > 70 && n < 130));
    CHECK(sides[0] + sides[1] + sides[2] + sides[3] == 400);
}

TEST_CASE("one column knows arctan(n) only, a longer baseline knows angles between", "[colluvium]") {
    auto const height = [](double angle, int baseline) { return top(pile(900, 61, {angle, baseline}), 30, 30); };
    int const at_45 = height(45, 1);
    CHECK(height(10, 1) == at_45);
    CHECK(height(30, 1) == at_45);
    CHECK(height(63, 1) == at_45);
    CHECK(height(64, 1) > at_45);
    int const at_20 = height(20, 4);
    int const at_30 = height(30, 4);
    int const at_37 = height(37, 4);
    CHECK(at_20 < at_30);
    CHECK(at_30 < at_37);
    CHECK(at_37 < height(45, 4));
    CHECK(height(45, 4) == at_45);

    // 2 voxels in 4 columns is the steepest that does not pass 30 degrees: 26.6.
    sparse_grid const g = pile(900, 61, {30, 4});
    int foot = 0;
    while (top(g, 30 + foot, 30) > 0) ++foot;
    double const slope = static_cast<double>(at_30) / foot;
    CAPTURE(at_30, foot);
    CHECK(slope > 0.4);
    CHECK(slope < 0.6);
}

TEST_CASE("the spacing of the grid is a part of the slope", "[colluvium]") {
    repose_rule const rule{.angle = 45};
    int const cubes = top(pile(700, 41, rule), 20, 20);
    CHECK(top(pile(700, 41, rule, 1, {1, 1, 0.5}), 20, 20) > cubes);
    CHECK(top(pile(700, 41, rule, 1, {1, 1, 2}), 20, 20) == cubes);  // nothing flatter than one grain
    sparse_grid const g = pile(700, 41, rule, 1, {3, 1, 1});
    int along_x = 0;
    int along_y = 0;
    while (top(g, 20 + along_x, 20) > 0) ++along_x;
    while (top(g, 20, 20 + along_y) > 0) ++along_y;
    CHECK(along_y > 2 * along_x);
}

TEST_CASE("a grain falls to the ground, or on the shelf below it", "[colluvium]") {
    auto g = box(20, 20, 80);
    drop(g, {{5, 5, 70}});
    CHECK(g.state({5, 5, 0}) == loose);
    for (int x = 10; x < 15; ++x) {
        for (int y = 10; y < 15; ++y) g.set({x, y, 33}, rock);
    }
    drop(g, {{12, 12, 70}, {12, 12, 20}});
    CHECK(g.state({12, 12, 34}) == loose);
    CHECK(g.state({12, 12, 0}) == loose);
    CHECK(drop(g, {{10, 12, 60}}).deposited == 1);  // over the shelf's edge it slides off
    CHECK(g.state({10, 12, 34}) == air);
    CHECK(g.count(voxel_plane::colluvium) == 4);
}

TEST_CASE("a grain takes the steepest side, column by column, to the end", "[colluvium]") {
    auto g = box(12, 3, 20);
    for (int x = 0; x < 12; ++x) {
        for (int y = 0; y < 3; ++y) {
            int const z = y != 1 ? 18 : x == 3 ? 8 : x < 3 ? 7 - x : 3;  // a hump in a gully, steeper to +x
            for (int k = 0; k <= z; ++k) g.set({x, y, k}, rock);
        }
    }
    drop(g, {{3, 1, 15}});
    CHECK(g.state({4, 1, 4}) == loose);
    drop(g, {{3, 1, 15}});
    CHECK(g.state({2, 1, 6}) == air);
    CHECK(g.count(voxel_plane::colluvium) == 2);
}

TEST_CASE("at 90 degrees grains only fall; at 0 nothing but single grains stands", "[colluvium]") {
    auto g = box(5, 5, 40);
    drop(g, {{2, 2, 30}, {2, 2, 31}, {2, 2, 32}}, {}, {.angle = 90});
    for (int z = 0; z < 3; ++z) CHECK(g.state({2, 2, z}) == loose);
    auto open = box(5, 5, 40, {});
    CHECK(drop(open, {{2, 2, 30}}, {}, {.angle = 90}).left == 1);
    for (int const baseline : {1, 3, 16}) {
        auto flat = box(21, 21, 40);
        std::vector<voxel> grains;
        for (int z = 10; z < 40; ++z) grains.push_back({10, 10, z});
        drop(flat, grains, {}, {.angle = 0, .baseline = baseline});
        CHECK(flat.count(voxel_plane::colluvium) == 30);
        if (baseline == 16) {
            for (int x = 0; x < 21; ++x) {
                for (int y = 0; y < 21; ++y) CHECK(top(flat, x, y) <= 1);
            }
        }
    }
}

TEST_CASE("an airy side lets grains go, a wall of rock or of more of the same keeps them", "[colluvium]") {
    for (border_kind const kind : {border_kind::air, border_kind::rock, border_kind::extend}) {
        auto g = box(4, 4, 60, floor_of(kind));
        std::vector<voxel> grains;
        for (int z = 20; z < 60; ++z) grains.push_back({1, 1, z});
        settle_report const r = drop(g, grains);
        CHECK(r.deposited + r.left == 40);
        CHECK(g.count(voxel_plane::colluvium) == r.deposited);
        CHECK((r.left > 0) == (kind == border_kind::air));
    }
    for (border_kind const bottom : {border_kind::air, border_kind::rock, border_kind::extend}) {
        auto border = floor_of(border_kind::rock);
        border.sides[4] = bottom;
        auto g = box(4, 4, 10, border);
        CHECK(drop(g, {{1, 1, 5}, {2, 2, 0}}).left == (bottom == border_kind::air ? 2U : 0U));
    }
}

TEST_CASE("colluvium settles again when what carried it goes", "[colluvium]") {
    SECTION("the rock below a stack") {
        auto g = box(9, 9, 40);
        for (int x = 3; x < 6; ++x) {
            for (int y = 3; y < 6; ++y) g.set({x, y, 20}, rock);
        }
        drop(g, {{4, 4, 30}, {4, 4, 31}});
        CHECK(g.state({4, 4, 21}) == loose);
        CHECK(g.count(voxel_plane::colluvium) == 2);
        std::vector<voxel> opened;
        for (int x = 3; x < 6; ++x) {
            for (int y = 3; y < 6; ++y) {
                opened.push_back({x, y, 20});
                g.set(opened.back(), air);
            }
        }
        settle_report const r = drop(g, {}, opened);
        CHECK(r.moved == 1);  // the other has slid off before
        CHECK(r.left == 0);
        for (int z = 2; z < 40; ++z) {
            for (int y = 0; y < 9; ++y) {
                for (int x = 0; x < 9; ++x) CHECK(g.state({x, y, z}) == air);
            }
        }
    }
    SECTION("a wall beside the middle of a stack: the grain there slides out and those above come down") {
        auto g = box(5, 1, 40);
        for (int z = 0; z < 30; ++z) g.set({1, 0, z}, rock);
        for (int z = 0; z < 30; ++z) g.set({2, 0, z}, z < 10 ? rock : loose);
        for (int z = 0; z < 30; ++z) g.set({3, 0, z}, rock);
        CHECK(drop(g, {}, {{2, 0, 15}}).moved == 0);
        for (int z = 5; z < 15; ++z) g.set({3, 0, z}, air);  // a cave, its roof stands
        std::vector<voxel> opened;
        for (int z = 5; z < 15; ++z) opened.push_back({3, 0, z});
        settle_report const r = drop(g, {}, opened);
        CHECK(r.moved > 10);
        CHECK(g.count(voxel_plane::colluvium) == 20);
        CHECK(g.state({3, 0, 5}) == loose);
        CHECK(top(g, 2, 0) < 30);
        CHECK(g.state({3, 0, 15}) == rock);
    }
    SECTION("a whole unsettled grid, by naming its colluvium") {
        auto g = box(24, 24, 24);
        std::vector<voxel> all;
        for (int z = 0; z < 24; ++z) {
            for (int y = 0; y < 24; ++y) {
                for (int x = 0; x < 24; ++x) {
                    if ((x + y + z) % 2 == 0) continue;
                    all.push_back({x, y, z});
                    g.set(all.back(), loose);
                }
            }
        }
        settle_report const r = drop(g, {}, all);
        CHECK(r.left == 0);
        CHECK(g.count(voxel_plane::colluvium) == all.size());
        int low = 24;
        int high = 0;
        int sum = 0;
        for (int y = 0; y < 24; ++y) {
            for (int x = 0; x < 24; ++x) {
                low = std::min(low, top(g, x, y));
                high = std::max(high, top(g, x, y));
                sum += top(g, x, y);
            }
        }
        CHECK(sum == 24 * 24 * 12);  // no hole is left
        CHECK(high - low <= 2);
    }
}

TEST_CASE("equal seeds give equal piles, other seeds and steps others", "[colluvium]") {
    auto const heap = [](std::uint64_t seed, std::uint64_t step) {
        auto g = box(30, 30, 90);
        std::vector<voxel> grains;
        for (int z = 30; z < 90; ++z) grains.push_back({15, 15, z});  // 85 would fill the octahedron
        std::vector<voxel_change> changes;
        settle(g, grains, {}, repose_rule{}, seed, step, inline_executor{}, changes);
        return changes;
    };
    CHECK((heap(1, 1) == heap(1, 1)));
    CHECK_FALSE((heap(1, 1) == heap(2, 1)));
    CHECK_FALSE((heap(1, 1) == heap(1, 2)));
    CHECK((heap(0, 0) == heap(0, 0)));
}

TEST_CASE("no grains, no changes", "[colluvium]") {
    auto g = box(1, 1, 1);
    CHECK(drop(g, {}) == settle_report{});
    CHECK(drop(g, {}, {{0, 0, 0}}) == settle_report{});
    std::vector<voxel_change> changes{{{7, 7, 7}, air, loose}};
    settle(g, std::vector<voxel>{{0, 0, 0}}, {}, repose_rule{}, 1, 1, inline_executor{}, changes);
    REQUIRE(changes.size() == 2);
    CHECK(changes[1] == voxel_change{{0, 0, 0}, air, loose});
}

TEST_CASE("a voxel that is named as opened many times is looked at as if named once", "[colluvium]") {
    sparse_grid grid({.size = {3, 3, 9}}, up_axis::plus_z, {{border_kind::rock, border_kind::rock, border_kind::rock, border_kind::rock, border_kind::rock, border_kind::air}});
    grid.set({1, 1, 7}, voxel_state::colluvium);
    sparse_grid once = grid;
    std::vector<voxel_change> changes;
    std::vector<voxel_change> wanted;
    settle(once, {}, std::vector<voxel>{{1, 1, 7}}, {}, 1, 1, inline_executor{}, wanted);
    auto const r = settle(grid, {}, std::vector<voxel>(5000, voxel{1, 1, 7}), {}, 1, 1, inline_executor{}, changes);
    CHECK(r.moved == 1);
    CHECK(changes == wanted);
}

TEST_CASE("grains that cannot be are refused before anything moves", "[colluvium]") {
    auto g = box(4, 4, 4);
    g.set({1, 1, 1}, loose);
    auto const refused = [&](std::vector<voxel> const& released, std::vector<voxel> const& opened, repose_rule const& rule, errc code) {
        try {
            drop(g, released, opened, rule);
        } catch (invalid_input const& e) {
            CHECK(e.code() == code);
            CHECK(g.state({1, 1, 1}) == loose);
            CHECK(g.count(voxel_plane::solid) == 1);
            return;
        }
        FAIL("accepted");
    };
    refused({{0, 0, 3}, {1, 1, 1}}, {}, {}, errc::bad_count);
    refused({{0, 0, 3}, {2, 0, 0}, {0, 0, 3}}, {}, {}, errc::bad_count);
    refused({{0, 0, 4}}, {}, {}, errc::out_of_range);
    refused({{-1, 0, 0}}, {}, {}, errc::out_of_range);
    refused({}, {{0, 4, 0}}, {}, errc::out_of_range);
    for (double const angle : {-1.0, 90.5, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        refused({}, {}, {.angle = angle}, errc::bad_parameter);
    }
    for (int const baseline : {0, -3, 17}) refused({}, {}, {.baseline = baseline}, errc::bad_parameter);
}
