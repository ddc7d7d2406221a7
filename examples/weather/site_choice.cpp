#include "site_choice.hpp"

#include "input.hpp"
#include "spec.hpp"

#include <tafoni/decomposition/given_sites.hpp>
#include <tafoni/decomposition/grid_sites.hpp>
#include <tafoni/decomposition/hexagonal_sites.hpp>
#include <tafoni/decomposition/joint_sites.hpp>
#include <tafoni/decomposition/poisson_sites.hpp>
#include <tafoni/decomposition/random_sites.hpp>
#include <tafoni/decomposition/slab_sites.hpp>
#include <tafoni/decomposition/surface_sites.hpp>
#include <tafoni/decomposition/vertex_sites.hpp>
#include <tafoni/field/ramp.hpp>

#include <algorithm>
#include <filesystem>

namespace weather {

using namespace tafoni;

namespace {

double cube_root(double x) { return elementary::pow(x, 1.0 / 3); }

/// Radii grow by `ratio` along `direction`; their size follows from the count of sites that is wanted.
std::vector<vec3> graded(spec& s, solid const& body, std::size_t count, std::uint64_t seed) {
    double const ratio = s.number("ratio", 1, 1e-2, 1e2);
    vec3 const along = s.direction("direction", {0, 0, 1});
    double lo = 0;
    double hi = 0;
    for (int a = 0; a < 3; ++a) {
        lo += std::min(along[a] * body.bounds.lo[a], along[a] * body.bounds.hi[a]);
        hi += std::max(along[a] * body.bounds.lo[a], along[a] * body.bounds.hi[a]);
    }
    ramp_field radius{.start = vec3{along * lo}, .end = vec3{along * hi}, .at_start = 1, .at_end = ratio};
    double density = 0;
    auto const probes = random_sites{.count = 2000}(body, seed);
    for (vec3 const& p : probes) density += 1 / (radius(p) * radius(p) * radius(p));
    double const fitting = cube_root(0.7 * body.volume * density / 2000 / static_cast<double>(count));
    double const base = s.number("radius", fitting, 1e-300, 1e300);
    radius.at_start = base;
    radius.at_end = base * ratio;
    return poisson_sites{radius}(body, seed);
}

}  // namespace

std::vector<vec3> choose_sites(std::string const& text, solid const& body, std::size_t count, double jitter,
                               vec3 const& up, std::uint64_t seed) {
    spec s = spec::parse("--sites", text);
    std::vector<vec3> sites;
    if (s.name() == "random") {
        s.done();
        sites = random_sites{.count = count}(body, seed);
    } else if (s.name() == "surface") {
        s.done();
        sites = surface_sites{.count = count}(body, seed);
    } else if (s.name() == "grid") {
        s.done();
        sites = grid_sites{.count = count, .jitter = jitter}(body, seed);
    } else if (s.name() == "hex") {
        hexagonal_sites pattern{.jitter = jitter, .axis = s.direction("axis", up)};
        pattern.layers = static_cast<std::size_t>(s.number("layers", 1, 1, 1e6));
        pattern.count = std::max<std::size_t>(count / pattern.layers, 1);
        pattern.vertical_jitter = s.number("vertical", 0.25, 0, 10);
        s.done();
        sites = pattern(body, seed);
    } else if (s.name() == "slabs") {
        slab_sites pattern{.up = s.direction("up", up), .jitter = jitter};
        // Slabs three times as wide as they are thick, where nothing else is said.
        double const thickness = cube_root(body.volume / static_cast<double>(count) / 9);
        pattern.spacings = s.list("spacings", {0.7 * thickness, 1.4 * thickness, 0.9 * thickness});
        pattern.across = s.number("across", 3 * thickness, 1e-150, 1e150);
        s.done();
        sites = pattern(body, seed);
    } else if (s.name() == "joints") {
        joint_sites pattern{.up = s.direction("up", up), .turn = s.number("turn", 0, -360, 360), .jitter = jitter};
        pattern.variation = s.number("variation", 0.6, 0, 0.95);
        pattern.left_out = s.number("left_out", 0.25, 0, 0.9);
        // `flat`: how much wider than thick the blocks are.
        double const flat = s.number("flat", 1.5, 1e-3, 1e3);
        double const thickness =
            cube_root(body.volume * (1 - pattern.left_out) / static_cast<double>(count) / (flat * flat));
        auto const spacing = s.list("spacing", {flat * thickness, flat * thickness, thickness});
        if (spacing.size() != 3) s.fail("spacing: three numbers are needed");
        pattern.spacing = {spacing[0], spacing[1], spacing[2]};
        s.done();
        sites = pattern(body, seed);
    } else if (s.name() == "poisson") {
        sites = graded(s, body, count, seed);
        s.done();
    } else if (s.name() == "vertices") {
        std::string const other = s.word("of", "");
        s.done();
        vertex_sites pattern{.count = count};
        if (!other.empty()) pattern.vertices = load_points(other);
        std::size_t const there = other.empty() ? body.positions.size() : pattern.vertices.size();
        pattern.count = std::min(count, there);
        sites = pattern(body, seed);
    } else if (std::error_code ignored; std::filesystem::is_regular_file(text, ignored)) {
        sites = given_sites{load_points(text)}(body, seed);
    } else {
        s.fail("no such file; known: random, surface, grid, hex, slabs, joints, poisson, vertices");
    }
    return sites;
}

}  // namespace weather
