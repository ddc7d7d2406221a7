#include "support/shapes.hpp"
#include "support/shard_laws.hpp"

#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/graph/make_link_graph.hpp>
#include <tafoni/testing/structure_laws.hpp>

#include <catch2/catch.hpp>

using namespace tafoni;
using namespace tafoni_test;

namespace {

constexpr voronoi_shards_options merging{.duplicates = duplicate_sites::merge};

shard_complex checked_shards(solid const& s, std::vector<vec3> const& sites, voronoi_shards_options const& options = merging) {
    shard_complex c = voronoi_shards(s, sites, options);
    for (std::string const& law : broken_laws(s, c, {.points = 50})) FAIL_CHECK(law);
    for (std::string const& law : laws::network(make_link_graph(c))) FAIL_CHECK(law);
    return c;
}

template <class F>
error_place refused(errc code, F const& f) {
    try {
        f();
    } catch (invalid_input const& e) {
        CHECK(e.code() == code);
        return e.place();
    }
    FAIL_CHECK("accepted");
    return {};
}

}  // namespace

TEST_CASE("P1: no site at all is refused") {
    solid const s = make_solid(l_shape());
    (void)refused(errc::no_sites, [&] { (void)voronoi_shards(s, std::span<vec3 const>{}); });
}

TEST_CASE("P2: one site gets the whole solid, one shard per piece") {
    auto const l = checked_shards(make_solid(l_shape()), {{0.5, 0.5, 0.5}});
    CHECK(l.cell_count() == 1);
    CHECK(l.volumes[0] == Approx(3).epsilon(1e-12));
    CHECK(checked_shards(make_solid(two_boxes()), {{1.5, 0.5, 0.5}}).cell_count() == 2);
    CHECK(checked_shards(make_solid(box_with_cavity()), {{1.5, 1.5, 1.5}}).cell_count() == 1);
}

TEST_CASE("P3: duplicates are named, or merged and counted, and no volume is lost") {
    solid const s = make_solid(unit_box());
    std::vector<vec3> const sites{{0.2, 0.5, 0.5}, {0.8, 0.5, 0.5}, {0.2, 0.5, 0.5}, {0.2, 0.5, 0.5}};
    auto const place = refused(errc::duplicate_sites, [&] { (void)voronoi_shards(s, sites); });
    CHECK(place.kind == entity::site);
    auto const c = checked_shards(s, sites);
    CHECK(c.merged_sites == 2);
    CHECK(c.cell_count() == 2);
    CHECK(c.shards_of(site_index{2U}).size() == 1);
    std::vector<vec3> const same(100, vec3{0.5, 0.5, 0.5});
    CHECK(checked_shards(s, same).merged_sites == 99);
}

TEST_CASE("P4: clusters from 1e-3 down to the last bit lose no volume") {
    solid const s = make_solid(l_shape());
    for (double const width : {1e-3, 1e-6, 1e-9, 1e-12, 1e-13, 1e-14, 1e-15, 2e-16}) {
        std::vector<vec3> sites{{1.5, 0.5, 0.5}};
        stream draw(5, stage::user, 0);
        for (int k = 0; k < 40; ++k) {
            vec3 p{0.5, 0.5, 0.5};
            for (int a = 0; a < 3; ++a) p[a] += width * draw.uniform(-1, 1);
            sites.push_back(p);
        }
        INFO("width " << width);
        (void)checked_shards(s, sites);
    }
}

TEST_CASE("P5: coplanar and collinear sites, also in the planes and along the edges of the solid") {
    solid const s = make_solid(l_shape());
    for (double const z : {0.0, 0.25, 1.0}) {
        std::vector<vec3> plane;
        std::vector<vec3> line;
        for (int k = 0; k < 25; ++k) plane.push_back(vec3{0.2 + 0.3 * (k % 5), 0.2 + 0.3 * (k / 5), z});
        for (int k = 0; k <= 16; ++k) line.push_back(vec3{k / 8.0, 0, z});
        (void)checked_shards(s, plane);
        (void)checked_shards(s, line);
    }
}

