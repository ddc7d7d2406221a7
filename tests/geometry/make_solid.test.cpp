#include <tafoni/geometry/make_solid.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/io/read_obj.hpp>
#include <tafoni/io/read_ply.hpp>

#include <catch2/catch.hpp>

#include <support/shapes.hpp>
#include <support/test_data.hpp>

#include <limits>
#include <string>

using namespace tafoni;
using tafoni_test::append;
using tafoni_test::box;
using tafoni_test::inside_out;
using tafoni_test::unit_box;

namespace {

struct outcome {
    errc code{};
    error_place place{};
    std::string text{};
    solid body{};
};

template <class M>
outcome attempt(M const& mesh, make_solid_options const& options = {}) {
    outcome r;
    try {
        r.body = make_solid(mesh, options);
    } catch (invalid_input const& e) {
        r = {e.code(), e.place(), e.what(), {}};
    } catch (bad_topology const& e) {
        r = {e.code(), e.place(), e.what(), {}};
    }
    return r;
}

indexed_mesh mapped(indexed_mesh m, double scale, vec3 const& shift) {
    for (auto& p : m.positions) p = vec3{p[0] * scale + shift[0], p[1] * scale + shift[1], p[2] * scale + shift[2]};
    return m;
}

indexed_mesh edited(indexed_mesh const& m, std::size_t face, std::vector<std::uint32_t> const& loop) {
    indexed_mesh r;
    r.positions = m.positions;
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        if (f != face) r.add_face(m.face(f));
        else if (!loop.empty()) r.add_face(loop);
    }
    return r;
}

std::vector<std::uint32_t> reversed(std::span<std::uint32_t const> loop) { return {loop.rbegin(), loop.rend()}; }

/// Indices as the user has them, of 64 bits.
struct wide_mesh {
    std::vector<vec3> places;
    std::vector<std::array<std::uint64_t, 3>> faces;
};

bool contains(std::string const& text, std::string const& part) { return text.find(part) != std::string::npos; }

}  // namespace

template <>
struct tafoni::mesh_access<wide_mesh> {
    static constexpr std::size_t corners_per_face = 3;
    static std::size_t vertex_count(wide_mesh const& m) { return m.places.size(); }
    static vec3 position(wide_mesh const& m, std::size_t v) { return m.places[v]; }
    static std::size_t face_count(wide_mesh const& m) { return m.faces.size(); }
    static std::size_t face_size(wide_mesh const&, std::size_t) { return 3; }
    static std::uint64_t corner(wide_mesh const& m, std::size_t f, std::size_t k) { return m.faces[f][k]; }
};
static_assert(triangle_mesh<wide_mesh>);

TEST_CASE("closed shapes have the volume and area of their closed form") {
    struct expected {
        indexed_mesh mesh;
        double volume;
        double area;
    };
    for (auto const& e : {expected{unit_box(), 1, 6}, expected{tafoni_test::l_shape(), 3, 14},
                          expected{tafoni_test::box_with_cavity(), 26, 60}, expected{tafoni_test::two_boxes(), 2, 12},
                          expected{tafoni_test::frame(), 8, 32},
                          expected{tafoni_test::tetrahedron(), 1.0 / 6, 1.5 + std::sqrt(0.75)}}) {
        solid const s = make_solid(e.mesh);
        CHECK(s.volume == Approx(e.volume).epsilon(1e-15));
        CHECK(s.area == Approx(e.area).epsilon(1e-15));
        CHECK(s.positions == e.mesh.positions);
        CHECK(s.polygon_count == e.mesh.face_count());
        CHECK(s.artificial == std::vector<std::uint8_t>(e.mesh.face_count(), 0));
    }
}

