/// \file
/// Procedural solids for tests: closed, outward oriented, made without libm so that they have the same
/// bits everywhere. Faces are polygons (the ends of `l_shape` are not convex).
#ifndef TAFONI_TESTS_SUPPORT_SHAPES_HPP
#define TAFONI_TESTS_SUPPORT_SHAPES_HPP

#include <tafoni/core/random.hpp>
#include <tafoni/geometry/indexed_mesh.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace tafoni_test {

using tafoni::indexed_mesh;
using tafoni::vec3;

/// Signed volume by fans over the faces; exact up to rounding for flat faces, convex or not. O(corners).
[[nodiscard]] inline double signed_volume(indexed_mesh const& m) {
    double six_volumes = 0;
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        auto const loop = m.face(f);
        for (std::size_t k = 2; k < loop.size(); ++k) {
            vec3 const& a = m.positions[loop[0]];
            six_volumes += tafoni::dot(a, tafoni::cross(m.positions[loop[k - 1]], m.positions[loop[k]]));
        }
    }
    return six_volumes / 6;
}

/// Sum of the areas of the faces, which must be flat. O(corners).
[[nodiscard]] inline double surface_area(indexed_mesh const& m) {
    double area = 0;
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        auto const loop = m.face(f);
        vec3 twice{0, 0, 0};
        for (std::size_t k = 2; k < loop.size(); ++k) {
            vec3 const& a = m.positions[loop[0]];
            twice += tafoni::cross(m.positions[loop[k - 1]] - a, m.positions[loop[k]] - a);
        }
        area += tafoni::length(twice) / 2;
    }
    return area;
}

/// Every face cut into a fan; only for convex faces.
[[nodiscard]] inline indexed_mesh fan_triangulated(indexed_mesh const& m) {
    indexed_mesh r;
    r.positions = m.positions;
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        auto const loop = m.face(f);
        for (std::size_t k = 2; k < loop.size(); ++k) r.add_face({loop[0], loop[k - 1], loop[k]});
    }
    return r;
}

/// `b` added to `a` without any joining.
inline void append(indexed_mesh& a, indexed_mesh const& b) {
    auto const base = static_cast<std::uint32_t>(a.vertex_count());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    for (std::size_t f = 0; f < b.face_count(); ++f) {
        std::vector<std::uint32_t> loop;
        for (std::uint32_t const v : b.face(f)) loop.push_back(base + v);
        a.add_face(loop);
    }
}

/// The same surface seen from the other side.
[[nodiscard]] inline indexed_mesh inside_out(indexed_mesh const& m) {
    indexed_mesh r;
    r.positions = m.positions;
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        auto const loop = m.face(f);
        r.add_face(std::vector<std::uint32_t>(loop.rbegin(), loop.rend()));
    }
    return r;
}

/// Eight vertices, six quads.
[[nodiscard]] inline indexed_mesh box(vec3 const& lo, vec3 const& hi) {
    indexed_mesh m;
    for (int i = 0; i < 8; ++i) {
        m.add_vertex(vec3{(i & 1) != 0 ? hi[0] : lo[0], (i & 2) != 0 ? hi[1] : lo[1], (i & 4) != 0 ? hi[2] : lo[2]});
    }
    m.add_face({0, 2, 3, 1});
    m.add_face({4, 5, 7, 6});
    m.add_face({0, 1, 5, 4});
    m.add_face({2, 6, 7, 3});
    m.add_face({0, 4, 6, 2});
    m.add_face({1, 3, 7, 5});
    return m;
}

/// The unit cube at the origin.
[[nodiscard]] inline indexed_mesh unit_box() { return box(vec3{0, 0, 0}, vec3{1, 1, 1}); }

