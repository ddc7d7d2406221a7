// A MagicaVoxel file from any bytes: an io_error, or models whose voxels lie inside; written, they come back.
#include "check_mesh_file.hpp"

#include <tafoni/io/read_vox.hpp>
#include <tafoni/io/write_vox.hpp>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size) {
    using tafoni_test::require;
    tafoni::vox_file file;
    try {
        file = tafoni::read_vox(std::string_view(reinterpret_cast<char const*>(bytes), size), "fuzz.vox");
    } catch (tafoni::io_error const&) {
        return 0;
    }
    require(!file.models.empty(), "a model");
    for (auto const& m : file.models) {
        for (std::size_t const n : m.size) require(n >= 1 && n <= 256, "a size");
        for (auto const& v : m.voxels) require(v.x < m.size[0] && v.y < m.size[1] && v.z < m.size[2], "voxels inside");
    }
    require(tafoni::read_vox(tafoni::encode_vox(file), "again.vox") == file, "what is written comes back");
    return 0;
}
