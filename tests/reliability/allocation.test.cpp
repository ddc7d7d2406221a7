#include "reliability/failing_new.hpp"

#include "percolation/box_network.hpp"
#include "support/shapes.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/decomposition/displaced_faces.hpp>
#include <tafoni/decomposition/random_sites.hpp>
#include <tafoni/decomposition/shard_surface.hpp>
#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/decomposition/voxelize.hpp>
#include <tafoni/field/fractal_noise.hpp>
#include <tafoni/geometry/inspect_mesh.hpp>
#include <tafoni/geometry/repair_solid.hpp>
#include <tafoni/geometry/terrain_solid.hpp>
#include <tafoni/graph/make_link_graph.hpp>
#include <tafoni/graph/surface_walk.hpp>
#include <tafoni/io/esri_ascii.hpp>
#include <tafoni/io/obj.hpp>
#include <tafoni/io/ply.hpp>
#include <tafoni/io/stl.hpp>
#include <tafoni/io/vtk_xml.hpp>
#include <tafoni/weathering/frost_run.hpp>

#include <catch2/catch.hpp>

using namespace tafoni;
using namespace tafoni_test;

namespace {

template <class Work>
void check_every_allocation(char const* what, Work const& work, long stride = 1) {
    auto const r = fail_every_allocation(work, stride);
    INFO(what << ": memory ran out at " << r.tried << " places");
    CHECK(r.tried > 0);
    CHECK(r.leaks == 0);
    CHECK(r.strangers == 0);
}

/// A unit box with damage of every kind that can be mended.
indexed_mesh broken_box() {
    indexed_mesh m = unit_box();
    append(m, inside_out(box(vec3{3, 0, 0}, vec3{4, 1, 1})));
    append(m, box(vec3{4, 1, 0}, vec3{5, 2, 1}));  // touches the one before along an edge
    m.add_face({0, 0, 1});
    m.add_face({0, 2, 3, 1});
    indexed_mesh r;
    r.positions = m.positions;
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        if (f != 5) r.add_face(m.face(f));
    }
    return r;
}

bool same(shard_complex const& a, shard_complex const& b) {
    return a.vertices == b.vertices && a.corners == b.corners && a.volumes == b.volumes && a.cell_faces == b.cell_faces &&
           a.site_of == b.site_of && a.skin_sources == b.skin_sources;
}

}  // namespace

TEST_CASE("C3: making, mending and inspecting solids gives up cleanly wherever memory runs out") {
    indexed_mesh const good = l_shape();
    indexed_mesh const cavity = box_with_cavity();
    indexed_mesh const bad = broken_box();
    repair_options const all{.merge_vertices = true, .drop_degenerate = true, .drop_duplicates = true, .orient = true,
                             .split_nonmanifold = true, .fill_holes = 8};
    check_every_allocation("make_solid of an L", [&] { (void)make_solid(good); });
    check_every_allocation("make_solid of a cavity", [&] { (void)make_solid(cavity); });
    check_every_allocation("repair_mesh", [&] { (void)repair_mesh(bad, all); });
    check_every_allocation("repair_solid", [&] { (void)repair_solid(bad, all); });
    check_every_allocation("inspect_mesh", [&] { (void)inspect_mesh(bad); });
    height_grid const grid{.columns = 3, .rows = 3, .heights = {1, 2, 3, 4, 9, 6, 7, 8, 9}, .missing = {1, 0, 0, 0, 0, 0, 0, 0, 1}};
    check_every_allocation("terrain_solid", [&] { (void)terrain_solid(grid); });
    CHECK(good == l_shape());
    CHECK(bad == broken_box());
}

TEST_CASE("C3: an error report that finds no memory is std::bad_alloc, too") {
    indexed_mesh open = unit_box();
    open.offsets.pop_back();
    open.corners.resize(open.offsets.back());
    check_every_allocation("make_solid of an open box", [&] {
        try {
            (void)make_solid(open);
        } catch (bad_topology const& e) {
            if (e.code() != errc::not_closed) throw;
        }
    });
    check_every_allocation("bad parameter", [&] {
        try {
            fractal_noise{.octaves = 99}.validate();
        } catch (invalid_input const&) {
        }
    });
}

