// expect: polygon_mesh
// expect: mesh_access<(M|mine)>
#include <tafoni/geometry/concepts.hpp>
#include <tafoni/geometry/make_solid.hpp>

struct mine {};

#ifndef TAFONI_TEST_MISTAKE
template <>
struct tafoni::mesh_access<mine> {
    static std::size_t vertex_count(mine const&) { return 0; }
    static tafoni::vec3 position(mine const&, std::size_t) { return {0, 0, 0}; }
    static std::size_t face_count(mine const&) { return 0; }
    static std::size_t face_size(mine const&, std::size_t) { return 3; }
    static std::uint64_t corner(mine const&, std::size_t, std::size_t) { return 0; }
};
#endif

tafoni::solid ask(mine const& m) { return tafoni::make_solid(m); }
