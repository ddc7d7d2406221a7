#include <catch2/catch.hpp>

#include <tafoni/io/stl.hpp>

#include "file_testing.hpp"

#include <cstring>

using namespace tafoni;
using tafoni_test::contains;
using tafoni_test::failure;
using tafoni_test::failure_of;

namespace {

mesh_file stl(std::string_view bytes) { return read_stl(bytes, "a.stl"); }
failure refused(std::string_view bytes) {
    return failure_of([&] { return stl(bytes); });
}

std::string const text =
    "solid two parts\n facet normal nan 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 -0.0\n   vertex 0 1e0 0\n  endloop\n endfacet\n"
    "facet normal 0 0 1 outer loop vertex 1 0 0 vertex 1 1 0 vertex 0 1 0 endloop endfacet\nendsolid two\n"
    "SOLID\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 5 0 0\nVERTEX 6 0 0\nVERTEX 5 1 0\nENDLOOP\nENDFACET\nENDSOLID";

/// A cube of eight vertices and six squares.
indexed_mesh cube() {
    indexed_mesh m;
    for (int k = 0; k < 8; ++k) m.add_vertex({double(k & 1), double((k >> 1) & 1), double(k >> 2)});
    m.add_face({0, 2, 3, 1});
    m.add_face({4, 5, 7, 6});
    m.add_face({0, 1, 5, 4});
    m.add_face({2, 6, 7, 3});
    m.add_face({0, 4, 6, 2});
    m.add_face({1, 3, 7, 5});
    return m;
}

double volume(indexed_mesh const& m) {
    double six = 0;
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        auto const c = m.face(f);
        six += dot(m.positions[c[0]], cross(m.positions[c[1]], m.positions[c[2]]));
    }
    return six / 6;
}

}  // namespace

TEST_CASE("an ASCII STL is read, equal corners are welded and its solids are groups") {
    mesh_file const file = stl(text);
    CHECK(file.mesh.vertex_count() == 7);
    CHECK(file.mesh.corners == std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2, 4, 5, 6});
    REQUIRE(file.attributes.groups.size() == 2);
    CHECK(file.attributes.groups[0].name == "two parts");
    CHECK(file.attributes.groups[1].first_face == 2);
}

TEST_CASE("the eight signs of the origin are one vertex") {
    std::string bytes = "solid\n";
    for (int signs = 0; signs < 8; ++signs) {
        bytes += "facet normal 0 0 1 outer loop vertex";
        for (int axis = 0; axis < 3; ++axis) bytes += (signs >> axis & 1) != 0 ? " -0" : " 0";
        bytes += " vertex 1 0 0 vertex 0 1 0 endloop endfacet\n";
    }
    CHECK(stl(bytes + "endsolid\n").mesh.vertex_count() == 3);
}

TEST_CASE("a cube written as binary STL comes back with eight vertices and volume one") {
    std::string const bytes = encode_stl(cube());
    CHECK(bytes.size() == 84 + 12 * 50);
    mesh_file const file = stl(bytes);
    CHECK(file.mesh.vertex_count() == 8);
    CHECK(file.mesh.face_count() == 12);
    CHECK(volume(file.mesh) == 1.0);
    CHECK(encode_stl(file.mesh) == bytes);
}

TEST_CASE("a binary STL is told by its size, also when it starts with solid") {
    std::string bytes = encode_stl(cube());
    bytes.replace(0, 10, "solid cube");
    CHECK(stl(bytes).mesh.face_count() == 12);
    failure const cut = refused(bytes.substr(0, bytes.size() - 7));
    CHECK(cut.code == errc::truncated);
    CHECK(contains(cut.what, "12 triangles"));
    CHECK(refused(bytes + "x").code == errc::bad_count);
    CHECK(refused(bytes.substr(0, 83)).happened);
    std::string lie(84, '\0');
    lie.replace(80, 4, "\xff\xff\xff\xff");
    CHECK(refused(lie).code == errc::truncated);
    CHECK(stl(std::string(84, '\0')).mesh.face_count() == 0);
    CHECK(refused("hello").code == errc::truncated);
}

TEST_CASE("a NaN corner is refused with its place, a NaN normal is not") {
    std::string bytes = encode_stl(cube());
    std::memcpy(bytes.data() + 84, "\xff\xff\xff\xff", 4);
    CHECK_FALSE(refused(bytes).happened);
    std::memcpy(bytes.data() + 84 + 50 + 12 + 12, "\xff\xff\xff\xff", 4);
    failure const f = refused(bytes);
    CHECK(f.code == errc::non_finite_vertex);
    CHECK(contains(f.what, "corner 1 of triangle 1"));
    failure const ascii = refused("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 inf\n");
    CHECK(ascii.code == errc::non_finite_vertex);
    CHECK(ascii.place.line == 4);
    CHECK(ascii.place.column == 12);
}

