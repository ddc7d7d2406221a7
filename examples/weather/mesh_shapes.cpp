// builtin: meshes, for whoever has no model at hand.
#include "mesh_input.hpp"

#include "spec.hpp"

#include <tafoni/core/elementary.hpp>
#include <tafoni/field/fractal_noise.hpp>
#include <tafoni/field/outcrop.hpp>
#include <tafoni/geometry/terrain_solid.hpp>
#include <tafoni/repair/collapse_short_edges.hpp>
#include <tafoni/voxel/isosurface.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>

namespace weather {

using namespace tafoni;

namespace {

/// n x n squares on each side of [0, 1]^3.
indexed_mesh make_cube(spec& s) {
    int const n = static_cast<int>(s.number("squares", 20, 1, 2000));
    indexed_mesh m;
    std::map<std::array<int, 3>, std::uint32_t> number;
    auto const at = [&](std::array<int, 3> const& q) {
        auto const [i, fresh] = number.try_emplace(q, static_cast<std::uint32_t>(m.positions.size()));
        if (fresh) m.add_vertex({1.0 * q[0] / n, 1.0 * q[1] / n, 1.0 * q[2] / n});
        return i->second;
    };
    for (std::size_t d = 0; d < 3; ++d) {
        for (int const side : {0, n}) {
            for (int i = 0; i < n; ++i) {
                for (int j = 0; j < n; ++j) {
                    auto const corner = [&](int a, int b) {
                        std::array<int, 3> q{};
                        q[d] = side;
                        q[(d + 1) % 3] = a;
                        q[(d + 2) % 3] = b;
                        return at(q);
                    };
                    std::uint32_t b = corner(i + 1, j);
                    std::uint32_t e = corner(i, j + 1);
                    if (side == 0) std::swap(b, e);
                    m.add_face({corner(i, j), b, corner(i + 1, j + 1)});
                    m.add_face({corner(i, j), corner(i + 1, j + 1), e});
                }
            }
        }
    }
    return m;
}

/// The cube blown up to a ball.
indexed_mesh make_sphere(spec& s) {
    indexed_mesh m = make_cube(s);
    for (vec3& p : m.positions) p = vec3{normalized(p - vec3{0.5, 0.5, 0.5}) * 0.5};
    return m;
}

/// What is nearer than the rest joins with it over a width w.
double joined(double a, double b, double w) {
    double const h = std::max(w - std::fabs(a - b), 0.0) / w;
    return std::min(a, b) - h * h * w / 4;
}
double capsule(vec3 const& p, vec3 const& a, vec3 const& b, double ra, double rb) {
    vec3 const u{p - a};
    vec3 const v{b - a};
    double const t = std::clamp(dot(u, v) / dot(v, v), 0.0, 1.0);
    return length(vec3{u - t * v}) - (ra + t * (rb - ra));
}
/// About the distance from an ellipsoid.
double ellipsoid(vec3 const& p, vec3 const& c, vec3 const& r) {
    vec3 const u{(p[0] - c[0]) / r[0], (p[1] - c[1]) / r[1], (p[2] - c[2]) / r[2]};
    return (length(u) - 1) * std::min({r[0], r[1], r[2]});
}

/// A head on shoulders and a plinth, its face to -y.
double bust(vec3 const& p) {
    vec3 const q{std::fabs(p[0]), p[1], p[2]};
    double d = ellipsoid(p, {0, 0, 0.74}, {0.145, 0.18, 0.2});
    d = joined(d, ellipsoid(p, {0, -0.03, 0.63}, {0.1, 0.125, 0.12}), 0.08);                // jaw
    d = joined(d, capsule(p, {0, -0.17, 0.755}, {0, -0.215, 0.685}, 0.012, 0.026), 0.035);  // nose
    d = joined(d, capsule(q, {0.015, -0.163, 0.775}, {0.09, -0.133, 0.78}, 0.02, 0.016), 0.03);  // brows
    d = joined(d, ellipsoid(p, {0, -0.165, 0.615}, {0.045, 0.022, 0.016}), 0.02);           // lips
    d = joined(d, ellipsoid(p, {0, -0.138, 0.55}, {0.035, 0.03, 0.028}), 0.04);             // chin
    d = -joined(-d, ellipsoid(q, {0.052, -0.178, 0.738}, {0.034, 0.024, 0.018}), 0.02);     // eyes
    d = joined(d, ellipsoid(q, {0.15, 0.01, 0.72}, {0.02, 0.036, 0.055}), 0.02);            // ears
    d = joined(d, capsule(p, {0, 0.03, 0.62}, {0, 0.05, 0.4}, 0.085, 0.1), 0.06);           // neck
    d = joined(d, ellipsoid(p, {0, 0.05, 0.28}, {0.3, 0.16, 0.13}), 0.12);                  // shoulders
    d = joined(d, capsule(p, {0, 0.03, 0.2}, {0, 0.03, 0.1}, 0.13, 0.1), 0.08);
    double const r = std::max(std::fabs(p[0]), std::fabs(p[1] - 0.03)) - 0.16;
    return joined(d, std::max(r, std::fabs(p[2] - 0.05) - 0.05), 0.02);                     // plinth
}

/// Palm, four fingers and a thumb.
double hand(vec3 const& p) {
    double d = ellipsoid(p, {0, 0, 0.34}, {0.15, 0.055, 0.17});
    d = joined(d, capsule(p, {0, 0, 0.3}, {0, 0, 0.05}, 0.085, 0.075), 0.08);
    std::array<std::array<double, 5>, 4> const fingers{{{-0.105, 0.46, -0.17, 0.72, 0.030}, {-0.038, 0.48, -0.055, 0.86, 0.033},
                                                        {0.034, 0.48, 0.06, 0.89, 0.034}, {0.1, 0.45, 0.17, 0.81, 0.032}}};
    for (auto const& f : fingers) {
        vec3 const knuckle{0.5 * (f[0] + f[2]), -0.035, 0.5 * (f[1] + f[3])};
        d = joined(d, capsule(p, {f[0], 0, f[1]}, knuckle, f[4] * 1.1, f[4]), 0.025);
        d = joined(d, capsule(p, knuckle, {f[2], 0, f[3]}, f[4], f[4] * 0.85), 0.015);
    }
    d = joined(d, capsule(p, {0.1, -0.02, 0.26}, {0.25, -0.05, 0.45}, 0.05, 0.04), 0.05);
    return joined(d, capsule(p, {0.25, -0.05, 0.45}, {0.28, -0.04, 0.58}, 0.04, 0.03), 0.02);
}

/// Where a winding stream runs at x.
double course(double x, double swing) {
    constexpr double turn = 6.283185307179586;
    return 0.5 + swing * elementary::sin(turn * x) + 0.3 * swing * elementary::sin(2.7 * turn * x + 1);
}
double smooth(double lo, double hi, double x) {
    double const t = std::clamp((x - lo) / (hi - lo), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

template <class F>
indexed_mesh solid_of(box3 const& box, double resolution, F const& inside) {
    vec3 const e = box.extent();
    double const cell = std::max({e[0], e[1], e[2]}) / resolution;
    grid_frame frame;
    for (std::size_t d = 0; d < 3; ++d) {
        auto const a = static_cast<Eigen::Index>(d);
        frame.size[d] = static_cast<std::size_t>(std::ceil(e[a] / cell)) + 2;
        frame.spacing[a] = cell;
        frame.origin[a] = box.lo[a] - cell;
    }
    indexed_mesh const raw = isosurface([&](vec3 const& p) -> double { return inside(p); }, frame, 0);
    // Slivers at the grid's corners say nothing about the shape.
    triangle_surface s = triangle_surface{.positions = raw.positions, .triangles = {}};
    for (std::size_t f = 0; f < raw.face_count(); ++f) s.triangles.push_back({raw.face(f)[0], raw.face(f)[1], raw.face(f)[2]});
    collapse_short_edges(s, 0.45 * cell);
    indexed_mesh out{.positions = s.positions, .corners = {}, .offsets = {0}};
    for (auto const& t : s.triangles) out.add_face(t);
    return out;
}

/// A block with a narrow, winding gorge that falls along x.
indexed_mesh make_canyon(spec& s, std::uint64_t seed) {
    double const resolution = s.number("resolution", 110, 8, 2000);
    double const width = s.number("width", 0.16, 0.01, 0.5);
    double const depth = s.number("depth", 0.34, 0.05, 0.5);
    fractal_noise const rough{.seed = seed, .frequency = 9, .octaves = 3};
    fractal_noise const rolling{.seed = seed + 1, .frequency = 2.5, .octaves = 2};
    box3 const box{.lo = {0, 0, -0.2}, .hi = {1.6, 1, 0.75}};
    return solid_of(box, resolution, [&](vec3 const& p) {
        double const off = std::fabs(p[1] - course(p[0] / 1.6, 0.13)) + 0.03 * rough(p);
        double const floor = 0.12 - 0.12 * p[0];
        double const top = 0.08 - 0.08 * p[0] + depth + 0.12 * rolling({p[0], p[1], 0}) + 0.03 * rough({p[0], p[1], 4});
        double const wall = smooth(0.5 * width, 0.5 * width + 0.09, off);
        double ground = floor + (top - floor) * wall + 0.15 * std::max(off - width, 0.0) - p[2];
        for (int a = 0; a < 2; ++a) ground = std::min({ground, p[a] - box.lo[a], box.hi[a] - p[a]});
        return std::min(ground, p[2] - box.lo[2]);
    });
}

/// A height surface with a meandering river bed in a plain.
indexed_mesh make_valley(spec& s, std::uint64_t seed) {
    auto const n = static_cast<std::size_t>(s.number("resolution", 160, 4, 5000));
    double const width = s.number("width", 0.07, 0.005, 0.3);
    double const depth = s.number("depth", 0.05, 0, 0.3);
    double const fall = s.number("fall", 0.12, 0, 1);
    fractal_noise const rough{.seed = seed, .frequency = 6, .octaves = 4};
    height_grid g{.columns = n + n / 2, .rows = n, .cell_size_x = 1.0 / static_cast<double>(n), .cell_size_y = 1.0 / static_cast<double>(n)};
    g.heights.resize(g.columns * g.rows);
    for (std::size_t r = 0; r < g.rows; ++r) {
        for (std::size_t c = 0; c < g.columns; ++c) {
            vec3 const p = g.position(r, c);
            double const off = std::fabs(p[1] - course(p[0] / 1.5, 0.17));
            double const bank = smooth(0.4 * width, 0.8 * width, off);
            g.heights[r * g.columns + c] = fall * (1 - p[0] / 1.5) + depth * bank + 0.25 * off * off + 0.02 * rough(p) * bank;
        }
    }
    return detail::terrain_top(g);
}

}  // namespace

indexed_mesh make_builtin_mesh(std::string const& text, std::uint64_t seed) {
    spec s = spec::parse("INPUT builtin:", text);
    seed = static_cast<std::uint64_t>(s.number("seed", static_cast<double>(seed), 0, 1e15));
    indexed_mesh out;
    if (s.name() == "cube") {
        out = make_cube(s);
    } else if (s.name() == "sphere") {
        out = make_sphere(s);
    } else if (s.name() == "bust") {
        out = solid_of({.lo = {-0.32, -0.26, 0}, .hi = {0.32, 0.24, 0.96}}, s.number("resolution", 120, 8, 2000), [](vec3 const& p) { return -bust(p); });
    } else if (s.name() == "hand") {
        out = solid_of({.lo = {-0.22, -0.12, 0}, .hi = {0.34, 0.08, 0.95}}, s.number("resolution", 110, 8, 2000), [](vec3 const& p) { return -hand(p); });
    } else if (s.name() == "canyon") {
        out = make_canyon(s, seed);
    } else if (s.name() == "valley") {
        out = make_valley(s, seed);
    } else if (s.name() == "outcrop") {
        out = make_outcrop(seed, static_cast<std::size_t>(s.number("resolution", 40, 4, 2000)));
    } else {
        s.fail("known: cube, sphere, bust, hand, canyon, valley, outcrop");
    }
    s.done();
    return out;
}

}  // namespace weather
