#include <catch2/catch.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/voxel/colluvium.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <span>
#include <vector>

using namespace tafoni;

namespace {

constexpr auto air = voxel_state::air;
constexpr auto rock = voxel_state::rock;
constexpr auto loose = voxel_state::colluvium;

sparse_grid box(std::size_t nx, std::size_t ny, std::size_t nz, grid_border const& border = {}, vec3 spacing = {1, 1, 1}) {
    return sparse_grid({.size = {nx, ny, nz}, .spacing = spacing}, up_axis::plus_z, border);
}

grid_border all_sides(border_kind k) { return {{k, k, k, k, k, k}}; }
/// Open to the sides, a floor below.
grid_border floor_of(border_kind sides) {
    auto b = all_sides(sides);
    b.sides[4] = border_kind::rock;
    return b;
}

/// The words of the documentation voxel by voxel, for the laws to be checked against.
struct oracle {
    sparse_grid const& g;
    repose_rule rule;

    bool wall(voxel v) const {
        if (g.contains(v)) return g.state(v) != air;
        auto const& s = g.border().sides;
        auto const n = g.size();
        bool const beside = v.x < 0 || v.y < 0 || v.x >= static_cast<int>(n[0]) || v.y >= static_cast<int>(n[1]);
        if (beside) {
            auto const kind = v.x < 0 ? s[0] : v.x >= static_cast<int>(n[0]) ? s[1] : v.y < 0 ? s[2] : s[3];
            if (kind != border_kind::air) return true;
            return v.z < 0 && s[4] == border_kind::rock;
        }
        return s[4] != border_kind::air;
    }
    double drop(voxel v) const {
        double n = 0;
        for (; !wall(v); --v.z) {
            if (v.z < 0) return std::numeric_limits<double>::infinity();
            ++n;
        }
        return n;
    }
    bool supported(voxel v) const { return wall({v.x, v.y, v.z - 1}); }
    bool too_steep(voxel v) const {
        double const slope = rule.angle >= 90 ? std::numeric_limits<double>::infinity() : std::tan(rule.angle * 3.14159265358979323846 / 180);
        for (int d = 0; d < 4; ++d) {
            double const pitch = d < 2 ? g.spacing()[0] : g.spacing()[1];
            for (int k = 1; k <= rule.baseline; ++k) {
                int const s = d % 2 == 0 ? k : -k;
                voxel const c{d < 2 ? v.x + s : v.x, d < 2 ? v.y : v.y + s, v.z};
                double const n = drop(c);
                if (n == 0) break;
                double const exact = k * pitch * slope / g.spacing()[2];
                double const limit = k == rule.baseline ? std::floor(exact + 1e-9) : std::ceil(exact - 1e-9);
                if (n > std::max(1.0, limit)) return true;
            }
        }
        return false;
    }
};

std::vector<voxel> all_of(sparse_grid const& g, voxel_state s) {
    std::vector<voxel> out;
    auto const n = g.size();
    for (int z = 0; z < static_cast<int>(n[2]); ++z) {
        for (int y = 0; y < static_cast<int>(n[1]); ++y) {
            for (int x = 0; x < static_cast<int>(n[0]); ++x) {
                if (g.state({x, y, z}) == s) out.push_back({x, y, z});
            }
        }
    }
    return out;
}

/// Colluvium that the laws of rest forbid.
std::size_t restless(sparse_grid const& g, repose_rule const& rule) {
    oracle const o{g, rule};
    std::size_t n = 0;
    for (voxel const v : all_of(g, loose)) n += !o.supported(v) || o.too_steep(v) ? 1U : 0U;
    return n;
}

struct outcome {
    settle_report report;
    std::vector<voxel_change> changes;
};

template <class E = inline_executor>
outcome run(sparse_grid& g, std::vector<voxel> const& released, std::vector<voxel> const& opened,
            repose_rule const& rule = {}, std::uint64_t seed = 1, std::uint64_t step = 1, E const& e = E{}) {
    outcome o;
    o.report = settle(g, released, opened, rule, seed, step, e, o.changes);
    return o;
}

/// Rocks, shelves, tunnels and heaps without order, and what a step of weathering did to them.
struct scene {
    sparse_grid grid;
    std::vector<voxel> released{};
    std::vector<voxel> opened{};
};

scene random_scene(std::uint64_t seed, repose_rule const& rule) {
    stream draw(seed, stage::user, 0);
    auto below = [&](int n) { return static_cast<int>(draw.index_below(static_cast<std::uint64_t>(n))); };
    auto const nx = static_cast<std::size_t>(1 + below(40));
    auto const ny = static_cast<std::size_t>(1 + below(40));
    auto const nz = static_cast<std::size_t>(1 + below(70));
    grid_border border;
    for (auto& s : border.sides) s = static_cast<border_kind>(below(3));
    scene s{box(nx, ny, nz, border)};
    auto block = [&](voxel_state state) {
        int const x = below(static_cast<int>(nx));
        int const y = below(static_cast<int>(ny));
        int const z = below(static_cast<int>(nz));
        int const a = 1 + below(12);
        int const b = 1 + below(12);
        int const c = 1 + below(12);
        for (int k = z; k < std::min(z + c, static_cast<int>(nz)); ++k) {
            for (int j = y; j < std::min(y + b, static_cast<int>(ny)); ++j) {
                for (int i = x; i < std::min(x + a, static_cast<int>(nx)); ++i) s.grid.set({i, j, k}, state);
            }
        }
    };
    int const blocks = below(60);
    for (int i = 0; i < blocks; ++i) block(below(3) == 0 ? air : rock);
    for (int i = 0; i < 4; ++i) block(loose);
    run(s.grid, {}, all_of(s.grid, loose), rule, seed, 0);
    for (voxel const v : all_of(s.grid, rock)) {
        if (below(10) == 0) s.released.push_back(v);
        if (below(40) == 0) s.opened.push_back(v);
    }
    for (voxel const v : all_of(s.grid, loose)) {
        if (below(6) == 0) s.opened.push_back(v);
    }
    s.opened.insert(s.opened.end(), s.released.begin(), s.released.end());
    for (voxel const v : s.opened) s.grid.set(v, air);
    return s;
}

bool same_voxels(sparse_grid const& a, sparse_grid const& b) {
    for (std::size_t i = 0; i < a.brick_count(); ++i) {
        for (std::size_t c = 0; c < 1024; ++c) {
            if (a.solid_word(i, c) != b.solid_word(i, c) || a.colluvium_word(i, c) != b.colluvium_word(i, c)) return false;
        }
    }
    return true;
}

}  // namespace

