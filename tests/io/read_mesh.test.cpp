#include <catch2/catch.hpp>

#include <tafoni/io/esri_ascii.hpp>
#include <tafoni/io/obj.hpp>
#include <tafoni/io/ply.hpp>
#include <tafoni/io/read_mesh.hpp>
#include <tafoni/io/stl.hpp>

#include "file_testing.hpp"

#include <fuzz/check_mesh_file.hpp>
#include <support/test_data.hpp>

#include <sys/stat.h>
#include <sys/wait.h>

using namespace tafoni;
using tafoni_test::contains;
using tafoni_test::failure;
using tafoni_test::failure_of;

namespace {

failure refused(std::filesystem::path const& path) {
    return failure_of([&] { return read_mesh(path); });
}

indexed_mesh triangle() {
    indexed_mesh m;
    m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    m.add_face({0, 1, 2});
    return m;
}

}  // namespace

TEST_CASE("the format is told by content first, then by the extension in any case") {
    indexed_mesh const m = triangle();
    CHECK(read_mesh(encode_ply(m), "a.ply").mesh == m);
    CHECK(read_mesh(encode_ply(m), "a.OBJ").mesh == m);
    CHECK(read_mesh(encode_ply(m), "no_extension").mesh == m);
    CHECK(read_mesh(encode_obj(m), "A.OBJ").mesh == m);
    CHECK(read_mesh(encode_stl(m), "a.stl").mesh == m);
    CHECK(read_mesh(encode_stl(m), "a").mesh == m);
    CHECK(failure_of([&] { return read_mesh(encode_obj(m), "a.txt"); }).code == errc::wrong_format);
    CHECK(failure_of([&] { return read_mesh(encode_obj(m), "a.asc"); }).code == errc::wrong_format);
    CHECK(failure_of([&] { return read_mesh(encode_obj(m), "a.ply"); }).code == errc::wrong_format);
}

TEST_CASE("compressed files, archives and UTF-16 are named as such") {
    using namespace std::string_view_literals;
    for (auto const& [magic, name] : {std::pair{"\x1f\x8b\x08\0\0\0"sv, "gzip"}, std::pair{"PK\x03\x04zzzz"sv, "zip"},
                                      std::pair{"BZh91AY"sv, "bzip2"}, std::pair{"\xfd" "7zXZ\0"sv, "xz"},
                                      std::pair{"\x28\xb5\x2f\xfd\0"sv, "zstd"}, std::pair{"\xff\xfev\0 \0"sv, "UTF-16"}}) {
        for (std::string_view const file : {"a.obj", "a.stl", "a.ply", "a"}) {
            failure const f = failure_of([&] { return read_mesh(magic, file); });
            CHECK(f.happened);
            if (std::string_view(name) == "UTF-16" && (file == "a.ply" || file == "a")) continue;
            CHECK(f.code == errc::wrong_format);
            CHECK(contains(f.what, name));
        }
    }
    CHECK(failure_of([] { return read_esri_ascii("\x1f\x8b\x08", "a.asc"); }).code == errc::wrong_format);
}

TEST_CASE("what is no regular file is refused at once, with a reason") {
    tafoni_test::scratch_folder const folder;
    CHECK(refused(folder / "missing.obj").code == errc::cannot_open);
    CHECK(refused(folder / ".").code == errc::not_a_file);
    REQUIRE(::mkfifo((folder / "pipe.obj").c_str(), 0600) == 0);
    CHECK(refused(folder / "pipe.obj").code == errc::not_a_file);
    CHECK(refused("/dev/zero").code == errc::not_a_file);
    CHECK(contains(refused("/dev/zero").what, "character device"));
    std::filesystem::create_symlink("loop.obj", folder / "loop.obj");
    CHECK(refused(folder / "loop.obj").code == errc::cannot_open);
    CHECK(refused(folder / std::string(4096, 'x')).code == errc::cannot_open);
    tafoni_test::put_bytes(folder / "empty.obj", "");
    CHECK(refused(folder / "empty.obj").code == errc::empty_input);
    CHECK(refused(folder / "empty.obj").place.file == (folder / "empty.obj").string());
    write_obj(folder / "n\xff\xfe.obj", triangle());
    CHECK(read_mesh(folder / "n\xff\xfe.obj").mesh == triangle());
}

TEST_CASE("a file without permission to read is refused") {
    tafoni_test::scratch_folder const folder;
    write_obj(folder / "a.obj", triangle());
    REQUIRE(::chmod((folder / "a.obj").c_str(), 0) == 0);
    pid_t const child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        // Root may read everything, so the child becomes somebody else.
        if (::geteuid() == 0 && ::setuid(65534) != 0) ::_exit(2);
        ::_exit(refused(folder / "a.obj").code == errc::cannot_open ? 0 : 1);
    }
    int status = 1;
    ::waitpid(child, &status, 0);
    CHECK(WEXITSTATUS(status) == 0);
}

