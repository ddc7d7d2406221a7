/// \file
/// Fills a grid of voxels with a silhouette, swept or revolved into a column.
#ifndef TAFONI_VOXEL_FILL_FROM_IMAGE_HPP
#define TAFONI_VOXEL_FILL_FROM_IMAGE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/detail/fill_bricks.hpp>
#include <tafoni/voxel/gray_image.hpp>
#include <tafoni/voxel/grid_frame.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

namespace tafoni {

/// How a flat picture becomes a column [Jones et al., Figure 7a].
enum class image_sweep : std::uint8_t {
    along_y,             ///< the picture stands in x and z and is drawn out along y
    around_middle,       ///< it turns around its vertical middle: what is dark on either side is rock
    around_left_edge     ///< it is half a silhouette and turns around its left edge
};

struct image_options {
    image_sweep sweep = image_sweep::around_middle;
    std::uint8_t darkest_air = 128;  ///< pixels below are rock
    std::size_t resolution = 0;      ///< of `frame_for_image`: voxels along the column's longest side; 0: a pixel's edge
    std::size_t depth = 0;           ///< of `frame_for_image`, for `along_y`: voxels along y; 0: as many as along x
    std::size_t padding = 1;         ///< of `frame_for_image`: voxels of air on each side but the bottom
};

namespace detail {

struct image_extent {
    double width;   ///< of the column, in pixels
    double height;
};
[[nodiscard]] inline image_extent extent_of(gray_image const& image, image_options const& options) {
    image.validate();
    if (options.sweep > image_sweep::around_left_edge) {
        fail<invalid_input>(errc::bad_parameter, "image_options.sweep: got " + std::to_string(static_cast<int>(options.sweep)),
                            {.kind = entity::parameter, .value = static_cast<double>(options.sweep), .limit = 2});
    }
    auto const width = static_cast<double>(image.width);
    return {options.sweep == image_sweep::around_left_edge ? 2 * width : width, static_cast<double>(image.height)};
}

struct frame_for_image_fn {
    /// Cubes of edge 1 for the column of an image, its base centred on the origin.
    ///
    /// With `resolution` 0 a voxel is a pixel; else the longest side of the column (padding left out) takes so
    /// many voxels, and each looks up the pixel that its centre falls into: nothing is interpolated.
    /// \throws invalid_input  as `gray_image::validate`; `bad_parameter`; `size_overflow`.
    [[nodiscard]] grid_frame operator()(gray_image const& image, image_options const& options = {}) const {
        image_extent const pixels = extent_of(image, options);
        double const longest = static_cast<double>(grid_frame::longest);
        require_range("image_options.resolution", static_cast<double>(options.resolution), 0, longest);
        require_range("image_options.depth", static_cast<double>(options.depth), 0, longest);
        require_range("image_options.padding", static_cast<double>(options.padding), 0, longest);
        double const scale = options.resolution == 0
                                 ? 1.0
                                 : static_cast<double>(options.resolution) / std::max(pixels.width, pixels.height);
        auto const voxels = [&](double n) { return static_cast<std::size_t>(std::max(1.0, std::ceil(n * scale * (1 - 0x1p-40)))); };
        std::size_t const wide = voxels(pixels.width);
        std::size_t const deep = options.sweep == image_sweep::along_y && options.depth != 0 ? options.depth : wide;
        grid_frame frame{.size = {wide + 2 * options.padding, deep + 2 * options.padding,
                                  voxels(pixels.height) + options.padding}};
        frame.origin = vec3{-0.5 * static_cast<double>(frame.size[0]), -0.5 * static_cast<double>(frame.size[1]), 0};
        frame.validate();
        return frame;
    }
};

struct fill_from_image_fn {
    /// Rock where the image is dark, air elsewhere, in the user's axes (z up). The column stands on the bottom
    /// of the grid, in the middle of x and y: the padding is taken off the sides and the top, as `frame_for_image`
    /// added it, and the image is stretched over the rest, its lowest row at the bottom. Each voxel takes the
    /// pixel that its centre falls into. Returns the voxels of rock. O(voxels).
    /// \throws invalid_input  as `gray_image::validate`, `grid_frame::validate`; `bad_parameter`;
    ///         `empty_input` for a grid no larger than its padding. The grid is then as it was.
    template <editable_voxel_grid G>
    std::size_t operator()(G& grid, gray_image const& image, image_options const& options = {}) const {
        grid_frame const frame = frame_of(grid);
        frame.validate();
        image_extent const pixels = extent_of(image, options);
        std::size_t const pad = options.padding;
        if (pad >= frame.size[2] || frame.size[0] < 2 * pad + 1 || frame.size[1] < 2 * pad + 1) {
            fail<invalid_input>(errc::empty_input, "fill_from_image: the grid has no voxels besides " + std::to_string(pad) +
                                                       " of padding", {.kind = entity::parameter, .value = static_cast<double>(pad)});
        }
        double const wide = static_cast<double>(frame.size[0] - 2 * pad);
        double const tall = static_cast<double>(frame.size[2] - pad);
        // Pixels per voxel; revolved about the axis, lengths along y are measured as along x.
        double const per_x = pixels.width / wide;
        double const per_y = per_x * std::min(frame.spacing[1] / frame.spacing[0], 1e100);
        double const middle_x = 0.5 * static_cast<double>(frame.size[0]);
        double const middle_y = 0.5 * static_cast<double>(frame.size[1]);
        auto const dark = [&](double column, std::size_t row) {
            if (!(column >= 0 && column < static_cast<double>(image.width))) return false;
            return image.at(static_cast<std::size_t>(column), row) < options.darkest_air;
        };
        return fill_voxels(grid, [&](voxel v) {
            auto const z = static_cast<std::size_t>(v.z);
            if (z >= frame.size[2] - pad) return false;
            double const above = std::floor((static_cast<double>(v.z) + 0.5) * (pixels.height / tall));
            std::size_t const row = image.height - 1 - std::min(static_cast<std::size_t>(above), image.height - 1);
            double const x = (static_cast<double>(v.x) + 0.5 - middle_x) * per_x;
            double const y = (static_cast<double>(v.y) + 0.5 - middle_y) * per_y;
            double const half = 0.5 * pixels.width;
            if (options.sweep == image_sweep::along_y) {
                bool const inside = static_cast<std::size_t>(v.y) >= pad && static_cast<std::size_t>(v.y) < frame.size[1] - pad;
                return inside && dark(std::floor(half + x), row);
            }
            double const r = std::sqrt(x * x + y * y);
            if (options.sweep == image_sweep::around_left_edge) return dark(std::floor(r), row);
            double const column = std::floor(half + r);
            return dark(column, row) || dark(pixels.width - 1 - column, row);
        });
    }
};

}  // namespace detail

/// `frame_for_image(image, options)`; see `detail::frame_for_image_fn`.
inline constexpr detail::frame_for_image_fn frame_for_image{};
/// `fill_from_image(grid, image, options)`; see `detail::fill_from_image_fn`.
inline constexpr detail::fill_from_image_fn fill_from_image{};

}  // namespace tafoni

#endif
