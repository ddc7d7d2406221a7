#include <catch2/catch.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/decomposition/shard_complex.hpp>
#include <tafoni/decomposition/voxel_cells.hpp>
#include <tafoni/graph/make_link_graph.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

using namespace tafoni;

namespace {

/// A complex written down by hand: faces with their cells, patch and loop.
struct sketch {
    shard_complex c{};

    explicit sketch(std::vector<vec3> vertices, std::size_t cells) {
        c.vertices = std::move(vertices);
        c.volumes.assign(cells, 1.0);
        c.centroids.assign(cells, vec3{0, 0, 0});
        box3 b;
        for (vec3 const& v : c.vertices) b.include(v);
        c.size = b.diagonal();
    }
    void face(std::uint32_t front, std::uint32_t back, std::uint32_t patch, std::vector<std::vector<std::uint32_t>> loops) {
        for (auto const& loop : loops) {
            for (std::uint32_t const v : loop) c.corners.push_back(vertex_index{v});
            c.loop_begin.push_back(c.corners.size());
        }
        c.face_begin.push_back(static_cast<std::uint32_t>(c.loop_begin.size() - 1));
        c.faces.push_back({cell_index{front}, cell_index{back}});
        if (cell_index{back}.valid()) {
            ++c.interior_face_count;  // interior faces are sketched first
        } else {
            c.skin_patches.push_back(patch_index{patch});
        }
    }
};
constexpr std::uint32_t none = cell_index::none;

std::set<std::uint32_t> neigh(link_graph const& g, std::uint32_t l) {
    std::set<std::uint32_t> r;
    for (link_index const n : g.neighbors(link_index{l})) r.insert(n.value);
    return r;
}

/// Neigh by the definition: a quadratic search over faces of one cell, small faces passed through one by one.
std::vector<std::set<std::uint32_t>> brute_neigh(cell_complex auto const& c, link_graph const& g, double limit) {
    std::vector<std::set<std::uint32_t>> result(g.link_count());
    std::vector<std::vector<face_index>> of(c.cell_count());
    for (std::uint32_t f = 0; f < c.face_count(); ++f) {
        for (cell_index const cell : c.face_cells(face_index{f})) {
            if (cell.valid()) of[cell.value].push_back(face_index{f});
        }
    }
    auto const edges = [&](face_index f) {
        std::set<std::pair<std::uint32_t, std::uint32_t>> e;
        for (std::size_t l = 0; l < c.loop_count(f); ++l) {
            auto const loop = c.face_loop(f, l);
            for (std::size_t k = 0; k < loop.size(); ++k) {
                std::uint32_t const u = vertex_index{loop[k]}.value;
                std::uint32_t const v = vertex_index{loop[(k + 1) % loop.size()]}.value;
                if (length(vec3(c.position(vertex_index{u}) - c.position(vertex_index{v}))) > limit) {
                    e.insert({std::min(u, v), std::max(u, v)});
                }
            }
        }
        return e;
    };
    auto const artificial = [&](face_index f) { return !c.face_cells(f)[1].valid() && !c.face_patch(f).valid(); };
    for (auto const& faces : of) {
        for (face_index const f : faces) {
            link_index const l = g.link_of(f);
            if (!l.valid()) continue;
            std::vector<face_index> front{f};
            std::set<face_index> seen{f};
            for (std::size_t i = 0; i < front.size(); ++i) {
                for (face_index const h : faces) {
                    if (seen.contains(h) || artificial(h)) continue;
                    auto const a = edges(front[i]);
                    auto const b = edges(h);
                    bool const touch = std::any_of(a.begin(), a.end(), [&](auto const& e) { return b.contains(e); });
                    if (!touch) continue;
                    link_index const m = g.link_of(h);
                    if (!m.valid()) {
                        seen.insert(h);
                        front.push_back(h);
                    } else if (m != l) {
                        result[l.value].insert(m.value);
                    }
                }
            }
        }
    }
    return result;
}

voxel_cells random_voxels(stream& random, std::size_t most) {
    voxel_cells_options o{.spacing = {1, 0.5, 2}, .origin = {-3, 7, 100}};
    for (std::size_t& s : o.size) s = 1 + random.index_below(most);
    for (bool& side : o.artificial) side = random.chance(0.3);
    double const share = random.uniform01();
    return voxel_cells::from_predicate(o, [&](vec3 const&) { return random.chance(share); });
}

}  // namespace

