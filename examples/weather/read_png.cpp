#include "read_png.hpp"

#include "input.hpp"

#include <tafoni/core/error.hpp>

#ifdef WEATHER_WITH_PNG
#include <png.h>
#endif

namespace weather {

namespace {

[[noreturn]] void refuse(std::string const& path, tafoni::errc code, std::string const& why) {
    tafoni::detail::fail<tafoni::io_error>(code, "read_png: " + path + ": " + why, {.kind = tafoni::entity::file, .file = path});
}

}  // namespace

#ifdef WEATHER_WITH_PNG

tafoni::gray_image read_png(std::string const& path) {
    std::string const bytes = load_bytes(path);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) refuse(path, tafoni::errc::wrong_format, image.message);
    struct release {
        png_image* image;
        ~release() { png_image_free(image); }
    } const held{&image};
    // A few bytes may claim a picture that no memory holds.
    std::uint64_t const pixels = std::uint64_t{image.width} * image.height;
    if (pixels > std::uint64_t{1} << 28) refuse(path, tafoni::errc::size_overflow, "more than 2^28 pixels");
    image.format = PNG_FORMAT_GRAY;
    tafoni::gray_image out{.width = image.width, .height = image.height, .pixels = std::vector<std::uint8_t>(pixels)};
    png_color const white{255, 255, 255};
    if (png_image_finish_read(&image, &white, out.pixels.data(), 0, nullptr) == 0) refuse(path, tafoni::errc::truncated, image.message);
    return out;
}

#else

tafoni::gray_image read_png(std::string const& path) {
    refuse(path, tafoni::errc::unsupported, "this tool was built without libpng (libpng-dev); convert the image to .pgm");
}

#endif

}  // namespace weather
