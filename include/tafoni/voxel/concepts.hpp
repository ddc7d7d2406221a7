/// \file
/// Grids of rock, air and colluvium: the states, and the one door for foreign grids.
#ifndef TAFONI_VOXEL_CONCEPTS_HPP
#define TAFONI_VOXEL_CONCEPTS_HPP

#include <tafoni/core/vector.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>

namespace tafoni {

/// What fills a voxel [Jones et al., section 4.1].
enum class voxel_state : std::uint8_t { air = 0, rock = 1, colluvium = 2 };

/// Specialise this for your own grid type; nothing else of the library has to know it.
///
/// Members, all static; those that read may not modify the grid:
///   std::array<std::size_t, 3> size(G const&);       // voxels along x, y, z
///   vec3 spacing(G const&);                          // edges of a voxel, length unit, > 0
///   vec3 origin(G const&);                           // lower corner of voxel (0, 0, 0)
///   voxel_state state(G const&, std::size_t i, std::size_t j, std::size_t k);
/// To be written as well:
///   void set(G&, std::size_t i, std::size_t j, std::size_t k, voxel_state);
/// Where the states lie as bytes side by side, x fastest (optional; copies are then several times faster):
///   std::span<std::uint8_t const> bytes(G const&);   // one per voxel: 0 air, 1 rock, 2 colluvium, nothing else
template <class G>
struct grid_access;

/// A box of voxels that can be read.
///
/// Laws: pure functions; indices are asked below `size` only; size and spacing do not change under `set`.
/// The first part makes the compiler say only that `grid_access<G>` is missing where it is.
template <class G>
concept voxel_grid = requires { sizeof(grid_access<G>); } && requires(G const& g, std::size_t i) {
    { grid_access<G>::size(g) } -> std::same_as<std::array<std::size_t, 3>>;
    { grid_access<G>::spacing(g) } -> std::same_as<vec3>;
    { grid_access<G>::origin(g) } -> std::same_as<vec3>;
    { grid_access<G>::state(g, i, i, i) } -> std::same_as<voxel_state>;
};

/// A `voxel_grid` whose voxels can be set. Laws: `state` answers what was last `set`, other voxels keep theirs.
template <class G>
concept editable_voxel_grid = voxel_grid<G> && requires(G& g, std::size_t i, voxel_state s) {
    { grid_access<G>::set(g, i, i, i, s) } -> std::same_as<void>;
};

}  // namespace tafoni

#endif
