#include <catch2/catch.hpp>

#include <tafoni/io/ply.hpp>

#include "file_testing.hpp"

#include <algorithm>
#include <cstring>

using namespace tafoni;
using tafoni_test::contains;
using tafoni_test::failure;
using tafoni_test::failure_of;

namespace {

mesh_file ply(std::string_view bytes) { return read_ply(bytes, "a.ply"); }
failure refused(std::string_view bytes) {
    return failure_of([&] { return ply(bytes); });
}

std::string const triangle_header =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
std::string const triangle = triangle_header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

std::string replaced(std::string text, std::string_view from, std::string_view to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
        text.replace(at, from.size(), to);
    }
    return text;
}

template <class T>
void put(std::string& out, T value, bool big) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (big) std::reverse(bytes, bytes + sizeof(T));
    out.append(bytes, sizeof(T));
}

/// A binary triangle whose face list has the given C++ types.
template <class Count, class Index>
std::string binary_triangle(bool big, char const* count_name, char const* index_name) {
    std::string out = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                      "_endian 1.0\nelement vertex 3\nproperty double x\nproperty float y\nproperty uchar z\n"
                      "element face 1\nproperty list " + count_name + " " + index_name + " vertex_index\nend_header\n";
    for (int v = 0; v < 3; ++v) {
        put(out, 0.1 * v, big);
        put(out, 0.5F * static_cast<float>(v), big);
        put(out, static_cast<std::uint8_t>(200 + v), big);
    }
    put(out, Count{3}, big);
    for (int v = 0; v < 3; ++v) put(out, static_cast<Index>(v), big);
    return out;
}

}  // namespace

TEST_CASE("an ASCII PLY of one triangle is read, with any line ending") {
    for (std::string_view const ending : {"\n", "\r\n", "\r"}) {
        mesh_file const file = ply(replaced(triangle, "\n", ending));
        REQUIRE(file.mesh.vertex_count() == 3);
        CHECK(file.mesh.positions[1] == vec3{1, 0, 0});
        CHECK(file.mesh.corners == std::vector<std::uint32_t>{0, 1, 2});
    }
}

TEMPLATE_TEST_CASE("binary lists of every integer type are read in both byte orders", "", std::int8_t, std::uint8_t,
                   std::int16_t, std::uint16_t, std::int32_t, std::uint32_t) {
    static constexpr char const* names[] = {"char", "uint8", "short", "uint16", "int", "uint32"};
    std::size_t const k = (sizeof(TestType) == 1 ? 0U : sizeof(TestType) == 2 ? 2U : 4U) + (std::is_signed_v<TestType> ? 0U : 1U);
    for (bool const big : {false, true}) {
        for (auto const& bytes : {binary_triangle<TestType, std::int32_t>(big, names[k], "int"),
                                  binary_triangle<std::uint8_t, TestType>(big, "uchar", names[k])}) {
            mesh_file const file = ply(bytes);
            CHECK(file.mesh.corners == std::vector<std::uint32_t>{0, 1, 2});
            CHECK(file.mesh.positions[2] == vec3{0.2, 1.0, 202});
        }
    }
}

TEST_CASE("scalar properties become channels of their type; other lists and elements are skipped") {
    mesh_file const file = ply("ply\nformat ascii 1.0\ncomment hi\nobj_info by hand\nelement wire 2\nproperty list uchar float knots\n"
                               "element face 1\nproperty float life\nproperty list uchar ushort vertex_indices\nproperty list uint8 float uv\n"
                               "element vertex 3\nproperty uchar red\nproperty double z\nproperty list int int near_ones\nproperty int y\nproperty short x\n"
                               "element nothing 99999999999\nelement edge 1\nproperty char q\nend_header\n"
                               "2 0.5 nan\n0\nnan 3 0 1 2 1 0.25\n1 2 0 3 4\n5 6 2 9 9 7 8\n255 1e300 1 0 -1 -2\n-7\n\n");
    CHECK(file.mesh.positions == std::vector<vec3>{{4, 3, 2}, {8, 7, 6}, {-2, -1, 1e300}});
    REQUIRE(file.attributes.vertex_channels.size() == 1);
    CHECK(file.attributes.vertex_channels[0].name == "red");
    CHECK(file.attributes.vertex_channels[0].type == channel_type::uint8);
    CHECK(file.attributes.vertex_channels[0].values == std::vector<double>{1, 5, 255});
    CHECK(std::isnan(file.attributes.face_channels[0].values[0]));
}

