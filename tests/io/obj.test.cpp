#include <catch2/catch.hpp>

#include <tafoni/io/obj.hpp>

#include "file_testing.hpp"

#include <cstring>

using namespace tafoni;
using tafoni_test::contains;
using tafoni_test::failure;
using tafoni_test::failure_of;

namespace {

mesh_file obj(std::string_view text) { return read_obj(text, "a.obj"); }
failure refused(std::string_view text) {
    return failure_of([&] { return obj(text); });
}

constexpr std::string_view square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("an OBJ of one square has its positions and one face of four corners") {
    mesh_file const file = obj(std::string(square) + "f 1 2 3 4\n");
    REQUIRE(file.mesh.vertex_count() == 4);
    REQUIRE(file.mesh.face_count() == 1);
    CHECK(file.mesh.corners == std::vector<std::uint32_t>{0, 1, 2, 3});
    CHECK(file.mesh.positions[2] == vec3{1, 1, 0});
    CHECK(file.attributes.corner_texture.empty());
    CHECK(file.attributes.corner_normals.empty());
}

TEST_CASE("line endings, blanks, continuations and a byte order mark change nothing in an OBJ") {
    mesh_file const plain = obj(std::string(square) + "f 1 2 3\nf 1 3 4\n");
    std::string const with_lf = "\t v 0\t0 0  \n\n\n# c \\\nv 1 0 0 # c\n  v 1 1 0\nv 0 \\\n1 \\\n0\nf 1 2\\\n 3\nf 1 3 4";
    auto const replaced = [&](std::string_view ending) {
        std::string text;
        for (char const c : with_lf) c == '\n' ? text += ending : text += c;
        return text;
    };
    for (std::string_view const ending : {"\n", "\r\n", "\r"}) {
        CHECK(obj(replaced(ending)).mesh == plain.mesh);
        CHECK(obj("\xef\xbb\xbf" + replaced(ending)).mesh == plain.mesh);
    }
}

TEST_CASE("negative indices count back from the vertex before the face, positive ones may point forward") {
    mesh_file const file = obj("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nf -4 -3 -2\n");
    CHECK(file.mesh.corners == std::vector<std::uint32_t>{0, 1, 2, 0, 1, 2, 0, 1, 2});
}

TEST_CASE("texture coordinates and normals are kept per corner, in every form of a face") {
    mesh_file const file = obj(std::string(square) +
                               "vt 0 0\nvt 1 0.5 7\nvt .25\nvn 0 0 2\nf 1 2 3\nf 1/1 2/2 3/3\nf 1//1 2//-1 3//1\nf 1/3/1 2/-2/1 3//1\n");
    std::uint32_t const none = mesh_attributes::none;
    CHECK(file.attributes.texture == std::vector<std::array<double, 2>>{{0, 0}, {1, 0.5}, {0.25, 0}});
    CHECK(file.attributes.normals[0] == vec3{0, 0, 2});
    CHECK(file.attributes.corner_texture ==
          std::vector<std::uint32_t>{none, none, none, 0, 1, 2, none, none, none, 2, 1, none});
    CHECK(file.attributes.corner_normals == std::vector<std::uint32_t>{none, none, none, none, none, none, 0, 0, 0, 0, 0, 0});
}

TEST_CASE("groups, objects and materials are runs of faces, with their names as bytes") {
    mesh_file const file = obj(std::string(square) + "mtllib ../../etc/passwd\ng empty\ng first part\no o\nusemtl \xff\xfe\nf 1 2 3\n"
                                                     "s 1\ng\nf 1 3 4\ng last\n");
    mesh_attributes const& a = file.attributes;
    REQUIRE(a.groups.size() == 2);
    CHECK(a.groups[0].name == "first part");
    CHECK(a.groups[0].first_face == 0);
    CHECK(a.groups[1].name.empty());
    CHECK(a.groups[1].first_face == 1);
    CHECK(a.materials[0].name == "\xff\xfe");
    CHECK(a.material_libraries == std::vector<std::string>{"../../etc/passwd"});
}

TEST_CASE("vertex colours become channels, with NaN where a vertex has none; w is dropped") {
    mesh_file const file = obj("v 0 0 0\nv 1 0 0 .5 .25 1\nv 0 1 0 2\nv 0 0 1 1 1 1 0.5\n");
    REQUIRE(file.attributes.vertex_channels.size() == 4);
    CHECK(file.attributes.vertex_channels[3].name == "alpha");
    std::vector<double> const& red = file.attributes.vertex_channels[0].values;
    REQUIRE(red.size() == 4);
    CHECK(std::isnan(red[0]));
    CHECK(red[1] == 0.5);
    CHECK(std::isnan(red[2]));
    CHECK(file.attributes.vertex_channels[3].values[3] == 0.5);
}

TEST_CASE("numbers in an OBJ are decimal and finite: each form is either read or refused by name") {
    for (std::string_view const good : {"1", "+1", "-1", ".5", "5.", "1e3", "1E-3", "1e-999", "-0", "4.9e-324",
                                        "0.1000000000000000055511151231257827021181583404541015625"}) {
        INFO(good);
        CHECK_FALSE(refused("v " + std::string(good) + " 0 0\n").happened);
    }
    for (std::string_view const bad : {"1e999", "-1e999", "1e", "0x10", "1.5f", "1,5", "--1", "+-1", ".", "e5", "1d5", "1..2", "#", "\xff"}) {
        INFO(bad);
        failure const f = refused("v 0 0 0\nv 0 " + std::string(bad) + " 0\n");
        REQUIRE(f.happened);
        CHECK((f.code == errc::bad_number || f.code == errc::bad_syntax));
        CHECK(f.place.line == 2);
    }
    for (std::string_view const bad : {"nan", "inf", "-inf", "NaN", "infinity"}) {
        failure const f = refused("v 0 0 " + std::string(bad) + "\n");
        REQUIRE(f.happened);
        CHECK(f.code == errc::non_finite_vertex);
        CHECK(f.place.column == 7);
    }
    CHECK(obj("v " + std::string(300, '9') + "e-299 0 0\n").mesh.positions[0][0] == 10.0);
    CHECK(std::signbit(obj("v -0 -1e-999 0").mesh.positions[0][1]));
}

TEST_CASE("an index that leads nowhere is refused with its line, column and the limit") {
    failure const beyond = refused(std::string(square) + "f 1 2 3\nf 1 2 5\nf 1 2 3\n");
    REQUIRE(beyond.happened);
    CHECK(beyond.code == errc::index_out_of_range);
    CHECK(beyond.place.line == 6);
    CHECK(beyond.place.column == 7);
    CHECK(beyond.place.value == 5);
    CHECK(beyond.place.limit == 4);
    CHECK(contains(beyond.what, "a.obj:6:7"));
    CHECK(contains(beyond.what, "'5'"));
    for (std::string_view const index : {"0", "-5", "99999999999999999999", "4294967296", "-99999999999999999999", "18446744073709551616",
                                         "4294967295", "1/1", "1//1", "1/0", "1//0"}) {
        INFO(index);
        failure const f = refused(std::string(square) + "f 1 2 " + std::string(index) + "\n");
        REQUIRE(f.happened);
        CHECK(f.code == errc::index_out_of_range);
        CHECK(f.place.line == 5);
    }
    CHECK(refused(std::string(square) + "f 1 2 x\n").code == errc::bad_number);
    CHECK(refused(std::string(square) + "f 1 2 3x\n").code == errc::bad_syntax);
    CHECK(refused(std::string(square) + "f 1 2 1.5\n").code == errc::bad_syntax);
}

TEST_CASE("faces of one or two corners, unknown statements and free-form surfaces are refused") {
    CHECK(refused(std::string(square) + "f 1\n").code == errc::degenerate_face);
    CHECK(refused(std::string(square) + "f 1 2\n").code == errc::degenerate_face);
    CHECK(refused(std::string(square) + "f\n").code == errc::degenerate_face);
    CHECK(refused("surf 0 1 0 1 1 2 3\n").code == errc::unsupported);
    CHECK(refused("hello\n").code == errc::bad_syntax);
    CHECK(refused("v 1 2\n").code == errc::bad_syntax);
    CHECK(refused("v 1 2 3 4 5\n").code == errc::bad_syntax);
    CHECK(refused("vt 1 2 3 4\n").code == errc::bad_syntax);
    CHECK(refused("vn 1 2\n").code == errc::bad_syntax);
    CHECK(refused(std::string_view("v 0 0 0\n\0\0", 10)).code == errc::bad_syntax);
}

TEST_CASE("a line of ten million bytes is read in one pass") {
    std::string text(square);
    text += "f";
    for (int k = 0; k < 5000000; ++k) text += k % 2 == 0 ? " 1" : " 3";
    CHECK(obj(text).mesh.face(0).size() == 5000000);
    CHECK(obj("#" + std::string(10000000, 'x')).mesh.vertex_count() == 0);
    CHECK(refused("v 0 0 1" + std::string(10000000, 'x')).what.size() < 200);
}

TEST_CASE("what is written as OBJ is read back equal bit for bit, and written again to the same bytes") {
    stream random(51, 1, 0);
    for (int round = 0; round < 200; ++round) {
        std::size_t const vertices = 1 + random.index_below(20);
        std::size_t const faces = random.index_below(10);
        indexed_mesh const mesh = tafoni_test::any_mesh(random, vertices, faces);
        std::string const once = encode_obj(mesh);
        if (once.empty()) continue;
        mesh_file const back = obj(once);
        REQUIRE(back.mesh.offsets == mesh.offsets);
        REQUIRE(back.mesh.corners == mesh.corners);
        for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
            REQUIRE(std::memcmp(back.mesh.positions[v].data(), mesh.positions[v].data(), 24) == 0);
        }
        REQUIRE(encode_obj(back.mesh, back.attributes) == once);
    }
}

