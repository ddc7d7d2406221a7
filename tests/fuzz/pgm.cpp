// An image from any bytes: an io_error, or a pixel per place.
#include "check_mesh_file.hpp"

#include <tafoni/io/read_pgm.hpp>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size) {
    tafoni::gray_image image;
    try {
        image = tafoni::read_pgm(std::string_view(reinterpret_cast<char const*>(bytes), size), "fuzz.pgm");
    } catch (tafoni::io_error const&) {
        return 0;
    }
    image.validate();
    tafoni_test::require(image.pixels.size() <= size, "no more pixels than bytes");
    return 0;
}
