#include <catch2/catch.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/voxel/dense_grid.hpp>
#include <tafoni/voxel/detail/brick_window.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

using namespace tafoni;

namespace {

using access = grid_access<sparse_grid>;

/// What a sparse grid is to answer, one voxel at a time and by the words of its documentation.
struct oracle {
    grid_frame frame;
    up_axis up;
    grid_border border;  // in the user's axes
    std::vector<voxel_state> states;

    voxel_state& at(voxel u) { return states[detail::linear_index(frame.size, u)]; }
    voxel_state state(voxel u) const {
        bool rock = false;
        bool air = false;
        std::int32_t c[3] = {u.x, u.y, u.z};
        for (std::size_t d = 0; d < 3; ++d) {
            auto const n = static_cast<std::int32_t>(frame.size[d]);
            if (c[d] >= 0 && c[d] < n) continue;
            border_kind const kind = border.sides[2 * d + (c[d] < 0 ? 0 : 1)];
            rock = rock || kind == border_kind::rock;
            air = air || kind == border_kind::air;
            c[d] = c[d] < 0 ? 0 : n - 1;
        }
        if (rock) return voxel_state::rock;
        return air ? voxel_state::air : states[detail::linear_index(frame.size, {c[0], c[1], c[2]})];
    }
};

grid_border any_border(stream& random) {
    grid_border b;
    for (border_kind& k : b.sides) k = static_cast<border_kind>(random.index_below(3));
    return b;
}

/// Mostly mixed, but with bricks of nothing but rock and of nothing but air in larger grids.
oracle any_rock(stream& random, up_axis up, std::size_t longest) {
    oracle o{.frame = {}, .up = up, .border = any_border(random), .states = {}};
    for (std::size_t& n : o.frame.size) n = 1 + random.index_below(longest);
    o.states.resize(o.frame.voxel_count());
    double const mixed = random.uniform01();
    bool const hollow = random.chance(0.5);
    for (std::size_t k = 0; k < o.frame.size[2]; ++k) {
        for (std::size_t j = 0; j < o.frame.size[1]; ++j) {
            for (std::size_t i = 0; i < o.frame.size[0]; ++i) {
                bool const apart = i > 20 && j > 20;
                voxel_state s = apart && hollow ? voxel_state::air : voxel_state::rock;
                if (!apart && random.chance(mixed)) s = static_cast<voxel_state>(random.index_below(3));
                o.states[i + o.frame.size[0] * (j + o.frame.size[1] * k)] = s;
            }
        }
    }
    return o;
}

sparse_grid grid_of(oracle const& o) {
    sparse_grid g(o.frame, o.up, o.border);
    for (std::size_t k = 0; k < o.frame.size[2]; ++k) {
        for (std::size_t j = 0; j < o.frame.size[1]; ++j) {
            for (std::size_t i = 0; i < o.frame.size[0]; ++i) {
                access::set(g, i, j, k, o.states[i + o.frame.size[0] * (j + o.frame.size[1] * k)]);
            }
        }
    }
    return g;
}

void compact_all(sparse_grid& g) {
    for (std::size_t b = 0; b < g.brick_count(); ++b) g.compact(b);
}

bool in_plane(voxel_state s, voxel_plane p) {
    if (p == voxel_plane::solid) return s != voxel_state::air;
    return s == (p == voxel_plane::rock ? voxel_state::rock : voxel_state::colluvium);
}

voxel voxel_within(stream& random, std::array<std::size_t, 3> const& size, std::int32_t beyond) {
    std::int32_t c[3];
    for (std::size_t d = 0; d < 3; ++d) {
        c[d] = static_cast<std::int32_t>(random.index_below(size[d] + 2 * static_cast<std::size_t>(beyond))) - beyond;
    }
    return {c[0], c[1], c[2]};
}

void check_states(sparse_grid const& g, oracle const& o) {
    std::size_t solid = 0;
    std::size_t colluvium = 0;
    std::size_t wrong = 0;
    auto const& n = o.frame.size;
    for (std::size_t k = 0; k < n[2]; ++k) {
        for (std::size_t j = 0; j < n[1]; ++j) {
            for (std::size_t i = 0; i < n[0]; ++i) {
                voxel_state const s = o.states[i + n[0] * (j + n[1] * k)];
                wrong += access::state(g, i, j, k) != s ? 1U : 0U;
                solid += s != voxel_state::air ? 1U : 0U;
                colluvium += s == voxel_state::colluvium ? 1U : 0U;
            }
        }
    }
    REQUIRE(wrong == 0);
    REQUIRE(g.count(voxel_plane::solid) == solid);
    REQUIRE(g.count(voxel_plane::colluvium) == colluvium);
    REQUIRE(g.count(voxel_plane::rock) == solid - colluvium);
}

void check_windows(sparse_grid const& g, oracle const& o, stream& random) {
    static detail::brick_window w;
    for (int p = 0; p < 3; ++p) {
        auto const plane = static_cast<voxel_plane>(p);
        std::size_t const b = random.index_below(g.brick_count());
        int const m = static_cast<int>(random.index_below(detail::brick_window::widest + 1));
        w.gather(g, plane, b, m);
        voxel const low = g.brick_corner(b);
        std::size_t wrong = 0;
        for (int y = -m; y < 32 + m; ++y) {
            for (int x = -m; x < 32 + m; ++x) {
                REQUIRE(w.rows()[x + m + 64 * (y + m)] == w.row(x, y));
                for (int z = -m; z < 64 - m; ++z) {
                    bool const beyond = z >= 32 + m;
                    bool const expected = !beyond && in_plane(o.state(g.to_user(low + voxel{x, y, z})), plane);
                    wrong += ((w.row(x, y) >> (z + m) & 1) != 0) != expected ? 1U : 0U;
                }
            }
        }
        INFO("plane " << p << ", brick " << b << ", margin " << m);
        REQUIRE(wrong == 0);
    }
}

void check_depths(sparse_grid const& g, oracle const& o, stream& random) {
    for (int q = 0; q < 200; ++q) {
        voxel const v = voxel_within(random, g.size(), 3);
        std::int32_t depth = 0;
        voxel at = v;
        for (; at.z >= -1 && o.state(g.to_user(at)) == voxel_state::air; --at.z) ++depth;
        bool const open = v.z < -1 ? o.state(g.to_user(v)) == voxel_state::air : at.z < -1;
        INFO(v.x << ' ' << v.y << ' ' << v.z);
        REQUIRE(g.air_depth(v) == (open ? sparse_grid::bottomless : depth));
    }
}

}  // namespace

