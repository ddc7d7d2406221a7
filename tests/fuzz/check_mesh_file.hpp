/// \file
/// What every reader promises of a mesh file; a broken promise aborts, so that the fuzzer sees it.
#ifndef TAFONI_TESTS_FUZZ_CHECK_MESH_FILE_HPP
#define TAFONI_TESTS_FUZZ_CHECK_MESH_FILE_HPP

#include <tafoni/io/mesh_file.hpp>

#include <cstdio>
#include <cstdlib>

namespace tafoni_test {

inline void require(bool kept, char const* promise) {
    if (kept) return;
    std::fprintf(stderr, "broken promise: %s\n", promise);
    std::abort();
}

inline void check_mesh_file(tafoni::mesh_file const& file) {
    tafoni::indexed_mesh const& m = file.mesh;
    tafoni::mesh_attributes const& a = file.attributes;
    require(!m.offsets.empty() && m.offsets.front() == 0 && m.offsets.back() == m.corners.size(), "offsets span the corners");
    for (std::size_t f = 0; f < m.face_count(); ++f) require(m.offsets[f] + 3 <= m.offsets[f + 1], "three corners per face");
    for (std::uint32_t const c : m.corners) require(c < m.vertex_count(), "corners are vertices");
    for (tafoni::vec3 const& p : m.positions) require(tafoni::is_finite(p), "positions are finite");
    for (auto const& c : a.vertex_channels) require(c.values.size() == m.vertex_count(), "a value per vertex");
    for (auto const& c : a.face_channels) require(c.values.size() == m.face_count(), "a value per face");
    for (auto const* list : {&a.corner_texture, &a.corner_normals}) {
        require(list->empty() || list->size() == m.corners.size(), "an entry per corner");
        std::size_t const limit = list == &a.corner_texture ? a.texture.size() : a.normals.size();
        for (std::uint32_t const i : *list) require(i == a.none || i < limit, "entries are in range");
    }
    for (auto const* groups : {&a.objects, &a.groups, &a.materials}) {
        for (std::size_t k = 0; k < groups->size(); ++k) {
            require((*groups)[k].first_face < m.face_count(), "groups have faces");
            require(k == 0 || (*groups)[k - 1].first_face < (*groups)[k].first_face, "groups are in order");
        }
    }
}

}  // namespace tafoni_test

#endif
