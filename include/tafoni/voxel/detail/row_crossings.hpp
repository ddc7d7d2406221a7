/// \file
/// Where rows of voxels cross a surface, so exactly that no row leaks.
#ifndef TAFONI_VOXEL_DETAIL_ROW_CROSSINGS_HPP
#define TAFONI_VOXEL_DETAIL_ROW_CROSSINGS_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/voxel/grid_frame.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// The axes of a grid as rows see them: `axis[0]` runs along a row, the other two tell rows apart.
/// Cyclic, so that triangles keep their sides; voxels are numbered backwards along a mirrored axis.
struct row_axes {
    std::array<std::uint8_t, 3> axis{0, 1, 2};
    std::array<bool, 3> mirrored{false, false, false};

    /// Rows along the turned z, told apart by the turned x and y.
    [[nodiscard]] static row_axes along_up(up_rotation const& r) noexcept {
        return {{r.axis[2], r.axis[0], r.axis[1]}, {r.mirrored[2], r.mirrored[0], r.mirrored[1]}};
    }
};

/// Winding numbers along rows of voxels, from signed crossings of a closed chain of triangles.
///
/// Across the rows vertices are rounded to 2^-20 of a voxel, and rows pass between the rounded places, so
/// that triangles that share an edge agree exactly on the rows they leave to each other: no row leaks.
class row_crossings {
public:
    static constexpr std::int64_t one = std::int64_t{1} << 21;  ///< of a voxel

    struct corner {
        double x = 0;        ///< along the row, in voxels
        std::int64_t y = 0;  ///< in units of 1 / one, even
        std::int64_t z = 0;
    };

    row_crossings(char const* who, grid_frame const& frame, row_axes const& axes = {})
        : who_(who), frame_(frame), axes_(axes) {
        for (std::size_t d = 0; d < 3; ++d) size_[d] = static_cast<std::int64_t>(frame.size[axes.axis[d]]);
        first_bits_ = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(size_[0])));
    }

    /// \throws invalid_input  `out_of_range` for a place 2^38 voxels away.
    [[nodiscard]] corner place(vec3 const& p) const {
        std::array<double, 3> u{};
        for (std::size_t d = 0; d < 3; ++d) {
            auto const a = static_cast<Eigen::Index>(axes_.axis[d]);
            u[d] = (p[a] - frame_.origin[a]) / frame_.spacing[a];
            if (!(std::fabs(u[d]) < most)) {
                fail<invalid_input>(errc::out_of_range,
                                    std::string(who_) + ": the surface lies too far from the grid, in voxels",
                                    {.kind = entity::vertex, .value = u[d], .limit = most});
            }
        }
        return {u[0], even(u[1]), even(u[2])};
    }

    /// O(rows that the triangle crosses).
    void add(std::array<corner, 3> const& t) {
        auto const [z_lo, z_hi] = std::minmax({t[0].z, t[1].z, t[2].z});
        auto const [x_lo, x_hi] = std::minmax({t[0].x, t[1].x, t[2].x});
        for (std::int64_t k = first_line_after(z_lo); k < size_[2] && line(k) < z_hi; ++k) {
            layer const at = cut_layer(t, line(k));
            auto const rows = std::min(at.b.row, size_[1]);
            for (std::int64_t j = at.a.row; j < rows; ++j) push(j, k, beyond(at, j, x_lo, x_hi), at.turn);
        }
    }
    /// Call after the last `add`. O(n log n).
    void sort() { std::sort(keys_.begin(), keys_.end()); }

    /// Crossings in the order of rows (j + rows along y times k), then along the row; mirrored as `axes` says.
    [[nodiscard]] std::vector<std::uint64_t> const& keys() const noexcept { return keys_; }
    [[nodiscard]] std::size_t row_of(std::uint64_t key) const noexcept { return key >> (first_bits_ + 1); }
    [[nodiscard]] std::size_t first_of(std::uint64_t key) const noexcept {
        return key >> 1 & ((std::uint64_t{1} << first_bits_) - 1);
    }
    [[nodiscard]] static int turn_of(std::uint64_t key) noexcept { return (key & 1) != 0 ? 1 : -1; }
    /// The lowest key that a row may have.
    [[nodiscard]] std::uint64_t key_of_row(std::size_t row) const noexcept {
        return static_cast<std::uint64_t>(row) << (first_bits_ + 1);
    }

    [[nodiscard]] row_axes const& axes() const noexcept { return axes_; }
    [[nodiscard]] std::array<std::int64_t, 3> const& size() const noexcept { return size_; }
    /// Between any two even places; the centre of line n but for 2^-21 of a voxel.
    [[nodiscard]] static std::int64_t line(std::int64_t n) { return n * one + one / 2 + 1; }

private:
    __extension__ using wide = __int128;
    static constexpr double most = 0x1p38;  ///< voxels from the origin

    [[nodiscard]] static std::int64_t even(double x) {
        return 2 * static_cast<std::int64_t>(std::floor(x * (one / 2) + 0.5));
    }
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

    /// The rows of one plane that pass a triangle: a.row .. b.row - 1.
    struct layer {
        cut a, b;
        int turn;
    };
    [[nodiscard]] static layer cut_layer(std::array<corner, 3> const& t, std::int64_t z) {
        cut up{};
        cut down{};
        for (std::size_t e = 0; e < 3; ++e) {
            corner const& p = t[e];
            corner const& q = t[(e + 1) % 3];
            if ((p.z < z) == (q.z < z)) continue;
            (p.z < z ? up : down) = cut_edge(p, q, z);
        }
        // An edge that runs up has the triangle on its left: the normal points along x where `up` is the larger y.
        if (up.row < down.row) return {up, down, 1};
        return {down, up, -1};
    }
    [[nodiscard]] std::int64_t beyond(layer const& at, std::int64_t j, double x_lo, double x_hi) const {
        cut const& a = at.a;
        cut const& b = at.b;
        double const s = b.y > a.y ? (static_cast<double>(line(j)) - a.y) / (b.y - a.y) : 0.5;
        double const x = std::clamp(a.x + s * (b.x - a.x), x_lo, x_hi);
        return static_cast<std::int64_t>(std::clamp(std::floor(x + 0.5), 0.0, static_cast<double>(size_[0])));
    }

    void push(std::int64_t j, std::int64_t k, std::int64_t first, int turn) {
        // The winding number of a closed chain is 0 behind the last crossing, so it can be counted from there.
        if (axes_.mirrored[0]) {
            first = size_[0] - first;
            turn = -turn;
        }
        if (axes_.mirrored[1]) j = size_[1] - 1 - j;
        if (axes_.mirrored[2]) k = size_[2] - 1 - k;
        auto const row = static_cast<std::uint64_t>(j + size_[1] * k);
        keys_.push_back(((row << first_bits_ | static_cast<std::uint64_t>(first)) << 1) | (turn > 0 ? 1U : 0U));
    }

    char const* who_;
    grid_frame frame_;
    row_axes axes_;
    std::array<std::int64_t, 3> size_{};
    int first_bits_ = 0;
    std::vector<std::uint64_t> keys_{};
};

}  // namespace tafoni::detail

#endif
