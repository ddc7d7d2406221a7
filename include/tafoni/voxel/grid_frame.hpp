/// \file
/// Size and place of a grid, its border, and which of its axes points up.
#ifndef TAFONI_VOXEL_GRID_FRAME_HPP
#define TAFONI_VOXEL_GRID_FRAME_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/voxel/voxel.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

namespace tafoni {

/// A box of voxels in space.
struct grid_frame {
    static constexpr std::size_t longest = std::size_t{1} << 20;  ///< voxels along an axis

    std::array<std::size_t, 3> size{};  ///< voxels along x, y, z; each in 1 .. `longest`
    vec3 spacing{1, 1, 1};              ///< edges of a voxel, length unit, > 0
    vec3 origin{0, 0, 0};               ///< lower corner of voxel (0, 0, 0)

    /// Below 2^60.
    [[nodiscard]] std::size_t voxel_count() const noexcept { return size[0] * size[1] * size[2]; }
    [[nodiscard]] bool contains(voxel v) const noexcept {
        return static_cast<std::size_t>(v.x) < size[0] && static_cast<std::size_t>(v.y) < size[1] &&
               static_cast<std::size_t>(v.z) < size[2];
    }
    friend bool operator==(grid_frame const& a, grid_frame const& b) noexcept {
        return a.size == b.size && a.spacing == b.spacing && a.origin == b.origin;
    }
    [[nodiscard]] vec3 centre(voxel v) const noexcept {
        return vec3{origin[0] + spacing[0] * (static_cast<double>(v.x) + 0.5),
                    origin[1] + spacing[1] * (static_cast<double>(v.y) + 0.5),
                    origin[2] + spacing[2] * (static_cast<double>(v.z) + 0.5)};
    }

    /// \throws invalid_input  `empty_input` for a size of 0, `size_overflow` beyond `longest`, `bad_parameter` for a
    ///         spacing that is not positive or an origin that is not finite.
    void validate() const {
        for (std::size_t d = 0; d < 3; ++d) {
            auto const e = static_cast<Eigen::Index>(d);
            std::string const at{'[', static_cast<char>('0' + d), ']'};
            if (size[d] == 0) {
                detail::fail<invalid_input>(errc::empty_input, "grid_frame.size" + at + ": got 0, need at least 1",
                                            {.kind = entity::parameter, .value = 0, .limit = 1});
            }
            if (size[d] > longest) {
                detail::fail<invalid_input>(errc::size_overflow,
                                            "grid_frame.size" + at + ": got " + std::to_string(size[d]) +
                                                ", at most " + std::to_string(longest),
                                            {.kind = entity::parameter, .value = static_cast<double>(size[d]),
                                             .limit = static_cast<double>(longest)});
            }
            detail::require_range(("grid_frame.spacing" + at).c_str(), spacing[e], std::numeric_limits<double>::min(), 1e100);
            detail::require_range(("grid_frame.origin" + at).c_str(), origin[e], -1e150, 1e150);
        }
    }
};

/// What a bubble sees, a grain meets and a surface is closed against beyond a side of the grid.
enum class border_kind : std::uint8_t {
    air,    ///< open: grains that leave are gone
    rock,   ///< solid ground: carries, never weathers
    extend  ///< the grid goes on as its outermost voxels do; nothing flows through, nothing weathers there
};

/// Kinds of the six sides. Where a voxel lies beyond several sides, rock wins over air and air over extend.
struct grid_border {
    std::array<border_kind, 6> sides{};  ///< -x, +x, -y, +y, -z, +z

    friend constexpr bool operator==(grid_border const&, grid_border const&) = default;
};

/// The axis of the user's grid that points up.
enum class up_axis : std::uint8_t { plus_z, plus_x, plus_y, minus_z, minus_x, minus_y };

/// The rotation that brings the user's up to +z: a signed permutation of axes, exact.
struct up_rotation {
    std::array<std::uint8_t, 3> axis{0, 1, 2};       ///< turned axis k is the user's axis `axis[k]` ...
    std::array<bool, 3> mirrored{false, false, false};  ///< ... run backwards where true; two of three or none

    static constexpr up_rotation of(up_axis up) noexcept {
        switch (up) {
            case up_axis::plus_x: return {{1, 2, 0}, {false, false, false}};
            case up_axis::plus_y: return {{2, 0, 1}, {false, false, false}};
            case up_axis::minus_z: return {{0, 1, 2}, {false, true, true}};
            case up_axis::minus_x: return {{1, 2, 0}, {false, true, true}};
            case up_axis::minus_y: return {{2, 0, 1}, {false, true, true}};
            case up_axis::plus_z: break;
        }
        return {};
    }

    [[nodiscard]] std::array<std::size_t, 3> turned_size(std::array<std::size_t, 3> const& user) const noexcept {
        return {user[axis[0]], user[axis[1]], user[axis[2]]};
    }
    /// A voxel of the turned grid, of that size, in the user's grid.
    [[nodiscard]] voxel to_user(voxel v, std::array<std::size_t, 3> const& turned) const noexcept {
        std::array<std::int32_t, 3> const in{v.x, v.y, v.z};
        std::array<std::int32_t, 3> out{};
        for (std::size_t k = 0; k < 3; ++k) {
            out[axis[k]] = mirrored[k] ? static_cast<std::int32_t>(turned[k]) - 1 - in[k] : in[k];
        }
        return {out[0], out[1], out[2]};
    }
    [[nodiscard]] voxel from_user(voxel v, std::array<std::size_t, 3> const& turned) const noexcept {
        std::array<std::int32_t, 3> const in{v.x, v.y, v.z};
        std::array<std::int32_t, 3> out{};
        for (std::size_t k = 0; k < 3; ++k) {
            std::int32_t const u = in[axis[k]];
            out[k] = mirrored[k] ? static_cast<std::int32_t>(turned[k]) - 1 - u : u;
        }
        return {out[0], out[1], out[2]};
    }
    /// A direction or offset; of points the part without the grid's origin.
    [[nodiscard]] vec3 direction_to_user(vec3 const& d) const noexcept {
        vec3 out;
        for (std::size_t k = 0; k < 3; ++k) {
            double const x = d[static_cast<Eigen::Index>(k)];
            out[static_cast<Eigen::Index>(axis[k])] = mirrored[k] ? -x : x;
        }
        return out;
    }
    [[nodiscard]] grid_border turned_border(grid_border const& user) const noexcept {
        grid_border out;
        for (std::size_t k = 0; k < 3; ++k) {
            std::size_t const low = 2U * axis[k];
            out.sides[2 * k] = user.sides[low + (mirrored[k] ? 1U : 0U)];
            out.sides[2 * k + 1] = user.sides[low + (mirrored[k] ? 0U : 1U)];
        }
        return out;
    }
};

}  // namespace tafoni

#endif
