/// \file
/// OpenVDB grids as grids of voxels, and back.
#ifndef TAFONI_INTEROP_OPENVDB_HPP
#define TAFONI_INTEROP_OPENVDB_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/grid_frame.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

#if defined(__clang__)  // Boost before 1.81, which OpenVDB 10 includes, casts -1 to enumerations without it
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wunknown-warning-option"
#pragma clang diagnostic ignored "-Wenum-constexpr-conversion"
#endif
#include <openvdb/openvdb.h>
#if defined(__clang__)
#pragma clang diagnostic pop
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

namespace tafoni {

/// A box of an OpenVDB grid, seen as voxels; voxel (0, 0, 0) is the box's lowest. Nothing is copied.
///
/// What is rock, by the type of `Grid`:
/// - `openvdb::Int32Grid`: the value is the state, 0 air, 1 rock, 2 colluvium. This one can be set as well.
/// - `openvdb::BoolGrid`: true is rock.
/// - `openvdb::FloatGrid`, `DoubleGrid`: by their class; negative in a level set, positive in a fog volume.
/// `Grid const` is only read. Models `voxel_grid`, of `Int32Grid` also `editable_voxel_grid`; readable by
/// several threads at once.
template <class Grid>
class openvdb_grid {
public:
    using pointer = openvdb::SharedPtr<Grid>;
    using value_type = typename Grid::ValueType;

    /// \throws invalid_input  `empty_input` for a null pointer or an empty box, `unsupported` for a transform that
    ///         turns, shears or mirrors, or a grid of numbers that is neither level set nor fog volume; as
    ///         `grid_frame::validate`.
    openvdb_grid(openvdb::SharedPtr<Grid> grid, openvdb::CoordBBox const& box) : grid_(std::move(grid)), box_(box) {
        require(grid_ != nullptr && !box_.empty(), errc::empty_input, "got no grid or an empty box");
        openvdb::math::Transform const& transform = grid_->transform();
        require(transform.isLinear(), errc::unsupported, "the transform is not linear");
        openvdb::Mat4d const m = transform.baseMap()->getAffineMap()->getMat4();
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) {
                require(row == column ? m(row, column) > 0 : m(row, column) == 0, errc::unsupported,
                        "the transform turns, shears or mirrors: resample the grid along its axes");
            }
            auto const d = static_cast<std::size_t>(row);
            std::int64_t const low = box_.min()[d];
            frame_.size[d] = static_cast<std::size_t>(box_.max()[d] - low + 1);
            frame_.spacing[row] = m(row, row);
            frame_.origin[row] = m(3, row) + m(row, row) * (static_cast<double>(low) - 0.5);
        }
        frame_.validate();
        if constexpr (std::is_floating_point_v<value_type>) {
            level_set_ = grid_->getGridClass() == openvdb::GRID_LEVEL_SET;
            require(level_set_ || grid_->getGridClass() == openvdb::GRID_FOG_VOLUME, errc::unsupported,
                    "a grid of numbers needs the class level set or fog volume");
        }
    }
    /// The box of what is active: of a level set the rock and its band. O(nodes).
    explicit openvdb_grid(openvdb::SharedPtr<Grid> grid)
        : openvdb_grid(grid, grid == nullptr ? openvdb::CoordBBox() : grid->evalActiveVoxelBoundingBox()) {}

    [[nodiscard]] pointer const& grid() const noexcept { return grid_; }
    [[nodiscard]] openvdb::CoordBBox const& box() const noexcept { return box_; }
    [[nodiscard]] grid_frame const& frame() const noexcept { return frame_; }
    [[nodiscard]] openvdb::Coord coordinates(std::size_t i, std::size_t j, std::size_t k) const noexcept {
        return box_.min().offsetBy(static_cast<openvdb::Int32>(i), static_cast<openvdb::Int32>(j),
                                   static_cast<openvdb::Int32>(k));
    }
    /// \throws invalid_input  `out_of_range` where an `Int32Grid` holds no state.
    [[nodiscard]] voxel_state state(openvdb::Coord const& at) const {
        value_type const value = grid_->constTree().getValue(at);
        if constexpr (std::is_same_v<value_type, bool>) {
            return value ? voxel_state::rock : voxel_state::air;
        } else if constexpr (std::is_floating_point_v<value_type>) {
            return (level_set_ ? value < 0 : value > 0) ? voxel_state::rock : voxel_state::air;
        } else {
            static_assert(std::is_same_v<value_type, openvdb::Int32>, "openvdb_grid: no states in such values");
            if (value < 0 || value > 2) refuse(at, value);
            return static_cast<voxel_state>(value);
        }
    }