TEST_CASE("P6: lattices of every kind, jittered or not, keep their volumes and link no faces without area") {
    solid const s = make_solid(unit_box());
    for (int const kind : {0, 1, 2}) {  // simple, body-centred, face-centred
        for (double const jitter : {0.0, 1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10}) {
            std::vector<vec3> sites;
            stream draw(7, stage::user, 0);
            auto const put = [&](double x, double y, double z) {
                vec3 p{x / 4, y / 4, z / 4};
                for (int a = 0; a < 3; ++a) p[a] += jitter * draw.uniform(-1, 1);
                sites.push_back(p);
            };
            for (int k = 0; k < 64; ++k) {
                double const x = k % 4 + 0.25;
                double const y = k / 4 % 4 + 0.25;
                double const z = k / 16 + 0.25;
                put(x, y, z);
                if (kind == 1) put(x + 0.5, y + 0.5, z + 0.5);
                if (kind != 2) continue;
                put(x + 0.5, y + 0.5, z);
                put(x + 0.5, y, z + 0.5);
                put(x, y + 0.5, z + 0.5);
            }
            INFO("lattice " << kind << ", jitter " << jitter);
            auto const c = checked_shards(s, sites);
            auto const g = make_link_graph(c);
            double least = 1;
            for (std::uint32_t l = 0; l < g.link_count(); ++l) least = std::min(least, g.link_area(link_index{l}));
            CHECK(least > 1e-4);  // of true faces, the smallest of these lattices
        }
    }
}

TEST_CASE("P7, P8: sites outside the box or not finite are named, or dropped and counted") {
    solid const s = make_solid(unit_box());
    std::vector<vec3> sites{{0.5, 0.5, 0.5}, {0.2, 0.5, 0.5}, {0.5, 0.5, 1.25}};
    CHECK(refused(errc::site_outside, [&] { (void)voronoi_shards(s, sites); }).index == 2);
    auto const c = checked_shards(s, sites, {.outside = outside_sites::drop});
    CHECK(c.dropped_sites == 1);
    CHECK(c.shards_of(site_index{2U}).empty());
    for (double const bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity()}) {
        sites[1][1] = bad;
        for (auto const outside : {outside_sites::refuse, outside_sites::drop}) {
            CHECK(refused(errc::non_finite_site, [&] { (void)voronoi_shards(s, sites, {.outside = outside}); }).index == 1);
        }
    }
}

TEST_CASE("P9: many sites at one spot beside few far away take no longer than spread ones should", "[slow]") {
    solid const s = make_solid(unit_box());
    std::vector<vec3> sites{{0.9, 0.9, 0.9}, {0.1, 0.9, 0.1}};
    stream draw(9, stage::user, 0);
    for (int k = 0; k < 20000; ++k) {
        vec3 p{0.25, 0.25, 0.25};
        for (int a = 0; a < 3; ++a) p[a] += 1e-7 * draw.uniform(-1, 1);
        sites.push_back(p);
    }
    (void)checked_shards(s, sites);
}

TEST_CASE("P10: sites on faces, edges and vertices, and bisectors in faces, have one answer for every order") {
    indexed_mesh const mesh = l_shape();
    solid const s = make_solid(mesh);
    std::vector<vec3> sites = mesh.positions;
    sites.push_back(vec3{1, 0.5, 0.5});
    sites.push_back(vec3{0.5, 0.5, 0});
    auto const c = checked_shards(s, sites);
    std::vector<vec3> reversed(sites.rbegin(), sites.rend());
    auto const d = checked_shards(s, reversed);
    for (std::uint32_t k = 0; k < sites.size(); ++k) {
        double a = 0;
        double b = 0;
        for (cell_index x : c.shards_of(site_index{k})) a += c.cell_volume(x);
        for (cell_index x : d.shards_of(site_index{static_cast<std::uint32_t>(sites.size()) - 1 - k})) b += d.cell_volume(x);
        CHECK(a == b);
    }
    // The bisector is the plane x = 1, in which a face of the L lies; then a hair off it, aslant.
    for (double const off : {0.0, 1e-17, 1e-16, 1e-15, 1e-14, 1e-12}) {
        INFO("off by " << off);
        (void)checked_shards(s, {{0.5, 0.5, 0.5}, {1.5 + off, 0.5 + off, 0.5 - 2 * off}});
    }
}