TEST_CASE("half-edges lie opposite each other, and triangles know their polygon") {
    for (auto const& m : {unit_box(), tafoni_test::l_shape(), tafoni_test::frame(), tafoni_test::torus(2, 0.5, 7, 5),
                          tafoni_test::thin_limbs(), tafoni_test::terrain_block(5, 4)}) {
        solid const s = make_solid(m);
        REQUIRE(s.opposite.size() == 3 * s.triangles.size());
        for (std::uint32_t h = 0; h < s.opposite.size(); ++h) {
            std::uint32_t const o = s.opposite[h];
            REQUIRE(o < s.opposite.size());
            CHECK(s.opposite[o] == h);
            CHECK(s.triangles[h / 3][h % 3] == s.triangles[o / 3][(o % 3 + 1) % 3]);
            CHECK(s.triangles[o / 3][o % 3] == s.triangles[h / 3][(h % 3 + 1) % 3]);
        }
        for (std::size_t t = 0; t < s.triangles.size(); ++t) {
            auto const face = m.face(s.polygon_of[t]);
            for (std::uint32_t const v : s.triangles[t]) CHECK(std::find(face.begin(), face.end(), v) != face.end());
        }
    }
}

TEST_CASE("M1: an empty mesh is refused as empty") {
    CHECK(attempt(indexed_mesh{}).code == errc::empty_input);
    indexed_mesh points;
    points.add_vertex(vec3{0, 0, 0});
    CHECK(attempt(points).code == errc::empty_input);
}

TEST_CASE("M2 and M6: an open mesh is named with its first edge, the number of edges and of loops") {
    indexed_mesh m = edited(edited(tafoni_test::two_boxes(), 11, {}), 3, {});
    outcome const r = attempt(m);
    CHECK(r.code == errc::not_closed);
    CHECK(r.place.kind == entity::edge);
    CHECK(r.place.value == 8);
    CHECK(contains(r.text, "8 open edges in 2 loops"));
    CHECK(contains(r.text, "from vertex 2 to 3 (face 0)"));
    CHECK(m.corners[r.place.index] == 2);

    indexed_mesh sheet;
    for (vec3 const& p : {vec3{0, 0, 0}, vec3{1, 0, 0}, vec3{0, 1, 0}}) sheet.add_vertex(p);
    sheet.add_face({0, 1, 2});
    CHECK(attempt(sheet).code == errc::not_closed);
    CHECK(attempt(sheet).place.value == 3);
}

TEST_CASE("M3 and M5: isolated vertices and vertices where sheets touch are accepted") {
    indexed_mesh m = unit_box();
    m.add_vertex(vec3{100, 0, 0});
    CHECK(attempt(m).body.volume == 1);
    CHECK(attempt(m).body.bounds.hi[0] == 1);
    indexed_mesh pair = unit_box();
    indexed_mesh const other = box(vec3{1, 1, 1}, vec3{2, 2, 2});
    for (std::size_t v = 1; v < 8; ++v) pair.add_vertex(other.positions[v]);
    for (std::size_t f = 0; f < 6; ++f) {
        std::vector<std::uint32_t> loop;
        for (std::uint32_t const v : other.face(f)) loop.push_back(v == 0 ? 7 : v + 7);
        pair.add_face(loop);
    }
    CHECK(attempt(pair).body.volume == Approx(2).epsilon(1e-15));
}

TEST_CASE("M4: an edge of more than two faces is refused, named and counted") {
    indexed_mesh pair = unit_box();
    indexed_mesh const other = box(vec3{1, 1, 0}, vec3{2, 2, 1});
    for (std::size_t v = 0; v < 8; ++v) pair.add_vertex(other.positions[v]);
    for (std::size_t f = 0; f < 6; ++f) {
        std::vector<std::uint32_t> loop;
        for (std::uint32_t const v : other.face(f)) loop.push_back(v == 0 ? 3 : v == 4 ? 7 : v + 8);
        pair.add_face(loop);
    }
    outcome const r = attempt(pair);
    CHECK(r.code == errc::nonmanifold_edge);
    CHECK(r.place.value == 1);
    CHECK(contains(r.text, "1 edges with more than two faces"));
}

TEST_CASE("M7: a mesh that is inside out is refused, also as one of several components") {
    for (auto const& m : {unit_box(), tafoni_test::torus(2, 0.5, 8, 6), tafoni_test::box_with_cavity()}) {
        CHECK(attempt(m).code == errc{});
        CHECK(attempt(inside_out(m)).code == errc::inverted_orientation);
    }
    indexed_mesh m = box(vec3{0, 0, 0}, vec3{3, 3, 3});
    append(m, inside_out(box(vec3{5, 1, 1}, vec3{6, 2, 2})));
    outcome const r = attempt(m);
    CHECK(r.code == errc::inverted_orientation);
    CHECK(r.place.kind == entity::face);
    CHECK(r.place.index == 6);
    CHECK(contains(r.text, "1 of 2 shells"));
}