TEST_CASE("counts that lie are refused before anything is allocated") {
    for (std::string_view const count : {"4294967295", "18446744073709551615", "4", "1000000"}) {
        failure const f = refused(replaced(triangle, "vertex 3", "vertex " + std::string(count)));
        INFO(f.what);
        REQUIRE(f.happened);
        CHECK((f.code == errc::bad_count || f.code == errc::bad_syntax));
    }
    CHECK(refused(replaced(triangle, "vertex 3", "vertex 18446744073709551616")).code == errc::bad_count);
    CHECK(refused(replaced(triangle, "vertex 3", "vertex -3")).code == errc::bad_count);
    CHECK(refused(replaced(triangle, "vertex 3", "vertex x")).code == errc::bad_count);
    CHECK(refused(replaced(triangle, "face 1", "face 0")).code == errc::bad_count);
    CHECK(refused(replaced(triangle, "face 1", "face 2")).happened);
    CHECK(refused(triangle + "3 0 1 2\n").code == errc::bad_count);
    CHECK_FALSE(refused(triangle + " \n\n").happened);
    std::string const binary = binary_triangle<std::uint8_t, std::int32_t>(false, "uchar", "int");
    CHECK(refused(binary + "x").code == errc::bad_count);
    CHECK(refused(binary.substr(0, binary.size() - 1)).happened);
    std::string list = binary_triangle<std::uint32_t, std::int32_t>(false, "uint", "int");
    list[list.size() - 13] = '\x7f';
    CHECK(refused(list).code == errc::truncated);
    list = binary_triangle<std::int32_t, std::int32_t>(false, "int", "int");
    list[list.size() - 13] = '\xff';
    CHECK(refused(list).code == errc::bad_count);
}

TEST_CASE("errors in an ASCII body name line and column, in a binary body the byte") {
    failure const text = refused(replaced(triangle, "3 0 1 2", "3 0 1 3"));
    REQUIRE(text.happened);
    CHECK(text.code == errc::index_out_of_range);
    CHECK(text.place.line == 13);
    CHECK(text.place.column == 7);
    CHECK(text.place.limit == 2);
    CHECK(contains(text.what, "a.ply:13:7"));
    CHECK(refused(replaced(triangle, "3 0 1 2", "3 0 1 -1")).code == errc::index_out_of_range);
    CHECK(refused(replaced(triangle, "3 0 1 2", "2 0 1")).code == errc::degenerate_face);
    CHECK(refused(replaced(triangle, "3 0 1 2", "3 0 1")).code == errc::bad_number);
    CHECK(refused(replaced(triangle, "3 0 1 2", "3 0 1 2 5")).code == errc::bad_syntax);
    CHECK(refused(replaced(triangle, "1 0 0\n", "1 0\n")).code == errc::bad_number);
    CHECK(refused(replaced(triangle, "1 0 0\n", "1 nan 0\n")).code == errc::non_finite_vertex);
    CHECK(refused(replaced(triangle, "1 0 0\n", "1 1e39 0\n")).code == errc::bad_number);
    CHECK(refused(replaced(triangle, "1 0 0\n", "1 0x1 0\n")).code == errc::bad_number);

    std::string binary = binary_triangle<std::uint8_t, std::int32_t>(true, "uchar", "int");
    std::size_t const last = binary.size() - 4;
    binary[last + 3] = 3;
    failure const at = refused(binary);
    REQUIRE(at.happened);
    CHECK(at.code == errc::index_out_of_range);
    CHECK(contains(at.what, "byte " + std::to_string(last)));
}

