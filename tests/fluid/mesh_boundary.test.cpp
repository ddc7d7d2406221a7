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

/// The same with the arithmetic of the walls, so that every bit can be asked for.
std::vector<boundary_contact> to_the_bit(triangle_surface const& s, vec3 const& p, double radius) {
    std::vector<boundary_contact> out;
    double best = radius * radius;
    boundary_contact nearest{.face = face_index::none};
    for (std::uint32_t f = 0; f < s.triangles.size(); ++f) {
        auto const& t = s.triangles[f];
        vec3 const& a = s.positions[t[0]];
        vec3 const u{s.positions[t[1]] - a};
        vec3 const v{s.positions[t[2]] - a};
        vec3 const w{p - a};
        vec3 const n = cross(u, v);
        double const nn = dot(n, n);
        double const over = dot(w, n);
        double const y = dot(cross(w, v), n);
        double const z = dot(cross(u, w), n);
        double const l = std::sqrt(nn);
        if (nn > 0 && over * over <= radius * radius * nn && y >= 0 && z >= 0 && y + z <= nn) {
            out.push_back({.face = f, .normal = vec3{n[0] / l, n[1] / l, n[2] / l}, .distance = over / l});
        }
        vec3 const away{p - tafoni::detail::nearest_on_triangle(a, s.positions[t[1]], s.positions[t[2]], p)};
        double const square = squared_length(away);
        if (square < best) {
            best = square;
            double const way = std::sqrt(square);
            double const k = over < 0 ? -1 / way : 1 / way;
            nearest = {.face = f, .normal = vec3{k * away[0], k * away[1], k * away[2]}, .distance = over < 0 ? -way : way};
        }
    }
    if (out.empty() && nearest.face != face_index::none && best > 0) out.push_back(nearest);
    return out;
}

/// Number of places that touch.
std::size_t check(mesh_boundary const& walls, triangle_surface const& s, std::vector<vec3> const& places, double radius) {
    std::size_t touching = 0;
    std::size_t wrong = 0;
    for (vec3 const& p : places) {
        auto const expected = to_the_bit(s, p, radius);
        std::vector<boundary_contact> found;
        walls.for_each_contact(p, radius, [&](boundary_contact const& c) { found.push_back(c); });
        touching += expected.empty() ? 0U : 1U;
        bool same = found.size() == expected.size() && (expected.empty() || walls.block_of(p) != 0);
        for (std::size_t i = 0; same && i < found.size(); ++i) {
            same = found[i].face == expected[i].face && found[i].normal == expected[i].normal && found[i].distance == expected[i].distance;
        }
        wrong += same ? 0U : 1U;
    }
    CHECK(wrong == 0);
    return touching;
}

vec3 within(stream& random, double size) {
    double const x = random.uniform(-size, size);
    double const y = random.uniform(-size, size);
    double const z = random.uniform(-size, size);
    return vec3{x, y, z};
}

/// Faces of all sizes in every direction.
triangle_surface soup(std::size_t n, double size, std::uint64_t seed) {
    triangle_surface s;
    stream random(seed, 0, 0);
    for (std::uint32_t f = 0; f < n; ++f) {
        vec3 const a = within(random, size);
        double const edge = size * (f % 7 == 0 ? 0.9 : f % 3 == 0 ? 0.01 : 0.15);
        for (int k = 0; k < 3; ++k) s.positions.push_back(a + within(random, edge));
        if (f % 11 == 0) s.positions.back() = s.positions[s.positions.size() - 2] + 1e-7 * within(random, edge);  // a needle
        if (f % 13 == 0) s.positions.back() = s.positions[s.positions.size() - 3];                                // a line
        s.triangles.push_back({3 * f, 3 * f + 1, 3 * f + 2});
    }
    return s;
}

triangle_surface flat_ground(std::uint32_t n) {
    triangle_surface s;
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) s.positions.push_back(vec3{1.0 * i, 1.0 * j, 0});
    }
    for (std::uint32_t j = 0; j + 1 < n; ++j) {
        for (std::uint32_t i = 0; i + 1 < n; ++i) {
            std::uint32_t const a = i + n * j;
            s.triangles.push_back({a, a + 1, a + n + 1});
            s.triangles.push_back({a, a + n + 1, a + n});
        }
    }
    return s;
}

}  // namespace

TEST_CASE("contacts are equal to the bit to those of every face looked at, while faces wander and of all radii") {
    for (std::uint64_t const seed : {1U, 2U, 3U}) {
        for (double const reach : {0.02, 0.1, 0.4, 20.0}) {
            triangle_surface s = seed == 3 ? torus_surface(24, 14, 0.3).mesh : soup(120, 1, seed);
            mesh_boundary walls(s.positions, s.triangles, reach);
            stream random(seed, 1, 0);
            std::size_t touching = 0;
            // In steps below the slack, so that cells are those of the start for a while.
            for (int step = 0; step < 5; ++step) {
                std::vector<vec3> places;
                for (int k = 0; k < 60; ++k) {
                    vec3 p = within(random, 1.4);
                    std::size_t const at = random.index_below(s.positions.size());
                    if (k % 2 == 0) p = s.positions[at] + within(random, 0.8 * std::min(reach, 0.5));
                    places.push_back(p);
                }
                touching += check(walls, s, places, reach);
                check(walls, s, places, 0.6 * reach);
                for (vec3& p : s.positions) p += within(random, 0.06 * std::min(reach, 0.5));
                walls.refit(s.positions, s.triangles);
            }
            CHECK(touching > 20);
        }
    }
}