TEST_CASE("M8: faces that disagree are named, and so is a surface that cannot be oriented") {
    indexed_mesh const cube = unit_box();
    outcome const r = attempt(edited(cube, 2, reversed(cube.face(2))));
    CHECK(r.code == errc::inconsistent_orientation);
    CHECK(r.place.value == 4);

    // A Klein bottle: a torus grid glued with one direction reversed.
    indexed_mesh klein;
    std::uint32_t const n = 5;
    for (std::uint32_t i = 0; i < n * n; ++i) klein.add_vertex(vec3{double(i % n), double(i / n), double(i * i % 7)});
    auto const at = [&](std::uint32_t i, std::uint32_t j) {
        if (i == n) return (n - j % n) % n;
        return i * n + j % n;
    };
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) klein.add_face({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
    CHECK(attempt(klein).code == errc::non_orientable);
}

TEST_CASE("M9: duplicate faces are refused, in the same and in the opposite direction") {
    indexed_mesh m = unit_box();
    m.add_face({2, 3, 1, 0});
    outcome const same = attempt(m);
    CHECK(same.code == errc::duplicate_face);
    CHECK(same.place.index == 6);
    CHECK(contains(same.text, "face 6 has the same vertices as face 0"));
    m = unit_box();
    m.add_face(reversed(m.face(3)));
    CHECK(attempt(m).code == errc::duplicate_face);
    indexed_mesh pillow;
    for (vec3 const& p : {vec3{0, 0, 0}, vec3{1, 0, 0}, vec3{0, 1, 0}}) pillow.add_vertex(p);
    pillow.add_face({0, 1, 2});
    pillow.add_face({0, 2, 1});
    CHECK(attempt(pillow).code == errc::duplicate_face);
}

TEST_CASE("M10: repeated corners are refused, faces of no area are accepted") {
    indexed_mesh const cube = unit_box();
    outcome const r = attempt(edited(cube, 3, {2, 6, 6, 3}));
    CHECK(r.code == errc::degenerate_face);
    CHECK(r.place.kind == entity::face);
    CHECK(r.place.index == 3);
    CHECK(attempt(edited(cube, 3, {2, 6})).code == errc::degenerate_face);

    // A cube whose top is split at a point on its rim: one triangle has no area.
    indexed_mesh m = edited(cube, 1, {4, 5, 8});
    m.add_vertex(vec3{0.5, 0, 1});
    m.add_face({5, 7, 6, 4, 8});
    outcome const flat = attempt(m);
    CHECK(flat.code == errc{});
    CHECK(flat.body.volume == Approx(1).epsilon(1e-15));
    CHECK(flat.body.area == Approx(6).epsilon(1e-15));
}

TEST_CASE("M11: the first non-finite vertex is named with its axis, before any other fault") {
    double const inf = std::numeric_limits<double>::infinity();
    for (double const bad : {std::numeric_limits<double>::quiet_NaN(), inf, -inf}) {
        for (int axis = 0; axis < 3; ++axis) {
            indexed_mesh m = unit_box();
            m.positions[5][axis] = bad;
            m.positions[6][axis] = bad;
            m.corners[0] = 77;
            outcome const r = attempt(m);
            CHECK(r.code == errc::non_finite_vertex);
            CHECK(r.place.kind == entity::vertex);
            CHECK(r.place.index == 5);
            CHECK(contains(r.text, std::string("vertex 5 has ") + "xyz"[axis]));
        }
    }
    indexed_mesh m = unit_box();
    m.positions[0][0] = std::numeric_limits<double>::denorm_min();
    CHECK(attempt(m).body.volume == 1);
}

TEST_CASE("M12: any scale from 1e-100 to 1e100 and an offset of 1e9 work, beyond it is out of range") {
    for (auto const& m : {unit_box(), tafoni_test::l_shape(), tafoni_test::torus(2, 0.5, 9, 7)}) {
        double const volume = make_solid(m).volume;
        double const area = make_solid(m).area;
        for (double const scale : {1e-100, 1e-30, 1e-3, 1e30, 1e100}) {
            solid const s = make_solid(mapped(m, scale, vec3{0, 0, 0}));
            CHECK(s.volume / (scale * scale * scale) == Approx(volume).epsilon(1e-13));
            CHECK(s.area / (scale * scale) == Approx(area).epsilon(1e-13));
        }
        solid const far = make_solid(mapped(m, 1, vec3{1e9, -1e9, 1e9}));
        CHECK(far.volume == Approx(volume).epsilon(1e-6));
        double const two = 0x1p77;
        CHECK(make_solid(mapped(m, two, vec3{0, 0, 0})).volume == volume * two * two * two);
        for (double const scale : {1e-104, 1e104, 1e150, 1e-200, 1e307}) {
            CHECK(attempt(mapped(m, scale, vec3{0, 0, 0})).code == errc::out_of_range);
        }
    }
    CHECK(make_solid(mapped(unit_box(), 1, vec3{1e9, -1e9, 1e9})).volume == 1);
}

TEST_CASE("M13: indices out of range are named with face, corner, value and limit") {
    indexed_mesh const t = tafoni_test::tetrahedron();
    for (std::uint64_t const bad : {std::uint64_t{4}, std::uint64_t{0xFFFFFFFF}, std::uint64_t{1} << 32,
                                    std::uint64_t{1} << 63, ~std::uint64_t{0}}) {
        wide_mesh m{t.positions, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
        m.faces[2][1] = bad;
        outcome const r = attempt(m);
        CHECK(r.code == errc::index_out_of_range);
        CHECK(r.place.kind == entity::face);
        CHECK(r.place.index == 2);
        CHECK(r.place.limit == 3);
        CHECK(contains(r.text, "corner 1 of face 2 names vertex " + std::to_string(bad) + ", there are 4"));
    }
}

TEST_CASE("M15: cavities, islands in cavities and shells in shells add up as a chain") {
    indexed_mesh m = box(vec3{0, 0, 0}, vec3{9, 9, 9});
    append(m, inside_out(box(vec3{1, 1, 1}, vec3{8, 8, 8})));
    append(m, box(vec3{2, 2, 2}, vec3{7, 7, 7}));
    append(m, inside_out(box(vec3{3, 3, 3}, vec3{6, 6, 6})));
    CHECK(attempt(m).body.volume == Approx(729 - 343 + 125 - 27).epsilon(1e-15));
    indexed_mesh twice = box(vec3{0, 0, 0}, vec3{3, 3, 3});
    append(twice, box(vec3{1, 1, 1}, vec3{2, 2, 2}));
    CHECK(attempt(twice).body.volume == Approx(28).epsilon(1e-15));
}

TEST_CASE("M15: a block with a thousand cavities is made in time, and one bubble outside it is found") {
    indexed_mesh m = box(vec3{0, 0, 0}, vec3{10, 10, 10});
    for (int i = 0; i < 1000; ++i) {
        vec3 const lo{i / 100 + 0.25, i / 10 % 10 + 0.25, i % 10 + 0.25};
        append(m, inside_out(box(lo, vec3{lo[0] + 0.5, lo[1] + 0.5, lo[2] + 0.5})));
    }
    CHECK(attempt(m).body.volume == Approx(1000 - 1000 * 0.125).epsilon(1e-13));
    append(m, inside_out(box(vec3{4, 4, 11}, vec3{5, 5, 12})));
    outcome const r = attempt(m);
    CHECK(r.code == errc::inverted_orientation);
    CHECK(r.place.index == 6 * 1001);
    CHECK(contains(r.text, "1 of 1002 shells"));
}

TEST_CASE("M16: a closed surface without volume is refused") {
    indexed_mesh flat = tafoni_test::tetrahedron();
    flat.positions[3] = vec3{0.3, 0.2, 0};
    CHECK(attempt(flat).code == errc::zero_volume);
    for (auto& p : flat.positions) p = vec3{1, 2, 3};
    CHECK(attempt(flat).code == errc::zero_volume);
    flat = mapped(tafoni_test::tetrahedron(), 1, vec3{0, 0, 0});
    flat.positions[3] = vec3{0.1, 0.7, 0.2 * (1 - 0.1 - 0.7)};
    for (auto& p : flat.positions) p = vec3{p[0], p[1], 0.3 * p[0] + 0.7 * p[1]};  // flat but for rounding
    CHECK(attempt(flat).code == errc::zero_volume);
    CHECK(attempt(box(vec3{0, 0, 0}, vec3{1, 1, 1e-12})).body.volume == Approx(1e-12).epsilon(1e-3));
}

TEST_CASE("M17: large, concave and bent polygons are accepted") {
    std::vector<std::array<double, 2>> star;
    for (std::size_t i = 0; i < 1000; ++i) {
        auto const p = tafoni_test::circle_point(i, 1000);
        double const r = i % 2 == 0 ? 1 : 0.5;
        star.push_back({r * p[0], r * p[1]});
    }
    indexed_mesh const m = tafoni_test::prism(star, 0, 2);
    double plan = 0;
    for (std::size_t i = 0; i < 1000; ++i) {
        auto const& a = star[i];
        auto const& b = star[(i + 1) % 1000];
        plan += (a[0] * b[1] - a[1] * b[0]) / 2;
    }
    outcome const r = attempt(m);
    CHECK(r.body.volume == Approx(2 * plan).epsilon(1e-13));
    CHECK(r.body.area == Approx(tafoni_test::surface_area(m)).epsilon(1e-12));
}

TEST_CASE("M18: a vertex with a hundred thousand edges costs no more than its share", "[slow]") {
    std::uint32_t const n = 100000;
    indexed_mesh m;
    for (std::uint32_t i = 0; i < n; ++i) {
        auto const p = tafoni_test::circle_point(i, n);
        m.add_vertex(vec3{p[0], p[1], 0});
    }
    m.add_vertex(vec3{0, 0, -1});
    m.add_vertex(vec3{0, 0, 1});
    for (std::uint32_t i = 0; i < n; ++i) {
        m.add_face({(i + 1) % n, i, n});
        m.add_face({i, (i + 1) % n, n + 1});
    }
    CHECK(attempt(m).body.volume == Approx(2 * 3.14159265358979 / 3).epsilon(1e-8));
}

TEST_CASE("M18: progress rises from 0 to 1 and can be stopped at every tick") {
    std::vector<double> seen;
    (void)make_solid(unit_box(), {}, {.on_progress = [&](progress_event const& e) {
        seen.push_back(e.fraction);
        return step_control::proceed;
    }});
    REQUIRE(seen.size() >= 2);
    CHECK(seen.front() == 0);
    CHECK(seen.back() == 1);
    CHECK(std::is_sorted(seen.begin(), seen.end()));
    for (std::size_t stop = 0; stop < seen.size(); ++stop) {
        std::size_t ticks = 0;
        auto const halt = [&](progress_event const&) {
            return ticks++ == stop ? step_control::stop : step_control::proceed;
        };
        CHECK_THROWS_AS(make_solid(unit_box(), {}, {.on_progress = halt}), cancelled);
    }
}

TEST_CASE("M20: marks of the wrong length are refused") {
    std::vector<std::uint8_t> marks(5, 1);
    outcome const r = attempt(unit_box(), {.artificial = marks});
    CHECK(r.code == errc::attribute_length);
    CHECK(r.place.value == 5);
    CHECK(r.place.limit == 6);
    marks = {0, 1, 0, 1, 0, 1};
    CHECK(attempt(unit_box(), {.artificial = marks}).body.artificial == marks);
}

TEST_CASE("any single mutation of a sound mesh gives the code of that fault") {
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
        stream draw(seed, stage::user, 2);
        indexed_mesh const sound = seed % 3 == 0   ? tafoni_test::icosphere(1)
                                   : seed % 3 == 1 ? tafoni_test::torus(2, 0.6, 3 + seed % 5, 3 + seed % 4)
                                                   : tafoni_test::terrain_block(3, 3);
        REQUIRE(attempt(sound).code == errc{});
        std::size_t const f = draw.index_below(sound.face_count());
        std::size_t const k = draw.index_below(sound.face(f).size());
        std::vector<std::uint32_t> loop(sound.face(f).begin(), sound.face(f).end());
        indexed_mesh m = sound;
        errc expected{};
        std::uint64_t const kind = draw.index_below(8);
        switch (kind) {
            case 0: m = edited(sound, f, reversed(loop)); expected = errc::inconsistent_orientation; break;
            case 1: m = edited(sound, f, {}); expected = errc::not_closed; break;
            case 2: m.add_face(loop); expected = errc::duplicate_face; break;
            case 3: m.add_face(reversed(loop)); expected = errc::duplicate_face; break;
            case 4: m.positions[loop[k]][static_cast<int>(seed % 3)] = std::numeric_limits<double>::quiet_NaN();
                    expected = errc::non_finite_vertex; break;
            case 5: loop[k] = static_cast<std::uint32_t>(m.vertex_count() + draw.index_below(5));
                    m = edited(sound, f, loop); expected = errc::index_out_of_range; break;
            case 6: loop[k] = loop[(k + 1) % loop.size()]; m = edited(sound, f, loop);
                    expected = errc::degenerate_face; break;
            default: m = inside_out(sound); expected = errc::inverted_orientation; break;
        }
        CAPTURE(seed, kind, f, k);
        indexed_mesh const before = m;
        outcome const r = attempt(m);
        CHECK(r.code == expected);
        // NaN differs from itself, so the copy is compared by bits where it matters: the topology.
        CHECK(m.corners == before.corners);
        CHECK(!r.text.empty());
    }
}

TEST_CASE("the number of faces and their order change no more than the numbering") {
    indexed_mesh const m = tafoni_test::thin_limbs();
    indexed_mesh shuffled;
    shuffled.positions = m.positions;
    for (std::size_t f = m.face_count(); f-- > 0;) shuffled.add_face(m.face(f));
    CHECK(make_solid(shuffled).volume == Approx(make_solid(m).volume).epsilon(1e-14));
}

TEST_CASE("real meshes are accepted, or refused with exactly their fault") {
    auto const obj = [](char const* name) { return read_obj(tafoni_test::find(name)).mesh; };
    auto const ply = [](char const* name) { return read_ply(tafoni_test::find(name)).mesh; };
    if (tafoni_test::find("meshes/hill3d_1.9k_quads.obj").empty()) {
        WARN("skipped: no data");
        return;
    }
    outcome const hill = attempt(obj("meshes/hill3d_1.9k_quads.obj"));
    CHECK(hill.body.volume == Approx(282.1691).epsilon(1e-6));
    CHECK(hill.body.polygon_count == 1894);

    outcome const player = attempt(obj("meshes/marble_player_9k.obj"));
    CHECK(player.code == errc::nonmanifold_edge);
    CHECK(player.place.value == 1);
    outcome const hand = attempt(obj("meshes/hand_lowres.obj"));
    CHECK(hand.code == errc::not_closed);
    CHECK(hand.place.value == 16);
    CHECK(contains(hand.text, "16 open edges in 1 loops"));
    outcome const mountain = attempt(ply("meshes/mountain_25k.ply"));
    CHECK(mountain.code == errc::not_closed);
    CHECK(mountain.place.value == 636);

    for (char const* name : {"meshes/plato_8.5k.obj", "meshes/column03_7k.obj", "meshes/hand_closed_8k.obj",
                             "meshes/goathead_2.7k.obj", "meshes/spot_0.8k.obj", "meshes/wingnut_3k.obj",
                             "meshes/mechpart_7.6k.obj", "meshes/itokawa_6k.obj"}) {
        CAPTURE(name);
        indexed_mesh const m = obj(name);
        outcome const r = attempt(m);
        CHECK(r.code == errc{});
        CHECK(r.body.volume == Approx(tafoni_test::signed_volume(m)).epsilon(1e-10));
    }
    for (char const* name : {"meshes/nefertiti_35k.ply", "meshes/scorpion_50k.ply", "meshes/spot_11k.ply"}) {
        CAPTURE(name);
        indexed_mesh const m = ply(name);
        outcome const r = attempt(m);
        CHECK(r.code == errc{});
        CHECK(r.body.volume == Approx(tafoni_test::signed_volume(m)).epsilon(1e-10));
    }
}