TEST_CASE("a sparse grid answers as voxel by voxel, for every up axis, border, size and content") {
    for (int up = 0; up < 6; ++up) {
        for (std::uint64_t round = 0; round < 6; ++round) {
            INFO("up " << up << ", round " << round);
            stream random(5, stage::user, static_cast<std::uint64_t>(up) * 100 + round);
            oracle const o = any_rock(random, static_cast<up_axis>(up), 70);
            sparse_grid g = grid_of(o);
            if (round % 2 == 0) compact_all(g);
            check_states(g, o);
            for (int q = 0; q < 500; ++q) {
                voxel const v = voxel_within(random, g.size(), 5);
                REQUIRE(g.state(v) == o.state(g.to_user(v)));
                REQUIRE(g.is_solid(v) == (g.state(v) != voxel_state::air));
                REQUIRE(g.is_rock(v) == (g.state(v) == voxel_state::rock));
                REQUIRE(g.contains(v) == o.frame.contains(g.to_user(v)));
                REQUIRE(g.from_user(g.to_user(v)) == v);
                REQUIRE(g.centre(v) == o.frame.centre(g.to_user(v)));
            }
            check_windows(g, o, random);
            check_depths(g, o, random);
        }
    }
}

TEST_CASE("a copy of any grid is the grid, however it lies in memory") {
    for (int up = 0; up < 6; ++up) {
        for (std::uint64_t round = 0; round < 4; ++round) {
            INFO("up " << up << ", round " << round);
            stream random(6, stage::user, static_cast<std::uint64_t>(up) * 100 + round);
            oracle const o = any_rock(random, static_cast<up_axis>(up), 70);
            dense_grid dense(o.frame);
            for (std::size_t n = 0; n < o.states.size(); ++n) {
                auto const i = static_cast<std::int32_t>(n % o.frame.size[0]);
                auto const j = static_cast<std::int32_t>(n / o.frame.size[0] % o.frame.size[1]);
                auto const k = static_cast<std::int32_t>(n / o.frame.size[0] / o.frame.size[1]);
                dense.set({i, j, k}, o.states[n]);
            }
            sparse_grid const a = sparse_grid::copy_of(dense, o.up, o.border);
            sparse_grid b = grid_of(o);
            compact_all(b);
            check_states(a, o);
            check_states(sparse_grid::copy_of(b, static_cast<up_axis>((up + 1) % 6)), o);
            REQUIRE(a.user_frame() == o.frame);
            REQUIRE(a.border() == b.border());
            for (std::size_t k = 0; k < a.brick_count(); ++k) {
                REQUIRE(a.is_air_brick(k) == b.is_air_brick(k));
                REQUIRE(a.is_rock_brick(k) == b.is_rock_brick(k));
                for (std::size_t c = 0; c < 1024; c += 31) {
                    REQUIRE(a.solid_word(k, c) == b.solid_word(k, c));
                    REQUIRE(a.plane_word(voxel_plane::rock, k, c) == b.plane_word(voxel_plane::rock, k, c));
                    REQUIRE((a.solid_word(k, c) & ~a.inside_word(k, c)) == 0);
                }
            }
        }
    }
}