/// A polygon in the plane, counter-clockwise, drawn up from z0 to z1.
[[nodiscard]] inline indexed_mesh prism(std::vector<std::array<double, 2>> const& outline, double z0, double z1) {
    auto const n = static_cast<std::uint32_t>(outline.size());
    indexed_mesh m;
    for (auto const& p : outline) m.add_vertex(vec3{p[0], p[1], z0});
    for (auto const& p : outline) m.add_vertex(vec3{p[0], p[1], z1});
    std::vector<std::uint32_t> bottom;
    std::vector<std::uint32_t> top;
    for (std::uint32_t i = 0; i < n; ++i) {
        bottom.push_back(n - 1 - i);
        top.push_back(n + i);
        m.add_face({i, (i + 1) % n, n + (i + 1) % n, n + i});
    }
    m.add_face(bottom);
    m.add_face(top);
    return m;
}

/// Three unit cubes in an L: volume 3, area 14, two faces that are not convex.
[[nodiscard]] inline indexed_mesh l_shape() {
    return prism({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 0, 1);
}

/// [0, 3]^3 without [1, 2]^3: volume 26, area 60, two shells.
[[nodiscard]] inline indexed_mesh box_with_cavity() {
    indexed_mesh m = box(vec3{0, 0, 0}, vec3{3, 3, 3});
    append(m, inside_out(box(vec3{1, 1, 1}, vec3{2, 2, 2})));
    return m;
}

/// Two unit cubes one apart along x: volume 2, two components.
[[nodiscard]] inline indexed_mesh two_boxes() {
    indexed_mesh m = unit_box();
    append(m, box(vec3{2, 0, 0}, vec3{3, 1, 1}));
    return m;
}

/// [0, 3]^2 x [0, 1] with the hole [1, 2]^2 bored through: volume 8, area 32, genus 1, flat.
[[nodiscard]] inline indexed_mesh frame() {
    indexed_mesh m;
    std::array<std::array<double, 2>, 8> const rings{{{0, 0}, {3, 0}, {3, 3}, {0, 3}, {1, 1}, {2, 1}, {2, 2}, {1, 2}}};
    for (double const z : {0.0, 1.0}) {
        for (auto const& p : rings) m.add_vertex(vec3{p[0], p[1], z});
    }
    for (std::uint32_t i = 0; i < 4; ++i) {
        std::uint32_t const j = (i + 1) % 4;
        m.add_face({i, j, 8 + j, 8 + i});
        m.add_face({4 + i, 12 + i, 12 + j, 4 + j});
        m.add_face({8 + i, 8 + j, 12 + j, 12 + i});
        m.add_face({i, 4 + i, 4 + j, j});
    }
    return m;
}

/// The corners at the origin and at the ends of the axes: volume 1/6.
[[nodiscard]] inline indexed_mesh tetrahedron() {
    indexed_mesh m;
    for (vec3 const& p : {vec3{0, 0, 0}, vec3{1, 0, 0}, vec3{0, 1, 0}, vec3{0, 0, 1}}) m.add_vertex(p);
    m.add_face({0, 2, 1});
    m.add_face({0, 1, 3});
    m.add_face({0, 3, 2});
    m.add_face({1, 2, 3});
    return m;
}

/// Point k of n on the unit circle, nearly even, by a rational parameter instead of sine and cosine.
[[nodiscard]] inline std::array<double, 2> circle_point(std::size_t k, std::size_t n) {
    std::size_t const quarter = 4 * k / n % 4;
    double const f = static_cast<double>(4 * k - 4 * k / n * n) / static_cast<double>(n);
    double const t = f * (0.7854 + 0.2146 * f * f);
    double const c = (1 - t * t) / (1 + t * t);
    double const s = 2 * t / (1 + t * t);
    switch (quarter) {
        case 0: return {c, s};
        case 1: return {-s, c};
        case 2: return {-c, -s};
        default: return {s, -c};
    }
}

/// A torus about the z axis of n x m quads (not flat); R > r > 0, n, m >= 3. Volume tends to 2 pi^2 R r^2.
[[nodiscard]] inline indexed_mesh torus(double R, double r, std::size_t n, std::size_t m) {
    indexed_mesh t;
    for (std::size_t i = 0; i < n; ++i) {
        auto const around = circle_point(i, n);
        for (std::size_t j = 0; j < m; ++j) {
            auto const tube = circle_point(j, m);
            double const d = R + r * tube[0];
            t.add_vertex(vec3{d * around[0], d * around[1], r * tube[1]});
        }
    }
    auto const at = [&](std::size_t i, std::size_t j) { return static_cast<std::uint32_t>(i % n * m + j % m); };
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < m; ++j) t.add_face({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
    return t;
}

/// An icosahedron split `level` times, 20 x 4^level triangles, vertices on the unit sphere.
[[nodiscard]] inline indexed_mesh icosphere(int level) {
    double const g = (1 + std::sqrt(5.0)) / 2;
    indexed_mesh m;
    for (vec3 const& p : {vec3{-1, g, 0}, vec3{1, g, 0}, vec3{-1, -g, 0}, vec3{1, -g, 0}, vec3{0, -1, g}, vec3{0, 1, g},
                          vec3{0, -1, -g}, vec3{0, 1, -g}, vec3{g, 0, -1}, vec3{g, 0, 1}, vec3{-g, 0, -1},
                          vec3{-g, 0, 1}}) {
        m.add_vertex(tafoni::normalized(p));
    }
    std::vector<std::array<std::uint32_t, 3>> faces{
        {0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},   {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
        {3, 8, 9},  {4, 9, 5},  {2, 4, 11},  {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (int l = 0; l < level; ++l) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        auto const middle = [&](std::uint32_t a, std::uint32_t b) {
            auto const [at, is_new] = middles.try_emplace(std::minmax(a, b), 0U);
            if (is_new) {
                vec3 const sum = m.positions[a] + m.positions[b];
                at->second = m.add_vertex(tafoni::normalized(sum)).value;
            }
            return at->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (auto const& [a, b, c] : faces) {
            std::uint32_t const ab = middle(a, b);
            std::uint32_t const bc = middle(b, c);
            std::uint32_t const ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        faces = std::move(finer);
    }
    for (auto const& [a, b, c] : faces) m.add_face({a, b, c});
    return m;
}

/// A cube [-1, 1]^3 with a crooked limb, `thickness` wide, out of the middle of every side; triangles.
[[nodiscard]] inline indexed_mesh thin_limbs(double thickness = 0.05, int segments = 8) {
    indexed_mesh m = box(vec3{-1, -1, -1}, vec3{1, 1, 1});
    indexed_mesh const body = m;
    indexed_mesh r;
    r.positions = body.positions;
    for (std::size_t f = 0; f < 6; ++f) {
        auto const loop = body.face(f);
        vec3 centre{0, 0, 0};
        for (std::uint32_t const v : loop) centre += body.positions[v] / 4;
        vec3 const out = centre;
        vec3 const side = (body.positions[loop[1]] - body.positions[loop[0]]) / 2;
        std::array<std::uint32_t, 4> ring{loop[0], loop[1], loop[2], loop[3]};
        for (int s = 0; s <= segments; ++s) {
            double const along = 4.0 * s / segments;
            double const width = thickness / 2 * (1 - 0.5 * s / segments);
            double const drift = 0.1 * (s % 2) + 0.05 * along * along;
            std::array<std::uint32_t, 4> next{};
            for (std::size_t k = 0; k < 4; ++k) {
                vec3 const corner = (body.positions[loop[k]] - centre) * width;
                vec3 const p = centre + out * along + side * drift + corner;
                next[k] = r.add_vertex(p).value;
            }
            for (std::size_t k = 0; k < 4; ++k) {
                std::size_t const l = (k + 1) % 4;
                r.add_face({ring[k], ring[l], next[l]});
                r.add_face({ring[k], next[l], next[k]});
            }
            ring = next;
        }
        r.add_face({ring[0], ring[1], ring[2]});
        r.add_face({ring[0], ring[2], ring[3]});
    }
    return r;
}

/// A block under a height field: nx x ny cells of size `cell` from the origin, sides and base z = 0; triangles.
/// Base and sides are faces of their own; the first 2 nx ny faces are the top.
template <class Height>
[[nodiscard]] indexed_mesh height_block(std::size_t nx, std::size_t ny, double cell, Height const& height) {
    indexed_mesh m;
    for (double const top : {1.0, 0.0}) {
        for (std::size_t j = 0; j <= ny; ++j) {
            for (std::size_t i = 0; i <= nx; ++i) {
                double const z = top > 0 ? height(i, j) : 0.0;
                m.add_vertex(vec3{static_cast<double>(i) * cell, static_cast<double>(j) * cell, z});
            }
        }
    }
    std::size_t const under = (nx + 1) * (ny + 1);
    auto const at = [&](std::size_t i, std::size_t j) { return static_cast<std::uint32_t>(j * (nx + 1) + i); };
    auto const low = [&](std::size_t i, std::size_t j) { return static_cast<std::uint32_t>(under + j * (nx + 1) + i); };
    for (std::size_t j = 0; j < ny; ++j) {
        for (std::size_t i = 0; i < nx; ++i) {
            m.add_face({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            m.add_face({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    for (std::size_t j = 0; j < ny; ++j) {
        for (std::size_t i = 0; i < nx; ++i) {
            m.add_face({low(i, j), low(i + 1, j + 1), low(i + 1, j)});
            m.add_face({low(i, j), low(i, j + 1), low(i + 1, j + 1)});
        }
    }
    auto const wall = [&](std::uint32_t a, std::uint32_t b, std::uint32_t la, std::uint32_t lb) {
        m.add_face({la, lb, b});
        m.add_face({la, b, a});
    };
    for (std::size_t i = 0; i < nx; ++i) {
        wall(at(i, 0), at(i + 1, 0), low(i, 0), low(i + 1, 0));
        wall(at(i + 1, ny), at(i, ny), low(i + 1, ny), low(i, ny));
    }
    for (std::size_t j = 0; j < ny; ++j) {
        wall(at(nx, j), at(nx, j + 1), low(nx, j), low(nx, j + 1));
        wall(at(0, j + 1), at(0, j), low(0, j + 1), low(0, j));
    }
    return m;
}

/// Smooth noise in [0, 1] on a grid: corners drawn from a stream, smoothstep between them.
[[nodiscard]] inline double lattice_noise(double x, double y, std::uint64_t seed) {
    double const fx = std::floor(x);
    double const fy = std::floor(y);
    auto const corner = [&](double i, double j) {
        auto const key = static_cast<std::uint64_t>(static_cast<std::int64_t>(i)) * 1000003U +
                         static_cast<std::uint64_t>(static_cast<std::int64_t>(j));
        return tafoni::stream(seed, tafoni::stage::user, key).uniform01();
    };
    double const u = (x - fx) * (x - fx) * (3 - 2 * (x - fx));
    double const v = (y - fy) * (y - fy) * (3 - 2 * (y - fy));
    double const low = corner(fx, fy) + u * (corner(fx + 1, fy) - corner(fx, fy));
    double const high = corner(fx, fy + 1) + u * (corner(fx + 1, fy + 1) - corner(fx, fy + 1));
    return low + v * (high - low);
}

/// A unit slab whose top is covered with n x n fine bumps, like a carved relief.
[[nodiscard]] inline indexed_mesh relief(std::size_t n = 40) {
    return height_block(n, n, 1.0 / static_cast<double>(n), [n](std::size_t i, std::size_t j) {
        double const x = 12.0 * static_cast<double>(i) / static_cast<double>(n);
        double const y = 12.0 * static_cast<double>(j) / static_cast<double>(n);
        return 0.3 + 0.08 * lattice_noise(x, y, 7) + 0.02 * lattice_noise(3 * x, 3 * y, 8);
    });
}

/// A mountain block, nx x ny cells of 10: ridges and valleys, heights in [100, 420].
[[nodiscard]] inline indexed_mesh terrain_block(std::size_t nx = 32, std::size_t ny = 24) {
    return height_block(nx, ny, 10, [](std::size_t i, std::size_t j) {
        double const x = static_cast<double>(i) / 8;
        double const y = static_cast<double>(j) / 8;
        double const ridge = 1 - std::fabs(2 * lattice_noise(x, y, 21) - 1);
        return 100 + 250 * ridge * ridge + 50 * lattice_noise(2 * x, 2 * y, 22) + 20 * lattice_noise(5 * x, 5 * y, 23);
    });
}

}  // namespace tafoni_test

#endif
