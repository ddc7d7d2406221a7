// expect: deleted
#include <tafoni/decomposition/voxel_cells.hpp>
#include <tafoni/weathering/frost_run.hpp>

tafoni::voxel_cells block();

void ask() {
#ifdef TAFONI_TEST_MISTAKE
    tafoni::frost_run<tafoni::voxel_cells> const run(block());
#else
    auto const network = block();
    tafoni::frost_run<tafoni::voxel_cells> const run(network);
#endif
}