TEST_CASE("two boxes side by side: one bond with eight neighbours, ten skin links") {
    auto const v = voxel_cells::from_predicate({.size = {2, 1, 1}}, [](vec3 const&) { return true; });
    link_graph const g = make_link_graph(v);
    REQUIRE(g.cell_count() == 2);
    REQUIRE(g.interior_link_count() == 1);
    REQUIRE(g.exterior_link_count() == 10);
    REQUIRE(g.link_cells(link_index{0U})[0] == cell_index{0U});
    REQUIRE(g.link_cells(link_index{0U})[1] == cell_index{1U});
    REQUIRE(g.link_centroid(link_index{0U}) == vec3(1, 0.5, 0.5));
    REQUIRE(g.link_normal(link_index{0U}) == vec3(1, 0, 0));
    REQUIRE(g.link_area(link_index{0U}) == 1);
    REQUIRE(neigh(g, 0).size() == 8);
    for (std::uint32_t l = 1; l < 11; ++l) {
        REQUIRE(neigh(g, l).size() == 4);
        REQUIRE_FALSE(g.link_cells(link_index{l})[1].valid());
        // The caps look along x and do not touch the bond; the walls do.
        REQUIRE(neigh(g, l).contains(0) == (g.link_normal(link_index{l})[0] == 0));
    }
    REQUIRE(g.other_cell(link_index{0U}, cell_index{1U}) == cell_index{0U});
    REQUIRE(g.links_of(cell_index{0U}).size() == 6);
}

TEST_CASE("a cube lattice has the links and neighbours of its closed form") {
    std::uint32_t const n = 7;
    auto const v = voxel_cells::from_predicate({.size = {n, n, n}}, [](vec3 const&) { return true; });
    link_graph const g = make_link_graph(v);
    REQUIRE(g.interior_link_count() == 3 * n * n * (n - 1));
    REQUIRE(g.exterior_link_count() == 6 * n * n);
    double area = 0;
    for (std::uint32_t l = 0; l < g.link_count(); ++l) {
        REQUIRE(g.neighbors(link_index{l}).size() == (g.is_interior(link_index{l}) ? 8 : 4));
        area += g.is_interior(link_index{l}) ? 0 : g.link_area(link_index{l});
    }
    REQUIRE(area == 6 * n * n);
}

TEST_CASE("faces of no width pass neighbours on, and edges of no length join none") {
    // Four prisms around the line x = y = 0, as a lattice looks after its ties were broken: the line is
    // doubled (d = 1e-13 wide) and a sliver face between cells 0 and 2 stands there.
    double const d = 1e-13;
    std::vector<vec3> v;
    for (double const z : {0.0, 1.0}) {
        for (vec3 const& p : {vec3{-1, -1, z}, vec3{0, -1, z}, vec3{1, -1, z}, vec3{-1, 0, z}, vec3{-d, 0, z}, vec3{0, d, z},
                              vec3{1, 0, z}, vec3{-1, 1, z}, vec3{0, 1, z}, vec3{1, 1, z}}) {
            v.push_back(p);
        }
    }
    std::uint32_t const up = 10;
    sketch s(v, 4);
    // Cells: 0 = (x<0, y<0)... counted by quadrant: 0 lower left, 1 lower right, 2 upper right, 3 upper left.
    auto const wall = [&](std::uint32_t front, std::uint32_t back, std::uint32_t patch, std::uint32_t a, std::uint32_t b) {
        s.face(front, back, patch, {{a, b, b + up, a + up}});
    };
    wall(0, 1, none, 1, 5);  // A
    wall(1, 2, none, 6, 5);  // B
    wall(2, 3, none, 8, 4);  // C
    wall(3, 0, none, 3, 4);  // D
    wall(0, 2, none, 5, 4);  // the sliver
    link_graph const g = make_link_graph(s.c);
    REQUIRE(g.link_count() == 4);
    REQUIRE_FALSE(g.link_of(face_index{4U}).valid());
    // A and D meet in cell 0 across the sliver, B and C in cell 2 likewise; A, B in cell 1, C, D in cell 3.
    REQUIRE(neigh(g, 0) == std::set<std::uint32_t>{1, 3});
    REQUIRE(neigh(g, 1) == std::set<std::uint32_t>{0, 2});
    REQUIRE(neigh(g, 2) == std::set<std::uint32_t>{1, 3});
    REQUIRE(neigh(g, 3) == std::set<std::uint32_t>{0, 2});
    REQUIRE(brute_neigh(s.c, g, 1e-9 * s.c.size)[0] == neigh(g, 0));
    // With tolerance 0 the sliver is a link like any other and A no longer touches D.
    link_graph const all = make_link_graph(s.c, {.tolerance = 0});
    REQUIRE(all.link_count() == 5);
    REQUIRE(neigh(all, 0) == std::set<std::uint32_t>{1, 4});
}