TEST_CASE("headers that make no sense are refused by line") {
    auto const code = [&](std::string_view from, std::string_view to) { return refused(replaced(triangle, from, to)).code; };
    CHECK(code("ply\n", "plx\n") == errc::wrong_format);
    CHECK(code("format ascii 1.0\n", "") == errc::bad_syntax);
    CHECK(code("ascii 1.0", "ascii 2.0") == errc::unsupported);
    CHECK(code("ascii", "binary") == errc::bad_syntax);
    CHECK(code("end_header\n", "") == errc::bad_syntax);
    CHECK(code("property float x\n", "property float xx\n") == errc::missing_property);
    CHECK(code("property float y\n", "property float x\n") == errc::bad_syntax);
    CHECK(code("element face", "element vertex") == errc::bad_syntax);
    CHECK(code("property float x", "property half x") == errc::bad_syntax);
    CHECK(code("property float x", "property list uchar float x") == errc::bad_syntax);
    CHECK(code("list uchar int", "list float int") == errc::bad_syntax);
    CHECK(code("list uchar int", "list uchar float") == errc::bad_syntax);
    CHECK(code("vertex_indices", "corners") == errc::missing_property);
    CHECK(code("element vertex", "element point") == errc::missing_property);
    CHECK(refused("ply\nformat ascii 1.0\nend_header\n").code == errc::missing_property);
    CHECK(refused("ply\nformat ascii 1.0\nelement vertex 3\n").code == errc::truncated);
    CHECK(refused(replaced(triangle, "element face 1\n", "element tristrips 1\n")).code == errc::unsupported);
}

TEST_CASE("a PLY without faces is a set of vertices") {
    mesh_file const file = ply("ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int y\nproperty int z\nend_header\n1 2 3");
    CHECK(file.mesh.vertex_count() == 1);
    CHECK(file.mesh.face_count() == 0);
}

TEST_CASE("what is written as PLY is read back equal bit for bit, in every encoding, and written again to the same bytes") {
    stream random(51, 2, 0);
    for (int round = 0; round < 150; ++round) {
        std::size_t const vertices = 1 + random.index_below(20);
        std::size_t const faces = random.index_below(10);
        indexed_mesh const mesh = tafoni_test::any_mesh(random, vertices, faces);
        mesh_attributes attributes;
        for (int type = 0; type < 8; ++type) {
            mesh_channel v{"v" + std::to_string(type), {}, static_cast<channel_type>(type)};
            mesh_channel f{"f" + std::to_string(type), {}, static_cast<channel_type>(type)};
            auto const value = [&]() -> double {
                std::uint64_t const bits = random.bits();
                switch (type) {
                    case 0: return static_cast<std::int8_t>(bits);
                    case 1: return static_cast<std::uint8_t>(bits);
                    case 2: return static_cast<std::int16_t>(bits);
                    case 3: return static_cast<std::uint16_t>(bits);
                    case 4: return static_cast<std::int32_t>(bits);
                    case 5: return static_cast<std::uint32_t>(bits);
                    case 6: {
                        float const single = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
                        return static_cast<double>(single == single ? single : 0.0F);
                    }
                    default: break;
                }
                double const wide = std::bit_cast<double>(bits);
                return wide == wide ? wide : 0.0;
            };
            for (std::size_t i = 0; i < mesh.vertex_count(); ++i) v.values.push_back(value());
            for (std::size_t i = 0; i < mesh.face_count(); ++i) f.values.push_back(value());
            attributes.vertex_channels.push_back(v);
            attributes.face_channels.push_back(f);
        }
        for (auto const encoding : {ply_encoding::ascii, ply_encoding::little_endian, ply_encoding::big_endian}) {
            std::string const once = encode_ply(mesh, attributes, {.encoding = encoding});
            mesh_file const back = ply(once);
            REQUIRE(back.mesh.offsets == mesh.offsets);
            REQUIRE(back.mesh.corners == mesh.corners);
            for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
                REQUIRE(std::memcmp(back.mesh.positions[v].data(), mesh.positions[v].data(), 24) == 0);
            }
            for (std::size_t k = 0; k < 8; ++k) {
                REQUIRE(back.attributes.vertex_channels[k].values == attributes.vertex_channels[k].values);
                REQUIRE(back.attributes.face_channels[k].values == attributes.face_channels[k].values);
                REQUIRE(back.attributes.vertex_channels[k].type == attributes.vertex_channels[k].type);
            }
            REQUIRE(encode_ply(back.mesh, back.attributes, {.encoding = encoding}) == once);
        }
    }
}

