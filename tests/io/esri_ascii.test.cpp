#include <catch2/catch.hpp>

#include <tafoni/io/esri_ascii.hpp>

#include "file_testing.hpp"

using namespace tafoni;
using tafoni_test::failure;
using tafoni_test::failure_of;

namespace {

height_grid grid(std::string_view text) { return read_esri_ascii(text, "a.asc"); }
failure refused(std::string_view text) {
    return failure_of([&] { return grid(text); });
}

std::string header(std::string_view columns, std::string_view rows, std::string_view rest = "cellsize 10\nNODATA_value -9999\n") {
    return "ncols " + std::string(columns) + "\nnrows " + std::string(rows) + "\nxllcorner 100\nyllcorner 200\n" + std::string(rest);
}

}  // namespace

TEST_CASE("heights run from the north, missing cells are marked, positions are cell centres") {
    height_grid const g = grid(header("3", "2") + "1 2 3\n4 -9999 6\n");
    CHECK(g.columns == 3);
    CHECK(g.rows == 2);
    CHECK(g.position(0, 0) == vec3{105, 215, 1});
    CHECK(g.position(1, 2) == vec3{125, 205, 6});
    CHECK_FALSE(g.has_height(1, 1));
    CHECK(g.has_height(1, 0));
}

TEST_CASE("header keys come in any order and case, with centres or two cell sizes") {
    height_grid const g = grid("NROWS 1\r\nNCOLS 2\r\nDY 3\r\nDX 2\r\nYLLCENTER -1\r\nXLLCENTER 5\r\n 7 8");
    CHECK(g.registration == grid_registration::centre);
    CHECK(g.position(0, 1) == vec3{7, -1, 8});
    CHECK(g.missing.empty());
    CHECK(grid("ncols 1\rnrows 1\rxllcorner 0\ryllcorner 0\rcellsize 1\r5\r").heights[0] == 5);
}

TEST_CASE("without NODATA_value -9999 is a height, with nan as NODATA_value nan is none") {
    CHECK(grid(header("1", "1", "cellsize 1\n") + "-9999").missing.empty());
    height_grid const g = grid(header("2", "1", "cellsize 1\nnodata_value nan\n") + "nan 1");
    CHECK_FALSE(g.has_height(0, 0));
    CHECK(refused(header("2", "1") + "nan 1").code == errc::non_finite_vertex);
    CHECK(refused(header("2", "1") + "inf 1").code == errc::non_finite_vertex);
}

TEST_CASE("headers that lie are refused before anything is allocated") {
    for (std::string_view const columns : {"0", "-1", "1000000000", "4294967296", "99999999999999999999", "x", "1.5", ""}) {
        INFO(columns);
        failure const f = refused(header(columns, "2") + "1 2\n3 4\n");
        REQUIRE(f.happened);
        CHECK(f.code == errc::bad_count);
        CHECK(f.place.line <= 2);
    }
    CHECK(refused(header("4294967295", "4294967295") + "1").code == errc::bad_count);
    for (std::string_view const size : {"0", "-1", "nan", "inf", "1e999", "x"}) {
        failure const f = refused(header("1", "1", "cellsize " + std::string(size) + "\n") + "1\n");
        CHECK(f.code == errc::bad_number);
        CHECK(f.place.line == 5);
    }
    CHECK(refused("ncols 1\nnrows 1\ncellsize 1\n5").code == errc::bad_syntax);
    CHECK(refused("ncols 1\nnrows 1\nxllcorner 0\nyllcorner 0\n5").code == errc::bad_syntax);
    CHECK(refused(header("1", "1", "cellsize 1\ncellsize 1\n") + "1").code == errc::bad_syntax);
    CHECK(refused("hello 1").code == errc::bad_syntax);
    CHECK(refused("1 2 3").code == errc::bad_syntax);
}

TEST_CASE("a row of the wrong length is refused with its line; a file without rows flows freely") {
    CHECK(refused(header("3", "3") + "1 2 3\n4 5\n6 7 8 9\n").place.line == 9);
    CHECK(refused(header("3", "3") + "1 2 3\n4 5 6 7\n8 9\n").place.line == 8);
    CHECK(refused(header("3", "2") + "1 2 3\n4 5\n").happened);
    CHECK(refused(header("3", "2") + "1 2 3\n4 5 6\n7\n").code == errc::bad_count);
    CHECK(refused(header("3", "2") + "1 2 3\n4 5 x\n").code == errc::bad_number);
    CHECK(grid(header("3", "2") + "1\n2\n3\n4\n5\n6\n").heights == std::vector<double>{1, 2, 3, 4, 5, 6});
    CHECK(grid(header("3", "2") + "1 2 3 4 5 6").heights[5] == 6);
    CHECK(grid(header("3", "2") + "\n 1 2 3 \n\n4 5 6\n\n").heights[3] == 4);
}
