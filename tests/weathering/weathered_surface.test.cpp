#include <tafoni/weathering/weathered_surface.hpp>

#include <tafoni/decomposition/random_sites.hpp>
#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/graph/make_link_graph.hpp>
#include <tafoni/testing/structure_archetypes.hpp>
#include <tafoni/weathering/frost_run.hpp>

#include <catch2/catch.hpp>

#include "support/shapes.hpp"
#include "support/surface_laws.hpp"

using namespace tafoni;

namespace {

shard_complex shards_of(indexed_mesh const& mesh, std::size_t count) {
    solid const body = make_solid(mesh);
    return voronoi_shards(body, random_sites{.count = count}(body, 5));
}

double triangle_area(indexed_mesh const& m, std::size_t t) {
    auto const v = m.face(t);
    return 0.5 * length(cross(m.positions[v[1]] - m.positions[v[0]], m.positions[v[2]] - m.positions[v[0]]));
}

}  // namespace

TEST_CASE("what stands after a run is a closed 2-manifold of the standing volume, skin and breaks of the links' areas") {
    for (auto const& mesh : {tafoni_test::unit_box(), tafoni_test::l_shape(), tafoni_test::frame()}) {
        auto const shards = shards_of(mesh, 150);
        auto const links = make_link_graph(shards);
        frost_run run(links, frost_wedging{}, {.seed = 2});
        run.run({.paths = 4000});
        REQUIRE(run.report().cells_detached > 5);
        auto const s = extract_weathered_surface(shards, run);
        CHECK(tafoni_test::manifold_defects(s.surface.mesh) == 0);
        CHECK(tafoni_test::signed_volume(s.surface.mesh) ==
              Approx(make_solid(mesh).volume - run.report().volume_detached).epsilon(1e-9));
        double fresh = 0;
        double skin = 0;
        for (std::size_t t = 0; t < s.surface.mesh.face_count(); ++t) {
            (s.surface.fresh[t] != 0 ? fresh : skin) += triangle_area(s.surface.mesh, t);
        }
        double open = 0;
        double old = 0;
        for (std::size_t i = 0; i < links.link_count(); ++i) {
            auto const ends = links.link_cells(link_index{i});
            bool const first = run.cell(ends[0]) != cell_state::air;
            if (!ends[1].valid()) {
                old += first ? links.link_area(link_index{i}) : 0;
            } else if (first != (run.cell(ends[1]) != cell_state::air)) {
                open += links.link_area(link_index{i});
            }
        }
        CHECK(fresh == Approx(open).epsilon(1e-6));
        CHECK(skin == Approx(old).epsilon(1e-6));
    }
}

TEST_CASE("life is the link's where frost laid a face open, and only there; elsewhere the shard's hold") {
    auto const shards = shards_of(tafoni_test::l_shape(), 200);
    auto const links = make_link_graph(shards);
    frost_run run(links, frost_wedging{}, {.seed = 3});
    run.run({.paths = 5000});
    auto const s = extract_weathered_surface(shards, run);
    std::size_t const n = s.surface.mesh.face_count();
    REQUIRE(s.life.size() == n);
    REQUIRE(s.hold.size() == n);
    REQUIRE(s.exposed.size() == n);
    std::size_t worn = 0;
    for (std::size_t t = 0; t < n; ++t) {
        face_index const face = s.surface.face[t];
        cell_index const cell = s.surface.cell[t];
        auto const ends = shards.face_cells(face);
        REQUIRE((s.surface.fresh[t] != 0) == ends[1].valid());
        REQUIRE(run.cell(cell) != cell_state::air);
        double area = 0;
        double sum = 0;
        for (link_index const l : links.bonds_of(cell)) {
            area += links.link_area(l);
            sum += links.link_area(l) * run.life(l);
        }
        REQUIRE(s.hold[t] == Approx(area > 0 ? sum / area : 1.0));
        REQUIRE((s.life[t] >= 0 && s.life[t] <= 1));
        REQUIRE((s.hold[t] >= 0 && s.hold[t] <= 1));
        link_index const link = links.link_of(face);
        bool const is_bond = ends[1].valid() && link.valid();
        REQUIRE(s.life[t] == (is_bond ? run.life(link) : s.hold[t]));
        REQUIRE(s.exposed[t] == (link.valid() && run.state(link) == link_state::skin ? 1 : 0));
        worn += is_bond && run.life(link) < 1 ? 1U : 0U;
    }
    CHECK(worn > 20);
}

TEST_CASE("a closed pocket is laid open but not exposed") {
    // The middle one of 27 cubes, marked air before the first path.
    std::vector<vec3> sites;
    for (int i = 0; i < 27; ++i) sites.push_back(vec3{i % 3 + 0.5, i / 3 % 3 + 0.5, i / 9 + 0.5});
    auto const shards = voronoi_shards(make_solid(tafoni_test::box(vec3{0, 0, 0}, vec3{3, 3, 3})), sites);
    auto const links = make_link_graph(shards);
    frost_run run(links);
    auto const whole = extract_weathered_surface(shards, run);
    CHECK(tafoni_test::signed_volume(whole.surface.mesh) == Approx(27));
    for (std::size_t t = 0; t < whole.life.size(); ++t) REQUIRE((whole.life[t] == 1 && whole.exposed[t] == 1));

    for (std::size_t c = 0; c < 27; ++c) {
        if (length(shards.cell_centroid(cell_index{c}) - vec3{1.5, 1.5, 1.5}) < 0.1) run.mark(cell_index{c}, cell_state::air);
    }
    auto const s = extract_weathered_surface(shards, run);
    CHECK(tafoni_test::signed_volume(s.surface.mesh) == Approx(26));
    CHECK(tafoni_test::manifold_defects(s.surface.mesh) == 0);
    double pocket = 0;
    for (std::size_t t = 0; t < s.life.size(); ++t) {
        REQUIRE((s.exposed[t] == 0) == (s.surface.fresh[t] != 0));
        pocket += s.exposed[t] == 0 ? triangle_area(s.surface.mesh, t) : 0;
    }
    CHECK(pocket == Approx(6));
}

TEST_CASE("the surface of a complex that the run does not belong to is refused; of nothing it is empty") {
    auto const shards = shards_of(tafoni_test::unit_box(), 40);
    auto const links = make_link_graph(shards);
    frost_run run(links);
    CHECK_THROWS_AS(extract_weathered_surface(shards_of(tafoni_test::unit_box(), 41), run), invalid_input);
    CHECK_THROWS_AS(extract_weathered_surface(shards_of(tafoni_test::l_shape(), 40), run), invalid_input);
    for (std::size_t c = 0; c < links.cell_count(); ++c) run.mark(cell_index{c}, cell_state::air);
    auto const none = extract_weathered_surface(shards, run);
    CHECK(none.surface.mesh.face_count() == 0);
    CHECK(none.life.empty());
}

TEST_CASE("the least complex has a weathered surface") {
    archetypes::complex const two;
    auto const links = make_link_graph(two);
    frost_run const run(links);
    auto const s = extract_weathered_surface(two, run);
    CHECK(tafoni_test::signed_volume(s.surface.mesh) == Approx(2));
    CHECK(s.life == std::vector<double>(s.surface.mesh.face_count(), 1));
}