TEST_CASE("C3: cutting, linking and drawing shards gives up cleanly wherever memory runs out") {
    solid const s = make_solid(l_shape());
    std::vector<vec3> const sites{{0.4, 0.5, 0.5}, {1.5, 0.5, 0.4}, {0.5, 1.6, 0.6}, {0.5, 0.6, 0.5}, {0.5, 0.6, 0.5}};
    voronoi_shards_options const options{.duplicates = duplicate_sites::merge, .min_volume = 0.02};
    shard_complex const whole = voronoi_shards(s, sites, options);
    check_every_allocation("voronoi_shards", [&] { (void)voronoi_shards(s, sites, options); });
    solid const ring = make_solid(frame());
    check_every_allocation("voronoi_shards of a frame", [&] {
        (void)voronoi_shards(ring, std::vector<vec3>{{1.5, 1.5, 0.5}, {0.2, 0.2, 0.2}});
    });
    CHECK(same(voronoi_shards(s, sites, options), whole));
    check_every_allocation("make_link_graph", [&] { (void)make_link_graph(whole); });
    std::vector<std::uint8_t> const inside(whole.cell_count(), 1);
    check_every_allocation("extract_surface", [&] { (void)extract_surface(whole, inside); });
    std::vector<cell_index> const first{cell_index{0U}};
    shard_surface const one = extract_surface(whole, first);
    check_every_allocation("displaced_faces", [&] {
        (void)displaced_faces(one, field_displacement{constant_field{0.7}, 0.01}, {.edge_length = 0.5});
    });
    check_every_allocation("voxelize", [&] { (void)voxelize(s, 0.5); });
    check_every_allocation("random_sites", [&] { (void)random_sites{.count = 5}(s, 1); });
}

TEST_CASE("C3: readers and encoders give up cleanly wherever memory runs out") {
    mesh_attributes attributes;
    std::string const obj = "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nusemtl m\nf 1/1 3/1 2/1\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    mesh_file const m = read_obj(obj, "a.obj");
    std::string const ply = encode_ply(m.mesh, {}, {});
    std::string const stl = encode_stl(fan_triangulated(m.mesh));
    check_every_allocation("read_obj", [&] { (void)read_obj(obj, "a.obj"); });
    check_every_allocation("read_ply", [&] { (void)read_ply(ply, "a.ply"); });
    check_every_allocation("read_stl", [&] { (void)read_stl(stl, "a.stl"); });
    check_every_allocation("encode_obj", [&] { (void)encode_obj(m.mesh, m.attributes); });
    check_every_allocation("encode_ply", [&] { (void)encode_ply(m.mesh, m.attributes); });
    check_every_allocation("encode_stl", [&] { (void)encode_stl(m.mesh); });
    check_every_allocation("encode_vtp", [&] { (void)encode_vtp(m.mesh); });
    check_every_allocation("read_obj of nonsense", [&] {
        try {
            (void)read_obj("v 0 0 0\nf 1 2 99999\n", "a.obj");
        } catch (io_error const&) {
        }
    });
}

TEST_CASE("C3: a pool of threads is made whole or not at all, and its loops need no memory") {
    thread_pool const pool(3);
    auto const r = fail_every_allocation([&] {
        std::atomic<int> sum = 0;
        pool.for_blocks(100, 1, [&](std::size_t b, std::size_t) { sum += static_cast<int>(b); });
        if (sum != 4950) throw 0;
    });
    CHECK(r.tried == 0);
    CHECK(r.strangers == 0);
    check_every_allocation("thread_pool", [] { thread_pool const p(3); });
}

