// PLY from any bytes: an io_error, or a valid mesh that is written and read back to the same bytes.
#include "check_mesh_file.hpp"

#include <tafoni/io/ply.hpp>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size) {
    tafoni::mesh_file file;
    try {
        file = tafoni::read_ply(std::string_view(reinterpret_cast<char const*>(bytes), size), "fuzz.ply");
    } catch (tafoni::io_error const&) {
        return 0;
    }
    tafoni_test::check_mesh_file(file);
    tafoni::write_ply_options options;
    options.encoding = static_cast<tafoni::ply_encoding>(size % 3);
    std::string const once = tafoni::encode_ply(file.mesh, file.attributes, options);
    tafoni::mesh_file const again = tafoni::read_ply(once, "again.ply");
    tafoni_test::check_mesh_file(again);
    tafoni_test::require(tafoni::encode_ply(again.mesh, again.attributes, options) == once,
                         "writing what was read changes nothing");
    return 0;
}
