#include "support/water_scenes.hpp"

#include <tafoni/core/random.hpp>
#include <tafoni/fluid/facing_contacts.hpp>
#include <tafoni/fluid/mesh_boundary.hpp>
#include <tafoni/fluid/rain_particles.hpp>
#include <tafoni/fluid/sph.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>
#include <vector>

using namespace tafoni;
using namespace tafoni_test;

namespace {

std::vector<boundary_contact> contacts(mesh_boundary const& walls, vec3 const& p) {
    std::vector<boundary_contact> out;
    walls.for_each_contact(p, walls.reach(), [&](boundary_contact const& c) { out.push_back(c); });
    return out;
}
std::vector<boundary_contact> facing(mesh_boundary const& walls, vec3 const& p) {
    std::vector<boundary_contact> out;
    for_each_facing_contact(walls, p, walls.reach(), [&](boundary_contact const& c) { out.push_back(c); });
    return out;
}

/// The nearest point of any face, negative behind it.
boundary_contact nearest(triangle_surface const& s, vec3 const& p) {
    boundary_contact best{.distance = 1e9};
    for (std::uint32_t f = 0; f < s.triangles.size(); ++f) {
        auto const& t = s.triangles[f];
        vec3 const& a = s.positions[t[0]];
        vec3 const away{p - detail::nearest_on_triangle(a, s.positions[t[1]], s.positions[t[2]], p)};
        double const l = length(away);
        if (!(l < std::fabs(best.distance))) continue;
        bool const behind = dot(p - a, cross(vec3{s.positions[t[1]] - a}, vec3{s.positions[t[2]] - a})) < 0;
        best = {.face = f, .normal = vec3{away / (behind ? -l : l)}, .distance = behind ? -l : l};
    }
    return best;
}

/// Two sides of a groove along y that meet at the origin, each at `angle` (tangent) from the vertical, rock outside.
triangle_surface groove(double tangent) {
    triangle_surface s;
    for (double const x : {-tangent, 0.0, tangent}) {
        for (double const y : {-5.0, 5.0}) s.positions.push_back(vec3{5 * x, y, x == 0 ? 0.0 : 5.0});
    }
    s.triangles = {{0, 2, 1}, {2, 3, 1}, {2, 4, 3}, {4, 5, 3}};
    for (auto& t : s.triangles) std::swap(t[1], t[2]);
    vec3 const& a = s.positions[s.triangles[0][0]];
    vec3 const n = cross(vec3{s.positions[s.triangles[0][1]] - a}, vec3{s.positions[s.triangles[0][2]] - a});
    if (n[2] < 0) {
        for (auto& t : s.triangles) std::swap(t[1], t[2]);
    }
    return s;
}

}  // namespace

TEST_CASE("a particle touches that side of a thin wall that it is on") {
    triangle_surface const s = slab(8, 0.1);
    mesh_boundary const walls(s.positions, s.triangles, 0.5);
    for (double const z : {0.12, 0.2, 0.35}) {
        vec3 const above{1.03, 1.07, z};
        REQUIRE(contacts(walls, above).size() > 1);
        REQUIRE(facing(walls, above).size() == 1);
        CHECK(facing(walls, above)[0].distance == Approx(z - 0.1));
        vec3 const below{1.03, 1.07, -z};
        REQUIRE_FALSE(facing(walls, below).empty());
        for (boundary_contact const& c : facing(walls, below)) CHECK((c.normal[2] < 0 && c.distance > 0));
    }
    // Within the wall it is behind both, and both count.
    vec3 const within{1.03, 1.07, 0.06};
    REQUIRE(contacts(walls, within).size() > 1);
    CHECK(facing(walls, within).size() == contacts(walls, within).size());
}

