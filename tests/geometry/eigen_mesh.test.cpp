#include <tafoni/geometry/eigen_mesh.hpp>

#include <tafoni/geometry/make_solid.hpp>

#include <catch2/catch.hpp>

#include <support/shapes.hpp>

#include <cstdint>

using namespace tafoni;

namespace {

template <class V, class F>
void fill(indexed_mesh const& m, V& vertices, F& faces) {
    vertices.resize(static_cast<Eigen::Index>(m.vertex_count()), 3);
    for (std::size_t v = 0; v < m.vertex_count(); ++v) {
        for (int a = 0; a < 3; ++a) {
            vertices(static_cast<Eigen::Index>(v), a) = static_cast<typename V::Scalar>(m.positions[v][a]);
        }
    }
    faces.resize(static_cast<Eigen::Index>(m.face_count()), 3);
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        for (int k = 0; k < 3; ++k) {
            faces(static_cast<Eigen::Index>(f), k) =
                static_cast<typename F::Scalar>(m.face(f)[static_cast<std::size_t>(k)]);
        }
    }
}

template <class V, class F>
void check_volume() {
    indexed_mesh const m = tafoni_test::fan_triangulated(tafoni_test::unit_box());
    V vertices;
    F faces;
    fill(m, vertices, faces);
    auto const view = view_matrices(vertices, faces);
    static_assert(polygon_mesh<std::remove_const_t<decltype(view)>>);
    static_assert(triangle_mesh<std::remove_const_t<decltype(view)>> == (F::ColsAtCompileTime == 3));
    CHECK(&view.vertices == &vertices);
    CHECK(&view.faces == &faces);
    CHECK(make_solid(view).volume == 1);
    CHECK(make_solid(view).triangles == make_solid(m).triangles);
}

template <class V, class F>
concept viewable = requires(V&& v, F&& f) { view_matrices(std::forward<V>(v), std::forward<F>(f)); };

template <class T, int Columns, int Order>
using matrix = Eigen::Matrix<T, Eigen::Dynamic, Columns, Order>;

}  // namespace

TEST_CASE("V and F of any scalar, index and order are read where they lie") {
    check_volume<Eigen::MatrixXd, Eigen::MatrixXi>();
    check_volume<Eigen::MatrixXf, Eigen::MatrixXi>();
    check_volume<matrix<double, 3, Eigen::RowMajor>, matrix<std::int64_t, 3, Eigen::RowMajor>>();
    check_volume<matrix<float, 3, Eigen::ColMajor>, matrix<std::uint32_t, 3, Eigen::RowMajor>>();
    check_volume<matrix<float, 3, Eigen::RowMajor>, matrix<std::int64_t, Eigen::Dynamic, Eigen::ColMajor>>();
    check_volume<matrix<double, Eigen::Dynamic, Eigen::RowMajor>, matrix<std::uint64_t, 3, Eigen::ColMajor>>();
}

TEST_CASE("maps over foreign memory and blocks are viewed, temporaries are not") {
    double const xyz[12]{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    int const corners[12]{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    Eigen::Map<matrix<double, 3, Eigen::RowMajor> const> const V(xyz, 4, 3);
    Eigen::Map<matrix<int, 3, Eigen::RowMajor> const> const F(corners, 4, 3);
    CHECK(make_solid(view_matrices(V, F)).volume == Approx(1.0 / 6));
    Eigen::MatrixXd wide = Eigen::MatrixXd::Zero(4, 6);
    wide.leftCols(3) = V;
    auto const left = wide.leftCols(3);
    CHECK(make_solid(view_matrices(left, F)).volume == Approx(1.0 / 6));
    static_assert(!viewable<Eigen::MatrixXd, Eigen::MatrixXi const&>);
    static_assert(!viewable<Eigen::MatrixXd const&, Eigen::MatrixXi>);
    static_assert(!viewable<Eigen::MatrixXi const&, Eigen::MatrixXi const&>);
}

TEST_CASE("quads and rows padded with negative indices read as polygons") {
    indexed_mesh const cube = tafoni_test::unit_box();
    Eigen::MatrixXd V(8, 3);
    for (int v = 0; v < 8; ++v) {
        for (int a = 0; a < 3; ++a) V(v, a) = cube.positions[static_cast<std::size_t>(v)][a];
    }
    Eigen::MatrixXi F(7, 5);
    F.setConstant(-1);
    F.row(0) << 0, 2, 3, -1, -1;
    F.row(6) << 0, 3, 1, -1, -1;
    for (int f = 1; f < 6; ++f) {
        for (int k = 0; k < 4; ++k) F(f, k) = static_cast<int>(cube.face(static_cast<std::size_t>(f))[static_cast<std::size_t>(k)]);
    }
    solid const s = make_solid(view_matrices(V, F));
    CHECK(s.volume == 1);
    CHECK(s.polygon_count == 7);
}

TEST_CASE("matrices of the wrong width and negative corners are refused") {
    Eigen::MatrixXd const V = Eigen::MatrixXd::Zero(4, 3);
    Eigen::MatrixXi F = Eigen::MatrixXi::Zero(4, 3);
    Eigen::MatrixXd const two = Eigen::MatrixXd::Zero(4, 2);
    Eigen::MatrixXi const pairs = Eigen::MatrixXi::Zero(4, 2);
    CHECK_THROWS_AS(view_matrices(two, F), invalid_input);
    CHECK_THROWS_AS(view_matrices(V, pairs), invalid_input);
    F(2, 2) = -1;
    try {
        (void)make_solid(view_matrices(V, F));
        FAIL("accepted");
    } catch (invalid_input const& e) {
        CHECK(e.code() == errc::index_out_of_range);
        CHECK(e.place().index == 2);
    }
}
