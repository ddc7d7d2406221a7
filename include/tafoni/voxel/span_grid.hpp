/// \file
/// A grid over bytes that lie in the user's memory.
#ifndef TAFONI_VOXEL_SPAN_GRID_HPP
#define TAFONI_VOXEL_SPAN_GRID_HPP

#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/detail/grid_checks.hpp>
#include <tafoni/voxel/grid_frame.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace tafoni {

/// One byte per voxel, x fastest: 0 air, 1 rock, 2 colluvium. Nothing is copied; the bytes must outlive it.
/// `span_grid<std::uint8_t>` models `editable_voxel_grid`, `span_grid<std::uint8_t const>` models `voxel_grid`.
template <class Byte>
    requires std::same_as<std::remove_const_t<Byte>, std::uint8_t>
class span_grid {
public:
    /// O(voxels) to check.
    /// \throws invalid_input  as `grid_frame::validate`; `attribute_length` when there is not one byte per voxel,
    ///                        `out_of_range` for a byte above 2.
    span_grid(grid_frame const& frame, std::span<Byte> states)
        : frame_((frame.validate(), detail::require_states("span_grid", frame, states), frame)), states_(states) {}

    [[nodiscard]] grid_frame const& frame() const noexcept { return frame_; }
    [[nodiscard]] std::span<Byte> states() const noexcept { return states_; }

private:
    grid_frame frame_;
    std::span<Byte> states_;
};

template <class Byte>
struct grid_access<span_grid<Byte>> {
    using grid = span_grid<Byte>;
    static std::array<std::size_t, 3> size(grid const& g) { return g.frame().size; }
    static vec3 spacing(grid const& g) { return g.frame().spacing; }
    static vec3 origin(grid const& g) { return g.frame().origin; }
    static voxel_state state(grid const& g, std::size_t i, std::size_t j, std::size_t k) {
        return static_cast<voxel_state>(g.states()[i + g.frame().size[0] * (j + g.frame().size[1] * k)]);
    }
    static void set(grid& g, std::size_t i, std::size_t j, std::size_t k, voxel_state s)
        requires(!std::is_const_v<Byte>)
    {
        g.states()[i + g.frame().size[0] * (j + g.frame().size[1] * k)] = static_cast<std::uint8_t>(s);
    }
    static std::span<std::uint8_t const> bytes(grid const& g) { return g.states(); }
};

static_assert(editable_voxel_grid<span_grid<std::uint8_t>> && voxel_grid<span_grid<std::uint8_t const>>);
static_assert(!editable_voxel_grid<span_grid<std::uint8_t const>>);

}  // namespace tafoni

#endif
