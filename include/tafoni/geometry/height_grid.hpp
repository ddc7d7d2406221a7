/// \file
/// A regular grid of heights, as elevation models come: rows from north to south.
#ifndef TAFONI_GEOMETRY_HEIGHT_GRID_HPP
#define TAFONI_GEOMETRY_HEIGHT_GRID_HPP

#include <tafoni/core/vector.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tafoni {

/// Which point of the lower left (south-west) cell `lower_left_x/y` names.
enum class grid_registration : std::uint8_t {
    corner,  ///< its outer corner (ESRI xllcorner, yllcorner)
    centre   ///< its centre, where the height is measured (ESRI xllcenter, yllcenter)
};

/// Heights at the centres of the cells of a grid; x runs east, y north, z up, all in one length unit.
///
/// `heights` holds rows * columns values, row-major, the northernmost row first. `missing` is empty
/// (nothing is missing) or has as many entries, 1 where there is no height (NODATA).
struct height_grid {
    std::size_t columns = 0;
    std::size_t rows = 0;
    double cell_size_x = 1;  ///< > 0
    double cell_size_y = 1;  ///< > 0
    double lower_left_x = 0;
    double lower_left_y = 0;
    grid_registration registration = grid_registration::corner;
    std::vector<double> heights{};
    std::vector<std::uint8_t> missing{};

    [[nodiscard]] bool has_height(std::size_t row, std::size_t column) const noexcept {
        return missing.empty() || missing[row * columns + column] == 0;
    }
    [[nodiscard]] double height(std::size_t row, std::size_t column) const noexcept {
        return heights[row * columns + column];
    }
    /// Where the height of (row, column) is measured. The row counts from the north.
    [[nodiscard]] vec3 position(std::size_t row, std::size_t column) const noexcept {
        double const shift = registration == grid_registration::corner ? 0.5 : 0.0;
        return vec3{lower_left_x + (static_cast<double>(column) + shift) * cell_size_x,
                    lower_left_y + (static_cast<double>(rows - 1 - row) + shift) * cell_size_y,
                    height(row, column)};
    }

    friend bool operator==(height_grid const&, height_grid const&) = default;
};

}  // namespace tafoni

#endif