TEST_CASE("files that a mesh refers to are never opened") {
    tafoni_test::scratch_folder const folder;
    REQUIRE(::mkfifo((folder / "m.mtl").c_str(), 0600) == 0);  // opening it would wait for ever
    tafoni_test::put_bytes(folder / "a.obj", "mtllib m.mtl\nmtllib ../../../etc/passwd\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n");
    CHECK(read_mesh(folder / "a.obj").mesh == triangle());
}

TEST_CASE("the real meshes have the numbers of vertices and faces that their list says") {
    struct entry {
        char const* name;
        std::size_t vertices;
        std::size_t faces;
    };
    std::size_t found = 0;
    for (entry const& e : {entry{"hill3d_1.9k_quads.obj", 1896, 1894}, entry{"nefertiti_35k.ply", 35002, 70000},
                           entry{"marble_player_9k.obj", 9035, 18082}, entry{"plato_8.5k.obj", 8534, 17064},
                           entry{"column03_7k.obj", 6992, 13980}, entry{"hand_closed_8k.obj", 7993, 15982},
                           entry{"hand_lowres.obj", 810, 1602}, entry{"goathead_2.7k.obj", 2763, 5522},
                           entry{"scorpion_50k.ply", 49997, 99990}, entry{"spot_0.8k.obj", 829, 1654},
                           entry{"spot_11k.ply", 11533, 23062}, entry{"wingnut_3k.obj", 3047, 6090},
                           entry{"mechpart_7.6k.obj", 7612, 15232}, entry{"itokawa_6k.obj", 6146, 12288},
                           entry{"mountain_25k.ply", 25600, 50562}}) {
        auto const path = tafoni_test::find(std::string("meshes/") + e.name);
        if (path.empty()) continue;
        ++found;
        INFO(e.name);
        mesh_file const file = read_mesh(path);
        CHECK(file.mesh.vertex_count() == e.vertices);
        CHECK(file.mesh.face_count() == e.faces);
        tafoni_test::check_mesh_file(file);
        // There and back through every format: the same mesh, bit for bit.
        CHECK(read_obj(encode_obj(file.mesh), "x").mesh == file.mesh);
        CHECK(read_ply(encode_ply(file.mesh), "x").mesh == file.mesh);
        CHECK(read_ply(encode_ply(file.mesh, {}, {.encoding = ply_encoding::ascii}), "x").mesh == file.mesh);
        CHECK(read_stl(encode_stl(file.mesh), "x").mesh.face_count() == file.mesh.corners.size() - 2 * file.mesh.face_count());
    }
    if (found == 0) WARN("skipped: no data");
}

TEST_CASE("the bounding box of hill3d is the published one") {
    auto const hill = tafoni_test::find("meshes/hill3d_1.9k_quads.obj");
    if (hill.empty()) {
        WARN("skipped: no data");
        return;
    }
    box3 bounds;
    for (vec3 const& p : read_mesh(hill).mesh.positions) bounds.include(p);
    CHECK(bounds.lo[0] == Approx(-6.606).margin(5e-4));
    CHECK(bounds.hi[2] == Approx(5.296).margin(5e-4));
}

TEST_CASE("the real elevation grids have the sizes and missing cells that their list says") {
    struct entry {
        char const* name;
        std::size_t columns, rows, missing;
        double lowest, highest;
    };
    std::size_t found = 0;
    for (entry const& e : {entry{"stubai_10m.asc", 324, 360, 0, 1349.1, 2716.1}, entry{"bigtujunga_30m.asc", 1197, 643, 0, 315, 2295},
                           entry{"bigtujunga_ridge128_30m.asc", 128, 128, 0, 563, 1547},
                           entry{"sthelens_slope_10m.asc", 80, 122, 122, 189, 582.4},
                           entry{"grandcanyon_400_unitcells.asc", 400, 400, 0, 2.721, 14.54}}) {
        auto const path = tafoni_test::find(std::string("dems/") + e.name);
        if (path.empty()) continue;
        ++found;
        INFO(e.name);
        height_grid const g = read_esri_ascii(path);
        CHECK(g.columns == e.columns);
        CHECK(g.rows == e.rows);
        std::size_t missing = 0;
        double lowest = 1e9;
        double highest = -1e9;
        for (std::size_t row = 0; row < g.rows; ++row) {
            for (std::size_t column = 0; column < g.columns; ++column) {
                if (!g.has_height(row, column)) {
                    ++missing;
                    continue;
                }
                lowest = std::min(lowest, g.height(row, column));
                highest = std::max(highest, g.height(row, column));
            }
        }
        CHECK(missing == e.missing);
        CHECK(lowest == Approx(e.lowest).margin(0.06));
        CHECK(highest == Approx(e.highest).margin(0.06));
    }
    if (found == 0) WARN("skipped: no data");
}
