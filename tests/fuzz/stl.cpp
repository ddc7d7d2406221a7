// STL from any bytes: an io_error, or a valid mesh that is written and read back to the same bytes.
#include "check_mesh_file.hpp"

#include <tafoni/io/stl.hpp>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size) {
    tafoni::mesh_file file;
    std::string once;
    try {
        file = tafoni::read_stl(std::string_view(reinterpret_cast<char const*>(bytes), size), "fuzz.stl");
        tafoni_test::check_mesh_file(file);
        once = tafoni::encode_stl(file.mesh, file.attributes);
    } catch (tafoni::io_error const&) {
        return 0;
    }
    tafoni::mesh_file const again = tafoni::read_stl(once, "again.stl");
    tafoni_test::check_mesh_file(again);
    tafoni_test::require(tafoni::encode_stl(again.mesh, again.attributes) == once, "writing what was read changes nothing");
    return 0;
}
