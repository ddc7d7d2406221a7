// An elevation grid from any bytes: an io_error, or a grid whose arrays have the size that it claims.
#include "check_mesh_file.hpp"

#include <tafoni/io/esri_ascii.hpp>

#include <cmath>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size) {
    using tafoni_test::require;
    tafoni::height_grid grid;
    try {
        grid = tafoni::read_esri_ascii(std::string_view(reinterpret_cast<char const*>(bytes), size), "fuzz.asc");
    } catch (tafoni::io_error const&) {
        return 0;
    }
    require(grid.columns > 0 && grid.rows > 0 && grid.heights.size() == grid.columns * grid.rows, "a height per cell");
    require(grid.missing.empty() || grid.missing.size() == grid.heights.size(), "a mark per cell");
    require(grid.cell_size_x > 0 && grid.cell_size_y > 0, "cells have a size");
    for (std::size_t i = 0; i < grid.heights.size(); ++i) {
        require(std::isfinite(grid.heights[i]) || (!grid.missing.empty() && grid.missing[i] == 1), "heights are finite");
    }
    return 0;
}
