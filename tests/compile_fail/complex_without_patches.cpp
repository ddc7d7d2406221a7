// expect: cell_complex
// expect: c\.face_patch\(face\)
#include <tafoni/decomposition/concepts.hpp>

struct mine {
    std::size_t cell_count() const { return 0; }
    double cell_volume(tafoni::cell_index) const { return 0; }
    tafoni::vec3 cell_centroid(tafoni::cell_index) const { return {0, 0, 0}; }
    std::size_t vertex_count() const { return 0; }
    tafoni::vec3 position(tafoni::vertex_index) const { return {0, 0, 0}; }
    std::size_t face_count() const { return 0; }
    std::array<tafoni::cell_index, 2> face_cells(tafoni::face_index) const { return {}; }
    std::size_t loop_count(tafoni::face_index) const { return 1; }
    std::span<tafoni::vertex_index const> face_loop(tafoni::face_index, std::size_t) const { return {}; }
#ifndef TAFONI_TEST_MISTAKE
    tafoni::patch_index face_patch(tafoni::face_index) const { return {}; }
#endif
    double model_size() const { return 1; }
};

static_assert(tafoni::cell_complex<mine>);
