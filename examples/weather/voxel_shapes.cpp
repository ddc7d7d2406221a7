// builtin: shapes, for whoever has no model at hand.
#include "voxel_input.hpp"

#include "spec.hpp"

#include <tafoni/field/fractal_noise.hpp>

#include <algorithm>
#include <cmath>

namespace weather {

using namespace tafoni;

namespace {

/// A column on a plinth, bulging and bent a little, as an image swept around would give it [Figures 7 and 14].
builtin_shape make_hoodoo(spec& s, std::uint64_t seed) {
    double const radius = s.number("radius", 0.21, 0.05, 0.4);
    double const plinth = s.number("plinth", 0.1, 0, 0.5);
    double const bulge = s.number("bulge", 0.05, 0, 0.3);
    fractal_noise const bulges{.seed = seed, .frequency = 3, .octaves = 3};
    fractal_noise const bend{.seed = seed + 1, .frequency = 1.5, .octaves = 1};
    double const wide = std::max(radius + bulge, 1.6 * radius);
    return {.bounds = {.lo = {-wide, -wide, 0}, .hi = {wide, wide, 1}},
            .contains = [=](vec3 const& p) {
                if (p[2] < 0 || p[2] > 1) return false;
                double r = radius + bulge * 2 * bulges(p);
                if (p[2] < plinth) r = std::max(r, 1.6 * radius - 0.5 * p[2]);
                if (p[2] > 0.94) r -= (p[2] - 0.94) * 0.8;
                double const share = std::max(0.0, p[2] - plinth);
                double const x = p[0] - 0.12 * share * bend({0, 0, p[2]});
                double const y = p[1] - 0.12 * share * bend({7.5, 0, p[2]});
                return x * x + y * y < r * r;
            }};
}

/// A wall with shallow dents, from which caverns grow.
builtin_shape make_cliff(spec& s, std::uint64_t seed) {
    double const dents = s.number("dents", 0.06, 0, 0.2);
    double const wavelength = s.number("wavelength", 0.16, 1e-3, 10);
    fractal_noise const front{.seed = seed, .frequency = 1 / wavelength, .octaves = 3};
    return {.bounds = {.lo = {0, 0, 0}, .hi = {1, 0.4, 0.7}},
            .contains = [=](vec3 const& p) {
                if (p[0] < 0 || p[0] > 1 || p[1] > 0.4 || p[2] < 0 || p[2] > 0.7) return false;
                return p[1] > dents * (1 + 2 * std::clamp(front(p), -0.5, 0.5));
            }};
}

}  // namespace

builtin_shape make_builtin(std::string const& text, std::uint64_t seed) {
    spec s = spec::parse("INPUT builtin:", text);
    seed = static_cast<std::uint64_t>(s.number("seed", static_cast<double>(seed), 0, 1e15));
    builtin_shape out;
    if (s.name() == "hoodoo") {
        out = make_hoodoo(s, seed);
    } else if (s.name() == "cliff") {
        out = make_cliff(s, seed);
    } else if (s.name() == "cube") {
        out = {.bounds = {.lo = {0, 0, 0}, .hi = {1, 1, 1}}, .contains = [](vec3 const&) { return true; }};
    } else if (s.name() == "corner") {
        // An inside corner between two walls [Figure 10].
        double const height = s.number("height", 0.75, 0.05, 1);
        double const wall = s.number("wall", 0.45, 0.05, 0.95);
        out = {.bounds = {.lo = {0, 0, 0}, .hi = {1, 1, height}},
               .contains = [wall](vec3 const& p) { return p[0] < wall || p[1] > 1 - wall; }};
    } else {
        s.fail("known: hoodoo, cube, corner, cliff, outcrop");
    }
    s.done();
    // Voxels of air in a margin lie outside of the box.
    return {.bounds = out.bounds, .contains = [out](vec3 const& p) {
                for (int a = 0; a < 3; ++a) {
                    if (p[a] < out.bounds.lo[a] || p[a] > out.bounds.hi[a]) return false;
                }
                return out.contains(p);
            }};
}

}  // namespace weather
