#include "support/curved_surfaces.hpp"

#include <tafoni/fluid/mesh_boundary.hpp>

#include <catch2/catch.hpp>

#include <limits>

using namespace tafoni;
using namespace tafoni_test;

namespace {

/// What the concept says, by looking at every face.
std::vector<boundary_contact> brute_force(triangle_surface const& s, vec3 const& p, double radius) {
    std::vector<boundary_contact> over;
    boundary_contact nearest;
    double best = radius;
    bool any = false;
    for (std::uint32_t f = 0; f < s.triangles.size(); ++f) {
        auto const& t = s.triangles[f];
        vec3 const a = s.positions[t[0]];
        vec3 const n = normalized(cross(s.positions[t[1]] - a, s.positions[t[2]] - a));
        double const height = dot(p - a, n);
        vec3 const foot = p - height * n;
        bool inside = true;
        for (std::size_t k = 0; k < 3; ++k) {
            vec3 const e = s.positions[t[(k + 1) % 3]] - s.positions[t[k]];
            inside = inside && dot(cross(e, foot - s.positions[t[k]]), n) >= 0;
        }
        if (inside && std::fabs(height) <= radius) over.push_back({f, n, height});
        vec3 const q = tafoni::detail::nearest_on_triangle(a, s.positions[t[1]], s.positions[t[2]], p);
        double const d = length(p - q);
        if (d < best) {
            best = d;
            nearest = {f, vec3{0, 0, 0}, height < 0 ? -d : d};
            any = true;
        }
    }
    if (over.empty() && any) over.push_back(nearest);
    return over;
}

}  // namespace

TEST_CASE("contacts are those that looking at every face finds") {
    triangle_surface const s = torus_surface(40, 24, 0.3).mesh;
    for (double const reach : {0.02, 0.1, 0.4}) {
        mesh_boundary const walls(s.positions, s.triangles, reach);
        stream random(9, 0, 0);
        std::size_t touching = 0;
        for (int k = 0; k < 400; ++k) {
            double const x = random.uniform(-1.6, 1.6);
            double const y = random.uniform(-1.6, 1.6);
            double const z = random.uniform(-0.6, 0.6);
            vec3 const p{x, y, z};
            auto const expected = brute_force(s, p, reach);
            std::vector<boundary_contact> found;
            walls.for_each_contact(p, reach, [&](boundary_contact const& c) { found.push_back(c); });
            REQUIRE(found.size() == expected.size());
            touching += found.empty() ? 0U : 1U;
            for (std::size_t i = 0; i < found.size(); ++i) {
                CHECK(found[i].distance == Approx(expected[i].distance).margin(1e-12));
                CHECK(length(found[i].normal) == Approx(1));
                if (length(expected[i].normal) > 0) CHECK(found[i].face == expected[i].face);
                if (i > 0) CHECK(found[i - 1].face < found[i].face);
            }
        }
        CHECK(touching > 3);
    }
}

