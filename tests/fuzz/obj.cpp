// OBJ from any bytes: an io_error, or a valid mesh that is written and read back to the same bytes.
#include "check_mesh_file.hpp"

#include <tafoni/io/obj.hpp>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size) {
    tafoni::mesh_file file;
    try {
        file = tafoni::read_obj(std::string_view(reinterpret_cast<char const*>(bytes), size), "fuzz.obj");
    } catch (tafoni::io_error const&) {
        return 0;
    }
    tafoni_test::check_mesh_file(file);
    std::string const once = tafoni::encode_obj(file.mesh, file.attributes);
    if (once.empty()) return 0;
    tafoni::mesh_file const again = tafoni::read_obj(once, "again.obj");
    tafoni_test::require(tafoni::encode_obj(again.mesh, again.attributes) == once, "writing what was read changes nothing");
    return 0;
}
