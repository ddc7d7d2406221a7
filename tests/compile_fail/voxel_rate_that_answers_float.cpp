// expect: `rate` takes a rate_function
#include <tafoni/weathering/voxel_weathering.hpp>

#ifdef TAFONI_TEST_MISTAKE
auto const process = tafoni::voxel_weathering{.rate = [](float c) { return c; }};
#else
auto const process = tafoni::voxel_weathering{.rate = [](double c) { return c; }};
#endif
