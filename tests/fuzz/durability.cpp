// A durability profile from any bytes: an io_error, or corners that make a valid field.
#include "check_mesh_file.hpp"

#include <tafoni/io/read_durability.hpp>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size) {
    tafoni::durability_table table;
    try {
        table = tafoni::read_durability(std::string_view(reinterpret_cast<char const*>(bytes), size), "fuzz.txt");
    } catch (tafoni::io_error const& e) {
        tafoni_test::require(e.place().line > 0 || e.place().index <= size, "an error names its place");
        return 0;
    }
    tafoni_test::require(table.points.size() <= size / 3 + 1, "no more corners than bytes make");
    tafoni::durability_profile<> profile{.points = table.points};
    profile.validate();
    double const value = profile({0.3, -0.7, table.points.front().altitude});
    tafoni_test::require(value >= profile.floor && value <= 1e151, "durability in range");
    return 0;
}
