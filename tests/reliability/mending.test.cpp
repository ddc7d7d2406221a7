#include <tafoni/geometry/repair_mesh.hpp>

#include <catch2/catch.hpp>

using namespace tafoni;

TEST_CASE("law 34: a face that stands alone is no hole, so mending twice changes nothing more") {
    indexed_mesh m;
    for (vec3 const& p : {vec3{0, 0, 0}, vec3{1, 0, 0}, vec3{1, 1, 0}, vec3{0, 1, 0}}) m.add_vertex(p);
    m.add_face({0, 1, 2, 3});
    repair_options const options{.drop_duplicates = true, .fill_holes = 15};
    repaired_mesh const once = repair_mesh(m, options);
    CHECK(once.report.filled_holes == 0);
    CHECK(once.mesh == m);
    m.add_vertex(vec3{0.5, 0.5, 1});
    m.add_face({1, 0, 4});
    m.add_face({2, 1, 4});
    m.add_face({3, 2, 4});
    repaired_mesh const pyramid = repair_mesh(m, options);  // one side of it is a hole
    CHECK(pyramid.report.filled_holes == 1);
    CHECK(repair_mesh(pyramid.mesh, options).mesh == pyramid.mesh);
}
