/// \file
/// A grid of one bit per voxel, and a second one where there is colluvium.
#ifndef TAFONI_VOXEL_BIT_GRID_HPP
#define TAFONI_VOXEL_BIT_GRID_HPP

#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/detail/grid_checks.hpp>
#include <tafoni/voxel/grid_frame.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tafoni {

/// Bits in the order of `dense_grid`, an eighth of its memory; twice that from the first colluvium on.
///
/// Not to be set by several threads at once: voxels share words. Models `editable_voxel_grid`.
class bit_grid {
public:
    static constexpr std::size_t most = std::size_t{1} << 43;  ///< voxels

    bit_grid() = default;
    /// All air. O(voxels / 64). \throws invalid_input  as `grid_frame::validate`; `size_overflow` beyond `most`.
    explicit bit_grid(grid_frame const& frame)
        : frame_((detail::require_stored_frame("bit_grid", frame, most), frame)),
          solid_((frame.voxel_count() + 63) / 64, 0) {}

    bit_grid(bit_grid const&) = default;
    bit_grid& operator=(bit_grid const&) = default;
    /// What is moved from has no voxels.
    bit_grid(bit_grid&& other) noexcept
        : frame_(std::exchange(other.frame_, {})),
          solid_(std::exchange(other.solid_, {})),
          loose_(std::exchange(other.loose_, {})) {}
    bit_grid& operator=(bit_grid&& other) noexcept {
        frame_ = std::exchange(other.frame_, {});
        solid_ = std::exchange(other.solid_, {});
        loose_ = std::exchange(other.loose_, {});
        return *this;
    }
    ~bit_grid() = default;

    [[nodiscard]] grid_frame const& frame() const noexcept { return frame_; }
    [[nodiscard]] std::size_t bytes() const noexcept { return (solid_.capacity() + loose_.capacity()) * 8; }
    /// Voxels in a state. O(voxels / 64).
    [[nodiscard]] std::size_t count(voxel_state s) const noexcept {
        std::size_t const loose = ones(loose_);
        if (s == voxel_state::colluvium) return loose;
        std::size_t const solid = ones(solid_);
        return s == voxel_state::rock ? solid - loose : frame_.voxel_count() - solid;
    }

    /// A voxel inside the grid, unchecked. O(1).
    [[nodiscard]] voxel_state state(voxel v) const noexcept { return state(detail::linear_index(frame_.size, v)); }
    /// Strong guarantee: the first colluvium may find no memory. O(1), once O(voxels / 64).
    void set(voxel v, voxel_state s) { set(detail::linear_index(frame_.size, v), s); }
    /// \throws invalid_input  `index_out_of_range` for a voxel beyond the grid.
    [[nodiscard]] voxel_state at(voxel v) const {
        detail::require_voxel("bit_grid::at", frame_, v);
        return state(v);
    }

private:
    friend struct grid_access<bit_grid>;

    [[nodiscard]] static std::size_t ones(std::vector<std::uint64_t> const& words) noexcept {
        std::size_t n = 0;
        for (std::uint64_t const w : words) n += static_cast<std::size_t>(std::popcount(w));
        return n;
    }
    [[nodiscard]] voxel_state state(std::size_t n) const noexcept {
        if ((solid_[n >> 6] >> (n & 63) & 1) == 0) return voxel_state::air;
        return !loose_.empty() && (loose_[n >> 6] >> (n & 63) & 1) != 0 ? voxel_state::colluvium : voxel_state::rock;
    }
    void set(std::size_t n, voxel_state s) {
        if (s == voxel_state::colluvium && loose_.empty()) loose_.assign(solid_.size(), 0);
        std::uint64_t const bit = std::uint64_t{1} << (n & 63);
        std::uint64_t& solid = solid_[n >> 6];
        solid = s == voxel_state::air ? solid & ~bit : solid | bit;
        if (loose_.empty()) return;
        std::uint64_t& loose = loose_[n >> 6];
        loose = s == voxel_state::colluvium ? loose | bit : loose & ~bit;
    }

    grid_frame frame_{};
    std::vector<std::uint64_t> solid_{};  ///< bit n & 63 of word n >> 6 is voxel n
    std::vector<std::uint64_t> loose_{};  ///< a part of solid; empty while there is no colluvium
};

template <>
struct grid_access<bit_grid> {
    static std::array<std::size_t, 3> size(bit_grid const& g) { return g.frame_.size; }
    static vec3 spacing(bit_grid const& g) { return g.frame_.spacing; }
    static vec3 origin(bit_grid const& g) { return g.frame_.origin; }
    static voxel_state state(bit_grid const& g, std::size_t i, std::size_t j, std::size_t k) {
        return g.state(i + g.frame_.size[0] * (j + g.frame_.size[1] * k));
    }
    static void set(bit_grid& g, std::size_t i, std::size_t j, std::size_t k, voxel_state s) {
        g.set(i + g.frame_.size[0] * (j + g.frame_.size[1] * k), s);
    }
};

static_assert(editable_voxel_grid<bit_grid>);

}  // namespace tafoni

#endif
