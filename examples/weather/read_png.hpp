// PNG images, where the tool was built with libpng.
#pragma once

#include <tafoni/voxel/gray_image.hpp>

#include <string>

namespace weather {

/// In shades of grey, on white where it is transparent. \throws tafoni::io_error  also when built without libpng
tafoni::gray_image read_png(std::string const& path);

}  // namespace weather