TEST_CASE("a patch of the skin is one link: its area, centroid and normal are weighted by area") {
    // A roof of two slopes on one cell: areas 1 and 3, one patch; a third face is artificial.
    sketch s({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, -3}, {1, 1, -3}, {5, 5, 5}}, 1);
    s.face(0, none, 4, {{0, 1, 2, 3}});
    s.face(0, none, 4, {{1, 4, 5, 2}});
    s.face(0, none, none, {{0, 4, 1}});
    link_graph const g = make_link_graph(s.c);
    REQUIRE(g.link_count() == 1);
    link_index const l{0U};
    REQUIRE(g.link_area(l) == 4);
    REQUIRE(length(vec3(g.link_centroid(l) - vec3(0.875, 0.5, -1.125))) < 1e-15);
    REQUIRE(length(vec3(g.link_normal(l) - normalized(vec3(3, 0, 1)))) < 1e-15);
    REQUIRE(g.link_of(face_index{0U}) == l);
    REQUIRE(g.link_of(face_index{1U}) == l);
    REQUIRE_FALSE(g.link_of(face_index{2U}).valid());
    REQUIRE(g.neighbors(l).empty());
    std::vector<std::uint32_t> faces;
    g.for_each_face(l, [&](face_index f) { faces.push_back(f.value); });
    REQUIRE(faces == std::vector<std::uint32_t>{0, 1});
}

TEST_CASE("a hole takes its area away and moves the centroid") {
    sketch s({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}}, 1);
    s.face(0, none, 0, {{0, 1, 2, 3}, {4, 5, 6, 7}});
    link_graph const g = make_link_graph(s.c);
    REQUIRE(g.link_area(link_index{0U}) == 15);
    REQUIRE(g.link_centroid(link_index{0U})[0] == Approx((16 * 2 - 1.5) / 15).epsilon(1e-15));
}

TEST_CASE("Neigh is symmetric, without itself, ascending, and what its definition says", "[law3]") {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        INFO("seed " << seed);
        stream random(seed, stage::user, 0);
        voxel_cells const v = random_voxels(random, 4);
        link_graph const g = make_link_graph(v);
        auto const expected = brute_neigh(v, g, 1e-9 * v.model_size());
        for (std::uint32_t l = 0; l < g.link_count(); ++l) {
            auto const n = g.neighbors(link_index{l});
            REQUIRE(std::is_sorted(n.begin(), n.end()));
            REQUIRE(neigh(g, l).size() == n.size());
            REQUIRE(neigh(g, l) == expected[l]);
            for (link_index const m : n) REQUIRE(neigh(g, m.value).contains(l));
        }
    }
}

TEST_CASE("the stored graph of voxels is their computed network up to numbering") {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        INFO("seed " << seed);
        stream random(seed, stage::user, 1);
        voxel_cells const v = random_voxels(random, 6);
        link_graph const g = make_link_graph(v);
        using place = std::tuple<double, double, double>;
        auto const key = [](vec3 const& p) { return place{p[0], p[1], p[2]}; };
        std::map<place, link_index> slot_at;
        for (std::uint32_t l = 0; l < v.link_count(); ++l) {
            link_index const s{l};
            if (v.has_link(s)) REQUIRE(slot_at.emplace(key(v.link_centroid(s)), s).second);
        }
        REQUIRE(slot_at.size() == g.link_count());
        std::map<link_index, link_index> slot_of;
        for (std::uint32_t l = 0; l < g.link_count(); ++l) {
            // Fans of a flat square may round where the network multiplies; all sizes here are powers of two.
            auto const at = slot_at.find(key(g.link_centroid(link_index{l})));
            REQUIRE(at != slot_at.end());
            slot_of[link_index{l}] = at->second;
        }
        for (auto const& [l, s] : slot_of) {
            REQUIRE(g.link_cells(l) == v.link_cells(s));
            REQUIRE(g.link_area(l) == v.link_area(s));
            REQUIRE(g.link_normal(l) == v.link_normal(s));
            std::set<link_index> stored;
            for (link_index const m : g.neighbors(l)) stored.insert(slot_of[m]);
            std::set<link_index> computed;
            std::size_t visits = 0;
            v.for_each_neighbor(s, [&](link_index m) {
                REQUIRE(v.has_link(m));
                computed.insert(m);
                ++visits;
            });
            REQUIRE(visits == computed.size());
            REQUIRE(stored == computed);
        }
        for (std::uint32_t c = 0; c < v.cell_count(); ++c) {
            std::set<link_index> stored;
            for (link_index const l : g.links_of(cell_index{c})) stored.insert(slot_of[l]);
            std::set<link_index> computed;
            v.for_each_cell_link(cell_index{c}, [&](link_index m) { computed.insert(m); });
            REQUIRE(stored == computed);
        }
    }
}

