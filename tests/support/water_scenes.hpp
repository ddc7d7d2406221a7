// Ground and boxes that tests of fluids and of hydraulic erosion share.
#ifndef TAFONI_TESTS_SUPPORT_WATER_SCENES_HPP
#define TAFONI_TESTS_SUPPORT_WATER_SCENES_HPP

#include "support/curved_surfaces.hpp"

#include <tafoni/core/executor.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/fluid/concepts.hpp>
#include <tafoni/geometry/triangle_surface.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tafoni_test {

[[nodiscard]] inline tafoni::box3 between(tafoni::vec3 const& lo, tafoni::vec3 const& hi) { return {.lo = lo, .hi = hi}; }

/// An open sheet of n x n squares over [0, 10]^2, with `height(x, y)` above it.
template <class Height>
[[nodiscard]] tafoni::triangle_surface sheet(std::uint32_t n, Height const& height, double jitter = 0) {
    return parametric(
               n + 1, n + 1, false, false, jitter,
               [&](double u, double v) { return tafoni::vec3{10 * u, 10 * v, height(10 * u, 10 * v)}; },
               [](double, double) { return 0.0; })
        .mesh;
}
/// The fluid that the concept asks for, and no more: particles that stay where they are put, whatever their speed.
struct standing {
    std::vector<tafoni::vec3> at{};
    tafoni::vec3 speed{0, 0, 0};
    double wide = 0.2;
    std::size_t particle_count() const { return at.size(); }
    tafoni::vec3 position(std::size_t i) const { return at[i]; }
    tafoni::vec3 velocity(std::size_t) const { return speed; }
    double reach() const { return wide; }
    double step(tafoni::fluid_boundary auto const&, tafoni::executor auto const&) { return 0.1; }
};
static_assert(tafoni::particle_fluid<standing>);

/// One that falls by `drop` along x.
[[nodiscard]] inline tafoni::triangle_surface slope(std::uint32_t n, double drop) {
    return parametric(
               n + 1, n + 1, false, false, 0, [&](double u, double v) { return tafoni::vec3{10 * u, 10 * v, -drop * u}; },
               [](double, double) { return 0.0; })
        .mesh;
}

/// A closed slab of n x n squares of 0.25 on either side, the lower one wavy.
[[nodiscard]] inline tafoni::triangle_surface slab(std::uint32_t n, double thick) {
    tafoni::triangle_surface s;
    std::uint32_t const row = n + 1;
    for (std::uint32_t side = 0; side < 2; ++side) {
        for (std::uint32_t y = 0; y < row; ++y) {
            for (std::uint32_t x = 0; x < row; ++x) {
                s.positions.push_back(tafoni::vec3{0.25 * x, 0.25 * y + 0.03 * ((x * 7 + y * 5 + side) % 4), side == 0 ? thick : 0.01 * ((x + y) % 2)});
            }
        }
    }
    auto const at = [&](std::uint32_t side, std::uint32_t x, std::uint32_t y) { return side * row * row + y * row + x; };
    auto const quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        s.triangles.push_back({a, b, c});
        s.triangles.push_back({a, c, d});
    };
    for (std::uint32_t y = 0; y < n; ++y) {
        for (std::uint32_t x = 0; x < n; ++x) {
            quad(at(0, x, y), at(0, x + 1, y), at(0, x + 1, y + 1), at(0, x, y + 1));
            quad(at(1, x, y), at(1, x, y + 1), at(1, x + 1, y + 1), at(1, x + 1, y));
        }
    }
    for (std::uint32_t k = 0; k < n; ++k) {
        quad(at(1, k, 0), at(1, k + 1, 0), at(0, k + 1, 0), at(0, k, 0));
        quad(at(0, k, n), at(0, k + 1, n), at(1, k + 1, n), at(1, k, n));
        quad(at(0, 0, k), at(0, 0, k + 1), at(1, 0, k + 1), at(1, 0, k));
        quad(at(1, n, k), at(1, n, k + 1), at(0, n, k + 1), at(0, n, k));
    }
    return s;
}

/// Whether triangles and positions are equal, zeros by their sign too.
[[nodiscard]] inline bool same_bits(tafoni::triangle_surface const& a, tafoni::triangle_surface const& b) {
    return a.triangles == b.triangles &&
           std::equal(a.positions.begin(), a.positions.end(), b.positions.begin(), b.positions.end(),
                      [](tafoni::vec3 const& p, tafoni::vec3 const& q) {
                          for (int d = 0; d < 3; ++d) {
                              if (std::bit_cast<std::uint64_t>(p[d]) != std::bit_cast<std::uint64_t>(q[d])) return false;
                          }
                          return true;
                      });
}

}  // namespace tafoni_test

#endif
