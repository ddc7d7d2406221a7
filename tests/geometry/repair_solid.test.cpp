#include <tafoni/geometry/repair_solid.hpp>

#include <support/shapes.hpp>

#include <catch2/catch.hpp>

#include <algorithm>

using namespace tafoni;

TEST_CASE("a sound mesh becomes the solid that make_solid makes, and nothing is reported") {
    indexed_mesh const mesh = tafoni_test::l_shape();
    repaired_solid const r = repair_solid(mesh, {.merge_vertices = true, .drop_degenerate = true, .drop_duplicates = true,
                                                 .orient = true, .split_nonmanifold = true, .fill_holes = 100});
    solid const s = make_solid(mesh);
    CHECK(r.report.nothing_done());
    CHECK(r.body.positions == s.positions);
    CHECK(r.body.triangles == s.triangles);
    CHECK(r.body.polygon_of == s.polygon_of);
    CHECK(r.body.volume == s.volume);
}

TEST_CASE("a filled hole gets a name behind the last face, and marks stay with the faces of the input") {
    indexed_mesh const whole = tafoni_test::unit_box();
    indexed_mesh open;
    open.positions = whole.positions;
    for (std::size_t f = 0; f < whole.face_count(); ++f) {
        if (f != 2) open.add_face(whole.face(f));
    }
    std::vector<std::uint8_t> const marks{0, 1, 0, 0, 1};
    repaired_solid const r = repair_solid(open, {.fill_holes = 4}, {.artificial = marks});
    CHECK(r.report.filled_holes == 1);
    CHECK(r.body.volume == Approx(1));
    CHECK(r.body.polygon_count == 6);
    CHECK(r.body.artificial == std::vector<std::uint8_t>{0, 1, 0, 0, 1, 0});
    CHECK(std::count(r.body.polygon_of.begin(), r.body.polygon_of.end(), 5U) == 2);
}

TEST_CASE("faces that are dropped leave the names of the others alone") {
    indexed_mesh mesh = tafoni_test::unit_box();
    indexed_mesh with_extra;
    with_extra.positions = mesh.positions;
    with_extra.add_face({0, 0, 1});
    for (std::size_t f = 0; f < mesh.face_count(); ++f) with_extra.add_face(mesh.face(f));
    repaired_solid const r = repair_solid(with_extra, {.drop_degenerate = true});
    CHECK(r.report.degenerate_faces == std::vector<std::uint32_t>{0});
    CHECK(r.body.polygon_count == 7);
    CHECK(std::count(r.body.polygon_of.begin(), r.body.polygon_of.end(), 0U) == 0);
    CHECK(*std::max_element(r.body.polygon_of.begin(), r.body.polygon_of.end()) == 6);
}

TEST_CASE("what is not asked for is not mended, and marks of the wrong length are refused") {
    indexed_mesh open = tafoni_test::unit_box();
    open.offsets.pop_back();
    open.corners.resize(open.offsets.back());
    CHECK_THROWS_AS(repair_solid(open, {.orient = true}), bad_topology);
    std::vector<std::uint8_t> const marks{1};
    try {
        (void)repair_solid(tafoni_test::unit_box(), {}, {.artificial = marks});
        FAIL("accepted");
    } catch (invalid_input const& e) {
        CHECK(e.code() == errc::attribute_length);
        CHECK(e.place().kind == entity::attribute);
    }
}
