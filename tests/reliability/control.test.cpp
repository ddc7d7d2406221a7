#include "percolation/box_network.hpp"
#include "support/shapes.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/decomposition/displaced_faces.hpp>
#include <tafoni/decomposition/random_sites.hpp>
#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/decomposition/voxelize.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/geometry/repair_mesh.hpp>
#include <tafoni/geometry/terrain_solid.hpp>
#include <tafoni/graph/make_link_graph.hpp>
#include <tafoni/graph/surface_walk.hpp>
#include <tafoni/weathering/frost_run.hpp>

#include <catch2/catch.hpp>

#include <atomic>
#include <memory>
#include <stdexcept>
#include <thread>

namespace {

/// A mesh of the user that throws at call number `left`; cannot be copied.
struct fused_mesh {
    tafoni::indexed_mesh mesh{};
    long* left = nullptr;
    std::unique_ptr<int> own{};

    void burn() const {
        if (--*left == 0) throw std::runtime_error("fuse");
    }
};

}  // namespace

template <>
struct tafoni::mesh_access<fused_mesh> {
    static std::size_t vertex_count(fused_mesh const& m) { m.burn(); return m.mesh.vertex_count(); }
    static vec3 position(fused_mesh const& m, std::size_t v) { m.burn(); return m.mesh.positions[v]; }
    static std::size_t face_count(fused_mesh const& m) { m.burn(); return m.mesh.face_count(); }
    static std::size_t face_size(fused_mesh const& m, std::size_t f) { m.burn(); return m.mesh.face(f).size(); }
    static std::uint64_t corner(fused_mesh const& m, std::size_t f, std::size_t k) { m.burn(); return m.mesh.face(f)[k]; }
};

using namespace tafoni;
using namespace tafoni_test;

namespace {

bool same(solid const& a, solid const& b) {
    return a.positions == b.positions && a.triangles == b.triangles && a.opposite == b.opposite && a.volume == b.volume;
}
bool same(shard_complex const& a, shard_complex const& b) {
    return a.vertices == b.vertices && a.corners == b.corners && a.volumes == b.volumes && a.cell_faces == b.cell_faces &&
           a.site_of == b.site_of && a.skin_sources == b.skin_sources;
}
bool same(link_graph const& a, link_graph const& b) {
    if (a.link_count() != b.link_count() || a.cell_count() != b.cell_count()) return false;
    for (std::uint32_t l = 0; l < a.link_count(); ++l) {
        link_index const i{l};
        if (a.link_cells(i) != b.link_cells(i) || a.link_area(i) != b.link_area(i) || a.link_centroid(i) != b.link_centroid(i)) return false;
        auto const n = a.neighbors(i);
        auto const m = b.neighbors(i);
        if (!std::equal(n.begin(), n.end(), m.begin(), m.end())) return false;
    }
    return true;
}

/// Stops, then throws, at tick 1, 2, 3 ... of `algorithm(context)`; checks order and ranges on the way.
template <class Algorithm>
void interrupt_at_every_tick(Algorithm const& algorithm) {
    auto const whole = algorithm(run_context{});
    int ticks = 0;
    std::string stage;
    double last = 0;
    (void)algorithm(run_context{.on_progress = [&](progress_event const& e) {
        if (e.stage != stage) {
            CHECK(e.fraction == 0);
            CHECK((stage.empty() || last == 1));
            stage = e.stage;
            last = 0;
        }
        CHECK(e.fraction >= last);
        CHECK(e.fraction <= 1);
        last = e.fraction;
        ++ticks;
        return step_control::proceed;
    }});
    CHECK(last == 1);
    REQUIRE(ticks >= 2);
    for (int k = 1; k <= ticks; ++k) {
        for (bool const throws : {false, true}) {
            int seen = 0;
            bool cancelled_once = false;
            bool thrown = false;
            try {
                (void)algorithm(run_context{.on_progress = [&](progress_event const&) -> step_control {
                    if (++seen != k) return step_control::proceed;
                    if (throws) throw std::runtime_error("observer");
                    return step_control::stop;
                }});
            } catch (cancelled const& e) {
                cancelled_once = e.code() == errc::cancelled;
            } catch (std::runtime_error const& e) {
                thrown = std::string(e.what()) == "observer";
            }
            CHECK(cancelled_once == !throws);
            CHECK(thrown == throws);
            CHECK(seen == k);
        }
    }
    CHECK(same(algorithm(run_context{}), whole));
}

std::vector<vec3> few_sites() { return {{0.4, 0.5, 0.5}, {1.5, 0.5, 0.4}, {0.5, 1.6, 0.6}, {0.5, 0.6, 0.5}}; }

}  // namespace

