// expect: voxel_grid
// expect: grid_access<(G|mine|From)>
#include <tafoni/voxel/sparse_grid.hpp>

struct mine {};

#ifndef TAFONI_TEST_MISTAKE
template <>
struct tafoni::grid_access<mine> {
    static std::array<std::size_t, 3> size(mine const&) { return {1, 1, 1}; }
    static tafoni::vec3 spacing(mine const&) { return {1, 1, 1}; }
    static tafoni::vec3 origin(mine const&) { return {0, 0, 0}; }
    static tafoni::voxel_state state(mine const&, std::size_t, std::size_t, std::size_t) { return {}; }
};
#endif

tafoni::sparse_grid work(mine const& grid) { return tafoni::sparse_grid::copy_of(grid); }
