#include <tafoni/geometry/inspect_mesh.hpp>
#include <tafoni/geometry/repair_mesh.hpp>
#include <tafoni/geometry/repair_solid.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/io/read_obj.hpp>

#include <catch2/catch.hpp>

#include <support/shapes.hpp>
#include <support/test_data.hpp>

using namespace tafoni;
using tafoni_test::append;
using tafoni_test::box;
using tafoni_test::inside_out;
using tafoni_test::unit_box;

namespace {

repair_options const everything{.merge_vertices = true,
                                .drop_degenerate = true,
                                .drop_duplicates = true,
                                .orient = true,
                                .split_nonmanifold = true,
                                .fill_holes = 100};

/// Every face with vertices of its own, as an STL file has them.
indexed_mesh soup(indexed_mesh const& m) {
    indexed_mesh r;
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        std::vector<std::uint32_t> loop;
        for (std::uint32_t const v : m.face(f)) loop.push_back(r.add_vertex(m.positions[v]).value);
        r.add_face(loop);
    }
    return r;
}

indexed_mesh with_turned_face(indexed_mesh const& m, std::size_t turned) {
    indexed_mesh r;
    r.positions = m.positions;
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        auto const loop = m.face(f);
        if (f == turned) r.add_face(std::vector<std::uint32_t>(loop.rbegin(), loop.rend()));
        else r.add_face(loop);
    }
    return r;
}

indexed_mesh without_face(indexed_mesh const& m, std::size_t gone) {
    indexed_mesh r;
    r.positions = m.positions;
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        if (f != gone) r.add_face(m.face(f));
    }
    return r;
}

template <class M>
errc code_of(M const& mesh) {
    try {
        (void)make_solid(mesh);
    } catch (invalid_input const& e) {
        return e.code();
    } catch (bad_topology const& e) {
        return e.code();
    }
    return errc{};
}

}  // namespace

TEST_CASE("repair does nothing unless asked, and nothing to a sound mesh, bit for bit") {
    for (auto const& m : {unit_box(), tafoni_test::l_shape(), tafoni_test::box_with_cavity(), tafoni_test::two_boxes(),
                          tafoni_test::torus(2, 0.5, 12, 9), tafoni_test::thin_limbs()}) {
        CHECK(repair_mesh(soup(m), {}).mesh == soup(m));
        repaired_mesh const r = repair_mesh(m, everything);
        CHECK(r.mesh == m);
        CHECK(r.report.nothing_done());
        CHECK(r.face_of.size() == m.face_count());
    }
}

TEST_CASE("a soup of triangles is welded by exact equality, zero and minus zero being equal") {
    indexed_mesh m = soup(tafoni_test::icosphere(2));
    for (auto& p : m.positions) {
        for (int a = 0; a < 3; ++a) {
            if (p[a] == 0 && (&p - m.positions.data()) % 2 == 0) p[a] = -0.0;
        }
    }
    CHECK(code_of(m) == errc::not_closed);
    auto const r = repair_solid(m, {.merge_vertices = true});
    CHECK(r.report.merged_vertices.size() == 3 * 320 - 162);
    CHECK(r.body.volume == Approx(make_solid(tafoni_test::icosphere(2)).volume).epsilon(1e-14));
    CHECK(r.body.polygon_count == 320);
}

TEST_CASE("turned faces are turned back and named") {
    indexed_mesh const sphere = tafoni_test::icosphere(2);
    indexed_mesh m = with_turned_face(with_turned_face(sphere, 7), 200);
    CHECK(code_of(m) == errc::inconsistent_orientation);
    auto const r = repair_mesh(m, {.orient = true});
    CHECK(r.report.turned_faces == std::vector<std::uint32_t>{7, 200});
    CHECK(r.report.turned_shells == 0);
    CHECK(make_solid(r.mesh).volume == Approx(make_solid(sphere).volume));
}

TEST_CASE("a mesh that is inside out is turned, with its cavities") {
    indexed_mesh const m = inside_out(tafoni_test::box_with_cavity());
    CHECK(code_of(m) == errc::inverted_orientation);
    auto const r = repair_solid(m, {.orient = true});
    CHECK(r.body.volume == Approx(26).epsilon(1e-14));
    CHECK(r.report.turned_shells == 2);
    CHECK(r.report.turned_faces.size() == 12);

    indexed_mesh one = unit_box();
    append(one, inside_out(box(vec3{2, 0, 0}, vec3{3, 1, 1})));
    CHECK(code_of(one) == errc::inverted_orientation);
    auto const s = repair_solid(one, {.orient = true});
    CHECK(s.report.turned_shells == 1);
    CHECK(s.body.volume == Approx(2).epsilon(1e-14));
}