TEST_CASE("C1, C2: every algorithm stops at any tick, passes on what observers throw, and starts again the same") {
    indexed_mesh const mesh = l_shape();
    solid const s = make_solid(mesh);
    shard_complex const shards = voronoi_shards(s, few_sites());
    height_grid const grid{.columns = 3, .rows = 2, .heights = {1, 2, 3, 4, 5, 6}};
    interrupt_at_every_tick([&](run_context const& c) { return make_solid(mesh, {}, c); });
    interrupt_at_every_tick([&](run_context const& c) { return terrain_solid(grid, {}, c); });
    interrupt_at_every_tick([&](run_context const& c) { return voronoi_shards(s, few_sites(), {}, inline_executor{}, c); });
    interrupt_at_every_tick([&](run_context const& c) { return make_link_graph(shards, {}, inline_executor{}, c); });
    CHECK(mesh == l_shape());
}

TEST_CASE("C2, C4: a mesh of the user that throws at any access is passed on, and never copied") {
    long left = -1;
    fused_mesh m;
    m.mesh = l_shape();
    m.left = &left;
    for (int which = 0; which < 2; ++which) {
        auto const work = [&] {
            if (which == 0) (void)make_solid(m);
            else (void)repair_mesh(m, {.merge_vertices = true, .orient = true});
        };
        left = -1;
        work();
        long const calls = -1 - left;
        REQUIRE(calls > 20);
        for (long k = 1; k <= calls; ++k) {
            left = k;
            CHECK_THROWS_AS(work(), std::runtime_error);
            CHECK(left == 0);  // asked nothing more
        }
    }
}

TEST_CASE("C2: patterns, fields and predicates of the user may throw at any call") {
    solid const s = make_solid(l_shape());
    long left = -1;
    auto const burn = [&left] {
        if (--left == 0) throw std::runtime_error("fuse");
    };
    auto const shards = voronoi_shards(s, few_sites());
    std::vector<cell_index> const first{cell_index{0U}};
    shard_surface const surface = extract_surface(shards, first);
    auto const moved = [&](vec3 const& p) { burn(); return vec3{0.01 * p[1], 0, 0}; };
    auto const displace = [&] { (void)displaced_faces(surface, moved, {.edge_length = 0.5}); };
    auto const voxels = [&] {
        (void)voxel_cells::from_predicate({.size = {3, 3, 3}}, [&](vec3 const& p) { burn(); return p[0] < 2; });
    };
    for (std::function<void()> const& work : {std::function<void()>(displace), std::function<void()>(voxels)}) {
        left = -1;
        work();
        long const calls = -1 - left;
        REQUIRE(calls > 5);
        for (long k = 1; k <= calls; ++k) {
            left = k;
            CHECK_THROWS_AS(work(), std::runtime_error);
        }
    }
}

TEST_CASE("C2: of exceptions in worker threads that of the lowest block arrives, run after run", "[threads]") {
    thread_pool const pool(4);
    for (int round = 0; round < 50; ++round) {
        try {
            pool.for_blocks(64, 1, [](std::size_t b, std::size_t) {
                if (b % 7 == 3) throw std::runtime_error(std::to_string(b));
            });
            FAIL_CHECK("nothing thrown");
        } catch (std::runtime_error const& e) {
            CHECK(std::string(e.what()) == "3");
        }
    }
}

