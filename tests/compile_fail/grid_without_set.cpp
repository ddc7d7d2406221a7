// expect: editable_voxel_grid
// expect: set\(g, i, i, i, s\)
#include <tafoni/voxel/copy_states.hpp>

struct mine {};

template <>
struct tafoni::grid_access<mine> {
    static std::array<std::size_t, 3> size(mine const&) { return {1, 1, 1}; }
    static tafoni::vec3 spacing(mine const&) { return {1, 1, 1}; }
    static tafoni::vec3 origin(mine const&) { return {0, 0, 0}; }
    static tafoni::voxel_state state(mine const&, std::size_t, std::size_t, std::size_t) { return {}; }
#ifndef TAFONI_TEST_MISTAKE
    static void set(mine&, std::size_t, std::size_t, std::size_t, tafoni::voxel_state) {}
#endif
};

void back(tafoni::sparse_grid const& weathered, mine& grid) { tafoni::copy_states(weathered, grid); }
