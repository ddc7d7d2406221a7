#include "support/shapes.hpp"

#include <catch2/catch.hpp>

#include <map>
#include <utility>

namespace {

namespace t = tafoni_test;
using tafoni::indexed_mesh;

/// Every directed edge has exactly one opposite.
bool closed(indexed_mesh const& m) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        auto const loop = m.face(f);
        for (std::size_t k = 0; k < loop.size(); ++k) ++edges[{loop[k], loop[(k + 1) % loop.size()]}];
    }
    for (auto const& [edge, count] : edges) {
        auto const opposite = edges.find({edge.second, edge.first});
        if (count != 1 || opposite == edges.end()) return false;
    }
    return true;
}

long euler(indexed_mesh const& m) {
    return static_cast<long>(m.vertex_count()) - static_cast<long>(m.corners.size() / 2) +
           static_cast<long>(m.face_count());
}

}  // namespace

TEST_CASE("every test shape is closed, oriented outwards and of the stated volume") {
    CHECK(t::signed_volume(t::unit_box()) == Approx(1));
    CHECK(t::signed_volume(t::l_shape()) == Approx(3));
    CHECK(t::signed_volume(t::box_with_cavity()) == Approx(26));
    CHECK(t::signed_volume(t::two_boxes()) == Approx(2));
    CHECK(t::signed_volume(t::frame()) == Approx(8));
    CHECK(t::signed_volume(t::tetrahedron()) == Approx(1.0 / 6));
    CHECK(t::signed_volume(t::torus(2, 0.5, 200, 100)) == Approx(9.8696044).epsilon(2e-3));
    CHECK(t::signed_volume(t::icosphere(4)) == Approx(4.1887902).epsilon(1e-2));
    CHECK(t::surface_area(t::l_shape()) == Approx(14));
    CHECK(t::surface_area(t::box_with_cavity()) == Approx(60));
    CHECK(t::surface_area(t::frame()) == Approx(32));
    for (indexed_mesh const& m : {t::unit_box(), t::l_shape(), t::box_with_cavity(), t::two_boxes(), t::frame(),
                                  t::tetrahedron(), t::torus(2, 0.5, 12, 8), t::icosphere(2), t::thin_limbs(),
                                  t::relief(), t::terrain_block(), t::fan_triangulated(t::torus(1, 0.25, 7, 5))}) {
        CHECK(closed(m));
        CHECK(t::signed_volume(m) > 0);
    }
}

TEST_CASE("the test shapes have the stated genus") {
    CHECK(euler(t::l_shape()) == 2);
    CHECK(euler(t::box_with_cavity()) == 4);
    CHECK(euler(t::two_boxes()) == 4);
    CHECK(euler(t::frame()) == 0);
    CHECK(euler(t::torus(2, 0.5, 12, 8)) == 0);
    CHECK(euler(t::icosphere(3)) == 2);
    CHECK(euler(t::thin_limbs()) == 2);
    CHECK(euler(t::relief()) == 2);
    CHECK(euler(t::terrain_block()) == 2);
}
