// A flat open mesh, and its vertices by row and column.
#ifndef TAFONI_TESTS_SUPPORT_FLAT_SHEET_HPP
#define TAFONI_TESTS_SUPPORT_FLAT_SHEET_HPP

#include "support/curved_surfaces.hpp"

#include <tafoni/core/index.hpp>
#include <tafoni/geometry/triangle_surface.hpp>

#include <cstdint>

namespace tafoni_test {

/// [0, size]^2 of n x n squares at z = 0.
[[nodiscard]] inline tafoni::triangle_surface flat_sheet(std::uint32_t n, double size = 1) {
    return parametric(
               n + 1, n + 1, false, false, 0, [&](double u, double v) { return tafoni::vec3{size * u, size * v, 0}; },
               [](double, double) { return 0.0; })
        .mesh;
}
/// The vertex at i squares along x and j along y.
[[nodiscard]] inline tafoni::vertex_index sheet_vertex(std::uint32_t n, std::uint32_t i, std::uint32_t j) {
    return tafoni::vertex_index{i * (n + 1) + j};
}

}  // namespace tafoni_test

#endif
