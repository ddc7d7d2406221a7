// Files look the same whatever language the host program speaks.
#include <catch2/catch.hpp>

#include <tafoni/io/esri_ascii.hpp>
#include <tafoni/io/obj.hpp>
#include <tafoni/io/ply.hpp>
#include <tafoni/io/stl.hpp>
#include <tafoni/io/vtk_xml.hpp>

#include "file_testing.hpp"

#include <clocale>
#include <locale>

using namespace tafoni;

namespace {

struct comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

/// Everything that is read and written, as one string.
std::string everything() {
    mesh_file const obj = read_obj("v 0.5 1234567.25 1e-300\nv 0.1234567890123456789 1 0\nv 0 1 0\nf 1 2 3\n", "x");
    std::string all = encode_obj(obj.mesh);
    all += encode_ply(obj.mesh, {}, {.encoding = ply_encoding::ascii, .coordinates = coordinate_type::float32, .origin = {0.5, 1234567.5, 0}});
    all += encode_ply(read_ply(encode_ply(obj.mesh, {}, {.encoding = ply_encoding::ascii}), "x").mesh);
    all += encode_stl(obj.mesh, {}, {.origin = {0.5, 1234567.5, 0}});
    all += encode_vtp(obj.mesh);
    pvd_entry const entries[] = {{1234.5, "a.vtp"}};
    all += encode_pvd(entries);
    all += std::to_string(read_esri_ascii("ncols 1\nnrows 1\nxllcorner 1234.5\nyllcorner 0\ncellsize 0.5\n7.25", "x").heights[0] == 7.25);
    all += tafoni_test::failure_of([] { return read_obj("v 1,5 0 0\n", "x"); }).what;
    return all;
}

}  // namespace

TEST_CASE("reading and writing do not depend on the C or C++ locale") {
    std::string const plain = everything();
    std::locale const before = std::locale::global(std::locale(std::locale::classic(), new comma));
    std::string const spoken = everything();
    std::locale::global(before);
    CHECK(spoken == plain);

    bool set = false;
    for (char const* name : {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8", "fr_FR.utf8"}) set = set || std::setlocale(LC_ALL, name) != nullptr;
    if (!set) {
        WARN("no locale with a decimal comma is installed; only the C++ locale was changed");
        return;
    }
    std::string const german = everything();
    std::setlocale(LC_ALL, "C");
    CHECK(german == plain);
}
