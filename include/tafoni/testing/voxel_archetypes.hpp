/// \file
/// The least grids of voxels that satisfy their concepts.
#ifndef TAFONI_TESTING_VOXEL_ARCHETYPES_HPP
#define TAFONI_TESTING_VOXEL_ARCHETYPES_HPP

#include <tafoni/voxel/concepts.hpp>

#include <array>
#include <cstddef>

namespace tafoni::archetypes {

/// A block of 4 x 3 x 5 voxels of rock with a slab of air on top. Nothing but what `grid_access` reads; not copyable.
struct voxel_grid {
    voxel_grid() = default;
    voxel_grid(voxel_grid const&) = delete;
    voxel_grid& operator=(voxel_grid const&) = delete;
};

/// The same, to be set as well.
struct editable_voxel_grid {
    editable_voxel_grid() {
        for (std::size_t n = 0; n < states.size(); ++n) states[n] = n < 48 ? voxel_state::rock : voxel_state::air;
    }
    editable_voxel_grid(editable_voxel_grid const&) = delete;
    editable_voxel_grid& operator=(editable_voxel_grid const&) = delete;

    std::array<voxel_state, 60> states{};
};

}  // namespace tafoni::archetypes

template <>
struct tafoni::grid_access<tafoni::archetypes::voxel_grid> {
    using grid = archetypes::voxel_grid;
    static std::array<std::size_t, 3> size(grid const&) { return {4, 3, 5}; }
    static vec3 spacing(grid const&) { return vec3{1, 1, 1}; }
    static vec3 origin(grid const&) { return vec3{0, 0, 0}; }
    static voxel_state state(grid const&, std::size_t, std::size_t, std::size_t k) {
        return k < 4 ? voxel_state::rock : voxel_state::air;
    }
};

template <>
struct tafoni::grid_access<tafoni::archetypes::editable_voxel_grid> {
    using grid = archetypes::editable_voxel_grid;
    static std::array<std::size_t, 3> size(grid const&) { return {4, 3, 5}; }
    static vec3 spacing(grid const&) { return vec3{1, 1, 1}; }
    static vec3 origin(grid const&) { return vec3{0, 0, 0}; }
    static voxel_state state(grid const& g, std::size_t i, std::size_t j, std::size_t k) {
        return g.states[i + 4 * (j + 3 * k)];
    }
    static void set(grid& g, std::size_t i, std::size_t j, std::size_t k, voxel_state s) {
        g.states[i + 4 * (j + 3 * k)] = s;
    }
};

namespace tafoni::archetypes {

static_assert(tafoni::voxel_grid<voxel_grid> && !tafoni::editable_voxel_grid<voxel_grid>);
static_assert(tafoni::editable_voxel_grid<editable_voxel_grid>);

}  // namespace tafoni::archetypes

#endif
