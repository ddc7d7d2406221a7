/// \file
/// The bonds of a grid that joints cut, as bits in the bricks that discs touch.
#ifndef TAFONI_VOXEL_DETAIL_JOINT_CUTS_HPP
#define TAFONI_VOXEL_DETAIL_JOINT_CUTS_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/voxel/detail/joint_planes.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// 12 KiB for each brick with a cut bond. A bond is named by its lower voxel and its turned axis.
class joint_cuts {
public:
    struct brick_cuts {
        std::array<std::array<std::uint32_t, 1024>, 3> axis{};  ///< column x + 32 y, bit z: bond towards +axis
        std::vector<std::uint32_t> planes{};                    ///< that cut one of them, rising
    };

    joint_cuts() = default;

    /// O(discs bricks + 33^2 for each brick that a disc's plane passes within the disc's box).
    template <executor Executor>
    joint_cuts(sparse_grid const& grid, joint_set const& joints, Executor const& threads) {
        if (joints.discs.empty()) return;
        for (joint_disc const& d : joints.discs) planes_.push_back(joint_plane::of(d));
        std::vector<brick_cuts> found(grid.brick_count() < 256 ? grid.brick_count() : 256);
        table_.assign(grid.brick_count(), 0);
        for (std::size_t first = 0; first < grid.brick_count(); first += found.size()) {
            std::size_t const n = std::min(found.size(), grid.brick_count() - first);
            threads.for_blocks(n, 1, [&](std::size_t from, std::size_t to) {
                for (std::size_t i = from; i < to; ++i) cut_brick(grid, joints, first + i, found[i]);
            });
            for (std::size_t i = 0; i < n; ++i) {
                if (found[i].planes.empty()) continue;
                bricks_.push_back(std::move(found[i]));
                found[i] = {};
                table_[first + i] = static_cast<std::uint32_t>(bricks_.size());
            }
        }
    }

    [[nodiscard]] bool empty() const noexcept { return bricks_.empty(); }
    [[nodiscard]] std::vector<joint_plane> const& planes() const noexcept { return planes_; }
    /// Null where no bond of the brick is cut.
    [[nodiscard]] brick_cuts const* of(std::size_t brick) const noexcept {
        return table_.empty() || table_[brick] == 0 ? nullptr : &bricks_[table_[brick] - 1];
    }
    /// Bonds of a column towards +axis.
    [[nodiscard]] std::uint32_t word(std::size_t axis, std::size_t brick, std::size_t column) const noexcept {
        brick_cuts const* const c = of(brick);
        return c == nullptr ? 0 : c->axis[axis][column];
    }
    /// The bond of a voxel inside the grid and the next one towards +axis.
    [[nodiscard]] bool is_cut(sparse_grid const& grid, voxel low, std::size_t axis) const noexcept {
        return (word(axis, grid.brick_of(low), sparse_grid::column_of(low)) >> (low.z & 31) & 1U) != 0;
    }
    /// The plane that cuts the bond of `low` and the voxel above it; of several the steepest, then the first.
    [[nodiscard]] std::uint32_t plane_under(sparse_grid const& grid, voxel low) const noexcept {
        vec3 const p = grid.centre(low);
        vec3 const q = grid.centre(low + voxel{0, 0, 1});
        auto const up = static_cast<Eigen::Index>(grid.rotation().axis[2]);
        brick_cuts const& here = *of(grid.brick_of(low));
        std::uint32_t best = here.planes.front();
        double flat = 2;
        for (std::uint32_t const i : here.planes) {
            double const f = std::fabs(planes_[i].normal[up]);
            if (f >= flat || !planes_[i].cuts(p, q)) continue;
            flat = f;
            best = i;
        }
        return best;
    }

private:
    void cut_brick(sparse_grid const& grid, joint_set const& joints, std::size_t brick, brick_cuts& out) const {
        voxel const low = grid.brick_corner(brick);
        vec3 const a = grid.centre(low);
        vec3 const b = grid.centre(low + voxel{32, 32, 32});
        vec3 const& spacing = grid.user_frame().spacing;
        for (std::size_t i = 0; i < planes_.size(); ++i) {
            joint_plane const& plane = planes_[i];
            bool beside = false;
            for (int k = 0; k < 3; ++k) {
                double const n = plane.normal[k];
                double const half =
                    1.000001 * joints.discs[i].radius * std::sqrt(std::max(0.0, 1 - n * n) + 1e-12) + spacing[k];
                beside = beside || plane.centre[k] + half < std::min(a[k], b[k]) ||
                         plane.centre[k] - half > std::max(a[k], b[k]);
            }
            if (!beside && cut_by(grid, plane, low, out)) out.planes.push_back(static_cast<std::uint32_t>(i));
        }
    }

    static bool cut_by(sparse_grid const& grid, joint_plane const& plane, voxel low, brick_cuts& out) {
        auto const below = [&](int x, int y, int z) { return plane.is_below(grid.centre(low + voxel{x, y, z})); };
        int corners = 0;
        for (int c = 0; c < 8; ++c) corners += below(c & 1 ? 32 : 0, c & 2 ? 32 : 0, c & 4 ? 32 : 0) ? 1 : 0;
        if (corners == 0 || corners == 8) return false;  // heights are monotone along the axes
        std::vector<std::uint64_t> side(33 * 33);
        for (int y = 0; y <= 32; ++y) {
            for (int x = 0; x <= 32; ++x) side[static_cast<std::size_t>(x + 33 * y)] = below_bits(below, x, y);
        }
        bool any = false;
        for (int y = 0; y < 32; ++y) {
            for (int x = 0; x < 32; ++x) {
                auto const at = static_cast<std::size_t>(x + 33 * y);
                std::array<std::uint64_t, 3> const flips{side[at] ^ side[at + 1], side[at] ^ side[at + 33],
                                                         side[at] ^ side[at] >> 1};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    auto left = static_cast<std::uint32_t>(flips[axis]);
                    for (; left != 0; left &= left - 1) {
                        voxel const v = low + voxel{x, y, std::countr_zero(left)};
                        voxel const w = v + voxel{axis == 0 ? 1 : 0, axis == 1 ? 1 : 0, axis == 2 ? 1 : 0};
                        if (!plane.cuts(grid.centre(v), grid.centre(w))) continue;
                        out.axis[axis][sparse_grid::column_of(v)] |= std::uint32_t{1} << (v.z & 31);
                        any = true;
                    }
                }
            }
        }
        return any;
    }

    /// Bits 0 .. 32 of a column; they flip at most once.
    template <class Below>
    static std::uint64_t below_bits(Below const& below, int x, int y) {
        constexpr std::uint64_t all = (std::uint64_t{1} << 33) - 1;
        bool const first = below(x, y, 0);
        if (below(x, y, 32) == first) return first ? all : 0;
        int same = 0;
        int other = 32;
        while (other - same > 1) {
            int const middle = (same + other) / 2;
            (below(x, y, middle) == first ? same : other) = middle;
        }
        std::uint64_t const like_first = (std::uint64_t{1} << other) - 1;
        return first ? like_first : all & ~like_first;
    }

    std::vector<joint_plane> planes_{};
    std::vector<std::uint32_t> table_{};
    std::vector<brick_cuts> bricks_{};
};

}  // namespace tafoni::detail

#endif
