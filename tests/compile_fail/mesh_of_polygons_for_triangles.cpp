// expect: triangle_mesh
// expect: corners_per_face
#include <tafoni/geometry/concepts.hpp>

struct mine {};

template <>
struct tafoni::mesh_access<mine> {
    static std::size_t vertex_count(mine const&) { return 0; }
    static tafoni::vec3 position(mine const&, std::size_t) { return {0, 0, 0}; }
    static std::size_t face_count(mine const&) { return 0; }
    static std::size_t face_size(mine const&, std::size_t) { return 3; }
    static std::uint64_t corner(mine const&, std::size_t, std::size_t) { return 0; }
#ifndef TAFONI_TEST_MISTAKE
    static constexpr std::size_t corners_per_face = 3;
#endif
};

static_assert(tafoni::triangle_mesh<mine>);