TEST_CASE("C5: an observer may call the library again, on the same things") {
    solid const s = make_solid(l_shape());
    auto const whole = voronoi_shards(s, few_sites());
    int inner = 0;
    auto const outer = voronoi_shards(s, few_sites(), {}, inline_executor{}, {.on_progress = [&](progress_event const&) {
        inner += same(voronoi_shards(s, few_sites()), whole) ? 1 : 0;
        return step_control::proceed;
    }});
    CHECK(same(outer, whole));
    CHECK(inner >= 4);

    box_network const n(3, 3, 3);
    frost_run reference(n);
    reference.run({.paths = 200});
    auto const end = reference.checkpoint();
    frost_run run(n);
    bool equal = true;
    run.run({.paths = 200}, {.on_progress = [&](progress_event const&) {
        frost_run other(n);
        other.run({.paths = 200});
        equal = equal && other.checkpoint() == end;
        (void)run.checkpoint();  // looking at the run itself is fine between paths
        return step_control::proceed;
    }});
    CHECK(equal);
    CHECK(run.checkpoint() == end);
}

TEST_CASE("C5: the same mesh, solid, shards and graph serve eight threads at once, and one pool serves them all", "[threads]") {
    indexed_mesh const mesh = l_shape();
    solid const s = make_solid(mesh);
    std::vector<vec3> const sites = random_sites{.count = 20}(s, 3);
    shard_complex const shards = voronoi_shards(s, sites);
    link_graph const graph = make_link_graph(shards);
    frost_run reference(graph);
    reference.run({.paths = 300, .batch = 50});
    auto const end = reference.checkpoint();
    thread_pool const pool(3);
    std::atomic<int> wrong = 0;
    std::vector<std::thread> threads;
    for (int t = 0; t < 8; ++t) {
        threads.emplace_back([&, t] {
            if (!same(make_solid(mesh), s)) ++wrong;
            if (!same(t % 2 == 0 ? voronoi_shards(s, sites, {}, pool) : voronoi_shards(s, sites), shards)) ++wrong;
            if (!same(t % 2 == 0 ? make_link_graph(shards, {}, pool) : make_link_graph(shards), graph)) ++wrong;
            frost_run run(graph);
            run.run({.paths = 300, .batch = 50}, {}, pool);
            if (run.checkpoint() != end) ++wrong;
        });
    }
    for (std::thread& t : threads) t.join();
    CHECK(wrong == 0);
}

TEST_CASE("C7: what a run holds goes away quietly while an exception passes") {
    auto const throwing = [] {
        box_network const n(2, 2, 2);
        thread_pool const pool(3);
        frost_run run(n);
        run.run({.paths = 64, .batch = 64}, {}, pool);
        throw std::runtime_error("outside");
    };
    CHECK_THROWS_AS(throwing(), std::runtime_error);
}

TEST_CASE("C8: what was moved from may be assigned to and used again") {
    solid s = make_solid(l_shape());
    solid const copy = s;
    solid t = std::move(s);
    CHECK(same(t, copy));
    s = std::move(t);
    CHECK(same(s, copy));
    shard_complex c = voronoi_shards(s, few_sites());
    shard_complex const kept = c;
    shard_complex d = std::move(c);
    c = std::move(d);
    CHECK(same(c, kept));
    link_graph g = make_link_graph(c);
    link_graph const graph = g;
    link_graph h = std::move(g);
    g = std::move(h);
    CHECK(same(g, graph));

    box_network const n(3, 2, 2);
    frost_run run(n);
    run.run({.paths = 20});
    frost_run other = std::move(run);
    other.run({.paths = 20});
    run = std::move(other);
    run.run({.paths = 20});
    frost_run whole(n);
    whole.run({.paths = 60});
    CHECK(run.checkpoint() == whole.checkpoint());
}

TEST_CASE("C9: pools of one thread and of far more than there are cores give the same bits", "[threads]") {
    solid const s = make_solid(frame());
    std::vector<vec3> const sites = random_sites{.count = 60}(s, 3);
    auto const serial = voronoi_shards(s, sites);
    auto const graph = make_link_graph(serial);
    for (std::size_t const threads : {1U, 2U, 64U}) {
        thread_pool const pool(threads);
        CHECK(same(voronoi_shards(s, sites, {}, pool), serial));
        CHECK(same(make_link_graph(serial, {}, pool), graph));
    }
}
