#include <tafoni/core/random.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/voxel/detail/air_counter.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

using namespace tafoni;
using detail::kernel_set;

namespace {

std::vector<kernel_set> kernels_of_this_machine() {
    std::vector<kernel_set> out;
    for (auto const k : {kernel_set::portable, kernel_set::popcnt, kernel_set::avx2, kernel_set::avx512}) {
        if (k <= detail::best_kernel_set()) out.push_back(k);
    }
    return out;
}

/// Rock, air and colluvium at random, in lumps, between borders at random.
sparse_grid random_grid(stream& random) {
    grid_frame frame;
    for (auto& n : frame.size) n = 1 + random.index_below(80);
    grid_border border;
    for (auto& side : border.sides) side = static_cast<border_kind>(random.index_below(3));
    sparse_grid grid(frame, static_cast<up_axis>(random.index_below(6)), border);
    double const share = random.uniform01();
    std::uint64_t const lump = 1 + random.index_below(40);
    std::uint64_t const salt = random.index_below(1u << 30);
    for (std::size_t b = 0; b < grid.brick_count(); ++b) {
        grid.fill_brick(b, [&](voxel v) {
            auto const at = [lump](std::int32_t a) { return static_cast<std::uint64_t>(a) / lump; };
            stream s(salt, stage::user, at(v.x) + 100 * at(v.y) + 10000 * at(v.z));
            return s.chance(share) ? voxel_state::rock : static_cast<voxel_state>(s.index_below(3));
        });
    }
    return grid;
}

bubble_stencil random_bubble(stream& random) {
    double const r = random.chance(0.1) ? random.uniform(16, 48) : random.uniform(0.5, 17);
    switch (random.index_below(5)) {
        case 0: return ellipsoid_bubble{.semi_axes = {r, 0.5 * r + 1, 0.3 * r + 1}};
        case 1: return gumdrop_bubble{.radius = r};
        case 2: return disc_bubble{.radius = r, .thickness = 1 + 2.0 * static_cast<double>(random.index_below(4))};
        case 3: {
            std::uint64_t const salt = random.index_below(1u << 30);
            return predicate_bubble{
                [salt](vec3 const& o) {
                    auto const key = static_cast<std::uint64_t>((o[0] + 50) + 101 * (o[1] + 50) + 10201 * (o[2] + 50));
                    stream s(salt, stage::user, key);
                    return s.chance(0.3) || squared_length(o) == 0;
                },
                r};
        }
        default: return sphere_bubble{.radius = r};
    }
}

struct records {
    std::size_t brick = 0;
    std::vector<detail::brick_position> position{};
    std::vector<std::uint16_t> bubble{};
    std::vector<std::uint32_t> air{};

    records(sparse_grid const& grid, std::size_t bubbles, std::size_t n, stream& random) {
        brick = random.index_below(grid.brick_count());
        std::vector<bool> taken(32768, false);
        for (std::size_t i = 0; i < n; ++i) {
            auto const p = static_cast<detail::brick_position>(random.index_below(32768));
            if (taken[p] || !grid.contains(detail::at_position(grid.brick_corner(brick), p))) continue;
            taken[p] = true;
            position.push_back(p);
            bubble.push_back(static_cast<std::uint16_t>(random.index_below(bubbles)));
        }
        air.assign(position.size(), 12345);
    }
    detail::skin_view view() { return {position, bubble, air}; }
};

/// Looks at every voxel of every bubble.
int wrong(sparse_grid const& grid, std::vector<bubble_stencil> const& bubbles, records const& r) {
    std::vector<std::vector<voxel>> inside(bubbles.size());
    for (std::size_t b = 0; b < bubbles.size(); ++b) {
        int const reach = bubbles[b].reach();
        for (int i = 0; i < (2 * reach + 1) * (2 * reach + 1) * (2 * reach + 1); ++i) {
            int const n = 2 * reach + 1;
            voxel const o{i % n - reach, i / n % n - reach, i / (n * n) - reach};
            if (bubbles[b].contains(o.x, o.y, o.z)) inside[b].push_back(o);
        }
    }
    int n = 0;
    for (std::size_t i = 0; i < r.position.size(); ++i) {
        voxel const v = detail::at_position(grid.brick_corner(r.brick), r.position[i]);
        std::uint32_t air = 0;
        for (voxel const o : inside[r.bubble[i]]) air += grid.is_solid(v + o) ? 0u : 1u;
        if (air != r.air[i]) ++n;
    }
    return n;
}

std::vector<voxel_change> random_changes(sparse_grid& grid, std::size_t n, stream& random) {
    std::vector<voxel_change> out;
    for (std::size_t i = 0; i < n; ++i) {
        voxel v{};
        v.x = static_cast<std::int32_t>(random.index_below(grid.size()[0]));
        v.y = static_cast<std::int32_t>(random.index_below(grid.size()[1]));
        v.z = static_cast<std::int32_t>(random.index_below(grid.size()[2]));
        voxel_state const before = grid.state(v);
        auto const after = static_cast<voxel_state>(random.index_below(3));
        bool const known = std::any_of(out.begin(), out.end(), [v](voxel_change const& c) { return c.at == v; });
        if (before == after || known) continue;
        grid.set(v, after);
        out.push_back({v, before, after});
    }
    return out;
}

}  // namespace

