#include "percolation/box_network.hpp"
#include "support/shapes.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/decomposition/random_sites.hpp>
#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/decomposition/voxel_cells.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/graph/air_flood.hpp>
#include <tafoni/graph/make_link_graph.hpp>
#include <tafoni/graph/surface_walk.hpp>
#include <tafoni/testing/archetypes.hpp>
#include <tafoni/testing/laws.hpp>
#include <tafoni/weathering/frost_run.hpp>

#include <catch2/catch.hpp>

#include <limits>

using namespace tafoni;
using tafoni_test::box_network;

namespace {

double const nan_value = std::numeric_limits<double>::quiet_NaN();

struct long_rain {
    vec3 draw(stream&) const { return {0, 0, -2}; }
};
struct forgetful_rain {
    int* calls;
    vec3 draw(stream&) const { return ++*calls % 2 != 0 ? vec3{0, 0, -1} : vec3{1, 0, 0}; }
};
template <int Which>
struct wrong {
    double acceptance(link_view const&, vec3 const&) const { return answer(); }
    double weight(link_view const&, link_view const&, water const&) const { return answer(); }
    double absorbed(link_view const&, water const&, link_scale const&) const { return answer(); }
    double soak_chance(link_view const&, water const&) const { return answer(); }
    double damage(link_view const&, double, link_scale const&) const { return answer(); }
    double break_chance(link_view const&) const { return answer(); }
    double operator()(vec3 const&) const { return answer(); }
    static double answer() { return Which == 0 ? -0.5 : Which == 1 ? nan_value : std::numeric_limits<double>::infinity(); }
};
struct first_falls {
    falling decide(part const&, part const&) const { return falling::first; }
};
struct zero_divider {  // NaN only where two links lie at one place
    double weight(link_view const& here, link_view const& there, water const&) const {
        vec3 const d = there.centroid - here.centroid;
        return d[2] * d[2] / dot(d, d);
    }
};
struct twice {
    void for_blocks(std::size_t n, std::size_t grain, auto const& f) const {
        inline_executor{}.for_blocks(n, grain, f);
        inline_executor{}.for_blocks(n, grain, f);
    }
    std::size_t thread_count() const { return 1; }
};
struct nothing_opens : air_flood {
    template <link_network N>
    void update(N const&, std::span<cell_state const>, std::span<cell_index const>, state&, std::span<link_state>,
                exposure_change&) const {}
};
struct moody_sites {
    int* calls;
    std::vector<vec3> operator()(solid const&, std::uint64_t) const { return {vec3{double(++*calls), 0, 0}}; }
};

}  // namespace

TEST_CASE("law checks find policies that leave their range") {
    CHECK_FALSE(laws::rain(long_rain{}).empty());
    int calls = 0;
    CHECK_FALSE(laws::rain(forgetful_rain{&calls}).empty());
    auto const all = [](auto const& w) {
        CHECK_FALSE(laws::infiltration(w).empty());
        CHECK_FALSE(laws::flow(w).empty());
        CHECK_FALSE(laws::absorption(w).empty());
        CHECK_FALSE(laws::soaking(w).empty());
        CHECK_FALSE(laws::damage(w).empty());
        CHECK_FALSE(laws::breakage(w).empty());
        CHECK_FALSE(laws::field(w, 0, 1).empty());
    };
    all(wrong<0>{});
    all(wrong<1>{});
    all(wrong<2>{});
    CHECK_FALSE(laws::detachment(first_falls{}).empty());
    CHECK_FALSE(laws::flow(zero_divider{}).empty());
}

TEST_CASE("law checks find structures that break their laws") {
    CHECK_FALSE(laws::runs_blocks(twice{}).empty());
    int calls = 0;
    CHECK_FALSE(laws::sites(moody_sites{&calls}, solid{}).empty());
    CHECK_FALSE(laws::sites([](solid const&, std::uint64_t) { return std::vector<vec3>{}; }, solid{}).empty());
    CHECK_FALSE(laws::exposure(nothing_opens{}, box_network(3, 3, 3)).empty());
    box_network n(2, 2, 2);
    CHECK(laws::network(n).empty());
    n.neighbors[3].pop_back();
    CHECK_FALSE(laws::network(n).empty());
    box_network area(2, 2, 2);
    area.links[1].area = -1;
    CHECK_FALSE(laws::network(area).empty());
    box_network normal(2, 2, 2);
    normal.links[1].normal = vec3{0, 0, 2};
    CHECK_FALSE(laws::network(normal).empty());
}

