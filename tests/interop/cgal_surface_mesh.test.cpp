#include "support/same_on_every_mesh.hpp"

#include <tafoni/interop/cgal_surface_mesh.hpp>

#include <CGAL/Simple_cartesian.h>

#include <catch2/catch.hpp>

using namespace tafoni;
using namespace tafoni_test;

namespace {

using double_mesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;
using float_mesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<float>::Point_3>;

static_assert(polygon_mesh<double_mesh> && !triangle_mesh<double_mesh>);

template <class M>
M cgal_of(triangle_surface const& s) {
    using point = typename M::Point;
    M m;
    std::vector<typename M::Vertex_index> index;
    for (vec3 const& p : s.positions) {
        using scalar = std::remove_cvref_t<decltype(point{}.x())>;
        index.push_back(m.add_vertex(point(static_cast<scalar>(p[0]), static_cast<scalar>(p[1]), static_cast<scalar>(p[2]))));
    }
    for (auto const& t : s.triangles) m.add_face(index[t[0]], index[t[1]], index[t[2]]);
    return m;
}

}  // namespace

TEMPLATE_TEST_CASE("curvature and weathering run unchanged on a CGAL Surface_mesh, with the same bits", "", double_mesh,
                   float_mesh) {
    triangle_surface const s = uneven_ring();
    CHECK(differences(cgal_of<TestType>(s), s) == std::vector<std::string>{});
}

TEST_CASE("a Surface_mesh with removed elements is refused until its garbage is collected") {
    auto m = cgal_of<double_mesh>(triangles_of(icosphere(1)));
    auto const lone = m.add_vertex({5, 5, 5});
    m.remove_vertex(lone);
    CHECK_THROWS_WITH(estimate_curvature(m), Catch::Contains("collect_garbage"));
    CHECK_THROWS_AS(curvature_run(m), invalid_input);
    m.collect_garbage();
    CHECK(estimate_curvature(m).size() == 42);
}

TEST_CASE("a Surface_mesh of quadrilaterals is refused with the face that is none") {
    double_mesh m;
    auto const a = m.add_vertex({0, 0, 0});
    auto const b = m.add_vertex({1, 0, 0});
    auto const c = m.add_vertex({1, 1, 0});
    auto const d = m.add_vertex({0, 1, 0});
    m.add_face(a, b, c, d);
    CHECK_THROWS_WITH(curvature_run(m), Catch::Contains("face 0 has 4 corners"));
}

TEST_CASE("an empty Surface_mesh has no curvature") { CHECK(estimate_curvature(double_mesh{}).empty()); }
