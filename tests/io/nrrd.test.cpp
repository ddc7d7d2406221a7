#include <catch2/catch.hpp>

#include "file_testing.hpp"

#include <support/test_data.hpp>

#include <tafoni/io/detail/format_number.hpp>
#include <tafoni/io/read_nrrd.hpp>
#include <tafoni/voxel/fill_from_samples.hpp>

#include <algorithm>

using namespace tafoni;
using tafoni_test::failure_of;
using namespace std::string_literals;

namespace {

std::string header(std::string const& type, std::string const& more = "", std::string const& sizes = "2 1 2") {
    return "NRRD0004\n# a comment\ntype: " + type + "\ndimension: 3\nsizes: " + sizes + "\nencoding: raw\n" + more + "\n";
}
bool refused(std::string const& bytes, errc code) {
    auto const f = failure_of([&] { return read_nrrd(bytes, "x.nrrd"); });
    INFO(f.what);
    CHECK(f.happened);
    CHECK(f.code == code);
    CHECK(tafoni_test::contains(f.what, "read_nrrd: x.nrrd:"));
    return f.happened && f.code == code;
}
template <class T>
std::string bytes_of(std::initializer_list<T> values, bool big) {
    std::string r;
    for (T const v : values) {
        std::string one;
        detail::append_little(one, v);
        if (big) std::reverse(one.begin(), one.end());
        r += one;
    }
    return r;
}

}  // namespace

TEST_CASE("samples of every type and byte order are read") {
    for (bool const big : {false, true}) {
        std::string const order = big ? "endian: big\n" : "endian: little\n";
        auto const read = [&](char const* type, std::string const& data) { return read_nrrd(header(type, order) + data, "x").samples; };
        using samples = std::vector<float>;
        REQUIRE(read("uint8", "\1\2\xff\0"s) == samples{1, 2, 255, 0});
        REQUIRE(read("signed char", "\1\2\xff\x80"s) == samples{1, 2, -1, -128});
        REQUIRE(read("short", bytes_of<std::int16_t>({-2, 1, 300, -32768}, big)) == samples{-2, 1, 300, -32768});
        REQUIRE(read("unsigned short", bytes_of<std::uint16_t>({2, 1, 300, 65535}, big)) == samples{2, 1, 300, 65535});
        REQUIRE(read("int", bytes_of<std::int32_t>({-70000, 1, 0, 1 << 30}, big)) == samples{-70000, 1, 0, 1 << 30});
        REQUIRE(read("uint32_t", bytes_of<std::uint32_t>({70000, 1, 0, 1U << 31}, big)) == samples{70000, 1, 0, 2147483648.0F});
        REQUIRE(read("float", bytes_of<float>({-1.5F, 1e-30F, 0, 3e30F}, big)) == samples{-1.5F, 1e-30F, 0, 3e30F});
        REQUIRE(read("double", bytes_of<double>({-1.5, 0.1, 0, 1e30}, big)) == samples{-1.5F, 0.1F, 0, 1e30F});
    }
}

TEST_CASE("without places voxels are unit cubes from the origin; with them the first sample is where the file says") {
    sample_volume const plain = read_nrrd(header("uchar") + "abcd", "x");
    REQUIRE(plain.frame.size == std::array<std::size_t, 3>{2, 1, 2});
    REQUIRE(plain.frame.spacing == vec3{1, 1, 1});
    REQUIRE(plain.frame.origin == vec3{0, 0, 0});
    REQUIRE_FALSE(plain.placed);
    REQUIRE(plain.at(1, 0, 0) == 'b');
    REQUIRE(plain.at(0, 0, 1) == 'c');

    sample_volume const spaced = read_nrrd(header("uchar", "spacings: 0.5 2 4\nspace origin: (1,2,3)\n") + "abcd", "x");
    REQUIRE(spaced.frame.spacing == vec3{0.5, 2, 4});
    REQUIRE(spaced.frame.centre({0, 0, 0}) == vec3{1, 2, 3});
    REQUIRE(spaced.placed);

    // An axis that runs backwards is turned round: the first sample stays where it is.
    sample_volume const turned = read_nrrd(header("uchar", "space: left-posterior-superior\nspace directions: (-0.5,0,0) (0, 2 ,0) (0,0,4)\nspace origin: (1,2,3)\n") + "abcd", "x");
    REQUIRE(turned.frame.spacing == vec3{0.5, 2, 4});
    REQUIRE(turned.frame.centre({1, 0, 0}) == vec3{1, 2, 3});
    REQUIRE(turned.at(1, 0, 0) == 'a');
    REQUIRE(turned.at(0, 0, 0) == 'b');
    REQUIRE(turned.at(1, 0, 1) == 'c');
}

TEST_CASE("line ends of Windows, the user's keys, unknown fields and capitals do not matter") {
    std::string const bytes = "NRRD0001\r\nType: uchar\r\ncontent: a: b\r\nmy key:=some value\r\nDIMENSION: 3 \r\nsizes:2 1  2\r\nencoding: raw\r\nline skip: 0\r\n\r\nabcd";
    REQUIRE(read_nrrd(bytes, "x").samples == std::vector<float>{'a', 'b', 'c', 'd'});
}

