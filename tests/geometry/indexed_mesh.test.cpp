#include <tafoni/geometry/indexed_mesh.hpp>

#include <catch2/catch.hpp>

#include <vector>

using namespace tafoni;
using reading = mesh_access<indexed_mesh>;

TEST_CASE("an indexed mesh gives back the vertices and faces that were put in") {
    indexed_mesh m;
    CHECK(m.vertex_count() == 0);
    CHECK(m.face_count() == 0);
    for (std::uint32_t i = 0; i < 5; ++i) CHECK(m.add_vertex(vec3{double(i), 0, 0}).value == i);
    m.add_face({0, 1, 2});
    std::vector<std::uint32_t> const loop{4, 3, 2, 1};
    m.add_face(loop);
    CHECK(reading::vertex_count(m) == 5);
    CHECK(reading::position(m, 3) == vec3(3, 0, 0));
    CHECK(reading::face_count(m) == 2);
    CHECK(reading::face_size(m, 0) == 3);
    CHECK(reading::face_size(m, 1) == 4);
    CHECK(reading::corner(m, 1, 0) == 4);
    CHECK(reading::corner(m, 1, 3) == 1);
    CHECK(std::vector<std::uint32_t>(m.face(1).begin(), m.face(1).end()) == loop);
}

TEST_CASE("a mesh that was moved from or cleared can be filled again") {
    indexed_mesh m;
    m.add_vertex(vec3{0, 0, 0});
    m.add_face({0, 0, 0});
    indexed_mesh const taken = std::move(m);
    CHECK(taken.face_count() == 1);
    m = indexed_mesh{};
    m.offsets.clear();
    CHECK(m.face_count() == 0);
    m.add_face({0, 1, 2, 3});
    CHECK(m.face_count() == 1);
    CHECK(m.face(0).size() == 4);
}
