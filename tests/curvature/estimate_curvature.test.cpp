#include "support/same_on_every_mesh.hpp"

#include <tafoni/geometry/eigen_mesh.hpp>
#include <tafoni/geometry/indexed_mesh.hpp>
#include <tafoni/geometry/span_mesh.hpp>
#include <tafoni/testing/structure_archetypes.hpp>

#include <catch2/catch.hpp>

#include <limits>

using namespace tafoni;
using namespace tafoni_test;

TEST_CASE("curvature and weathering run unchanged on indexed meshes, matrices and arrays, with the same bits") {
    triangle_surface const s = uneven_ring();
    indexed_mesh indexed{.positions = s.positions, .corners = {}};
    Eigen::MatrixXd v(static_cast<Eigen::Index>(s.positions.size()), 3);
    Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> v_float(v.rows(), 3);
    Eigen::Matrix<int, Eigen::Dynamic, 3> f(static_cast<Eigen::Index>(s.triangles.size()), 3);
    Eigen::MatrixXi f_any(f.rows(), 3);
    std::vector<float> coordinates;
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i < s.positions.size(); ++i) {
        for (int d = 0; d < 3; ++d) {
            v(static_cast<Eigen::Index>(i), d) = s.positions[i][d];
            v_float(static_cast<Eigen::Index>(i), d) = static_cast<float>(s.positions[i][d]);
            coordinates.push_back(static_cast<float>(s.positions[i][d]));
        }
    }
    for (std::size_t i = 0; i < s.triangles.size(); ++i) {
        indexed.add_face(s.triangles[i]);
        for (int k = 0; k < 3; ++k) {
            f(static_cast<Eigen::Index>(i), k) = static_cast<int>(s.triangles[i][static_cast<std::size_t>(k)]);
            f_any(static_cast<Eigen::Index>(i), k) = f(static_cast<Eigen::Index>(i), k);
            corners.push_back(s.triangles[i][static_cast<std::size_t>(k)]);
        }
    }
    std::vector<std::string> const none;
    CHECK(differences(indexed, s) == none);
    CHECK(differences(view_matrices(v, f), s) == none);
    CHECK(differences(view_matrices(v_float, f_any), s) == none);  // columns known only when it runs
    CHECK(differences(view_triangles(coordinates, corners), s) == none);
}

TEST_CASE("a polygon that is no triangle is refused by number before anything is done") {
    indexed_mesh m;
    for (int k = 0; k < 5; ++k) m.add_vertex(vec3{1.0 * k, 1.0 * k * k, 0});
    m.add_face({0, 1, 2});
    m.add_face({0, 2, 3, 4});
    try {
        (void)estimate_curvature(m);
        FAIL("a quadrilateral went through");
    } catch (invalid_input const& e) {
        CHECK(e.code() == errc::unsupported);
        CHECK(e.place().kind == entity::face);
        CHECK(e.place().index == 1);
        CHECK(e.place().value == 4);
    }
    CHECK_THROWS_AS(curvature_run(m), invalid_input);
}

TEST_CASE("indices beyond the vertices are named, however large") {
    std::vector<double> const xyz{0, 0, 0, 1, 0, 0, 0, 1, 0};
    for (std::int64_t const bad : {std::int64_t{3}, std::int64_t{-1}, std::int64_t{0xffffffff}, std::numeric_limits<std::int64_t>::max()}) {
        std::vector<std::int64_t> const corners{0, 1, 2, 0, bad, 2};
        try {
            (void)estimate_curvature(view_triangles(xyz, corners));
            FAIL("index " << bad << " went through");
        } catch (invalid_input const& e) {
            CHECK(e.code() == errc::index_out_of_range);
            CHECK(e.place().index == 1);
        }
    }
}

TEST_CASE("coordinates that are no numbers are refused by vertex, the smallest ones are not") {
    triangle_surface s = triangles_of(icosphere(0));
    s.positions[2][1] = std::numeric_limits<double>::denorm_min();
    CHECK(estimate_curvature(s).size() == 12);
    s.positions[2][1] = -std::numeric_limits<double>::infinity();
    try {
        (void)estimate_curvature(s);
        FAIL("infinity went through");
    } catch (invalid_input const& e) {
        CHECK(e.code() == errc::non_finite_vertex);
        CHECK(e.place().index == 2);
    }
}
