#include <tafoni/decomposition/displaced_faces.hpp>

#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/geometry/make_solid.hpp>

#include <catch2/catch.hpp>

#include <set>

#include "support/shapes.hpp"
#include "support/surface_laws.hpp"

using namespace tafoni;

namespace {

struct ripple {
    double operator()(vec3 const& p) const { return tafoni_test::lattice_noise(7 * p[0] + 3 * p[2], 7 * p[1] - 5 * p[2], 3); }
};

shard_complex two_halves() {
    return voronoi_shards(make_solid(tafoni_test::unit_box()), std::vector<vec3>{vec3{0.25, 0.5, 0.5}, vec3{0.75, 0.4, 0.6}});
}

}  // namespace

static_assert(displacement_field<field_displacement<ripple>>);

TEST_CASE("both sides of a rough break fit together") {
    auto const c = two_halves();
    field_displacement const rough{ripple{}, 0.02};
    displaced_faces_options const options{.edge_length = 0.1};
    double volume = 0;
    std::set<std::array<double, 3>> first;
    std::size_t met = 0;
    std::size_t count = 0;
    for (std::uint32_t k = 0; k < 2; ++k) {
        auto const s = displaced_faces(extract_surface(c, std::vector<cell_index>{cell_index{k}}), rough, options);
        CHECK(tafoni_test::manifold_defects(s.mesh) == 0);
        CHECK(s.mesh.face_count() > 100);
        volume += tafoni_test::signed_volume(s.mesh);
        std::set<std::uint32_t> fresh;
        for (std::size_t i = 0; i < s.mesh.corners.size(); ++i) {
            if (s.fresh[i / 3] != 0) fresh.insert(s.mesh.corners[i]);
        }
        for (auto v : fresh) {
            vec3 const& p = s.mesh.positions[v];
            if (k == 0) first.insert({p[0], p[1], p[2]});
            else met += first.count({p[0], p[1], p[2]});
        }
        count = fresh.size();
    }
    CHECK(volume == Approx(1).epsilon(1e-12));
    CHECK(met == count);
    CHECK(count == first.size());
}

TEST_CASE("the skin and its rim stay where they were") {
    auto const c = two_halves();
    auto const s = extract_surface(c, std::vector<cell_index>{cell_index{std::uint32_t{0}}});
    auto const d = displaced_faces(s, field_displacement{ripple{}, 0.02}, {.edge_length = 0.1});
    double moved = 0;
    for (std::size_t v = 0; v < d.mesh.vertex_count(); ++v) {
        if (d.vertex[v].valid()) CHECK(d.mesh.positions[v] == c.position(d.vertex[v]));
    }
    for (std::size_t i = 0; i < d.mesh.corners.size(); ++i) {
        vec3 const& p = d.mesh.positions[d.mesh.corners[i]];
        double const off = std::fabs(dot(vec3(p - vec3{0.5, 0.45, 0.55}), vec3{0.5, -0.1, 0.1}));
        if (d.fresh[i / 3] != 0 && off > moved) moved = off;
    }
    CHECK(moved > 1e-3);
}

TEST_CASE("fresh edges are halved to the length asked for, skin is not") {
    auto const c = two_halves();
    auto const s = extract_surface(c, std::vector<cell_index>{cell_index{std::uint32_t{0}}});
    auto const none = displaced_faces(s, field_displacement{ripple{}, 0.0}, {.edge_length = 0.1});
    CHECK(tafoni_test::signed_volume(none.mesh) == Approx(c.volumes[0]).epsilon(1e-12));
    std::size_t skin = 0;
    for (auto f : none.fresh) skin += f == 0 ? 1 : 0;
    std::size_t before = 0;
    for (auto f : s.fresh) before += f == 0 ? 1 : 0;
    CHECK(skin == before);
    auto const coarse = displaced_faces(s, field_displacement{ripple{}, 0.0}, {.edge_length = 10});
    CHECK(coarse.mesh == s.mesh);
    CHECK_THROWS_AS(displaced_faces(s, field_displacement{ripple{}, 0.0}, {.edge_length = 0}), invalid_input);
}