TEST_CASE("archetypes keep the laws of their concepts") {
    CHECK(laws::rain(archetypes::rain(0)).empty());
    CHECK(laws::infiltration(archetypes::infiltration(0)).empty());
    CHECK(laws::flow(archetypes::flow(0)).empty());
    CHECK(laws::absorption(archetypes::absorption(0)).empty());
    CHECK(laws::soaking(archetypes::soaking(0)).empty());
    CHECK(laws::damage(archetypes::harm(0)).empty());
    CHECK(laws::breakage(archetypes::breakage(0)).empty());
    CHECK(laws::detachment(archetypes::detachment(0)).empty());
    CHECK(laws::field(archetypes::field(0), 0, 1).empty());
    CHECK(laws::runs_blocks(archetypes::executor(0)).empty());
    CHECK(laws::network(archetypes::network{}).empty());
    CHECK(laws::mesh(archetypes::mesh{}).empty());
    CHECK(laws::complex(archetypes::complex{}).empty());
    solid const body = make_solid(archetypes::mesh{});
    CHECK(laws::sites(archetypes::sites(0), body).empty());
    CHECK(laws::exposure(archetypes::exposure(0), box_network(3, 3, 3)).empty());
}

TEST_CASE("from mesh to weathered rock, everything is compiled with the least types and runs") {
    solid const body = make_solid(archetypes::mesh{});
    CHECK(body.volume == Approx(1.0 / 6));
    auto const sites = archetypes::sites(0)(body, 1);
    CHECK(make_link_graph(voronoi_shards(body, sites, {}, archetypes::executor(0))).exterior_link_count() > 0);

    archetypes::complex const cubes;
    link_graph const links = make_link_graph(cubes, {}, archetypes::executor(0));
    CHECK(links.interior_link_count() == 1);
    CHECK(links.exterior_link_count() == 10);
    CHECK(links.neighbors(link_index{0U}).size() == 8);
    CHECK(links.link_normal(link_index{0U})[2] == -1);  // out of the upper cube

    archetypes::network const pair;
    frost_run run(pair, frost_wedging{}, {}, archetypes::exposure(0));
    auto const saved = run.checkpoint();
    frost_run copy = run;
    CHECK(run.break_link(link_index{1U}));
    CHECK(run.report().cells_detached == 1);
    CHECK(run.state(link_index{1U}) == link_state::skin);  // laid open: rock on one side, air on the other
    copy.resume(saved);
    CHECK((copy.checkpoint() == saved));
}

TEST_CASE("law checks find meshes that are read wrongly") {
    indexed_mesh const box = tafoni_test::unit_box();
    CHECK(laws::mesh(box).empty());
    auto const one = [](indexed_mesh const& m) {
        auto const broken = laws::mesh(m);
        return broken.size() == 1 ? broken[0] : std::string();
    };
    CHECK(one(tafoni_test::inside_out(box)).find("counter-clockwise") != std::string::npos);
    indexed_mesh far = box;
    far.corners[5] = 99;
    CHECK(one(far).find("exist") != std::string::npos);
    indexed_mesh twice = box;
    twice.corners[1] = twice.corners[0];
    CHECK(one(twice).find("differ") != std::string::npos);
    indexed_mesh lost = box;
    lost.positions[3][1] = nan_value;
    CHECK(one(lost).find("finite") != std::string::npos);
    indexed_mesh open = box;
    open.corners.resize(open.corners.size() - 4);
    open.offsets.pop_back();
    CHECK(laws::mesh(open).empty());
}

TEST_CASE("shipped executors and exposures keep their laws") {
    CHECK(laws::runs_blocks(inline_executor{}).empty());
    CHECK(laws::runs_blocks(thread_pool(3)).empty());
    CHECK(laws::exposure(air_flood{}, box_network(4, 3, 3)).empty());
    CHECK(laws::exposure(surface_walk{}, box_network(4, 3, 3)).empty());
}

TEST_CASE("shipped decompositions and their links keep their laws") {
    auto const voxels = voxel_cells::from_indices({.size = {4, 4, 4}}, [](std::size_t i, std::size_t j, std::size_t k) {
        return i + j + k < 8 && !(i == 1 && j == 1 && k == 1);
    });
    CHECK(laws::network(voxels).empty());
    CHECK(laws::complex(voxels).empty());
    CHECK(laws::exposure(air_flood{}, voxels).empty());
    solid const body = make_solid(tafoni_test::l_shape());
    random_sites const pattern{.count = 60};
    CHECK(laws::sites(pattern, body).empty());
    auto const shards = voronoi_shards(body, pattern(body, 1));
    CHECK(laws::complex(shards).empty());
    auto const links = make_link_graph(shards);
    CHECK(laws::network(links).empty());
    CHECK(laws::exposure(air_flood{}, links).empty());
}
