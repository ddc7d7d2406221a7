#include <tafoni/decomposition/voronoi_shards.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/random_sites.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/geometry/terrain_solid.hpp>
#include <tafoni/io/esri_ascii.hpp>
#include <tafoni/io/read_mesh.hpp>

#include <catch2/catch.hpp>

#include "support/shard_laws.hpp"
#include "support/test_data.hpp"

using namespace tafoni;

namespace {

void check(solid const& body, std::size_t sites, bool embedded, std::size_t points = 60) {
    auto const c = voronoi_shards(body, random_sites{.count = sites}(body, 7));
    auto const broken = tafoni_test::broken_laws(body, c, {.embedded = embedded, .points = points});
    for (auto const& b : broken) UNSCOPED_INFO(b);
    CHECK(broken.empty());
    CHECK(c.cell_count() >= sites);
}

void check_mesh(char const* name, std::size_t sites, bool embedded = true) {
    auto const path = tafoni_test::find(std::string("meshes/") + name);
    if (path.empty()) {
        WARN("skipped without data: " << name);
        return;
    }
    check(make_solid(read_mesh(path).mesh), sites, embedded);
}

}  // namespace

TEST_CASE("the hill of the paper keeps the laws") {
    check_mesh("hill3d_1.9k_quads.obj", 300);
}

TEST_CASE("a mechanical part of genus 3 keeps the laws") {
    check_mesh("mechpart_7.6k.obj", 200);
}

TEST_CASE("a solid that cuts itself keeps closure and the volume of its chain") {
    check_mesh("wingnut_3k.obj", 300, false);
}

TEST_CASE("statue, column and asteroid keep the laws", "[slow]") {
    check_mesh("nefertiti_35k.ply", 1000);
    check_mesh("column03_7k.obj", 1000);
    check_mesh("itokawa_6k.obj", 1000);
    check_mesh("hill3d_1.9k_quads.obj", 10000);
}

TEST_CASE("thin limbs that cut themselves keep closure and the volume of their chain", "[slow]") {
    check_mesh("scorpion_50k.ply", 2000, false);
}

TEST_CASE("an alpine terrain keeps the laws", "[slow]") {
    auto const path = tafoni_test::find("dems/stubai_10m.asc");
    if (path.empty()) {
        WARN("skipped without data: stubai_10m.asc");
        return;
    }
    check(terrain_solid(read_esri_ascii(path)), 3000, true, 30);
}