TEST_CASE("after settling no grain hangs or stands too steep, and none is lost, in scenes without order", "[colluvium]") {
    std::array<repose_rule, 6> const rules{repose_rule{}, {.angle = 65}, {.angle = 0}, {.angle = 90}, {.angle = 30, .baseline = 4}, {.angle = 56, .baseline = 3}};
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        repose_rule const& rule = rules[seed % rules.size()];
        scene s = random_scene(seed, rule);
        CAPTURE(seed, rule.angle, rule.baseline);
        REQUIRE(all_of(s.grid, loose).size() == s.grid.count(voxel_plane::colluvium));
        sparse_grid const before = s.grid;
        outcome const o = run(s.grid, s.released, s.opened, rule, seed);
        CHECK(restless(s.grid, rule) == 0);
        CHECK(before.count(voxel_plane::colluvium) + s.released.size() == s.grid.count(voxel_plane::colluvium) + o.report.left);
        CHECK(before.count(voxel_plane::rock) == s.grid.count(voxel_plane::rock));

        sparse_grid replayed = before;
        bool net = std::is_sorted(o.changes.begin(), o.changes.end(), [](auto const& a, auto const& b) { return a.at < b.at; });
        for (std::size_t i = 0; i < o.changes.size(); ++i) {
            voxel_change const& c = o.changes[i];
            net = net && c.before != c.after && replayed.state(c.at) == c.before;
            net = net && (i == 0 || o.changes[i - 1].at != c.at);
            replayed.set(c.at, c.after);
        }
        CHECK(net);
        CHECK(same_voxels(replayed, s.grid));
    }
}

