// expect: `durability` takes a scalar_field
#include <tafoni/weathering/voxel_weathering.hpp>

#ifdef TAFONI_TEST_MISTAKE
auto const process = tafoni::voxel_weathering{.durability = 0.02};
#else
auto const process = tafoni::voxel_weathering{.durability = tafoni::constant_field{0.02}};
#endif
