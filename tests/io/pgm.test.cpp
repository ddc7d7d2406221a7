#include <catch2/catch.hpp>

#include "file_testing.hpp"

#include <tafoni/io/read_pgm.hpp>

using namespace tafoni;
using tafoni_test::failure_of;
using namespace std::string_literals;

namespace {

tafoni_test::failure refusal(std::string const& bytes) {
    return failure_of([&] { return read_pgm(bytes, "x.pgm"); });
}
bool refused(std::string const& bytes, errc code) {
    auto const f = refusal(bytes);
    INFO(f.what);
    CHECK(f.happened);
    CHECK(f.code == code);
    CHECK(tafoni_test::contains(f.what, "read_pgm: x.pgm:"));
    return f.happened && f.code == code;
}

}  // namespace

TEST_CASE("numbers and bytes give the same image, scaled to 255 and rounded") {
    gray_image const expected{3, 2, {0, 128, 255, 17, 34, 51}};
    REQUIRE(read_pgm("P2\n3 2\n255\n0 128 255\n17 34 51\n", "x") == expected);
    REQUIRE(read_pgm("P5\n3 2\n255\n"s + std::string("\x00\x80\xff\x11\x22\x33", 6), "x") == expected);
    REQUIRE(read_pgm("P2 3 2 15 0 8 15 1 2 3", "x").pixels == std::vector<std::uint8_t>{0, 136, 255, 17, 34, 51});
    REQUIRE(read_pgm("P5 1 3 65535 "s + std::string("\x00\x00\x80\x00\xff\xff", 6), "x").pixels == std::vector<std::uint8_t>{0, 128, 255});
    REQUIRE(read_pgm("P2 4 1 1 0 1 1 0", "x").pixels == std::vector<std::uint8_t>{0, 255, 255, 0});
}

TEST_CASE("comments, any line ending and blanks between numbers do not matter") {
    gray_image const expected{2, 1, {1, 2}};
    REQUIRE(read_pgm("P2# made by hand\n# 9 9\n2 # width\n1\r\n255\r1\t2", "x") == expected);
    REQUIRE(read_pgm("P2\n2 1\n255\n1 2 # end", "x") == expected);
    REQUIRE(read_pgm("P5\n# a\n2 1 255\n\1\2", "x") == expected);
    // The first sample may look like a blank or a comment.
    REQUIRE(read_pgm("P5 2 1 255\n# ", "x").pixels == std::vector<std::uint8_t>{'#', ' '});
}

TEST_CASE("what is no graymap, or no whole one, is refused with line and column") {
    REQUIRE(refused("", errc::empty_input));
    REQUIRE(refused("P", errc::wrong_format));
    REQUIRE(refused("\x89PNG", errc::wrong_format));
    for (char const* other : {"P1\n1 1\n0", "P3 1 1 255 0 0 0", "P4 1 1 \0", "P6 1 1 255 abc", "P7\nWIDTH 1"}) REQUIRE(refused(other, errc::unsupported));
    REQUIRE(refused("P2", errc::truncated));
    REQUIRE(refused("P2 2", errc::truncated));
    REQUIRE(refused("P2 0 1 255 ", errc::bad_count));
    REQUIRE(refused("P2 1 1 0 0", errc::bad_count));
    REQUIRE(refused("P2 1 1 65536 0", errc::bad_number));
    REQUIRE(refused("P2 -1 1 255 0", errc::bad_number));
    REQUIRE(refused("P2 1.5 1 255 0", errc::bad_number));
    REQUIRE(refused("P2 2 1 9 1 10", errc::bad_number));
    REQUIRE(refused("P2 2 1 9 1 x", errc::bad_number));
    REQUIRE(refused("P2 2 1 9 1 ", errc::truncated));
    REQUIRE(refused("P2 2 1 9 1 2 3", errc::bad_count));
    REQUIRE(refused("P5 2 1 255\n1", errc::truncated));
    REQUIRE(refused("P5 2 1 255\n123", errc::bad_count));
    REQUIRE(refused("P5 2 1 9\n\1\12", errc::out_of_range));
    // Claims that no file can hold, told before memory is taken.
    REQUIRE(refused("P2 2147483647 2147483647 255 1", errc::bad_count));
    REQUIRE(refused("P5 2147483647 2147483647 255\n1", errc::truncated));
    REQUIRE(refused("P2 4294967296 1 255 1", errc::bad_number));

    auto const f = refusal("P2\n2 2\n255\n0 1\n2 oh\n");
    REQUIRE(f.place.line == 5);
    REQUIRE(f.place.column == 3);
    REQUIRE(tafoni_test::contains(f.what, "read_pgm: x.pgm:5:3: expected a sample, at most 255, got 'oh'"));
}

TEST_CASE("a graymap comes from a file, and a folder is refused") {
    tafoni_test::scratch_folder const folder;
    tafoni_test::put_bytes(folder / "a.pgm", "P2 1 1 255 7");
    REQUIRE(read_pgm(folder / "a.pgm").pixels == std::vector<std::uint8_t>{7});
    REQUIRE(failure_of([&] { return read_pgm(folder / "."); }).code == errc::not_a_file);
    REQUIRE(failure_of([&] { return read_pgm(folder / "none.pgm"); }).code == errc::cannot_open);
}
