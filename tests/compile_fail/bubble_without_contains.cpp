// expect: bubble_shape
// expect: s\.contains\(offset\)
#include <tafoni/voxel/bubble.hpp>

struct mine {
#ifdef TAFONI_TEST_MISTAKE
    bool inside(tafoni::vec3 const& o) const { return o[2] < 3; }
#else
    bool contains(tafoni::vec3 const& o) const { return o[2] < 3; }
#endif
    double reach() const { return 3; }
};

static_assert(tafoni::bubble_shape<mine>);