TEST_CASE("what slipped through a side of a corner or a groove still meets it") {
    for (double const tangent : {0.2, 0.5, 1.0, 3.0}) {
        triangle_surface const s = groove(tangent);
        mesh_boundary const walls(s.positions, s.triangles, 0.5);
        double const c = 1 / std::sqrt(1 + tangent * tangent);
        // Behind the right side by a little, close above the bottom.
        double const z = 0.3 / std::max(tangent, 1.0);
        vec3 const p{tangent * z + 0.02, 0.1, z};
        auto const met = facing(walls, p);
        INFO("tangent " << tangent);
        CHECK(std::any_of(met.begin(), met.end(), [&](boundary_contact const& k) { return k.distance == Approx(-0.02 * c); }));
        CHECK(met.size() == contacts(walls, p).size());
    }
}

TEST_CASE("but for what lies behind another face all contacts are visited in their order") {
    triangle_surface s = torus_surface(24, 16, 0.3).mesh;
    for (vec3& p : s.positions) p[2] *= 0.3;  // thin
    mesh_boundary const walls(s.positions, s.triangles, 0.35);
    std::size_t hidden = 0;
    std::size_t slipped = 0;
    std::size_t edges = 0;
    for (std::uint64_t k = 0; k < 4000; ++k) {
        stream random(9, 0, k);
        double const x = random.uniform(-1.5, 1.5);
        double const y = random.uniform(-1.5, 1.5);
        double const z = random.uniform(-0.4, 0.4);
        vec3 const p{x, y, z};
        auto const all = contacts(walls, p);
        std::vector<boundary_contact> front;
        for (boundary_contact const& c : all) {
            if (c.distance >= 0) front.push_back(c);
        }
        std::vector<std::uint32_t> expected;
        if (front.empty() && !all.empty()) {
            // Over an edge of the near side that edge comes first.
            boundary_contact const edge = nearest(s, p);
            bool const nearer = std::all_of(all.begin(), all.end(), [&](auto const& c) { return edge.distance < -c.distance * (1 - 1e-9); });
            if (edge.distance >= 0 && nearer) {
                front.push_back(edge);
                expected.push_back(edge.face);
                ++edges;
            }
        }
        for (boundary_contact const& c : all) {
            vec3 const foot{p - c.distance * c.normal};
            bool const seen = c.distance >= 0 || std::none_of(front.begin(), front.end(), [&](boundary_contact const& f) {
                                  return dot(foot - (p - f.distance * f.normal), f.normal) < 0;
                              });
            if (seen) expected.push_back(c.face);
            if (seen && c.distance < 0) ++slipped;
            if (!seen) ++hidden;
        }
        std::vector<std::uint32_t> got;
        for (boundary_contact const& c : facing(walls, p)) got.push_back(c.face);
        REQUIRE(got == expected);
    }
    CHECK(hidden > 100);
    CHECK(slipped > 100);
    CHECK(edges > 3);
}

TEST_CASE("water stays on the side of a thin plate that it falls on") {
    triangle_surface const plate = slab(16, 0.1);  // 4 x 4
    auto const stays = [&](auto water, double reach) {
        mesh_boundary const walls(plate.positions, plate.triangles, reach);
        std::set<std::uint64_t> through;
        for (double t = 0; t < 2;) {
            t += water.step(walls, inline_executor{});
            for (std::size_t i = 0; i < water.particle_count(); ++i) {
                vec3 const p = water.position(i);
                if (p[2] < 0 && std::min({p[0], p[1], 4 - p[0], 4 - p[1]}) > 1) through.insert(water.id(i));
            }
        }
        REQUIRE(water.particle_count() > 0);
        CHECK(through.empty());
    };
    box_sink const keep{.keep = between(vec3{0.3, 0.3, -3}, vec3{3.7, 3.7, 4})};  // nothing runs round the rim
    stays(rain_particles({.box = between(vec3{1.2, 1.2, 0.5}, vec3{2.8, 2.8, 1})}, keep,
                         {.particles = 100, .radius = 0.4, .lifetime = 1e6}),
          0.4);
    stays(sph<float>({.box = between(vec3{1.4, 1.4, 0.5}, vec3{2.6, 2.6, 1.2})}, keep,
                     {.particles = 60, .spacing = 0.3, .sound_speed = 40}),
          0.3);
}
