#include <tafoni/geometry/inspect_mesh.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/io/read_obj.hpp>
#include <tafoni/io/read_ply.hpp>

#include <catch2/catch.hpp>

#include <support/shapes.hpp>
#include <support/test_data.hpp>

#include <limits>

using namespace tafoni;

TEST_CASE("sound meshes are counted by their closed forms") {
    inspect_report const cube = inspect_mesh(tafoni_test::unit_box());
    CHECK(cube.vertices == 8);
    CHECK(cube.faces == 6);
    CHECK(cube.polygons == 6);
    CHECK(cube.triangles == 12);
    CHECK(cube.edges == 12);
    CHECK(cube.euler == 2);
    CHECK(cube.shells == 1);
    CHECK(cube.closed());
    inspect_report const torus = inspect_mesh(tafoni_test::torus(2, 0.5, 9, 7));
    CHECK(torus.euler == 0);
    CHECK(torus.edges == 2 * 63);
    CHECK(inspect_mesh(tafoni_test::frame()).euler == 0);
    inspect_report const pair = inspect_mesh(tafoni_test::two_boxes());
    CHECK(pair.shells == 2);
    CHECK(pair.euler == 4);
}

TEST_CASE("each fault is counted under its name") {
    indexed_mesh m = tafoni_test::unit_box();
    m.add_vertex(vec3{9, 9, 9});
    CHECK(inspect_mesh(m).unused_vertices == 1);
    CHECK(inspect_mesh(m).closed());
    m.add_face({0, 2, 3, 1});
    CHECK(inspect_mesh(m).duplicate_faces == 1);
    CHECK(inspect_mesh(m).crowded_edges == 4);
    m = tafoni_test::unit_box();
    m.corners.resize(20);
    m.offsets.pop_back();
    CHECK(inspect_mesh(m).open_edges == 4);
    CHECK(inspect_mesh(m).boundary_loops == 1);
    m = tafoni_test::unit_box();
    std::reverse(m.corners.begin(), m.corners.begin() + 4);
    CHECK(inspect_mesh(m).inconsistent_edges == 4);
    CHECK(inspect_mesh(m).orientable);
    m.corners[0] = m.corners[1];
    CHECK(inspect_mesh(m).degenerate_faces == 1);
    m.corners[0] = 99;
    CHECK(inspect_mesh(m).bad_corners == 1);
    m.positions[0][2] = std::numeric_limits<double>::infinity();
    CHECK(inspect_mesh(m).non_finite_vertices == 1);

    indexed_mesh bow = tafoni_test::unit_box();
    indexed_mesh const other = tafoni_test::box(vec3{1, 1, 1}, vec3{2, 2, 2});
    for (std::size_t v = 1; v < 8; ++v) bow.add_vertex(other.positions[v]);
    for (std::size_t f = 0; f < 6; ++f) {
        std::vector<std::uint32_t> loop;
        for (std::uint32_t const v : other.face(f)) loop.push_back(v + 7);
        bow.add_face(loop);
    }
    CHECK(inspect_mesh(bow).nonmanifold_vertices == 1);
    CHECK(inspect_mesh(bow).shells == 2);
    CHECK(inspect_mesh(indexed_mesh{}).faces == 0);
    CHECK_FALSE(inspect_mesh(indexed_mesh{}).closed());
}

TEST_CASE("what is closed and has volume is what make_solid accepts") {
    for (std::uint64_t seed = 0; seed < 500; ++seed) {
        stream draw(seed, stage::user, 12);
        indexed_mesh m = seed % 2 == 0 ? tafoni_test::unit_box() : tafoni_test::icosphere(0);
        std::uint64_t const edits = draw.index_below(3);
        for (std::uint64_t i = 0; i < edits; ++i) {
            std::uint64_t const at = draw.index_below(m.corners.size());
            m.corners[at] = static_cast<std::uint32_t>(draw.index_below(m.vertex_count()));
        }
        bool accepted = true;
        try {
            (void)make_solid(m);
        } catch (invalid_input const&) {
            accepted = false;
        } catch (bad_topology const& e) {
            accepted = e.code() == errc::zero_volume || e.code() == errc::inverted_orientation;
        }
        CAPTURE(seed);
        CHECK(inspect_mesh(m).closed() == accepted);
    }
}

TEST_CASE("the real meshes have the counts of their table") {
    if (tafoni_test::find("meshes/marble_player_9k.obj").empty()) {
        WARN("skipped: no data");
        return;
    }
    inspect_report const player = inspect_mesh(read_obj(tafoni_test::find("meshes/marble_player_9k.obj")).mesh);
    CHECK(player.crowded_edges == 1);
    CHECK(player.open_edges == 0);
    CHECK(player.euler == -5);
    inspect_report const part = inspect_mesh(read_obj(tafoni_test::find("meshes/mechpart_7.6k.obj")).mesh);
    CHECK(part.closed());
    CHECK(part.euler == -4);
    inspect_report const mountain = inspect_mesh(read_ply(tafoni_test::find("meshes/mountain_25k.ply")).mesh);
    CHECK(mountain.open_edges == 636);
    CHECK(mountain.boundary_loops == 1);
    CHECK(mountain.euler == 1);
}