TEST_CASE("places in a brick are named by column, then height") {
    voxel const corner{64, 32, -32};
    for (int i = 0; i < 32768; ++i) {
        auto const p = static_cast<detail::brick_position>(i);
        voxel const v = detail::at_position(corner, p);
        REQUIRE(detail::position_of(v) == p);
        REQUIRE((v.x >= 64 && v.x < 96 && v.y >= 32 && v.y < 64 && v.z >= -32 && v.z < 0));
    }
    CHECK(detail::position_of({1, 0, 0}) == 32);
    CHECK(detail::position_of({0, 1, 0}) == 1024);
}

TEST_CASE("counts equal looking at every voxel, whatever the bubble, the grid, the border and the instructions") {
    for (std::uint64_t t = 0; t < 20; ++t) {
        stream random(41, stage::user, t);
        sparse_grid const grid = random_grid(random);
        std::vector<bubble_stencil> bubbles;
        std::size_t const n = 1 + random.index_below(4);
        for (std::size_t b = 0; b < n; ++b) bubbles.push_back(random_bubble(random));
        records r(grid, n, 40, random);
        std::vector<std::uint32_t> first;
        for (kernel_set const k : kernels_of_this_machine()) {
            detail::air_counter counter(k);
            std::fill(r.air.begin(), r.air.end(), 12345u);
            counter.recount(grid, r.brick, bubbles, r.view());
            if (first.empty()) {
                CHECK(wrong(grid, bubbles, r) == 0);
                first = r.air;
            }
            CHECK(r.air == first);
        }
    }
}

TEST_CASE("every reach up to 48 is counted right, also where bubbles of several reaches share a brick") {
    stream random(42, stage::user, 0);
    sparse_grid grid({.size = {100, 70, 90}}, up_axis::plus_z,
                     {{border_kind::rock, border_kind::extend, border_kind::air, border_kind::extend, border_kind::rock,
                       border_kind::extend}});
    for (std::size_t b = 0; b < grid.brick_count(); ++b) {
        grid.fill_brick(b, [&](voxel v) {
            return (v.x * 7 + v.y * 3 + v.z * 5) % 11 < 5 || v.z < 20 ? voxel_state::rock : voxel_state::air;
        });
    }
    std::vector<bubble_stencil> bubbles;
    for (int reach = 0; reach <= 48; ++reach) {  // its corners and a few of the voxels between
        bubbles.push_back(predicate_bubble{[reach](vec3 const& o) {
                                               auto const key = static_cast<int>(o[0] + 3 * o[1] + 9 * o[2]);
                                               return (std::fabs(o[0]) == reach && std::fabs(o[1]) == reach &&
                                                       std::fabs(o[2]) == reach) ||
                                                      key % 17 == 0;
                                           },
                                           double(reach)});
        REQUIRE(bubbles.back().reach() == reach);
    }
    records r(grid, bubbles.size(), 0, random);
    r.brick = 1 + 4 * 1;  // with neighbours on all sides but below
    for (std::size_t b = 0; b < bubbles.size(); ++b) {
        auto const p = static_cast<detail::brick_position>(random.index_below(32768));
        if (std::find(r.position.begin(), r.position.end(), p) != r.position.end()) continue;
        r.position.push_back(p);
        r.bubble.push_back(static_cast<std::uint16_t>(b));
    }
    std::vector<std::uint32_t> first;
    for (kernel_set const k : kernels_of_this_machine()) {
        r.air.assign(r.position.size(), 0);
        detail::air_counter(k).recount(grid, r.brick, bubbles, r.view());
        if (first.empty()) {
            CHECK(wrong(grid, bubbles, r) == 0);
            first = r.air;
        }
        CHECK(r.air == first);
    }
}

TEST_CASE("notified counts equal recounted ones bit by bit, at any moment") {
    for (std::uint64_t t = 0; t < 10; ++t) {
        stream random(43, stage::user, t);
        sparse_grid grid = random_grid(random);
        std::vector<bubble_stencil> bubbles;
        std::size_t const n = 1 + random.index_below(4);
        for (std::size_t b = 0; b < n; ++b) bubbles.push_back(random_bubble(random));
        records r(grid, n, 300, random);
        records oracle = r;
        detail::air_counter counter;
        counter.recount(grid, r.brick, bubbles, r.view());
        for (int step = 0; step < 8; ++step) {
            auto const changes = random_changes(grid, 1 + random.index_below(60), random);
            counter.notify(grid, r.brick, bubbles, r.view(), changes);
            counter.recount(grid, oracle.brick, bubbles, oracle.view());
            REQUIRE(r.air == oracle.air);
        }
        if (t % 8 == 0) CHECK(wrong(grid, bubbles, oracle) == 0);
    }
}