TEST_CASE("ASCII STL with a wrong word, number or end is refused with its line") {
    auto const line = [](std::string_view bytes) { return refused(bytes).place.line; };
    CHECK(line("solid\nfacett normal 0 0 1\n") == 2);
    CHECK(line("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 1,5\n") == 5);
    CHECK(refused(text.substr(0, 100)).happened);
    CHECK(refused("solid\n").code == errc::truncated);
    CHECK(stl("solid x\nendsolid x").mesh.face_count() == 0);
}

TEST_CASE("attribute bytes and a far origin survive STL there and back") {
    indexed_mesh mesh = cube();
    for (vec3& p : mesh.positions) p = vec3{p[0] + 376313.655, p[1] + 3788627.5, p[2]};
    write_stl_options const options{.origin = {376313.7, 3788627.8, 0}};
    mesh_attributes const attributes{.face_channels = {{"attribute", {1, 2, 3, 4, 5, 65535}, channel_type::uint16}}};
    std::string const once = encode_stl(mesh, attributes, options);
    mesh_file const back = stl(once);
    REQUIRE(back.mesh.vertex_count() == 8);
    for (vec3 const& p : back.mesh.positions) {
        double nearest = 1;
        for (vec3 const& q : mesh.positions) nearest = std::min(nearest, length(vec3(p - q)));
        CHECK(nearest < 1e-7);
    }
    REQUIRE(back.attributes.face_channels.size() == 1);
    CHECK(back.attributes.face_channels[0].values[11] == 65535);
    CHECK(encode_stl(back.mesh, back.attributes, {.origin = back.origin}) == once);
}

TEST_CASE("corners that only float makes equal are written alike, whatever the signs of their zeros") {
    indexed_mesh mesh;
    for (vec3 const& v : {vec3{0, 1, 0}, vec3{1 + 1e-13, 0, 0}, vec3{1, 0, -0.0}}) mesh.add_vertex(v);
    mesh.add_face({0, 1, 2});
    std::string const bytes = encode_stl(mesh);
    mesh_file const again = stl(bytes);
    CHECK(again.mesh.vertex_count() == 2);
    CHECK(encode_stl(again.mesh) == bytes);
}

TEST_CASE("concave polygons are cut along their inside in an STL") {
    indexed_mesh mesh;
    for (vec3 const& p : {vec3{0, 0, 0}, vec3{2, 0, 0}, vec3{2, 2, 0}, vec3{1, 0.5, 0}, vec3{0, 2, 0}}) mesh.add_vertex(p);
    mesh.add_face({0, 1, 2, 3, 4});
    mesh_file const file = stl(encode_stl(mesh));
    REQUIRE(file.mesh.face_count() == 3);
    double area = 0;
    for (std::size_t f = 0; f < 3; ++f) {
        auto const c = file.mesh.face(f);
        vec3 const u = file.mesh.positions[c[1]] - file.mesh.positions[c[0]];
        vec3 const w = file.mesh.positions[c[2]] - file.mesh.positions[c[0]];
        double const z = cross(u, w)[2] / 2;
        CHECK(z > 0);
        area += z;
    }
    CHECK(area == 2.5);
}

TEST_CASE("the STL writer refuses NaN and what float cannot hold") {
    indexed_mesh mesh = cube();
    mesh.positions[7][2] = 1e39;
    CHECK(failure_of([&] { return encode_stl(mesh); }).code == errc::format_limit);
    mesh.positions[7][2] = std::numeric_limits<double>::quiet_NaN();
    CHECK(failure_of([&] { return encode_stl(mesh); }).code == errc::non_finite_vertex);
}

TEST_CASE("an STL of random floats is written again to the same bytes") {
    stream random(51, 4, 0);
    for (int round = 0; round < 200; ++round) {
        std::size_t const triangles = random.index_below(12);
        std::string bytes(80, ' ');
        detail::append_little(bytes, static_cast<std::uint32_t>(triangles));
        for (std::size_t t = 0; t < triangles; ++t) {
            for (int k = 0; k < 12; ++k) {
                float const value = static_cast<float>(random.index_below(3)) - 1.0F;
                detail::append_little(bytes, random.chance(0.2) ? -value : value);
            }
            detail::append_little(bytes, static_cast<std::uint16_t>(random.index_below(2)));
        }
        mesh_file const file = stl(bytes);
        std::string const once = encode_stl(file.mesh, file.attributes);
        mesh_file const again = stl(once);
        REQUIRE(encode_stl(again.mesh, again.attributes) == once);
        REQUIRE(again.mesh.vertex_count() == file.mesh.vertex_count());
    }
}