TEST_CASE("faces of all sizes are found, and after small and large moves too") {
    // A coarse bowl, a fine patch in it, a needle and a speck.
    triangle_surface s = parametric(
                             7, 7, false, false, 0,
                             [](double u, double v) { return vec3{8 * u, 8 * v, 2 * (u - 0.5) * (u - 0.5) + (v - 0.5)}; },
                             [](double, double) { return 0.0; })
                             .mesh;
    triangle_surface const fine = torus_surface(30, 20, 0.2).mesh;
    auto const first = static_cast<std::uint32_t>(s.positions.size());
    for (vec3 const& p : fine.positions) s.positions.push_back(vec3{3 + 0.5 * p[0], 4 + 0.5 * p[1], 0.4 + 0.5 * p[2]});
    for (auto const& t : fine.triangles) s.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    auto const next = static_cast<std::uint32_t>(s.positions.size());
    for (vec3 const& p : {vec3{0, 0, 0}, vec3{8, 8, 3}, vec3{8, 8.01, 3}, vec3{5, 1, 1}, vec3{5.001, 1, 1}, vec3{5, 1.001, 1}}) s.positions.push_back(p);
    s.triangles.push_back({next, next + 1, next + 2});
    s.triangles.push_back({next + 3, next + 4, next + 5});
    stream random(17, 0, 0);
    for (double const reach : {0.03, 0.25, 1.0}) {
        triangle_surface now = s;
        mesh_boundary walls(now.positions, now.triangles, reach);
        for (double const move : {0.0, 0.02, 0.1, 2.0}) {
            for (vec3& p : now.positions) {
                for (int a = 0; a < 3; ++a) p[a] += random.uniform(-move, move) * reach;
            }
            walls.refit(now.positions, now.triangles);
            std::size_t touching = 0;
            for (int k = 0; k < 60; ++k) {
                double const x = random.uniform(-0.5, 8.5);
                double const y = random.uniform(-0.5, 8.5);
                double const z = random.uniform(-1, 2);
                vec3 p{x, y, z};
                auto const& t = now.triangles[random.index_below(now.triangles.size())];
                if (k % 3 != 0) p = now.positions[t[0]] + vec3{0.3 * reach * (x - 4), 0.3 * reach * (y - 4), reach * z};
                auto const expected = brute_force(now, p, reach);
                std::vector<boundary_contact> found;
                walls.for_each_contact(p, reach, [&](boundary_contact const& c) { found.push_back(c); });
                REQUIRE(found.size() == expected.size());
                touching += found.empty() ? 0U : 1U;
                if (!found.empty()) CHECK(walls.block_of(p) != 0);
                CHECK(walls.block_of(p) < walls.block_count());
                for (std::size_t i = 0; i < found.size(); ++i) {
                    // Of two faces that are equally near with an edge the point may be before one and behind the other.
                    bool const over = length(expected[i].normal) > 0;
                    CHECK(std::fabs(found[i].distance) == Approx(std::fabs(expected[i].distance)).margin(1e-9));
                    if (over) CHECK(found[i].face == expected[i].face);
                    if (over) CHECK(dot(found[i].normal, expected[i].normal) == Approx(1));
                }
            }
            CHECK(touching > 10);
        }
    }
}

TEST_CASE("after a refit contacts follow the vertices") {
    triangle_surface s = torus_surface(20, 12, 0).mesh;
    mesh_boundary walls(s.positions, s.triangles, 0.1);
    auto const touches = [&](vec3 const& p) {
        bool any = false;
        walls.for_each_contact(p, 0.1, [&](boundary_contact const&) { any = true; });
        return any;
    };
    CHECK(touches(vec3{1.42, 0, 0}));
    for (vec3& p : s.positions) p[0] += 10;
    walls.refit(s.positions, s.triangles);
    CHECK(!touches(vec3{1.42, 0, 0}));
    CHECK(touches(vec3{11.42, 0, 0}));
}

TEST_CASE("no faces, flat faces and far particles touch nothing") {
    triangle_surface const none;
    mesh_boundary const empty(none.positions, none.triangles, 1);
    empty.for_each_contact(vec3{0, 0, 0}, 1, [](boundary_contact const&) { FAIL("a contact with nothing"); });
    triangle_surface const flat{.positions = {vec3{0, 0, 0}, vec3{1, 0, 0}, vec3{2, 0, 0}}, .triangles = {{0, 1, 2}}};
    mesh_boundary const line(flat.positions, flat.triangles, 0.5);
    for (double const x : {-1e9, -0.1, 0.5, 2.2, 1e9}) {
        line.for_each_contact(vec3{x, 0.1, 0}, 0.5, [](boundary_contact const& c) { CHECK(std::isfinite(c.distance)); });
    }
    for (double const bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        CHECK_THROWS_AS(mesh_boundary(flat.positions, flat.triangles, bad), invalid_input);
    }
}

TEST_CASE("faces a million edges apart are found as those at hand") {
    for (double const far : {1e5, 9e5, 3e6}) {
        for (double const reach : {0.25, 0.01}) {
            std::vector<vec3> const p{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {far, 0, 0}, {far + 1, 0, 0}, {far, 1, 0}};
            std::vector<std::array<std::uint32_t, 3>> const t{{0, 1, 2}, {3, 4, 5}};
            mesh_boundary const walls(p, t, reach);
            for (std::uint32_t const face : {0U, 1U}) {
                for (double const x : {0.01, 0.2, 0.45}) {
                    for (double const height : {-0.9, -0.1, 0.6, 0.95}) {
                        INFO(far << " apart, reach " << reach << ", x " << x << ", height " << height);
                        std::vector<boundary_contact> met;
                        walls.for_each_contact(vec3{p[3 * face][0] + x, 0.3, height * reach}, reach,
                                               [&](boundary_contact const& c) { met.push_back(c); });
                        REQUIRE(met.size() == 1);
                        CHECK(met[0].face == face);
                        CHECK(met[0].distance == Approx(height * reach));
                    }
                }
            }
        }
    }
}
