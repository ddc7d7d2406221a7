#include <tafoni/tafoni.hpp>

std::uint64_t blocks_of_the_other_unit();

std::uint64_t blocks_of_the_other_unit() {
    auto const block = tafoni::voxel_cells::from_indices({.size = {4, 4, 4}}, [](auto...) { return true; });
    tafoni::frost_run run(block);
    return run.run({.paths = 100}).blocks;
}
