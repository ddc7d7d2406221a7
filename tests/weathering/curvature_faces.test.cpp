// Where the faces of the input are after edges were collapsed.
#include <tafoni/weathering/curvature_run.hpp>

#include <catch2/catch.hpp>

#include "support/curved_surfaces.hpp"
#include "support/water_scenes.hpp"

#include <cstddef>
#include <vector>

using namespace tafoni;

namespace {

/// Whether the faces that are left are all found, each once, in order and at the corners that the vertices went to.
bool all_found(triangle_surface const& input, auto const& run) {
    std::vector<face_index> const face = run.new_face();
    triangle_surface const now = run.surface();
    if (face.size() != input.triangles.size()) return false;
    std::size_t next = 0;
    for (std::size_t f = 0; f < face.size(); ++f) {
        auto const& t = input.triangles[f];
        std::array<std::uint32_t, 3> moved{};
        for (std::size_t k = 0; k < 3; ++k) moved[k] = run.new_vertex()[t[k]].value;
        bool const flat = moved[0] == moved[1] || moved[1] == moved[2] || moved[2] == moved[0];
        if (face[f].valid() == flat) return false;
        if (flat) continue;
        if (face[f].value != next || now.triangles[next] != moved) return false;
        ++next;
    }
    return next == now.triangles.size();
}

}  // namespace

TEST_CASE("faces of the input are found again after many collapses, on closed and on open meshes") {
    auto const ridge = [](double x, double y) { return x > 4 && x < 6 && y > 3 ? 2.0 : 0.0; };
    for (triangle_surface const& input : {tafoni_test::slab(10, 0.4), tafoni_test::sheet(24, ridge, 0.45)}) {
        curvature_run run(input, curvature_weathering{}, {.step_divisor = 4, .small_edge = 0.5});
        CHECK(all_found(input, run));
        CHECK(run.new_face()[7] == face_index{7U});
        for (int k = 0; k < 4; ++k) {
            run.run(60);
            CHECK(all_found(input, run));
        }
        CHECK(run.report().edges_collapsed > 10);
        curvature_run other(input, curvature_weathering{}, {.step_divisor = 4, .small_edge = 0.5});
        other.resume(run.checkpoint());
        CHECK(other.new_face() == run.new_face());
    }
}
