#include "support/odd_meshes.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/geometry/indexed_mesh.hpp>
#include <tafoni/weathering/curvature_run.hpp>

#include <catch2/catch.hpp>

#include <limits>

using namespace tafoni;
using namespace tafoni_test;

namespace {

/// A number of the test's at every vertex.
struct given {
    double value = 0;
    void operator()(surface_view const&, std::span<double> mean, executor auto const&) const {
        for (std::size_t v = 0; v < mean.size(); ++v) mean[v] = v % 3 == 0 ? value : 0.5;
    }
};

}  // namespace

TEST_CASE("M4, M5, M14, M15: sheets that touch, cut or hold each other weather, the same on any threads") {
    thread_pool const pool(3);
    for (odd_mesh const& odd : odd_meshes(2)) {
        for (mesh_topology const topology : {mesh_topology::keep, mesh_topology::adapt}) {
            CAPTURE(odd.name, topology == mesh_topology::keep);
            curvature_options const options{.small_edge = 0.45, .topology = topology, .check_every = 4};
            curvature_run run(odd.mesh, {}, options);
            curvature_report const r = run.run(9);
            CHECK(r.stopped == curvature_stop::finished);  // what cut from the start is no news
            CHECK(r.iterations == 9);
            for (vec3 const& p : run.surface().positions) REQUIRE(is_finite(p));
            CHECK(std::isfinite(r.removed_volume));
            curvature_run other(odd.mesh, {}, options);
            other.run(9, {}, pool);
            CHECK(other.surface() == run.surface());
            for (vertex_index const v : run.new_vertex()) REQUIRE(v.value < run.surface().positions.size());
        }
    }
}

TEST_CASE("M15: a cavity grows no smaller, an island far away wears as it does alone") {
    std::vector<odd_mesh> const all = odd_meshes(2);
    odd_mesh const& cavity = all[5];
    REQUIRE(cavity.name == "M15: a cavity");
    curvature_run run(cavity.mesh, {}, {.topology = mesh_topology::keep});
    run.run(5);
    for (std::size_t v = cavity.part; v < 2 * cavity.part; ++v) CHECK(run.surface().positions[v] == cavity.mesh.positions[v]);
    for (std::size_t v = 0; v < cavity.part; ++v) CHECK(length(run.surface().positions[v]) < 1);
}

TEST_CASE("M17: a face of more than three corners is refused by number, and what triangulate makes of it weathers") {
    indexed_mesh m;
    std::vector<std::uint32_t> face;
    for (std::uint32_t k = 0; k < 1000; ++k) {
        face.push_back(k);
        m.add_vertex(vec3{std::cos(tau * k / 1000), std::sin(tau * k / 1000), 0});
    }
    m.add_face(face);
    try {
        curvature_run const run(m);
        FAIL("went through");
    } catch (invalid_input const& e) {
        CHECK(e.code() == errc::unsupported);
        CHECK(e.place().index == 0);
        CHECK(e.place().value == 1000);
    }
}

TEST_CASE("M18: a vertex of a hundred thousand triangles weathers in a moment") {
    for (mesh_topology const topology : {mesh_topology::keep, mesh_topology::adapt}) {
        curvature_run run(hub(100000, 0.5, true), {}, {.topology = topology});
        CHECK(run.run(2).iterations == 2);
        if (topology == mesh_topology::adapt) CHECK(run.report().edges_collapsed > 90000);
        for (vec3 const& p : run.surface().positions) REQUIRE(is_finite(p));
    }
}

TEST_CASE("M19: triangles that share no vertices are flat, each for itself: nothing wears until they are welded") {
    triangle_surface const ball = triangles_of(icosphere(2));
    curvature_run run(soup_of(ball));
    // What is left is rounding: no vertex moves as far as that of the ball does.
    run.run(3);
    for (double const w : run.wear()) CHECK(w < 1e-9);
    curvature_run welded(ball);
    CHECK(welded.run(3).iterations == 3);
}

TEST_CASE("M20: curvature that is not finite is refused by vertex, and nothing has moved") {
    triangle_surface const ball = triangles_of(icosphere(1));
    for (double const bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        curvature_run run(ball, curvature_weathering{.estimator = given{bad}}, {.topology = mesh_topology::keep});
        try {
            run.run(1);
            FAIL("went through");
        } catch (invalid_input const& e) {
            CHECK(e.code() == errc::out_of_range);
            CHECK(e.place().index == 0);
        }
        CHECK(run.surface() == ball);
        CHECK(run.report().iterations == 0);
    }
}