TEST_CASE("C3: connectivity that found no memory is as good as its copy") {
    box_network const n(3, 2, 2);
    connectivity const start(n);
    check_every_allocation("connectivity", [&] { (void)connectivity(n); });
    std::vector<link_index> cut;
    for (std::uint32_t l = 0; l < n.link_count(); l += 2) {
        if (n.link_cells(link_index{l})[1].valid()) cut.push_back(link_index{l});
    }
    check_every_allocation("break_links of a copy", [&] {
        connectivity c = start;
        (void)c.break_links(n, cut);
    });
}

TEST_CASE("C3: a run by the paper's exposure forgets nothing when memory runs out twice in a row") {
    // A big cell without skin of its own beside two small ones, which fall one after the other: what they lay
    // open is skin by history alone.
    box_network n(1, 1, 1);
    n.volumes = {1, 1, 10};
    auto const cell = [](std::uint32_t c) { return cell_index{c}; };
    n.links = {{{cell(0), cell_index{}}, {0, 0, 1}, {0, 0, 1}}, {{cell(1), cell_index{}}, {1, 0, 1}, {0, 0, 1}},
               {{cell(0), cell(1)}, {0.5, 0, 0}, {1, 0, 0}},    {{cell(0), cell(2)}, {0, 0, -1}, {0, 0, -1}},
               {{cell(1), cell(2)}, {1, 0, -1}, {0, 0, -1}}};
    auto const links = [](std::initializer_list<std::uint32_t> all) {
        std::vector<link_index> r;
        for (std::uint32_t l : all) r.push_back(link_index{l});
        return r;
    };
    n.of_cell = {links({0, 2, 3}), links({1, 2, 4}), links({3, 4})};
    n.neighbors = {links({2, 3}), links({2, 4}), links({0, 1, 3, 4}), links({0, 2, 4}), links({1, 2, 3})};
    auto const weathered = [&] {
        frost_run run(n, frost_wedging{}, {}, surface_walk{});
        for (std::uint32_t l : {3U, 2U, 4U}) run.break_link(link_index{l});
        return run;
    };
    auto const reference = weathered();
    REQUIRE(reference.blocks().size() == 2);
    REQUIRE(reference.state(link_index{3U}) == link_state::skin);
    auto const end = reference.checkpoint();
    long forgot = 0;
    for (long k = 0; k < 40; ++k) {
        for (long again = 0; again < 40; ++again) {
            auto run = weathered();
            for (long const limit : {k, again}) {
                allocations_left = limit;
                try {
                    run.mark(cell(2), cell_state::solid);
                } catch (std::bad_alloc const&) {
                }
                allocations_left = -1;
            }
            run.run({.paths = 0});
            forgot += run.checkpoint() == end ? 0 : 1;
        }
    }
    CHECK(forgot == 0);
}

TEST_CASE("C3: marks, replacements and resets that find no memory can be done again") {
    box_network const n(2, 2, 2);
    frost_run whole(n);
    whole.run({.paths = 5});
    whole.mark(cell_index{0U}, cell_state::core);
    whole.run({.paths = 100});
    whole.replace(frost_options{.water = 2});
    whole.run({.paths = 100});
    auto const end = whole.checkpoint();
    long broken = 0;
    for (long k = 0; k < 60; ++k) {
        frost_run run(n);
        auto const act = [&](auto const& f) {
            allocations_left = k;
            try {
                f();
            } catch (std::bad_alloc const&) {
                allocations_left = -1;
                f();
            }
            allocations_left = -1;
        };
        run.run({.paths = 5});
        act([&] { run.mark(cell_index{0U}, cell_state::core); });
        run.run({.paths = 100});
        act([&] { run.replace(frost_options{.water = 2}); });
        run.run({.paths = 100});
        broken += run.checkpoint() == end ? 0 : 1;
        act([&] { run.reset(); });
        run.mark(cell_index{0U}, cell_state::solid);
        run.replace(frost_options{});
        run.run({.paths = 50});
        frost_run fresh(n);
        fresh.run({.paths = 50});
        broken += run.checkpoint() == fresh.checkpoint() ? 0 : 1;
    }
    CHECK(broken == 0);
}
