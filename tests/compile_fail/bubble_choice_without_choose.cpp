// expect: bubble_choice
// expect: c\.choose\(p\)
#include <tafoni/voxel/single_bubble.hpp>

struct mine {
    tafoni::single_bubble bubble{};
    std::span<tafoni::bubble_stencil const> stencils() const { return bubble.stencils(); }
#ifndef TAFONI_TEST_MISTAKE
    std::size_t choose(tafoni::vec3 const&) const { return 0; }
#endif
};

static_assert(tafoni::bubble_choice<mine>);
