#include <tafoni/geometry/span_mesh.hpp>

#include <tafoni/geometry/make_solid.hpp>

#include <catch2/catch.hpp>

#include <support/shapes.hpp>

#include <array>
#include <vector>

using namespace tafoni;

namespace {

template <class Scalar, class Index>
struct flat_arrays {
    std::vector<Scalar> coordinates{};
    std::vector<Index> corners{};
    std::vector<std::size_t> offsets{0};

    explicit flat_arrays(indexed_mesh const& m) {
        for (auto const& p : m.positions) {
            for (int a = 0; a < 3; ++a) coordinates.push_back(static_cast<Scalar>(p[a]));
        }
        for (auto const v : m.corners) corners.push_back(static_cast<Index>(v));
        offsets = m.offsets;
    }
};

template <class View>
bool reads_as(View const& view, indexed_mesh const& m) {
    using access = mesh_access<View>;
    if (access::vertex_count(view) != m.vertex_count() || access::face_count(view) != m.face_count()) return false;
    for (std::size_t v = 0; v < m.vertex_count(); ++v) {
        if (access::position(view, v) != m.positions[v]) return false;
    }
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        if (access::face_size(view, f) != m.face(f).size()) return false;
        for (std::size_t k = 0; k < m.face(f).size(); ++k) {
            if (access::corner(view, f, k) != m.face(f)[k]) return false;
        }
    }
    return true;
}

template <class A, class B>
concept viewable = requires(A&& a, B&& b) { view_triangles(std::forward<A>(a), std::forward<B>(b)); };

}  // namespace

TEMPLATE_TEST_CASE("flat arrays of any index type read as the mesh they hold", "", std::int8_t, std::uint8_t,
                   std::int16_t, std::uint16_t, std::int32_t, std::uint32_t, std::int64_t, std::uint64_t) {
    indexed_mesh const triangles = tafoni_test::fan_triangulated(tafoni_test::unit_box());
    flat_arrays<float, TestType> const f(triangles);
    flat_arrays<double, TestType> const d(triangles);
    auto const view = view_triangles(f.coordinates, f.corners);
    static_assert(triangle_mesh<std::remove_const_t<decltype(view)>>);
    CHECK(reads_as(view, triangles));
    CHECK(view.coordinates.data() == f.coordinates.data());
    CHECK(view.corners.data() == f.corners.data());
    CHECK(reads_as(view_triangles(d.coordinates, d.corners), triangles));
    CHECK(make_solid(view).volume == 1);

    indexed_mesh const polygons = tafoni_test::l_shape();
    flat_arrays<float, TestType> const p(polygons);
    CHECK(reads_as(view_polygons(p.coordinates, p.corners, p.offsets), polygons));
    CHECK(make_solid(view_polygons(p.coordinates, p.corners, p.offsets)).volume == Approx(3));
}

TEST_CASE("floats are read exactly") {
    std::array<float, 3> const xyz{0.1F, 1e-30F, -3.4e38F};
    auto const view = view_triangles(xyz, std::span<int const>{});
    using access = mesh_access<std::remove_const_t<decltype(view)>>;
    CHECK(access::position(view, 0) == vec3(double{0.1F}, double{1e-30F}, double{-3.4e38F}));
}

TEST_CASE("C arrays, spans and std arrays are viewed, temporaries that own memory are not") {
    float const xyz[12]{0, 0, 0, 3, 0, 0, 0, 3, 0, 0, 0, 3};
    std::array<unsigned, 12> const corners{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    CHECK(make_solid(view_triangles(xyz, corners)).volume == Approx(4.5));
    CHECK(make_solid(view_triangles(std::span(xyz), std::span(corners))).volume == Approx(4.5));
    static_assert(viewable<std::vector<float> const&, std::vector<int> const&>);
    static_assert(!viewable<std::vector<float>, std::vector<int> const&>);
    static_assert(!viewable<std::vector<int> const&, std::vector<int> const&>);
}

TEST_CASE("bad indices in flat arrays are refused by make_solid") {
    flat_arrays<float, int> f(tafoni_test::fan_triangulated(tafoni_test::unit_box()));
    f.corners[7] = -1;
    try {
        (void)make_solid(view_triangles(f.coordinates, f.corners));
        FAIL("accepted");
    } catch (invalid_input const& e) {
        CHECK(e.code() == errc::index_out_of_range);
        CHECK(e.place().index == 2);
    }
}

TEST_CASE("arrays that do not divide into threes, and offsets that do not fit, are refused") {
    std::vector<double> const xyz(12, 0.0);
    std::vector<double> const odd(13, 0.0);
    std::vector<int> const corners(6, 0);
    std::vector<int> const five(5, 0);
    CHECK_THROWS_AS(view_triangles(odd, corners), invalid_input);
    CHECK_THROWS_AS(view_triangles(xyz, five), invalid_input);
    std::vector<std::size_t> const good{0, 3, 6};
    CHECK_NOTHROW(view_polygons(xyz, corners, good));
    for (std::vector<std::size_t> const& bad : std::vector<std::vector<std::size_t>>{
             {}, {0}, {1, 6}, {0, 3}, {0, 9}, {0, 4, 3, 6}, {0, ~std::size_t{0}, 6}}) {
        CHECK_THROWS_AS(view_polygons(xyz, corners, bad), invalid_input);
    }
    CHECK_NOTHROW(view_polygons(xyz, std::span<int const>{}, std::span<std::size_t const>{}));
}
