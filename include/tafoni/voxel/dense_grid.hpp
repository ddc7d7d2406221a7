/// \file
/// A grid of one byte per voxel.
#ifndef TAFONI_VOXEL_DENSE_GRID_HPP
#define TAFONI_VOXEL_DENSE_GRID_HPP

#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/detail/grid_checks.hpp>
#include <tafoni/voxel/grid_frame.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tafoni {

/// States in one array, x fastest, then y, then z: `states()[i + nx (j + ny k)]` is a `voxel_state`.
///
/// For making and handing over grids; the processes work on a `sparse_grid`. Voxels may be set by several
/// threads at once where they are different ones. Models `editable_voxel_grid`.
class dense_grid {
public:
    static constexpr std::size_t most = std::size_t{1} << 40;  ///< voxels, one byte each

    dense_grid() = default;
    /// O(voxels). \throws invalid_input  as `grid_frame::validate`; `size_overflow` beyond `most`.
    explicit dense_grid(grid_frame const& frame, voxel_state fill = voxel_state::air)
        : frame_((detail::require_stored_frame("dense_grid", frame, most), frame)),
          states_(frame.voxel_count(), static_cast<std::uint8_t>(fill)) {}
    /// Takes the bytes over: 0 air, 1 rock, 2 colluvium. O(voxels) to check.
    /// \throws invalid_input  also `attribute_length` when they are not one per voxel, `out_of_range` for any
    ///                        other value.
    dense_grid(grid_frame const& frame, std::vector<std::uint8_t> states)
        : frame_((detail::require_stored_frame("dense_grid", frame, most),
                  detail::require_states("dense_grid", frame, states), frame)),
          states_(std::move(states)) {}

    dense_grid(dense_grid const&) = default;
    dense_grid& operator=(dense_grid const&) = default;
    /// What is moved from has no voxels.
    dense_grid(dense_grid&& other) noexcept
        : frame_(std::exchange(other.frame_, {})), states_(std::exchange(other.states_, {})) {}
    dense_grid& operator=(dense_grid&& other) noexcept {
        frame_ = std::exchange(other.frame_, {});
        states_ = std::exchange(other.states_, {});
        return *this;
    }
    ~dense_grid() = default;

    [[nodiscard]] grid_frame const& frame() const noexcept { return frame_; }
    [[nodiscard]] std::span<std::uint8_t const> states() const noexcept { return states_; }
    [[nodiscard]] std::size_t bytes() const noexcept { return states_.capacity(); }
    /// Voxels in a state. O(voxels).
    [[nodiscard]] std::size_t count(voxel_state s) const noexcept {
        return static_cast<std::size_t>(std::count(states_.begin(), states_.end(), static_cast<std::uint8_t>(s)));
    }

    /// A voxel inside the grid, unchecked. O(1).
    [[nodiscard]] voxel_state state(voxel v) const noexcept {
        return static_cast<voxel_state>(states_[detail::linear_index(frame_.size, v)]);
    }
    void set(voxel v, voxel_state s) noexcept {
        states_[detail::linear_index(frame_.size, v)] = static_cast<std::uint8_t>(s);
    }
    /// \throws invalid_input  `index_out_of_range` for a voxel beyond the grid.
    [[nodiscard]] voxel_state at(voxel v) const {
        detail::require_voxel("dense_grid::at", frame_, v);
        return state(v);
    }

    friend bool operator==(dense_grid const& a, dense_grid const& b) {
        return a.frame_ == b.frame_ && a.states_ == b.states_;
    }

private:
    friend struct grid_access<dense_grid>;

    grid_frame frame_{};
    std::vector<std::uint8_t> states_{};
};

template <>
struct grid_access<dense_grid> {
    static std::array<std::size_t, 3> size(dense_grid const& g) { return g.frame_.size; }
    static vec3 spacing(dense_grid const& g) { return g.frame_.spacing; }
    static vec3 origin(dense_grid const& g) { return g.frame_.origin; }
    static voxel_state state(dense_grid const& g, std::size_t i, std::size_t j, std::size_t k) {
        return static_cast<voxel_state>(g.states_[i + g.frame_.size[0] * (j + g.frame_.size[1] * k)]);
    }
    static void set(dense_grid& g, std::size_t i, std::size_t j, std::size_t k, voxel_state s) {
        g.states_[i + g.frame_.size[0] * (j + g.frame_.size[1] * k)] = static_cast<std::uint8_t>(s);
    }
    static std::span<std::uint8_t const> bytes(dense_grid const& g) { return g.states_; }
};

static_assert(editable_voxel_grid<dense_grid>);

}  // namespace tafoni

#endif
