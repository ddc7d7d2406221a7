// expect: bubble_shape
// expect: s\.reach\(\)
#include <tafoni/voxel/bubble.hpp>

struct mine {
    bool contains(tafoni::vec3 const& o) const { return o[2] < 3; }
#ifndef TAFONI_TEST_MISTAKE
    double reach() const { return 3; }
#endif
};

static_assert(tafoni::bubble_shape<mine>);
