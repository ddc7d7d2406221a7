/// \file
/// The voxels whose centres lie in a solid.
#ifndef TAFONI_DECOMPOSITION_VOXELIZE_HPP
#define TAFONI_DECOMPOSITION_VOXELIZE_HPP

#include <tafoni/decomposition/voxel_cells.hpp>
#include <tafoni/geometry/solid.hpp>
#include <tafoni/voxel/detail/row_crossings.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tafoni {

namespace detail {

/// Which voxels of rows along x lie inside.
class inside_rows {
public:
    inside_rows(solid const& body, voxel_cells_options const& grid)
        : rows_("voxelize", {.size = grid.size, .spacing = grid.spacing, .origin = grid.origin}), layer_(grid.size[1]) {
        std::vector<row_crossings::corner> corners;
        corners.reserve(body.positions.size());
        for (vec3 const& p : body.positions) corners.push_back(rows_.place(p));
        for (auto const& t : body.triangles) rows_.add({corners[t[0]], corners[t[1]], corners[t[2]]});
        rows_.sort();
    }

    /// Whether the winding number of a voxel's centre is positive. Ask x fastest, then y, then z.
    [[nodiscard]] bool inside(std::size_t i, std::size_t j, std::size_t k) {
        std::vector<std::uint64_t> const& keys = rows_.keys();
        std::size_t const row = j + layer_ * k;
        if (row != row_) {
            row_ = row;
            winding_ = 0;
            while (next_ < keys.size() && rows_.row_of(keys[next_]) < row) ++next_;
        }
        while (next_ < keys.size() && rows_.row_of(keys[next_]) == row && rows_.first_of(keys[next_]) <= i) {
            winding_ += row_crossings::turn_of(keys[next_++]);
        }
        return winding_ > 0;
    }

private:
    row_crossings rows_;
    std::size_t layer_;
    std::size_t row_ = ~std::size_t{0};
    std::size_t next_ = 0;
    int winding_ = 0;
};

struct voxelize_fn {
    /// Rock where the winding number of a voxel's centre is positive, so that cavities are air and shells
    /// that overlap are one rock. Same bits everywhere. O(voxels + crossings log crossings).
    /// \throws invalid_input  as `voxel_cells_options::validate`; `out_of_range` for a solid 2^38 voxels away.
    [[nodiscard]] voxel_cells operator()(solid const& body, voxel_cells_options const& grid) const {
        grid.validate();
        inside_rows rows(body, grid);
        return voxel_cells::from_indices(
            grid, [&](std::size_t i, std::size_t j, std::size_t k) { return rows.inside(i, j, k); });
    }

    /// Cubes of edge `spacing` over the solid's box, with the box in the middle.
    [[nodiscard]] voxel_cells operator()(solid const& body, double spacing) const {
        require_range("voxelize: spacing", spacing, std::numeric_limits<double>::min(), 1e100);
        voxel_cells_options grid{.spacing = {spacing, spacing, spacing}};
        vec3 const extent = body.bounds.extent();
        for (int d = 0; d < 3; ++d) {
            double const n = std::max(1.0, std::ceil(extent[d] / spacing));
            require_range("voxelize: voxels along an axis", n, 1, 0x1p31);
            grid.size[static_cast<std::size_t>(d)] = static_cast<std::size_t>(n);
            grid.origin[d] = body.bounds.lo[d] - 0.5 * (n * spacing - extent[d]);
        }
        return (*this)(body, grid);
    }
};

}  // namespace detail

/// `voxelize(solid, grid)` or `voxelize(solid, spacing)`.
inline constexpr detail::voxelize_fn voxelize{};

}  // namespace tafoni

#endif
