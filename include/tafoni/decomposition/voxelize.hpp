/// \file
/// The voxels whose centres lie in a solid.
#ifndef TAFONI_DECOMPOSITION_VOXELIZE_HPP
#define TAFONI_DECOMPOSITION_VOXELIZE_HPP

#include <tafoni/decomposition/voxel_cells.hpp>
#include <tafoni/geometry/solid.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

namespace tafoni {

namespace detail {

/// Winding numbers along rows of voxels, from signed crossings of the surface.
///
/// Along y and z vertices are rounded to 2^-20 of a voxel, and rows pass between the rounded places, so
/// that triangles that share an edge agree exactly on the rows they leave to each other: no row leaks.
class row_crossings {
public:
    row_crossings(solid const& body, voxel_cells_options const& grid) : grid_(grid) {
        std::vector<corner> corners;
        corners.reserve(body.positions.size());
        for (vec3 const& p : body.positions) corners.push_back(place(p));
        for (auto const& t : body.triangles) add({corners[t[0]], corners[t[1]], corners[t[2]]});
        std::sort(crossings_.begin(), crossings_.end());
    }

    /// Whether the winding number of a voxel's centre is positive. Ask x fastest, then y, then z.
    [[nodiscard]] bool inside(std::size_t i, std::size_t j, std::size_t k) {
        std::size_t const row = j + grid_.size[1] * k;
        if (row != row_) {
            row_ = row;
            winding_ = 0;
            while (next_ < crossings_.size() && crossings_[next_].row < row) ++next_;
        }
        while (next_ < crossings_.size() && crossings_[next_].row == row && crossings_[next_].first <= i) {
            winding_ += crossings_[next_++].turn;
        }
        return winding_ > 0;
    }

private:
    __extension__ using wide = __int128;
    static constexpr std::int64_t one = std::int64_t{1} << 21;  ///< of a voxel
    static constexpr double most = 0x1p38;                      ///< voxels from the origin

    struct corner {
        double x;           ///< in voxels
        std::int64_t y, z;  ///< in units of 1 / one, even
    };
    struct crossing {
        std::size_t row;
        std::size_t first;  ///< voxel beyond the surface
        int turn;
        friend bool operator<(crossing const& a, crossing const& b) {
            return std::tie(a.row, a.first, a.turn) < std::tie(b.row, b.first, b.turn);
        }
    };

    [[nodiscard]] corner place(vec3 const& p) const {
        double u[3];
        for (int d = 0; d < 3; ++d) {
            u[d] = (p[d] - grid_.origin[d]) / grid_.spacing[d];
            if (!(std::fabs(u[d]) < most)) {
                fail<invalid_input>(errc::out_of_range, "voxelize: the solid lies too far from the grid, in voxels",
                                    {.kind = entity::vertex, .value = u[d], .limit = most});
            }
        }
        auto const even = [](double x) { return 2 * static_cast<std::int64_t>(std::floor(x * (one / 2) + 0.5)); };
        return {u[0], even(u[1]), even(u[2])};
    }
    /// Between any two even places; the centre of line n but for 2^-21 of a voxel.
    [[nodiscard]] static std::int64_t line(std::int64_t n) { return n * one + one / 2 + 1; }
    /// The first line beyond `at`, no less than 0.
    [[nodiscard]] static std::int64_t first_line_after(std::int64_t at) {
        std::int64_t const n = at - one / 2;
        return n <= 0 ? 0 : (n + one - 1) / one;
    }

    /// Where an edge that crosses the plane z leads: exact threshold of rows, and the place in double.
    struct cut {
        std::int64_t row;
        double x, y;
    };
    [[nodiscard]] static cut cut_edge(corner p, corner q, std::int64_t z) {
        if (q.z < p.z) std::swap(p, q);
        wide const height = q.z - p.z;
        wide const over = wide{q.y - p.y} * (z - p.z);
        wide floor = over / height;
        if (floor * height > over) --floor;
        double const t = static_cast<double>(z - p.z) / static_cast<double>(q.z - p.z);
        double const y = static_cast<double>(p.y) + t * static_cast<double>(q.y - p.y);
        return {first_line_after(p.y + static_cast<std::int64_t>(floor)), p.x + t * (q.x - p.x), y};
    }

    void add(std::array<corner, 3> const& t) {
        auto const [z_lo, z_hi] = std::minmax({t[0].z, t[1].z, t[2].z});
        auto const [x_lo, x_hi] = std::minmax({t[0].x, t[1].x, t[2].x});
        auto const layers = static_cast<std::int64_t>(grid_.size[2]);
        for (std::int64_t k = first_line_after(z_lo); k < layers && line(k) < z_hi; ++k) {
            std::int64_t const z = line(k);
            cut up{};
            cut down{};
            for (std::size_t e = 0; e < 3; ++e) {
                corner const& p = t[e];
                corner const& q = t[(e + 1) % 3];
                if ((p.z < z) == (q.z < z)) continue;
                (p.z < z ? up : down) = cut_edge(p, q, z);
            }
            // An edge that runs up has the triangle on its left: the normal points along x where `up` is the larger y.
            cut const& a = up.row < down.row ? up : down;
            cut const& b = up.row < down.row ? down : up;
            int const turn = up.row < down.row ? 1 : -1;
            auto const rows = std::min(b.row, static_cast<std::int64_t>(grid_.size[1]));
            for (std::int64_t j = a.row; j < rows; ++j) {
                double const s = b.y > a.y ? (static_cast<double>(line(j)) - a.y) / (b.y - a.y) : 0.5;
                double const x = std::clamp(a.x + s * (b.x - a.x), x_lo, x_hi);
                double const first = std::clamp(std::floor(x + 0.5), 0.0, static_cast<double>(grid_.size[0]));
                crossings_.push_back({static_cast<std::size_t>(j) + grid_.size[1] * static_cast<std::size_t>(k),
                                      static_cast<std::size_t>(first), turn});
            }
        }
    }

    voxel_cells_options grid_;
    std::vector<crossing> crossings_{};
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
        row_crossings rows(body, grid);
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
