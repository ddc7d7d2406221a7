// A volume from any bytes: an io_error, or a frame that holds and a sample per voxel.
#include "check_mesh_file.hpp"

#include <tafoni/io/read_nrrd.hpp>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size) {
    tafoni::sample_volume volume;
    try {
        volume = tafoni::read_nrrd(std::string_view(reinterpret_cast<char const*>(bytes), size), "fuzz.nrrd");
    } catch (tafoni::io_error const&) {
        return 0;
    }
    volume.validate();
    tafoni_test::require(volume.samples.size() <= size, "no more samples than bytes");
    return 0;
}
