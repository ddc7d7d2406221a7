// Surfaces whose mean curvature is known, as triangles.
#ifndef TAFONI_TESTS_SUPPORT_CURVED_SURFACES_HPP
#define TAFONI_TESTS_SUPPORT_CURVED_SURFACES_HPP

#include "support/shapes.hpp"

#include <tafoni/core/random.hpp>
#include <tafoni/geometry/triangle_surface.hpp>
#include <tafoni/geometry/vertex_rings.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace tafoni_test {

/// Triangles, mean curvature at each vertex (positive where the surface bends away from the normal).
struct curved_surface {
    tafoni::triangle_surface mesh{};
    std::vector<double> mean{};
};

[[nodiscard]] inline tafoni::triangle_surface triangles_of(tafoni::indexed_mesh const& m) {
    tafoni::triangle_surface s{.positions = m.positions, .triangles = {}};
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        auto const c = m.face(f);
        for (std::size_t k = 1; k + 1 < c.size(); ++k) s.triangles.push_back({c[0], c[k], c[k + 1]});
    }
    return s;
}

/// A grid of parameters in [0, 1)^2 with `point(u, v)` and `curvature(u, v)`; wraps around where asked. `jitter` moves
/// vertices within the surface, in cells.
template <class Point, class Curvature>
[[nodiscard]] curved_surface parametric(std::uint32_t n, std::uint32_t m, bool wrap_u, bool wrap_v, double jitter,
                                        Point const& point, Curvature const& curvature) {
    curved_surface s;
    tafoni::stream random(17, 0, 0);
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < m; ++j) {
            double const a = jitter * random.uniform(-1, 1);
            double const b = jitter * random.uniform(-1, 1);
            double const u = (i + a) / (wrap_u ? n : n - 1);
            double const v = (j + b) / (wrap_v ? m : m - 1);
            s.mesh.positions.push_back(point(u, v));
            s.mean.push_back(curvature(u, v));
        }
    }
    for (std::uint32_t i = 0; i + (wrap_u ? 0 : 1) < n; ++i) {
        for (std::uint32_t j = 0; j + (wrap_v ? 0 : 1) < m; ++j) {
            auto const at = [&](std::uint32_t x, std::uint32_t y) { return x % n * m + y % m; };
            s.mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            s.mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return s;
}

inline constexpr double tau = 6.283185307179586;

[[nodiscard]] inline curved_surface sphere(int level) {
    curved_surface s{.mesh = triangles_of(icosphere(level)), .mean = {}};
    s.mean.assign(s.mesh.positions.size(), 1.0);
    return s;
}
[[nodiscard]] inline curved_surface torus_surface(std::uint32_t n, std::uint32_t m, double jitter, double R = 1, double r = 0.4) {
    auto const out = [=](double v) { return R + r * std::cos(tau * v); };
    return parametric(
        n, m, true, true, jitter,
        [=](double u, double v) {
            return tafoni::vec3{out(v) * std::cos(tau * u), out(v) * std::sin(tau * u), r * std::sin(tau * v)};
        },
        [=](double, double v) { return (R + 2 * r * std::cos(tau * v)) / (2 * r * out(v)); });
}
[[nodiscard]] inline curved_surface cylinder(std::uint32_t n, std::uint32_t m, double jitter) {
    return parametric(
        n, m, true, false, jitter,
        [](double u, double v) { return tafoni::vec3{std::cos(tau * u), std::sin(tau * u), 2 * v}; },
        [](double, double) { return 0.5; });
}
/// A minimal surface: H = 0 though it is bent.
[[nodiscard]] inline curved_surface catenoid(std::uint32_t n, std::uint32_t m, double jitter) {
    return parametric(
        n, m, true, false, jitter,
        [](double u, double v) {
            double const h = 2 * v - 1;
            return tafoni::vec3{std::cosh(h) * std::cos(tau * u), std::cosh(h) * std::sin(tau * u), h};
        },
        [](double, double) { return 0.0; });
}

struct curvature_error {
    double rms = 0;      ///< of the error over that of the curvature (or of 1 where that is 0)
    double largest = 0;  ///< of |error| / |curvature| (or / 1)
};

/// Border vertices are left out, and their neighbours when `rings_off` is 2.
[[nodiscard]] inline curvature_error error_of(curved_surface const& s, std::vector<double> const& estimate, int rings_off = 1) {
    tafoni::vertex_rings const rings(s.mesh.positions.size(), s.mesh.triangles);
    double error = 0;
    double scale = 0;
    curvature_error e;
    for (std::size_t v = 0; v < estimate.size(); ++v) {
        bool skip = rings.is_border(v);
        if (rings_off > 1) {
            for (auto const w : rings.neighbors(v)) skip = skip || rings.is_border(w);
        }
        if (skip) continue;
        double const d = estimate[v] - s.mean[v];
        double const unit = s.mean[v] == 0 ? 1 : std::fabs(s.mean[v]);
        error += d * d;
        scale += unit * unit;
        e.largest = std::max(e.largest, std::fabs(d) / unit);
    }
    e.rms = std::sqrt(error / scale);
    return e;
}

}  // namespace tafoni_test

#endif