TEST_CASE("particles at the reach itself, over edges and corners, and on the borders of cells find what they touch") {
    triangle_surface const s = flat_ground(9);
    for (double const reach : {0.5, 0.375}) {
        mesh_boundary const walls(s.positions, s.triangles, reach);
        std::vector<vec3> places;
        for (double const z : {reach, std::nextafter(reach, 0.0), std::nextafter(reach, 9.0), -reach, 0.0, 0.25 * reach}) {
            for (double const x : {-reach, std::nextafter(-reach, -9.0), 0.0, 0.25, 3.0, std::nextafter(4.0, 0.0), 8.0, 8 + reach, std::nextafter(8 + reach, 99.0)}) {
                for (double const y : {-0.25 * reach, 0.0, 1.5, 3.0, 7.75, 8.0}) places.push_back(vec3{x, y, z});
            }
        }
        CHECK(check(walls, s, places, reach) > 100);
        // The cells are the mean edge or four reaches long, from a rim around the faces on.
        double const edge = s.mean_edge_length();
        double const cell = std::max(4 * reach, edge);
        double const lo = -(reach + 0.25 * std::max(reach, edge));
        places.clear();
        for (int i = 0; i < 24; ++i) {
            double const x = lo + 0.25 * cell * i;
            for (double const q : {x, std::nextafter(x, -99.0), std::nextafter(x, 99.0)}) {
                for (int k = 0; k < 7; ++k) {
                    places.push_back(vec3{q, 4.2, lo + 0.25 * cell * k});
                    places.push_back(vec3{q, q, 0.9 * reach});
                }
            }
        }
        CHECK(check(walls, s, places, reach) > 100);
    }
}

TEST_CASE("faces that have gone almost as far as their cells allow still meet what is at their corners and at the reach") {
    triangle_surface const start = flat_ground(7);
    for (double const reach : {0.5, 0.125, 2.0}) {
        double const far = 0.24 * std::max(reach, start.mean_edge_length());
        for (vec3 const& way : {vec3{0, 0, 1}, vec3{0, 0, -1}, vec3{1, 0, 0}, vec3{-0.7, 0.7, 0}, vec3{0, -1, 0}, vec3{0.57, 0.57, 0.57}}) {
            triangle_surface s = start;
            mesh_boundary walls(s.positions, s.triangles, reach);
            for (vec3& p : s.positions) p += far * way;
            walls.refit(s.positions, s.triangles);
            std::vector<vec3> places;
            for (auto const& t : s.triangles) {
                for (std::size_t k = 0; k < 3; ++k) {
                    vec3 const in = 0.998 * s.positions[t[k]] + 0.001 * s.positions[t[(k + 1) % 3]] + 0.001 * s.positions[t[(k + 2) % 3]];
                    vec3 const out = 2 * s.positions[t[k]] - in;
                    for (double const z : {0.999, -0.999}) places.push_back(vec3{in[0], in[1], in[2] + z * reach});
                    // Beside the corner, over nothing where that is on the border.
                    for (vec3 const& side : {vec3{1, 0, 0}, vec3{-1, 0, 0}, vec3{0, 1, 0}, vec3{0, -1, 0}}) places.push_back(out + 0.99 * reach * side);
                }
            }
            CHECK(check(walls, s, places, reach) > 400);
        }
    }
}

TEST_CASE("crowds in one place, single particles, and models of any size and far away find what they touch") {
    stream random(31, 0, 0);
    triangle_surface const start = torus_surface(20, 12, 0.2).mesh;
    for (double const size : {1e-30, 1e-9, 1.0, 1e9, 1e30}) {
        for (double const far : {0.0, 1.0, 1e3}) {
            triangle_surface s = start;
            vec3 const at{far * size, -far * size, 0.3 * far * size};
            for (vec3& p : s.positions) p = vec3{at + size * p};
            double const reach = 0.1 * size;
            mesh_boundary const walls(s.positions, s.triangles, reach);
            std::vector<vec3> places;
            for (int k = 0; k < 40; ++k) places.push_back(vec3{at + within(random, 1.5 * size)});
            for (int k = 0; k < 40; ++k) places.push_back(s.positions[7] + within(random, 0.2 * size));
            for (int k = 0; k < 20; ++k) places.push_back(s.positions[9]);
            CHECK(check(walls, s, places, reach) > 30);
        }
    }
    // A reach beyond the model: one cell, all faces in it.
    mesh_boundary const one(start.positions, start.triangles, 30);
    std::vector<vec3> places;
    for (int k = 0; k < 60; ++k) places.push_back(within(random, 25));
    CHECK(check(one, start, places, 30) > 40);
}

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
