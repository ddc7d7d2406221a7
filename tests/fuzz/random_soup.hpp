/// \file
/// A small mesh of triangles chosen by bytes: sheets and balls, dented, welded or torn, with odd triangles among them.
#ifndef TAFONI_TESTS_FUZZ_RANDOM_SOUP_HPP
#define TAFONI_TESTS_FUZZ_RANDOM_SOUP_HPP

#include "reliability/cases.hpp"
#include "support/curved_surfaces.hpp"

#include <tafoni/geometry/triangle_surface.hpp>

#include <cmath>

namespace tafoni_test {

[[nodiscard]] inline tafoni::triangle_surface random_soup(choices& c) {
    using tafoni::vec3;
    tafoni::triangle_surface s;
    std::uint64_t const kind = c.below(4);
    if (kind == 0) s = sphere(static_cast<int>(c.below(3))).mesh;
    if (kind == 1) s = torus_surface(static_cast<std::uint32_t>(3 + c.below(8)), static_cast<std::uint32_t>(3 + c.below(6)), 0).mesh;
    if (kind >= 2) {
        auto const n = static_cast<std::uint32_t>(2 + c.below(8));
        double const rough = c.chance(0.5) ? 0.0 : 0.5 * c.unit();
        double const tilt = c.unit();
        s = parametric(
                n, static_cast<std::uint32_t>(2 + c.below(8)), false, false, c.chance(0.5) ? 0.0 : 0.3,
                [&](double u, double v) { return vec3{2 * u - 1, 2 * v - 1, tilt * u + rough * c.unit()}; }, [](double, double) { return 0.0; })
                .mesh;
    }
    for (std::uint64_t k = c.below(6); k-- > 0;) {
        std::size_t const v = c.below(s.positions.size());
        for (int d = 0; d < 3; ++d) s.positions[v][d] += 0.5 * (c.unit() - 0.5);
    }
    for (std::uint64_t k = c.below(4); k-- > 0;) {  // of no area, twice there, or across
        auto const corner = [&] { return static_cast<std::uint32_t>(c.below(s.positions.size())); };
        std::uint32_t const a = corner();
        std::uint32_t const b = corner();
        s.triangles.push_back({a, b, c.chance(0.3) ? a : corner()});
    }
    for (std::uint64_t k = c.below(4); k-- > 0 && !s.triangles.empty();) {
        s.triangles.erase(s.triangles.begin() + static_cast<std::ptrdiff_t>(c.below(s.triangles.size())));
    }
    double const unit = c.chance(0.7) ? 1.0 : std::ldexp(1.0, static_cast<int>(c.below(60)) - 30);
    vec3 const origin = c.chance(0.7) ? vec3{0, 0, 0} : vec3{1000 * unit * c.unit(), 0, -1e6 * unit * c.unit()};
    for (vec3& p : s.positions) p = origin + unit * p;
    return s;
}

}  // namespace tafoni_test

#endif
