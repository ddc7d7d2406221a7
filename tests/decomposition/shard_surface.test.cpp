#include <tafoni/decomposition/shard_surface.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/geometry/make_solid.hpp>

#include <catch2/catch.hpp>

#include <map>

#include "support/shapes.hpp"
#include "support/surface_laws.hpp"

using namespace tafoni;

namespace {

std::vector<vec3> some_points(box3 const& box, std::size_t n) {
    std::vector<vec3> points;
    stream draw(9, stage::user, 0);
    for (std::size_t k = 0; k < n; ++k) {
        vec3 p{0, 0, 0};
        for (int a = 0; a < 3; ++a) p[a] = draw.uniform(box.lo[a], box.hi[a]);
        points.push_back(p);
    }
    return points;
}

/// Unit cubes at whole places, as a complex of its own: the least that can touch along edges.
struct cubes {
    std::vector<std::array<int, 3>> at;
    std::size_t cell_count() const { return at.size(); }
    double cell_volume(cell_index) const { return 1; }
    vec3 cell_centroid(cell_index c) const { return vec3{at[c.value][0] + 0.5, at[c.value][1] + 0.5, at[c.value][2] + 0.5}; }
    std::size_t vertex_count() const { return 1000; }
    vec3 position(vertex_index v) const { return vec3(v.value % 10, v.value / 10 % 10, v.value / 100); }
    std::size_t face_count() const { return 6 * at.size(); }
    std::array<cell_index, 2> face_cells(face_index f) const {
        auto other = at[f.value / 6];
        other[f.value % 6 / 2] += f.value % 2 == 0 ? -1 : 1;
        for (std::size_t k = 0; k < at.size(); ++k) {
            if (at[k] == other) return {cell_index{f.value / 6}, cell_index{k}};
        }
        return {cell_index{f.value / 6}, cell_index{}};
    }
    std::size_t loop_count(face_index) const { return 1; }
    std::array<vertex_index, 4> face_loop(face_index f, std::size_t) const {
        auto const p = at[f.value / 6];
        std::size_t const axis = f.value % 6 / 2;
        std::array<vertex_index, 4> r{};
        for (std::size_t k = 0; k < 4; ++k) {
            auto q = p;
            std::size_t const turn = f.value % 2 == 0 ? 3 - k : k;
            q[axis] += f.value % 2 == 0 ? 0 : 1;
            q[(axis + 1) % 3] += turn == 1 || turn == 2 ? 1 : 0;
            q[(axis + 2) % 3] += turn >= 2 ? 1 : 0;
            r[k] = vertex_index{static_cast<std::uint32_t>(q[0] + 10 * q[1] + 100 * q[2])};
        }
        return r;
    }
    patch_index face_patch(face_index) const { return {}; }
    double model_size() const { return 10; }
};
static_assert(cell_complex<cubes>);

}  // namespace

TEST_CASE("the surface of any set of shards is a closed 2-manifold around their volume") {
    using namespace tafoni_test;
    for (auto const& mesh : {unit_box(), l_shape(), box_with_cavity(), two_boxes(), tafoni_test::frame(), torus(2, 0.6, 24, 12), thin_limbs(), relief(12)}) {
        solid const body = make_solid(mesh);
        for (std::size_t n : {std::size_t{1}, std::size_t{4}, std::size_t{120}}) {
            auto const c = voronoi_shards(body, some_points(body.bounds, n));
            for (std::size_t step : {std::size_t{1}, std::size_t{2}, std::size_t{3}}) {
                std::vector<std::uint8_t> inside(c.cell_count(), 0);
                double volume = 0;
                for (std::size_t k = 0; k < inside.size(); k += step) {
                    inside[k] = 1;
                    volume += c.volumes[k];
                }
                auto const s = extract_surface(c, inside);
                CHECK(manifold_defects(s.mesh) == 0);
                CHECK(signed_volume(s.mesh) == Approx(volume).epsilon(1e-9));
                for (std::size_t t = 0; t < s.mesh.face_count(); ++t) {
                    auto const& face = c.faces[s.face[t].value];
                    REQUIRE((s.cell[t] == face.front || s.cell[t] == face.back));
                    REQUIRE(inside[s.cell[t].value] == 1);
                    REQUIRE((s.fresh[t] != 0) == face.back.valid());
                }
            }
        }
    }
}

TEST_CASE("a list of shards gives the same triangles as a mask") {
    solid const body = make_solid(tafoni_test::l_shape());
    auto const c = voronoi_shards(body, some_points(body.bounds, 60));
    std::vector<std::uint8_t> inside(c.cell_count(), 0);
    std::vector<cell_index> cells;
    for (std::uint32_t k = 3; k < 20; ++k) {
        inside[k] = 1;
        cells.push_back(cell_index{k});
    }
    auto const a = extract_surface(c, inside);
    auto const b = extract_surface(c, cells);
    CHECK(a.mesh.face_count() == b.mesh.face_count());
    CHECK(tafoni_test::signed_volume(a.mesh) == Approx(tafoni_test::signed_volume(b.mesh)));
    CHECK_THROWS_AS(extract_surface(c, std::vector<cell_index>{cell_index{c.cell_count()}}), invalid_input);
    CHECK_THROWS_AS(extract_surface(c, std::vector<std::uint8_t>(3, 1)), invalid_input);
    CHECK(extract_surface(c, std::vector<cell_index>{}).mesh.face_count() == 0);
}

TEST_CASE("cells that touch along an edge or at a corner are separated into sheets") {
    std::vector<std::vector<std::array<int, 3>>> const cases{
        {{0, 0, 0}, {1, 1, 0}},                        // along an edge
        {{0, 0, 0}, {1, 1, 1}},                        // at a corner
        {{0, 0, 0}, {1, 1, 0}, {0, 0, 1}, {1, 1, 1}},  // along two edges in a row
        {{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}},  // a checkerboard
        {{0, 0, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}},  // joined behind the edge
        {{0, 0, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 0, 2}, {1, 1, 2}, {0, 1, 3}, {0, 0, 3}, {1, 1, 3}},
        {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}, {0, 0, -1}, {0, 1, -1}, {1, 1, -1}}};
    for (auto const& at : cases) {
        cubes c{at};
        for (auto& p : c.at) {
            for (int& x : p) x += 2;
        }
        auto const s = extract_surface(c, std::vector<std::uint8_t>(at.size(), 1));
        CHECK(tafoni_test::manifold_defects(s.mesh) == 0);
        CHECK(tafoni_test::signed_volume(s.mesh) == Approx(static_cast<double>(at.size())));
    }
}

TEST_CASE("holes of a face are bridged, and the triangles cover its area") {
    solid const body = make_solid(tafoni_test::frame());
    auto const c = voronoi_shards(body, std::vector<vec3>{vec3{1.5, 1.5, 0.25}, vec3{1.5, 1.5, 0.75}});
    auto const s = extract_surface(c, std::vector<cell_index>{cell_index{std::uint32_t{0}}});
    double fresh = 0;
    for (std::size_t t = 0; t < s.mesh.face_count(); ++t) {
        auto const tri = s.mesh.face(t);
        vec3 const& p = s.mesh.positions[tri[0]];
        if (s.fresh[t] != 0) fresh += 0.5 * length(cross(vec3(s.mesh.positions[tri[1]] - p), vec3(s.mesh.positions[tri[2]] - p)));
    }
    CHECK(fresh == Approx(8).epsilon(1e-12));
    CHECK(tafoni_test::manifold_defects(s.mesh) == 0);
}