TEST_CASE("texture, normals, groups, materials and colours survive OBJ there and back") {
    std::string const once = encode_obj(obj("mtllib m\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0.1\nv 0 1 0\nvt 0.1 0.2\nvn 0 0 1\no box\ng a b\nusemtl s\n"
                                            "f 1/1/1 2//1 3/1\ng c\nf 3 2 1\n").mesh,
                                        obj("mtllib m\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0.1\nv 0 1 0\nvt 0.1 0.2\nvn 0 0 1\no box\ng a b\nusemtl s\n"
                                            "f 1/1/1 2//1 3/1\ng c\nf 3 2 1\n").attributes);
    CHECK(once == "mtllib m\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0.1\nv 0 1 0\nvt 0.1 0.2\nvn 0 0 1\no box\ng a b\nusemtl s\nf 1/1/1 2//1 3/1\ng c\nf 3 2 1\n");
    mesh_file const back = obj(once);
    CHECK(encode_obj(back.mesh, back.attributes) == once);
}

TEST_CASE("the OBJ writer refuses NaN, dangling corners and arrays of wrong length before it writes") {
    indexed_mesh mesh = obj(std::string(square) + "f 1 2 3\n").mesh;
    auto const code = [&](mesh_attributes const& a = {}) {
        return failure_of([&] { return encode_obj(mesh, a); }).code;
    };
    CHECK(code({.vertex_channels = {{"red", {1, 2}}}}) == errc::attribute_length);
    CHECK(code({.normals = {vec3{0, 0, 1}}, .corner_normals = {0, 0, 1}}) == errc::index_out_of_range);
    CHECK(code({.normals = {vec3{0, 0, 1}}, .corner_normals = {0, 0}}) == errc::attribute_length);
    CHECK(code({.groups = {{"a", 1}}}) == errc::bad_parameter);
    CHECK(code({.groups = {{"a\nb", 0}}}) == errc::bad_parameter);
    CHECK(code({.material_libraries = {"rock.mtl", "a\nv 0 0 0"}}) == errc::bad_parameter);
    mesh.corners[1] = 4;
    CHECK(code() == errc::index_out_of_range);
    mesh.corners[1] = 1;
    mesh.positions[3][1] = std::numeric_limits<double>::quiet_NaN();
    CHECK(code() == errc::non_finite_vertex);
}