TEST_CASE("faces and links name each other, whatever the order of the faces") {
    stream random(5, stage::user, 2);
    for (int round = 0; round < 20; ++round) {
        voxel_cells const v = random_voxels(random, 5);
        link_graph const g = make_link_graph(v);
        std::size_t named = 0;
        for (std::uint32_t l = 0; l < g.link_count(); ++l) {
            g.for_each_face(link_index{l}, [&](face_index f) {
                REQUIRE(g.link_of(f) == link_index{l});
                REQUIRE(v.face_cells(f) == g.link_cells(link_index{l}));
                ++named;
            });
        }
        std::size_t linked = 0;
        for (std::uint32_t f = 0; f < v.face_count(); ++f) linked += g.link_of(face_index{f}).valid() ? 1U : 0U;
        REQUIRE(named == linked);
    }
}

TEST_CASE("cells with more links than bits in a word have the same neighbours") {
    // A fan of 90 skin triangles of own patches around an apex, with a sliver between two of them.
    std::size_t const n = 90;
    std::vector<vec3> v{{0, 0, 1}};
    for (std::size_t i = 0; i < n; ++i) {
        double const t = static_cast<double>(i) / static_cast<double>(n) * 4;  // around a square
        double const u = t - std::floor(t);
        int const side = static_cast<int>(t);
        v.push_back(side == 0 ? vec3{u, 0, 0} : side == 1 ? vec3{1, u, 0} : side == 2 ? vec3{1 - u, 1, 0} : vec3{0, 1 - u, 0});
    }
    v.push_back(v[1] + vec3(1e-13, 0, 0));
    auto const last = static_cast<std::uint32_t>(v.size() - 1);
    sketch s(v, 1);
    std::vector<std::uint32_t> base;
    for (std::uint32_t i = 0; i < n; ++i) {
        std::uint32_t const from = i == 0 ? last : i + 1;
        s.face(0, none, i, {{0, from, i + 1 == n ? 1 : i + 2}});
        base.push_back(i + 1);
    }
    s.face(0, none, n, {{0, 1, last}});
    std::reverse(base.begin(), base.end());
    link_graph const g = make_link_graph(s.c);
    REQUIRE(g.link_count() == n);
    for (std::uint32_t i = 0; i < n; ++i) {
        auto const m = static_cast<std::uint32_t>(n);
        REQUIRE(neigh(g, i) == std::set<std::uint32_t>{(i + 1) % m, (i + m - 1) % m});
    }
}

TEST_CASE("the graph has the same bits for every number of threads", "[threads]") {
    auto const v = voxel_cells::from_predicate({.size = {17, 13, 11}}, [](vec3 const& p) {
        return squared_length(vec3(p - vec3(8, 6, 5))) > 9;
    });
    link_graph const one = make_link_graph(v);
    for (std::size_t const threads : {2U, 7U}) {
        link_graph const g = make_link_graph(v, {}, thread_pool(threads));
        REQUIRE(g.link_count() == one.link_count());
        for (std::uint32_t l = 0; l < g.link_count(); ++l) {
            link_index const i{l};
            REQUIRE(g.link_centroid(i) == one.link_centroid(i));
            REQUIRE(g.link_cells(i) == one.link_cells(i));
            REQUIRE(std::equal(g.neighbors(i).begin(), g.neighbors(i).end(), one.neighbors(i).begin(), one.neighbors(i).end()));
        }
    }
}

TEST_CASE("nothing makes an empty graph, a bad tolerance is refused, an observer may cancel") {
    REQUIRE(make_link_graph(shard_complex{}).link_count() == 0);
    auto const v = voxel_cells::from_predicate({.size = {2, 2, 2}}, [](vec3 const&) { return true; });
    for (double const bad : {-1.0, 0.5, std::numeric_limits<double>::quiet_NaN()}) {
        REQUIRE_THROWS_AS(make_link_graph(v, {.tolerance = bad}), invalid_input);
    }
    for (int stop = 1; stop <= 5; ++stop) {
        int ticks = 0;
        run_context const context{[&](progress_event const&) { return ++ticks == stop ? step_control::stop : step_control::proceed; }};
        REQUIRE_THROWS_AS(make_link_graph(v, {}, inline_executor{}, context), cancelled);
    }
}
