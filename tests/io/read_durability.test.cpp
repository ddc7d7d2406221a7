#include <catch2/catch.hpp>

#include <tafoni/io/read_durability.hpp>

#include "file_testing.hpp"

using namespace tafoni;
using tafoni_test::contains;
using tafoni_test::failure;
using tafoni_test::failure_of;

namespace {

durability_table table(std::string_view text) { return read_durability(text, "a.txt"); }
failure refused(std::string_view text) {
    return failure_of([&] { return table(text); });
}

}  // namespace

TEST_CASE("corners stand one in a line, with or without noise, between comments and empty lines") {
    durability_table const t = table("# a profile\n\n  0 2\n1.5\t3.5 0.25 8 # noise from here\n1.5 +9\r\n\r\n2e0 .5");
    CHECK_FALSE(t.relative);
    REQUIRE(t.points.size() == 4);
    CHECK(t.points[0] == durability_point{0, 2, 0, 0});
    CHECK(t.points[1] == durability_point{1.5, 3.5, 0.25, 8});
    CHECK(t.points[2] == durability_point{1.5, 9, 0, 0});
    CHECK(t.points[3] == durability_point{2, 0.5, 0, 0});
    CHECK(table("-3 1").points[0].altitude == -3);
    CHECK(table("\xef\xbb\xbf" "1 2\r3 4\r").points.size() == 2);
    CHECK(table("1 2#close\n").points.size() == 1);
}

TEST_CASE("a first word says whether altitudes are shares of the height") {
    CHECK(table("relative\n0 1\n1 2\n").relative);
    CHECK(table("# shares\n  relative # of the height\n0 1\n").relative);
    CHECK_FALSE(table("absolute\n0 1\n").relative);
    CHECK(refused("relative\nrelative\n0 1").place.line == 2);
    CHECK(refused("0 1\nrelative\n1 2").place.line == 2);
    CHECK(refused("relative 0 1\n").code == errc::bad_syntax);
    CHECK(refused("relatively\n0 1\n").code == errc::bad_syntax);
    CHECK(refused("share\n0 1\n").code == errc::bad_number);
}

TEST_CASE("what is wrong in a durability file is told with its line and column") {
    failure f = refused("0 1\n1 2 3\n");
    CHECK(f.code == errc::bad_count);
    CHECK(f.place.line == 2);
    CHECK(contains(f.what, "a.txt:2:"));
    CHECK(contains(f.what, "got 3 numbers"));
    f = refused("0 1\n\n# x\n2 1\n1 1\n");
    CHECK(f.code == errc::bad_syntax);
    CHECK(f.place.line == 5);
    CHECK(f.place.column == 1);
    CHECK(contains(f.what, "must ascend"));
    f = refused("0 one\n");
    CHECK(f.code == errc::bad_number);
    CHECK(f.place.column == 3);
    CHECK(contains(f.what, "a durability, got 'one'"));
    for (std::string_view const bad : {"0 -1", "0 1 -2 3", "0 1 2 -3", "0 nan", "inf 1", "0 1e999", "0 1e200", "0 1,5", "0 0x10", "0 1 2 3x"}) {
        INFO(bad);
        CHECK(refused(bad).code == errc::bad_number);
        CHECK(refused(bad).place.line == 1);
    }
    CHECK(refused("0\n").code == errc::bad_count);
    CHECK(refused("0 1 2 3 4\n").code == errc::bad_count);
    CHECK(refused("0 1 2 3 4\n").place.column == 9);
    CHECK(refused("").code == errc::empty_input);
    CHECK(refused("# nothing\n").code == errc::empty_input);
    CHECK(refused("relative\n").code == errc::empty_input);
    CHECK(refused("\x1f\x8b rest").code == errc::wrong_format);
    CHECK(refused("\xff\xfe" "0").code == errc::wrong_format);
    CHECK(refused(std::string_view("0 1\0", 4)).code == errc::bad_number);
}

TEST_CASE("every prefix of a durability file is read or refused [law 52]") {
    std::string const whole = "relative\n# a\n0 2.5\n0.5 3.5 0.25 8 # b\n0.5 9\n1 .5e-1\n";
    for (std::size_t n = 0; n <= whole.size(); ++n) {
        failure const f = refused(std::string_view(whole).substr(0, n));
        if (f.happened) CHECK(f.place.line <= 6);
    }
    CHECK_FALSE(refused(whole).happened);
}

TEST_CASE("durability files are read from disk, and what is no file is refused [F13]") {
    tafoni_test::scratch_folder const folder;
    tafoni_test::put_bytes(folder / "p.txt", "0 4\n");
    CHECK(read_durability(folder / "p.txt").points[0].durability == 4);
    CHECK(failure_of([&] { return read_durability(folder / "none.txt"); }).code == errc::cannot_open);
    CHECK(failure_of([&] { return read_durability(folder / "."); }).code == errc::not_a_file);
    CHECK(failure_of([&] { return read_durability(std::filesystem::path("/dev/zero")); }).code == errc::not_a_file);
}