TEST_CASE("duplicate faces are dropped: one stays on the surface, none of a fin without thickness") {
    indexed_mesh const sphere = tafoni_test::icosphere(1);
    indexed_mesh m = sphere;
    m.add_face({sphere.face(5)[1], sphere.face(5)[2], sphere.face(5)[0]});
    CHECK(code_of(m) == errc::duplicate_face);
    auto r = repair_mesh(m, {.drop_duplicates = true});
    CHECK(r.report.duplicate_faces == std::vector<std::uint32_t>{80});
    CHECK(r.mesh == sphere);

    m = sphere;
    m.add_vertex(vec3{5, 0, 0});
    m.add_face({sphere.face(0)[0], sphere.face(0)[1], 42});
    m.add_face({sphere.face(0)[1], sphere.face(0)[0], 42});
    CHECK(code_of(m) == errc::duplicate_face);
    r = repair_mesh(m, {.drop_duplicates = true});
    CHECK(r.report.duplicate_faces == std::vector<std::uint32_t>{80, 81});
    CHECK(make_solid(r.mesh).volume == make_solid(sphere).volume);
}

TEST_CASE("degenerate faces are shortened or dropped") {
    indexed_mesh m = unit_box();
    m.add_face({0, 0, 1});
    m.add_face({0, 1});
    indexed_mesh n = m;
    CHECK(code_of(n) == errc::degenerate_face);
    auto const r = repair_mesh(n, {.drop_degenerate = true});
    CHECK(r.report.degenerate_faces == std::vector<std::uint32_t>{6, 7});
    CHECK(r.mesh == unit_box());
    indexed_mesh thick;
    thick.positions = unit_box().positions;
    thick.add_face({0, 2, 2, 3, 1, 0});
    for (std::size_t f = 1; f < 6; ++f) thick.add_face(unit_box().face(f));
    CHECK(repair_mesh(thick, {.drop_degenerate = true}).mesh == unit_box());
}

TEST_CASE("boxes that share an edge or a corner come apart") {
    indexed_mesh m = soup(unit_box());
    append(m, soup(box(vec3{1, 1, 0}, vec3{2, 2, 1})));
    m = repair_mesh(m, {.merge_vertices = true}).mesh;
    CHECK(code_of(m) == errc::nonmanifold_edge);
    auto const r = repair_mesh(m, {.split_nonmanifold = true});
    CHECK(r.report.split_edges == 1);
    CHECK(r.report.split_vertices.size() == 2);
    CHECK(make_solid(r.mesh).volume == Approx(2).epsilon(1e-14));
    CHECK(repair_mesh(r.mesh, {.split_nonmanifold = true}).report.nothing_done());

    m = soup(unit_box());
    append(m, soup(box(vec3{1, 1, 1}, vec3{2, 2, 2})));
    m = repair_mesh(m, {.merge_vertices = true}).mesh;
    CHECK(code_of(m) == errc{});  // accepted as it is
    auto const s = repair_mesh(m, {.split_nonmanifold = true});
    CHECK(s.report.split_edges == 0);
    CHECK(s.report.split_vertices.size() == 1);
}

TEST_CASE("two bars that share a whole edge become two shells") {
    indexed_mesh m = soup(box(vec3{0, 0, 0}, vec3{1, 1, 3}));
    append(m, soup(box(vec3{-1, -1, 0}, vec3{0, 0, 3})));
    m = repair_mesh(m, {.merge_vertices = true}).mesh;
    auto const r = repair_solid(m, {.split_nonmanifold = true});
    CHECK(r.body.volume == Approx(6).epsilon(1e-14));
    std::vector<std::uint8_t> reached(r.body.triangles.size(), 0);
    std::vector<std::uint32_t> stack{0};
    reached[0] = 1;
    std::size_t count = 0;
    while (!stack.empty()) {
        std::uint32_t const t = stack.back();
        stack.pop_back();
        ++count;
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t const o = r.body.opposite[3 * t + k] / 3;
            if (reached[o] == 0) {
                reached[o] = 1;
                stack.push_back(o);
            }
        }
    }
    CHECK(count == 12);
}