TEST_CASE("a float PLY relative to a recorded origin keeps millimetres of a model far from zero") {
    indexed_mesh mesh;
    stream random(51, 3, 0);
    for (int v = 0; v < 1000; ++v) {
        double const x = random.uniform01();
        double const y = random.uniform01();
        mesh.add_vertex({376313.6555 + 1000 * x, 3788627.828 + 1000 * y, 945.123});
    }
    write_ply_options const options{.coordinates = coordinate_type::float32, .origin = {376313.6555, 3788627.828, 900}};
    std::string const once = encode_ply(mesh, {}, options);
    mesh_file const back = ply(once);
    double worst = 0;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) worst = std::max(worst, length(vec3(back.mesh.positions[v] - mesh.positions[v])));
    CHECK(worst < 1e-4);
    CHECK(std::abs(back.origin[1] - 3788627.828) < 0.25);
    CHECK(encode_ply(back.mesh, {}, {.coordinates = coordinate_type::float32, .origin = back.origin}) == once);
    // Without an origin a float has steps of a quarter metre out there.
    mesh_file const coarse = ply(encode_ply(mesh, {}, {.coordinates = coordinate_type::float32}));
    CHECK(std::abs(coarse.mesh.positions[0][1] - mesh.positions[0][1]) > 1e-4);
}

TEST_CASE("the PLY writer refuses what it cannot write") {
    indexed_mesh mesh;
    for (int v = 0; v < 3; ++v) mesh.add_vertex({1e300, double(v), 0});
    mesh.add_face({0, 1, 2});
    auto const code = [&](mesh_attributes const& a, write_ply_options const& o = {}) {
        return failure_of([&] { return encode_ply(mesh, a, o); }).code;
    };
    double const nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(code({}, {.coordinates = coordinate_type::float32}) == errc::format_limit);
    indexed_mesh thin = mesh;
    thin.add_face({0, 1});
    CHECK(failure_of([&] { return encode_ply(thin); }).code == errc::degenerate_face);
    CHECK(code({}, {.origin = {nan, 0, 0}}) == errc::non_finite_vertex);
    CHECK(code({.vertex_channels = {{"x", {1, 2, 3}}}}) == errc::bad_parameter);
    CHECK(code({.vertex_channels = {{"a b", {1, 2, 3}}}}) == errc::bad_parameter);
    CHECK(code({.vertex_channels = {{"", {1, 2, 3}}}}) == errc::bad_parameter);
    CHECK(code({.face_channels = {{"a", {1, 2}}}}) == errc::attribute_length);
    CHECK(code({.face_channels = {{"a", {1}}, {"a", {1}}}}) == errc::bad_parameter);
    CHECK(code({.face_channels = {{"a", {256}, channel_type::uint8}}}) == errc::bad_parameter);
    CHECK(code({.face_channels = {{"a", {0.5}, channel_type::int32}}}) == errc::bad_parameter);
    CHECK(code({.face_channels = {{"a", {nan}, channel_type::int32}}}) == errc::bad_parameter);
    CHECK(code({.face_channels = {{"a", {1e300}, channel_type::float32}}}) == errc::bad_parameter);
    mesh.positions[0][2] = std::numeric_limits<double>::infinity();
    CHECK(code({}) == errc::non_finite_vertex);
}

TEST_CASE("faces of more than 255 corners get a wider list length") {
    indexed_mesh mesh;
    std::vector<std::uint32_t> loop;
    for (std::uint32_t v = 0; v < 300; ++v) {
        mesh.add_vertex({double(v), double(v) * v, 0});
        loop.push_back(v);
    }
    mesh.add_face(loop);
    CHECK(ply(encode_ply(mesh)).mesh == mesh);
    CHECK(ply(encode_ply(mesh, {}, {.encoding = ply_encoding::ascii})).mesh == mesh);
}

TEST_CASE("a zero keeps its sign along the axes that a recorded origin does not move") {
    indexed_mesh mesh;
    for (vec3 const& v : {vec3{100, -0.0, 0}, vec3{101, 0, -0.0}, vec3{100, 1, -0.0}}) mesh.add_vertex(v);
    mesh.add_face({0, 1, 2});
    write_ply_options const options{.coordinates = coordinate_type::float32, .origin = {100, 0, 0}};
    std::string const once = encode_ply(mesh, {}, options);
    mesh_file const back = read_ply(once, "memory");
    CHECK(std::signbit(back.mesh.positions[0][1]));
    CHECK_FALSE(std::signbit(back.mesh.positions[1][1]));
    CHECK(std::signbit(back.mesh.positions[2][2]));
    CHECK(back.mesh.positions[1][0] == 101);
    CHECK(encode_ply(back.mesh, {}, options) == once);
}
