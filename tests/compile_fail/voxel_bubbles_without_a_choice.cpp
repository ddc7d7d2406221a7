// expect: `bubbles` takes a bubble_choice
#include <tafoni/weathering/voxel_weathering.hpp>

#ifdef TAFONI_TEST_MISTAKE
auto const process = tafoni::voxel_weathering{.bubbles = tafoni::sphere_bubble{5}};
#else
auto const process = tafoni::voxel_weathering{.bubbles = tafoni::single_bubble{tafoni::sphere_bubble{5}}};
#endif
