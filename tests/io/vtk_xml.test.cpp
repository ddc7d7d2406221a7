#include <catch2/catch.hpp>

#include <tafoni/io/vtk_xml.hpp>

#include "file_testing.hpp"

#include <cstdlib>
#include <cstring>

using namespace tafoni;
using tafoni_test::contains;
using tafoni_test::failure_of;

namespace {

/// An independent look into the appended bytes: the array of that name, as T.
template <class T>
std::vector<T> array_of(std::string const& file, std::string const& name) {
    std::size_t const tag = file.find("Name=\"" + name + "\"");
    REQUIRE(tag != std::string::npos);
    std::size_t const at = file.find("offset=\"", tag) + 8;
    std::size_t const offset = std::strtoull(file.c_str() + at, nullptr, 10);
    std::size_t const blob = file.find('_', file.find("<AppendedData")) + 1;
    std::uint64_t length = 0;
    std::memcpy(&length, file.data() + blob + offset, 8);
    REQUIRE(length % sizeof(T) == 0);
    std::vector<T> values(length / sizeof(T));
    std::memcpy(values.data(), file.data() + blob + offset + 8, length);
    return values;
}

indexed_mesh house() {
    indexed_mesh m;
    m.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 2}};
    m.add_face({3, 2, 1, 0});
    m.add_face({0, 1, 4});
    return m;
}

}  // namespace

TEST_CASE("a .vtp holds points, polygons and channels of every type") {
    mesh_attributes const a{.vertex_channels = {{"height", {0, 0, 0, 0, 2}}, {"n", {1, 2, 3, 4, 255}, channel_type::uint8}},
                            .face_channels = {{"life", {0.25, std::numeric_limits<double>::quiet_NaN()}, channel_type::float32}}};
    std::string const file = encode_vtp(house(), a);
    CHECK(contains(file, "NumberOfPoints=\"5\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"2\""));
    CHECK(contains(file, "<CellData Scalars=\"life\">"));
    CHECK(array_of<double>(file, "Points")[14] == 2);
    CHECK(array_of<std::int64_t>(file, "connectivity") == std::vector<std::int64_t>{3, 2, 1, 0, 0, 1, 4});
    CHECK(array_of<std::int64_t>(file, "offsets") == std::vector<std::int64_t>{4, 7});
    CHECK(array_of<double>(file, "height")[4] == 2);
    CHECK(array_of<std::uint8_t>(file, "n")[4] == 255);
    CHECK(array_of<float>(file, "life")[0] == 0.25F);
    CHECK(std::isnan(array_of<float>(file, "life")[1]));
}

TEST_CASE("nx, ny, nz together are the normals of a .vtp; names are escaped") {
    mesh_attributes const a{.face_channels = {{"nx", {0, 1}}, {"ny", {0, 2}}, {"nz", {-1, 3}}, {"a<\"b\">&c", {1, 2}}}};
    std::string const file = encode_vtp(house(), a);
    CHECK(array_of<float>(file, "Normals") == std::vector<float>{0, 0, -1, 1, 2, 3});
    CHECK(contains(file, "Scalars=\"a&lt;&quot;b&quot;&gt;&amp;c\" Normals=\"Normals\""));
}

TEST_CASE("a mesh without faces is a cloud of points in a .vtp, an empty mesh an empty piece") {
    indexed_mesh cloud;
    cloud.positions = {{0, 0, 0}, {1, 2, 3}};
    std::string const file = encode_vtp(cloud);
    CHECK(contains(file, "NumberOfVerts=\"2\""));
    CHECK(array_of<std::int64_t>(file, "connectivity") == std::vector<std::int64_t>{0, 1});
    CHECK(contains(encode_vtp(indexed_mesh{}), "NumberOfPoints=\"0\""));
}

TEST_CASE("polylines carry numbers per point and per line") {
    polyline_set lines;
    lines.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
    lines.add_line({0, 1, 2});
    lines.add_line({2, 0});
    std::string const file = encode_vtp(lines, {{"water", {3, 2, 1}}}, {{"path", {7, 8}, channel_type::int32}});
    CHECK(contains(file, "NumberOfLines=\"2\""));
    CHECK(array_of<std::int64_t>(file, "offsets") == std::vector<std::int64_t>{3, 5});
    CHECK(array_of<std::int32_t>(file, "path") == std::vector<std::int32_t>{7, 8});
    CHECK(array_of<double>(file, "water")[1] == 2);
    CHECK(failure_of([&] { return encode_vtp(lines, {{"water", {3, 2}}}); }).code == errc::attribute_length);
    lines.corners[0] = 3;
    CHECK(failure_of([&] { return encode_vtp(lines); }).code == errc::index_out_of_range);
    lines.corners[0] = 0;
    lines.offsets.back() = 9;
    CHECK(failure_of([&] { return encode_vtp(lines); }).code == errc::bad_parameter);
}

TEST_CASE("float coordinates of a .vtp are relative to an origin that the file records") {
    indexed_mesh mesh = house();
    for (vec3& p : mesh.positions) p = vec3{p[0] + 376313.65, p[1] + 3788627.8, p[2]};
    std::string const file = encode_vtp(mesh, {}, {.coordinates = coordinate_type::float32, .origin = {376313, 3788627, 0}});
    CHECK(array_of<double>(file, "origin") == std::vector<double>{376313, 3788627, 0});
    CHECK(array_of<float>(file, "Points")[1] == 0.8F);
}

TEST_CASE("a .pvd lists files and times, and refuses times that are not numbers") {
    std::vector<pvd_entry> entries{{0, "snapshots/a_0.vtp"}, {0.1, "a&b.vtp", 1}};
    std::string const file = encode_pvd(entries);
    CHECK(contains(file, "<DataSet timestep=\"0\" part=\"0\" file=\"snapshots/a_0.vtp\"/>"));
    CHECK(contains(file, "<DataSet timestep=\"0.1\" part=\"1\" file=\"a&amp;b.vtp\"/>"));
    entries[0].time = std::numeric_limits<double>::infinity();
    CHECK(failure_of([&] { return encode_pvd(entries); }).code == errc::bad_parameter);
}

TEST_CASE("f3d opens what is written, where it is installed", "[slow]") {
    if (std::system("command -v f3d >/dev/null && command -v xvfb-run >/dev/null") != 0) {
        WARN("skipped: no f3d with xvfb-run");
        return;
    }
    tafoni_test::scratch_folder const folder;
    write_vtp(folder / "a.vtp", house(), {.face_channels = {{"life", {0.25, 1}}}});
    std::string const command = "xvfb-run -a timeout 60 f3d " + (folder / "a.vtp").string() + " --output " + (folder / "a.png").string() +
                                " --resolution 64,64 --verbose > " + (folder / "log").string() + " 2>&1";
    REQUIRE(std::system(command.c_str()) == 0);
    std::string const log = tafoni_test::bytes_of(folder / "log");
    CHECK(contains(log, "Number of points: 5"));
    CHECK(contains(log, "Number of polygons: 2"));
    CHECK(contains(log, "life : double : [0.25, 1]"));
    CHECK(std::filesystem::file_size(folder / "a.png") > 100);
}