TEST_CASE("what is no such volume, or no whole one, is refused with its place") {
    REQUIRE(refused("", errc::empty_input));
    REQUIRE(refused("NRR", errc::truncated));
    REQUIRE(refused("NRDD0004\n", errc::wrong_format));
    REQUIRE(refused("NRRD0009\n", errc::unsupported));
    REQUIRE(refused("NRRD0004\ntype: uchar\n", errc::truncated));
    REQUIRE(refused("NRRD0004\n\nabcd", errc::bad_syntax));
    REQUIRE(refused("NRRD0004\nno colon\n\n", errc::bad_syntax));
    REQUIRE(refused(header("uchar", "type: uchar\n") + "abcd", errc::bad_syntax));
    REQUIRE(refused(header("long long int") + "abcd", errc::unsupported));
    REQUIRE(refused(header("block") + "abcd", errc::unsupported));
    REQUIRE(refused(header("short") + "abcdefgh", errc::bad_syntax));  // no byte order
    REQUIRE(refused(header("short", "endian: middle\n") + "abcdefgh", errc::bad_syntax));
    for (char const* const coded : {"gzip", "gz", "ascii", "txt", "hex", "bzip2"}) {
        REQUIRE(refused("NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 1 2\nencoding: "s + coded + "\n\nabcd", errc::unsupported));
    }
    REQUIRE(refused(header("uchar", "data file: a.raw\n"), errc::unsupported));
    REQUIRE(refused(header("uchar", "datafile: a.raw\n"), errc::unsupported));
    REQUIRE(refused(header("uchar", "byte skip: -1\n") + "abcd", errc::unsupported));
    REQUIRE(refused("NRRD0004\ntype: uchar\ndimension: 2\nsizes: 2 2\nencoding: raw\n\nabcd", errc::unsupported));
    REQUIRE(refused(header("uchar", "", "2 2") + "abcd", errc::bad_number));
    REQUIRE(refused(header("uchar", "", "2 1 2 1") + "abcd", errc::bad_count));
    REQUIRE(refused(header("uchar", "", "2 0 2") + "abcd", errc::bad_count));
    REQUIRE(refused(header("uchar", "", "2 -1 2") + "abcd", errc::bad_number));
    REQUIRE(refused(header("uchar", "", "2 1.5 2") + "abcd", errc::bad_number));
    REQUIRE(refused(header("uchar", "", "4294967295 4294967295 4294967295") + "abcd", errc::bad_count));
    REQUIRE(refused(header("uchar", "", "1048576 1048576 1048576") + "abcd", errc::truncated));
    REQUIRE(refused(header("double", "endian: little\n", "1048576 1048576 1048576") + "abcd", errc::truncated));
    REQUIRE(refused(header("uchar") + "abc", errc::truncated));
    REQUIRE(refused(header("uchar") + "abcde", errc::bad_count));
    REQUIRE(refused(header("short", "endian: big\n") + "abcdefg", errc::truncated));
    REQUIRE(refused(header("short", "endian: big\n") + "abcdefghi", errc::bad_count));
    for (char const* const s : {"1 1 0", "1 1 -1", "1 1 1e200", "1 1 1e-200"}) REQUIRE(refused(header("uchar", "spacings: "s + s + "\n") + "abcd", errc::out_of_range));
    for (char const* const s : {"1 1 nan", "1 1 x", "1 1.5f 1"}) REQUIRE(refused(header("uchar", "spacings: "s + s + "\n") + "abcd", errc::bad_number));
    REQUIRE(refused(header("uchar", "spacings: 1 1\n") + "abcd", errc::bad_count));
    REQUIRE(refused(header("uchar", "spacings: 1 1 1 1\n") + "abcd", errc::bad_count));
    REQUIRE(refused(header("uchar", "spacings: 1,5 1 1\n") + "abcd", errc::bad_count));
    REQUIRE(refused(header("uchar", "space directions: (1,0,0) (0,1,0.1) (0,0,1)\n") + "abcd", errc::unsupported));
    REQUIRE(refused(header("uchar", "space directions: none (0,1,0) (0,0,1)\n") + "abcd", errc::bad_number));
    REQUIRE(refused(header("uchar", "spacings: 1 1 1\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n") + "abcd", errc::bad_syntax));
    REQUIRE(refused(header("uchar", "space origin: (1e200,0,0)\n") + "abcd", errc::out_of_range));

    auto const f = failure_of([&] { return read_nrrd(header("uchar", "spacings: 1 1 x\n") + "abcd", "x.nrrd"); });
    REQUIRE(f.place.line == 7);
    REQUIRE(f.place.column == 15);
}

TEST_CASE("every shorter length of a whole volume is refused") {
    std::string const bytes = header("float", "endian: little\nspacings: 1 1 1\n") + std::string(16, 'x');
    REQUIRE(read_nrrd(bytes, "x").samples.size() == 4);
    for (std::size_t n = 0; n < bytes.size(); ++n) REQUIRE(failure_of([&] { return read_nrrd(std::string_view(bytes).substr(0, n), "x"); }).happened);
}

TEST_CASE("real volumes hold as many voxels as their makers counted") {
    struct real { char const* name; float least; std::size_t voxels; };
    for (real const& r : {real{"volumes/itokawa_solid.nrrd", 1, 78197}, real{"volumes/nefertiti_solid.nrrd", 1, 182190},
                          real{"volumes/goathead_layered.nrrd", 120, 202837}}) {
        auto const path = tafoni_test::find(r.name);
        if (path.empty()) {
            WARN("skipped: no data");
            return;
        }
        sample_volume const volume = read_nrrd(path);
        sparse_grid grid(volume.frame);
        REQUIRE(fill_from_samples(grid, volume, r.least) == r.voxels);
        REQUIRE(fill_from_samples(grid, volume, 255.0F) == 0);
    }
}