TEST_CASE("an update leads to the same counts whichever way it takes") {
    stream random(44, stage::user, 0);
    sparse_grid grid = random_grid(random);
    while (grid.size()[0] < 40 || grid.size()[2] < 40) grid = random_grid(random);
    std::vector<bubble_stencil> const bubbles{sphere_bubble{.radius = 5}, disc_bubble{.radius = 7, .thickness = 3}};
    records r(grid, 2, 800, random);
    records oracle = r;
    detail::air_counter counter;
    counter.recount(grid, r.brick, bubbles, r.view());
    bool few = false;
    bool many = false;
    for (std::size_t const n : {1u, 3u, 10u, 100u, 1000u, 2u, 4000u, 0u}) {
        auto changes = random_changes(grid, n, random);
        std::erase_if(changes, [&](voxel_change const& c) {
            return !detail::air_counter::concerns(c, grid.brick_corner(r.brick),
                                                  detail::air_counter::reach_of(bubbles));
        });
        (counter.recount_is_cheaper(bubbles, r.view(), changes.size()) ? many : few) = true;
        counter.update(grid, r.brick, bubbles, r.view(), changes);
        counter.recount(grid, oracle.brick, bubbles, oracle.view());
        CHECK(r.air == oracle.air);
    }
    CHECK(few);
    CHECK(many);
}

TEST_CASE("a change that leaves a voxel solid, or is too far, tells nobody") {
    voxel const corner{32, 32, 32};
    auto const open = [](voxel v) { return voxel_change{v, voxel_state::rock, voxel_state::air}; };
    CHECK(detail::air_counter::concerns(open({32, 40, 50}), corner, 0));
    CHECK(detail::air_counter::concerns(open({27, 68, 27}), corner, 5));
    CHECK_FALSE(detail::air_counter::concerns(open({26, 40, 50}), corner, 5));
    CHECK_FALSE(detail::air_counter::concerns(open({40, 69, 50}), corner, 5));
    CHECK_FALSE(detail::air_counter::concerns({{40, 40, 40}, voxel_state::rock, voxel_state::colluvium}, corner, 5));
    CHECK(detail::air_counter::concerns({{40, 40, 40}, voxel_state::air, voxel_state::colluvium}, corner, 5));
}

TEST_CASE("counts of a bubble that any symmetry of the cube maps to itself commute with the 48 symmetries") {
    constexpr int n = 36;
    auto const rock = [](voxel v) {
        return (v.x - 11) * (v.x - 11) + 2 * (v.y - 20) * (v.y - 20) + (v.z - 14) * (v.z - 9) < 130 ||
               (v.x * v.y + v.z) % 13 == 0;
    };
    bubble_stencil const bubble = sphere_bubble{.radius = 5.5};
    detail::air_counter counter;
    auto const counts = [&](std::function<voxel(voxel)> const& source) {
        sparse_grid grid({.size = {n, n, n}});
        std::vector<std::uint32_t> out(n * n * n);
        for (std::size_t b = 0; b < grid.brick_count(); ++b) {
            grid.fill_brick(b, [&](voxel v) { return rock(source(v)) ? voxel_state::rock : voxel_state::air; });
        }
        for (std::size_t b = 0; b < grid.brick_count(); ++b) {
            std::vector<detail::brick_position> position;
            for (int i = 0; i < 32768; ++i) {
                auto const p = static_cast<detail::brick_position>(i);
                voxel const v = detail::at_position(grid.brick_corner(b), p);
                if (grid.contains(v) && grid.is_solid(v)) position.push_back(p);
            }
            std::vector<std::uint32_t> air(position.size());
            counter.recount(grid, b, {&bubble, 1}, {position, {}, air});
            for (std::size_t i = 0; i < position.size(); ++i) {
                voxel const v = source(detail::at_position(grid.brick_corner(b), position[i]));
                out[static_cast<std::size_t>(v.x + n * (v.y + n * v.z))] = air[i] + 1;
            }
        }
        return out;
    };
    auto const expected = counts([](voxel v) { return v; });
    std::array<int, 3> axes{0, 1, 2};
    int symmetries = 0;
    do {
        for (unsigned mirrored = 0; mirrored < 8; ++mirrored) {
            auto const turned = counts([&](voxel v) {
                std::array<std::int32_t, 3> const in{v.x, v.y, v.z};
                std::array<std::int32_t, 3> out{};
                for (std::size_t k = 0; k < 3; ++k) {
                    std::int32_t const c = in[static_cast<std::size_t>(axes[k])];
                    out[k] = (mirrored >> k & 1u) != 0 ? n - 1 - c : c;
                }
                return voxel{out[0], out[1], out[2]};
            });
            CHECK(turned == expected);
            ++symmetries;
        }
    } while (std::next_permutation(axes.begin(), axes.end()));
    CHECK(symmetries == 48);
}