TEST_CASE("bricks filled, stored, set and forgotten in any order hold what was set last") {
    stream random(7, stage::user, 0);
    oracle o = any_rock(random, up_axis::minus_y, 70);
    sparse_grid g = grid_of(o);
    for (int round = 0; round < 30; ++round) {
        std::size_t const b = random.index_below(g.brick_count());
        std::uint64_t const what = random.index_below(5);
        voxel const low = g.brick_corner(b);
        auto const fill = [&](auto const& state) {
            for (int z = 0; z < 32; ++z) {
                for (int y = 0; y < 32; ++y) {
                    for (int x = 0; x < 32; ++x) {
                        voxel const v = low + voxel{x, y, z};
                        if (g.contains(v)) o.at(g.to_user(v)) = state(v);
                    }
                }
            }
        };
        if (what == 0) g.compact(b);
        if (what == 1) (void)g.make_mixed(b);
        if (what == 2) {
            auto const stripes = [](voxel v) { return static_cast<voxel_state>((v.x + v.y + v.z) % 3); };
            g.fill_brick(b, stripes);
            fill(stripes);
        }
        if (what == 3) {
            auto const all = [&](voxel) { return round % 2 == 0 ? voxel_state::rock : voxel_state::air; };
            g.fill_brick(b, all);
            fill(all);
            REQUIRE(g.stored(b) == nullptr);
        }
        if (what == 4) {
            for (int q = 0; q < 100; ++q) {
                voxel const v = voxel_within(random, g.size(), 0);
                auto const s = static_cast<voxel_state>(random.index_below(3));
                g.set(v, s);
                o.at(g.to_user(v)) = s;
            }
        }
        check_states(g, o);
    }
}

TEST_CASE("copies are independent; what is moved from has no voxels") {
    stream random(8, stage::user, 0);
    oracle const o = any_rock(random, up_axis::plus_x, 40);
    sparse_grid a = grid_of(o);
    sparse_grid b = a;
    for (int q = 0; q < 100; ++q) b.set(voxel_within(random, b.size(), 0), voxel_state::colluvium);
    check_states(a, o);
    sparse_grid const c = std::move(a);
    check_states(c, o);
    CHECK(a.brick_count() == 0);
    CHECK(a.state({0, 0, 0}) == voxel_state::air);
    CHECK(a.count(voxel_plane::solid) == 0);
    b = c;
    check_states(b, o);
    a = std::move(b);
    check_states(a, o);
    CHECK(b.state({3, 2, 1}) == voxel_state::air);
}