TEST_CASE("an edge of many faces comes apart, also where faces lie on each other or have no area") {
    stream draw(5, stage::user, 2);
    for (int round = 0; round < 50; ++round) {
        indexed_mesh m;
        m.add_vertex({0, 0, 0});
        m.add_vertex({0, 0, 1});
        for (std::uint32_t f = 0; f < 60; ++f) {
            double const x = draw.uniform(-1, 1);
            double const y = draw.uniform(-1, 1);
            switch (f % 4) {
                case 0: m.add_vertex({0, 0, 2.0 + f}); break;                        // no area
                case 1: m.add_vertex({-1, -1 - f * 0x1p-52, 0.5}); break;            // nearly one plane
                default: m.add_vertex({x, y, 0.5}); break;
            }
            if (draw.chance(0.5)) m.add_face({0, 1, f + 2});
            else m.add_face({1, 0, f + 2});
        }
        repaired_mesh const r = repair_mesh(m, {.split_nonmanifold = true});
        CHECK(r.report.split_edges == 1);
        inspect_report const now = inspect_mesh(r.mesh);
        CHECK(now.crowded_edges == 0);
        CHECK(now.inconsistent_edges == 0);
        CHECK(now.nonmanifold_vertices == 0);
        CHECK(r.mesh.face_count() == 60);
    }
}

TEST_CASE("what cannot be oriented stays as it is") {
    indexed_mesh m;  // a strip of five triangles with a half turn
    for (int v = 0; v < 5; ++v) m.add_vertex({double(v % 3), double(v % 2), double(v)});
    for (std::uint32_t f = 0; f < 5; ++f) m.add_face({f, (f + 1) % 5, (f + 2) % 5});
    REQUIRE_FALSE(inspect_mesh(m).orientable);
    repaired_mesh const r = repair_mesh(m, {.orient = true});
    CHECK(r.mesh == m);
    CHECK(r.report.nothing_done());
}

TEST_CASE("holes up to the given size are filled and counted") {
    indexed_mesh const m = without_face(without_face(unit_box(), 4), 0);
    CHECK(code_of(m) == errc::not_closed);
    CHECK(code_of(repair_mesh(m, {.fill_holes = 3}).mesh) == errc::not_closed);
    auto const r = repair_mesh(without_face(unit_box(), 2), {.fill_holes = 4});
    CHECK(r.report.filled_holes == 1);
    CHECK(r.face_of.back() == repaired_mesh::none);
    CHECK(make_solid(r.mesh).volume == Approx(1).epsilon(1e-14));
    auto const s = repair_solid(without_face(unit_box(), 2), {.fill_holes = 4});
    CHECK(s.body.polygon_count == 6);
    CHECK(s.body.polygon_of.back() == 5);
}

TEST_CASE("random damage of a known kind is mended, and mending twice changes nothing more") {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        stream draw(seed, stage::user, 1);
        indexed_mesh m = seed % 2 == 0 ? tafoni_test::icosphere(1) : tafoni_test::torus(2, 0.7, 8, 6);
        double const volume = make_solid(m).volume;
        for (std::uint64_t i = 0; i < 3; ++i) m = with_turned_face(m, draw.index_below(m.face_count()));
        if (draw.chance(0.5)) {
            auto const f = draw.index_below(m.face_count());
            std::vector<std::uint32_t> const loop(m.face(f).begin(), m.face(f).end());
            m.add_face(loop);
        }
        if (draw.chance(0.5)) m = soup(m);
        if (draw.chance(0.5)) m = inside_out(m);
        CAPTURE(seed);
        repaired_mesh const r = repair_mesh(m, everything);
        CHECK(make_solid(r.mesh).volume == Approx(volume).epsilon(1e-12));
        CHECK(repair_mesh(r.mesh, everything).mesh == r.mesh);
    }
}

TEST_CASE("repair refuses what cannot be mended, before anything else") {
    indexed_mesh m = unit_box();
    m.positions[3][1] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(repair_mesh(m, everything), invalid_input);
    m = unit_box();
    m.corners[4] = 8;
    CHECK_THROWS_AS(repair_mesh(m, everything), invalid_input);
    CHECK(repair_mesh(indexed_mesh{}, everything).mesh == indexed_mesh{});
}

TEST_CASE("real meshes with one fault each become solids by the one repair that it takes") {
    if (tafoni_test::find("meshes/marble_player_9k.obj").empty()) {
        WARN("skipped: no data");
        return;
    }
    auto const player = read_obj(tafoni_test::find("meshes/marble_player_9k.obj")).mesh;
    auto const split = repair_solid(player, {.split_nonmanifold = true});
    CHECK(split.report.split_edges == 1);
    CHECK(split.report.split_vertices.size() == 2);
    CHECK(split.body.volume == Approx(tafoni_test::signed_volume(player)).epsilon(1e-10));
    auto const hand = repair_solid(read_obj(tafoni_test::find("meshes/hand_lowres.obj")).mesh, {.fill_holes = 16});
    CHECK(hand.report.filled_holes == 1);
    CHECK(hand.body.polygon_count == 1603);
}
