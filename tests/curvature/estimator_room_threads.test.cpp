// On its own, for the thread sanitizer brings an operator new of its own.
#include "support/curved_surfaces.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/curvature/estimator_room.hpp>
#include <tafoni/curvature/tensor_fit.hpp>

#include <catch2/catch.hpp>

#include <vector>

using namespace tafoni;
using namespace tafoni_test;

TEST_CASE("a room may be used by several threads at once", "[threads]") {
    triangle_surface const s = torus_surface(30, 20, 0.2).mesh;
    vertex_rings const rings(s.positions.size(), s.triangles);
    estimator_room room;
    surface_view const view{.positions = s.positions, .triangles = s.triangles, .rings = &rings, .room = &room};
    std::vector<double> whole(s.positions.size());
    tensor_fit{}(view, whole, inline_executor{});
    thread_pool const pool(4);
    std::vector<std::vector<double>> means(16, std::vector<double>(s.positions.size()));
    pool.for_blocks(means.size(), 1, [&](std::size_t k, std::size_t) { tensor_fit{}(view, means[k], pool); });
    for (auto const& m : means) CHECK(m == whole);
}