private:
    static void require(bool holds, errc code, char const* what) {
        if (!holds) detail::fail<invalid_input>(code, std::string("openvdb_grid: ") + what);
    }
    [[noreturn]] static void refuse(openvdb::Coord const& at, openvdb::Int32 value) {
        detail::fail<invalid_input>(errc::out_of_range,
                                    "openvdb_grid: state of voxel (" + std::to_string(at.x()) + ", " +
                                        std::to_string(at.y()) + ", " + std::to_string(at.z()) + "): got " +
                                        std::to_string(value) + ", allowed [0, 2]",
                                    {.kind = entity::voxel, .value = static_cast<double>(value), .limit = 2});
    }

    pointer grid_;
    openvdb::CoordBBox box_;
    grid_frame frame_{};
    bool level_set_ = false;
};

template <class Grid>
struct grid_access<openvdb_grid<Grid>> {
    using grid = openvdb_grid<Grid>;
    static std::array<std::size_t, 3> size(grid const& g) { return g.frame().size; }
    static vec3 spacing(grid const& g) { return g.frame().spacing; }
    static vec3 origin(grid const& g) { return g.frame().origin; }
    static voxel_state state(grid const& g, std::size_t i, std::size_t j, std::size_t k) {
        return g.state(g.coordinates(i, j, k));
    }
    static void set(grid& g, std::size_t i, std::size_t j, std::size_t k, voxel_state s)
        requires std::is_same_v<Grid, openvdb::Int32Grid>
    {
        auto const value = static_cast<openvdb::Int32>(s);
        if (s == voxel_state::air) {
            g.grid()->tree().setValueOff(g.coordinates(i, j, k), value);
        } else {
            g.grid()->tree().setValueOn(g.coordinates(i, j, k), value);
        }
    }
};

static_assert(editable_voxel_grid<openvdb_grid<openvdb::Int32Grid>>);
static_assert(voxel_grid<openvdb_grid<openvdb::FloatGrid const>> && voxel_grid<openvdb_grid<openvdb::BoolGrid>>);

namespace detail {

struct to_openvdb_fn {
    /// States in the user's axes as a sparse OpenVDB grid of class unknown, named "states": rock and colluvium
    /// active, air the background, blocks of one state as tiles; voxel (i, j, k) at coordinates (i, j, k) and
    /// in the same place in space. O(voxels near the surface + bricks).
    [[nodiscard]] openvdb::Int32Grid::Ptr operator()(sparse_grid const& grid) const {
        auto out = openvdb::Int32Grid::create(0);
        out->setName("states");
        grid_frame const& frame = grid.user_frame();
        auto const transform = openvdb::math::Transform::createLinearTransform(1.0);
        transform->preScale(openvdb::Vec3d(frame.spacing[0], frame.spacing[1], frame.spacing[2]));
        vec3 const first = frame.centre({0, 0, 0});
        transform->postTranslate(openvdb::Vec3d(first[0], first[1], first[2]));
        out->setTransform(transform);
        auto access = out->getAccessor();
        auto const place = [&](voxel v) {
            voxel const u = grid.to_user(v);
            return openvdb::Coord(u.x, u.y, u.z);
        };
        for (std::size_t b = 0; b < grid.brick_count(); ++b) {
            if (grid.is_air_brick(b)) continue;
            voxel const low = grid.brick_corner(b);
            if (grid.is_rock_brick(b)) {
                access.clear();  // filling replaces nodes
                auto const last = [&](std::int32_t from, std::size_t d) {
                    return std::min(from + 31, static_cast<std::int32_t>(grid.size()[d]) - 1);
                };
                openvdb::Coord const one = place(low);
                openvdb::Coord const two = place({last(low.x, 0), last(low.y, 1), last(low.z, 2)});
                out->sparseFill({openvdb::Coord::minComponent(one, two), openvdb::Coord::maxComponent(one, two)}, 1);
                continue;
            }
            sparse_grid::brick const& bits = *grid.stored(b);
            for (std::size_t c = 0; c < 1024; ++c) {
                for (std::uint32_t left = bits.solid[c]; left != 0; left &= left - 1) {
                    int const z = std::countr_zero(left);
                    voxel const v{low.x + static_cast<std::int32_t>(c & 31), low.y + static_cast<std::int32_t>(c >> 5),
                                  low.z + z};
                    access.setValueOn(place(v), (bits.colluvium[c] >> z & 1U) != 0 ? 2 : 1);
                }
            }
        }
        access.clear();
        out->pruneGrid();
        return out;
    }
    /// The same for any grid. O(voxels).
    template <voxel_grid G>
    [[nodiscard]] openvdb::Int32Grid::Ptr operator()(G const& grid) const {
        return (*this)(sparse_grid::copy_of(grid));
    }
};

}  // namespace detail

/// `to_openvdb(grid)`.
inline constexpr detail::to_openvdb_fn to_openvdb{};

}  // namespace tafoni

#endif