TEST_CASE("grids of one voxel, of nothing but air and of nothing but rock need no bits", "[V2][V3][V4]") {
    for (std::size_t const n : {1u, 31u, 32u, 33u, 64u}) {
        sparse_grid g({.size = {n, n, n}});
        std::size_t const empty = g.bytes();
        CHECK(g.count(voxel_plane::solid) == 0);
        for (std::size_t b = 0; b < g.brick_count(); ++b) g.fill_brick(b, [](voxel) { return voxel_state::rock; });
        CHECK(g.count(voxel_plane::rock) == n * n * n);
        CHECK(g.stored(0) == nullptr);
        auto const top = static_cast<std::int32_t>(n) - 1;
        g.set({top, top, top}, voxel_state::air);
        CHECK(g.stored(g.brick_count() - 1) != nullptr);
        CHECK(g.count(voxel_plane::rock) == n * n * n - 1);
        g.set({top, top, top}, voxel_state::rock);
        g.compact(g.brick_count() - 1);
        CHECK(g.stored(g.brick_count() - 1) == nullptr);
        CHECK(g.bytes() <= empty + 64);
    }
}

TEST_CASE("a sparse grid of no voxels or of too many is refused", "[V1][V5]") {
    auto const code_of = [](grid_frame const& f) {
        try {
            sparse_grid g(f);
        } catch (invalid_input const& e) {
            return e.code();
        }
        return errc{};
    };
    std::size_t const huge = 0xFFFFFFFF;
    std::size_t const mega = grid_frame::longest;
    CHECK(code_of({.size = {1, 1, 0}}) == errc::empty_input);
    CHECK(code_of({.size = {huge, huge, huge}}) == errc::size_overflow);
    CHECK(code_of({.size = {mega, mega, mega}}) == errc::size_overflow);
    CHECK(code_of({.size = {mega, 1, 1}}) == errc{});
    CHECK(code_of({.size = {1, 1, 1}, .spacing = {1, -1, 1}}) == errc::bad_parameter);
}

TEST_CASE("a column of open air is bottomless, and ground is what the border says") {
    sparse_grid g({.size = {3, 3, 100}});
    CHECK(g.air_depth({1, 1, 99}) == sparse_grid::bottomless);
    CHECK(g.air_depth({1, 1, 500}) == sparse_grid::bottomless);
    g.set({1, 1, 40}, voxel_state::colluvium);
    CHECK(g.air_depth({1, 1, 99}) == 59);
    CHECK(g.air_depth({1, 1, 500}) == 460);
    CHECK(g.air_depth({1, 1, 40}) == 0);
    CHECK(g.air_depth({1, 1, 39}) == sparse_grid::bottomless);
    grid_border border;
    border.sides[4] = border_kind::rock;
    sparse_grid const ground({.size = {3, 3, 100}}, up_axis::plus_z, border);
    CHECK(ground.air_depth({1, 1, 99}) == 100);
    CHECK(ground.air_depth({-1, 1, 99}) == 100);
    CHECK(ground.air_depth({1, 1, -1}) == 0);
}

TEST_CASE("512 voxels along an edge: a bust keeps below 32 MiB, and what is stored is what its surface meets", "[slow]") {
    // Head, chest, neck and plinth as balls and a slab, about as much surface as a real one.
    grid_frame const frame{.size = {512, 512, 512}};
    auto const inside = [](std::int32_t x, std::int32_t y, std::int32_t z) {
        auto const ball = [&](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t r) {
            std::int32_t const dx = x - a, dy = y - b, dz = z - c;
            return dx * dx + dy * dy + dz * dz < r * r;
        };
        return ball(256, 256, 370, 110) || ball(256, 250, 150, 140) || ball(256, 256, 260, 80) || z < 40;
    };
    sparse_grid g(frame);
    for (std::size_t b = 0; b < g.brick_count(); ++b) {
        g.fill_brick(b, [&](voxel v) { return inside(v.x, v.y, v.z) ? voxel_state::rock : voxel_state::air; });
    }
    CHECK(g.bytes() < std::size_t{32} << 20);
    CHECK(g.bytes() > std::size_t{1} << 20);
    std::size_t stored = 0;
    for (std::size_t b = 0; b < g.brick_count(); ++b) stored += g.stored(b) != nullptr ? 1U : 0U;
    CHECK(stored * 4 < g.brick_count());
    CHECK(g.is_solid({256, 256, 370}));
    CHECK_FALSE(g.is_solid({256, 256, 490}));
}
