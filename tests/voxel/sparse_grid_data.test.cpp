#include "support/test_data.hpp"

#include <catch2/catch.hpp>

#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/io/read_mesh.hpp>
#include <tafoni/voxel/fill_from_solid.hpp>
#include <tafoni/voxel/frame_for.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

using namespace tafoni;

TEST_CASE("the memory of a scanned bust grows with its surface: a few MiB at 512 along its height") {
    auto const path = tafoni_test::find("meshes/nefertiti_35k.ply");
    if (path.empty()) {
        WARN("skipped: no data");
        return;
    }
    solid const bust = make_solid(read_mesh(path).mesh);
    std::array<double, 3> bytes{};
    for (std::size_t k = 0; k < 3; ++k) {
        std::size_t const n = std::size_t{128} << k;
        sparse_grid grid(frame_for(bust.bounds, n));
        std::size_t const rock = fill_from_solid(grid, bust);
        CHECK(grid.count(voxel_plane::rock) == rock);
        bytes[k] = static_cast<double>(grid.bytes());
        CAPTURE(n, rock, bytes[k]);
        CHECK(bytes[k] < (n == 512 ? 20e6 : 5e6));
    }
    CAPTURE(bytes[0], bytes[1], bytes[2]);
    CHECK(bytes[1] < 6 * bytes[0]);  // a volume would take eight times as much
    CHECK(bytes[2] < 6 * bytes[1]);
}
