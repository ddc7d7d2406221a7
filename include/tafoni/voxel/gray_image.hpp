/// \file
/// A picture in shades of grey, however it was read.
#ifndef TAFONI_VOXEL_GRAY_IMAGE_HPP
#define TAFONI_VOXEL_GRAY_IMAGE_HPP

#include <tafoni/core/error.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tafoni {

/// Pixels row by row, the uppermost row first; 0 is black, 255 white.
struct gray_image {
    std::size_t width = 0;
    std::size_t height = 0;
    std::vector<std::uint8_t> pixels{};

    [[nodiscard]] std::uint8_t at(std::size_t column, std::size_t row) const noexcept {
        return pixels[row * width + column];
    }

    /// \throws invalid_input  `empty_input` for an image without pixels, `size_overflow` for a side beyond
    ///         2^31, `attribute_length` when pixels are not width times height.
    void validate() const {
        constexpr std::size_t longest = std::size_t{1} << 31;
        if (width == 0 || height == 0) detail::fail<invalid_input>(errc::empty_input, "gray_image: it has no pixels");
        if (width > longest || height > longest) {
            detail::fail<invalid_input>(errc::size_overflow, "gray_image: got " + std::to_string(width) + " x " +
                                                                 std::to_string(height) + " pixels, at most 2^31 a side");
        }
        if (pixels.size() != width * height) {
            detail::fail<invalid_input>(errc::attribute_length,
                                        "gray_image: got " + std::to_string(pixels.size()) + " pixels for " +
                                            std::to_string(width) + " x " + std::to_string(height),
                                        {.kind = entity::attribute,
                                         .value = static_cast<double>(pixels.size()),
                                         .limit = static_cast<double>(width * height)});
        }
    }

    friend bool operator==(gray_image const&, gray_image const&) = default;
};

}  // namespace tafoni

#endif