namespace {

/// Claims threads and takes the blocks from the last to the first.
struct backwards {
    template <class F>
    void for_blocks(std::size_t n, std::size_t grain, F const& f) const {
        std::size_t const blocks = (n + grain - 1) / grain;
        for (std::size_t b = blocks; b-- > 0;) f(b * grain, std::min(n, b * grain + grain));
    }
    std::size_t thread_count() const noexcept { return 3; }
};
static_assert(executor<backwards>);

/// A tower with a shelf and a tunnel that loses a good part of its skin: grains by the thousand on each other's way.
scene crumbling_tower(repose_rule const& rule) {
    auto border = floor_of(border_kind::air);
    border.sides[0] = border_kind::rock;
    border.sides[2] = border_kind::extend;
    scene s{box(64, 60, 90, border)};
    auto stone = [](voxel v) {
        bool const tunnel = std::abs(v.y - 30) < 4 && std::abs(v.z - 20) < 4;
        bool const shelf = v.z > 50 && v.z < 54 && v.x < 55 && v.y < 50;
        int const r = (v.x - 30) * (v.x - 30) + (v.y - 30) * (v.y - 30);
        return shelf || (r < 250 && v.z < 85 && !tunnel);
    };
    for (std::size_t b = 0; b < s.grid.brick_count(); ++b) {
        s.grid.fill_brick(b, [&](voxel v) { return stone(v) ? rock : air; });
    }
    stream draw(7, stage::user, 0);
    for (int round = 0; round < 2; ++round) {
        s.released.clear();
        s.opened.clear();
        for (voxel const v : all_of(s.grid, rock)) {
            if (draw.chance(0.15)) s.released.push_back(v);
        }
        s.opened = s.released;
        for (voxel const v : all_of(s.grid, loose)) {
            if (draw.chance(0.2)) s.opened.push_back(v);
        }
        for (voxel const v : s.opened) s.grid.set(v, air);
        if (round == 0) run(s.grid, s.released, s.opened, rule);
    }
    return s;
}

}  // namespace

TEST_CASE("grains settle in parallel exactly as one after the other", "[colluvium]") {
    for (repose_rule const rule : {repose_rule{}, repose_rule{.angle = 30, .baseline = 4}, repose_rule{.angle = 70, .baseline = 2}}) {
        scene const s = crumbling_tower(rule);
        CAPTURE(rule.angle, rule.baseline, s.released.size());
        REQUIRE(s.released.size() > 5000);
        sparse_grid one = s.grid;
        sparse_grid many = s.grid;
        outcome const a = run(one, s.released, s.opened, rule);
        outcome const b = run(many, s.released, s.opened, rule, 1, 1, backwards{});
        CHECK(a.report.moved > 500);
        CHECK(a.report == b.report);
        CHECK((a.changes == b.changes));
        CHECK(same_voxels(one, many));
        CHECK(restless(many, rule) == 0);
    }
    for (std::uint64_t seed = 100; seed < 140; ++seed) {
        repose_rule const rule{.angle = 40, .baseline = 1 + static_cast<int>(seed % 3)};
        scene s = random_scene(seed, rule);
        sparse_grid many = s.grid;
        CAPTURE(seed);
        outcome const a = run(s.grid, s.released, s.opened, rule);
        outcome const b = run(many, s.released, s.opened, rule, 1, 1, backwards{});
        CHECK(a.report == b.report);
        CHECK((a.changes == b.changes));
    }
}

TEST_CASE("every number of threads lays the grains into the same voxels", "[colluvium][threads]") {
    scene const s = crumbling_tower({});
    sparse_grid one = s.grid;
    outcome const a = run(one, s.released, s.opened);
    for (std::size_t const threads : {std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{7}}) {
        thread_pool const pool(threads);
        sparse_grid g = s.grid;
        outcome o;
        o.report = settle(g, s.released, s.opened, repose_rule{}, 1, 1, pool, o.changes);
        CAPTURE(threads);
        CHECK(o.report == a.report);
        CHECK((o.changes == a.changes));
        CHECK(same_voxels(g, one));
    }
}
