// Bytes choose a small solid, sites and options: what voronoi_shards makes of them keeps its laws.
#include "check_mesh_file.hpp"
#include "reliability/cases.hpp"

#include <tafoni/graph/make_link_graph.hpp>
#include <tafoni/testing/structure_laws.hpp>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size) {
    using namespace tafoni;
    tafoni_test::choices c(std::span(bytes, size));
    tafoni_test::random_body const body = tafoni_test::make_random_body(c);
    solid s;
    try {
        s = make_solid(body.mesh);
    } catch (bad_topology const&) {  // rounded far away, a needle may have no volume left
        return 0;
    } catch (invalid_input const&) {
        return 0;
    }
    std::string name;
    std::vector<vec3> const sites = tafoni_test::make_random_sites(s, c, name);
    voronoi_shards_options const options{.duplicates = duplicate_sites::merge,
                                         .patch_angle = 180 * c.unit(),
                                         .min_volume = c.chance(0.8) ? 1e-12 : 0.1 * c.unit()};
    shard_complex const shards = voronoi_shards(s, sites, options);
    for (std::string const& law : tafoni_test::broken_laws(s, shards, tafoni_test::laws_for(body, s, 5))) {
        tafoni_test::require(false, law.c_str());
    }
    for (std::string const& law : laws::network(make_link_graph(shards))) tafoni_test::require(false, law.c_str());
    return 0;
}
