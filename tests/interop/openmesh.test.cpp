#include "support/same_on_every_mesh.hpp"

#include <tafoni/interop/openmesh.hpp>

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <catch2/catch.hpp>

using namespace tafoni;
using namespace tafoni_test;

namespace {

struct double_traits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
};
using double_mesh = OpenMesh::TriMesh_ArrayKernelT<double_traits>;
using float_mesh = OpenMesh::TriMesh_ArrayKernelT<>;
using polygons = OpenMesh::PolyMesh_ArrayKernelT<double_traits>;
struct own_mesh : float_mesh {};  // how hosts use it

static_assert(triangle_mesh<double_mesh> && triangle_mesh<float_mesh> && triangle_mesh<own_mesh>);
static_assert(polygon_mesh<polygons> && !triangle_mesh<polygons>);

template <class M>
M openmesh_of(triangle_surface const& s) {
    M m;
    std::vector<typename M::VertexHandle> handle;
    for (vec3 const& p : s.positions) {
        using scalar = typename M::Scalar;
        handle.push_back(m.add_vertex({static_cast<scalar>(p[0]), static_cast<scalar>(p[1]), static_cast<scalar>(p[2])}));
    }
    for (auto const& t : s.triangles) m.add_face(handle[t[0]], handle[t[1]], handle[t[2]]);
    return m;
}

}  // namespace

TEMPLATE_TEST_CASE("curvature and weathering run unchanged on OpenMesh, with the same bits", "", double_mesh, float_mesh,
                   own_mesh, polygons) {
    triangle_surface const s = uneven_ring();
    CHECK(differences(openmesh_of<TestType>(s), s) == std::vector<std::string>{});
}

TEST_CASE("an OpenMesh with deleted faces is refused until its garbage is collected") {
    auto m = openmesh_of<double_mesh>(triangles_of(icosphere(1)));
    m.request_face_status();
    m.request_edge_status();
    m.request_halfedge_status();
    m.request_vertex_status();
    m.delete_vertex(m.vertex_handle(5));
    try {
        (void)estimate_curvature(m);
        FAIL("deleted elements were read");
    } catch (invalid_input const& e) {
        CHECK(e.code() == errc::unsupported);
        CHECK(e.place().kind == entity::vertex);
        CHECK(e.place().index == 5);
    }
    m.garbage_collection();
    CHECK(estimate_curvature(m).size() == 41);
    m.delete_face(m.face_handle(7), false);
    CHECK_THROWS_WITH(estimate_curvature(m), Catch::Contains("face 7") && Catch::Contains("garbage_collection"));
}

TEST_CASE("an OpenMesh of quadrilaterals is refused with the face that is none") {
    polygons m;
    auto const a = m.add_vertex({0, 0, 0});
    auto const b = m.add_vertex({1, 0, 0});
    auto const c = m.add_vertex({1, 1, 0});
    auto const d = m.add_vertex({0, 1, 0});
    m.add_face(a, b, c, d);
    CHECK_THROWS_WITH(estimate_curvature(m), Catch::Contains("face 0 has 4 corners"));
}

TEST_CASE("an empty OpenMesh has no curvature and nothing to weather") {
    CHECK(estimate_curvature(double_mesh{}).empty());
    CHECK(curvature_run(double_mesh{}).run(2).iterations == 0);
}
