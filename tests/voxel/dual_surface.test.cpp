// Laws of dual contouring: closed manifolds for every input, sharp edges and corners, convergence.
#include <tafoni/core/random.hpp>
#include <tafoni/field/grid_field.hpp>
#include <tafoni/voxel/dual_surface.hpp>

#include <catch2/catch.hpp>
#include <support/surface_laws.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <vector>

namespace {

using namespace tafoni;

/// A cube, turned by Cayley's rotation, as a distance to its nearest face plane; positive inside.
struct turned_cube {
    double half = 1;
    vec3 centre{0.013, -0.021, 0.008};
    std::array<vec3, 3> axis{};

    explicit turned_cube(double a, double b, double c) {
        double const n = 1 + a * a + b * b + c * c;
        axis = {vec3{1 + a * a - b * b - c * c, 2 * (a * b - c), 2 * (a * c + b)} / n,
                vec3{2 * (a * b + c), 1 - a * a + b * b - c * c, 2 * (b * c - a)} / n,
                vec3{2 * (a * c - b), 2 * (b * c + a), 1 - a * a - b * b + c * c} / n};
    }
    [[nodiscard]] std::array<double, 3> local(vec3 const& p) const {
        vec3 const d = p - centre;
        return {dot(axis[0], d), dot(axis[1], d), dot(axis[2], d)};
    }
    double operator()(vec3 const& p) const {
        auto const u = local(p);
        return half - std::fmax(std::fabs(u[0]), std::fmax(std::fabs(u[1]), std::fabs(u[2])));
    }
    [[nodiscard]] vec3 gradient(vec3 const& p) const {
        auto const u = local(p);
        std::size_t d = 0;
        for (std::size_t k = 1; k < 3; ++k) d = std::fabs(u[k]) > std::fabs(u[d]) ? k : d;
        return u[d] > 0 ? vec3(-axis[d]) : axis[d];
    }
};

struct ball {
    double operator()(vec3 const& p) const { return 1 - length(p); }
};

grid_frame frame(std::size_t n, double half) {
    double const h = 2 * half / static_cast<double>(n);
    return {.size = {n, n, n}, .spacing = vec3{h, h, h}, .origin = vec3{-half, -half, -half}};
}

double volume(indexed_mesh const& m) {
    double sum = 0;
    for (std::size_t t = 0; t < m.face_count(); ++t) {
        auto const f = m.face(t);
        sum += dot(m.positions[f[0]], cross(m.positions[f[1]], m.positions[f[2]])) / 6;
    }
    return sum;
}

/// What a grid of samples holds at its nodes; asked elsewhere, in between.
struct node_samples {
    grid_field<double> samples;
    double operator()(vec3 const& p) const { return samples(p); }
};

}  // namespace

TEST_CASE("two adjacent cells of any corners have a closed manifold as dual", "[voxel][dual]") {
    std::vector<double> samples(12);
    grid_frame const nodes{.size = {3, 2, 2}};
    for (unsigned code = 0; code < 4096; code += code % 64 == 63 ? 1 : 3) {
        for (std::size_t v = 0; v < 12; ++v) samples[v] = (code >> v & 1U) != 0 ? 1.0 : -1.0;
        CAPTURE(code);
        node_samples const f{{.samples = samples, .size = nodes.size, .origin = nodes.centre({0, 0, 0})}};
        for (auto const placement : {dual_placement::sharp, dual_placement::mean}) {
            auto const m = dual_surface(f, nodes, 0.0, {.placement = placement});
            REQUIRE(tafoni_test::manifold_defects(m) == 0);
        }
    }
}

TEST_CASE("random samples have a closed manifold as dual", "[voxel][dual]") {
    grid_frame const nodes{.size = {7, 8, 6}};
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        stream random(seed, stage::user, 0);
        std::vector<double> samples;
        for (std::size_t v = 0; v < nodes.voxel_count(); ++v) {
            samples.push_back(seed % 2 == 0 ? random.uniform01() - 0.02 * static_cast<double>(seed) : static_cast<double>(random.index_below(3)) - 1);
        }
        node_samples const f{{.samples = samples, .size = nodes.size, .origin = nodes.centre({0, 0, 0})}};
        CAPTURE(seed);
        auto const m = dual_surface(f, nodes, 0.0, {.placement = dual_placement::mean});
        REQUIRE(tafoni_test::manifold_defects(m) == 0);
        REQUIRE(volume(m) > 0);
        for (vec3 const& p : m.positions) REQUIRE(is_finite(p));
    }
}

TEST_CASE("a cube's faces, edges and corners stay sharp", "[voxel][dual]") {
    for (auto const& c : {turned_cube(0, 0, 0), turned_cube(0.2, 0.1, -0.15), turned_cube(0.5, -0.3, 0.1), turned_cube(0.4142, 0, 0),
                          turned_cube(0.366, 0.366, 0), turned_cube(-0.2, 0.7, 0.35)}) {
        auto const m = dual_surface(c, frame(24, 2.0), 0.0);
        REQUIRE(tafoni_test::manifold_defects(m) == 0);
        REQUIRE(volume(m) == Approx(8.0).epsilon(1e-6));
        std::set<int> corners;  // by octant: two cells may share one
        int on_edges = 0;
        for (vec3 const& p : m.positions) {
            REQUIRE(std::fabs(c(p)) < 1e-6);
            int sides = 0;
            int octant = 0;
            for (double const u : c.local(p)) {
                sides += std::fabs(std::fabs(u) - 1) < 1e-6 ? 1 : 0;
                octant = 2 * octant + (u > 0 ? 1 : 0);
            }
            on_edges += sides >= 2 ? 1 : 0;
            if (sides == 3) corners.insert(octant);
        }
        REQUIRE(corners.size() == 8);
        REQUIRE(on_edges > 12 * 8);
    }
}

TEST_CASE("where the grid cuts a shape off, the lid's rim is sharp", "[voxel][dual]") {
    auto const everywhere = [](vec3 const&) { return 1.0; };
    grid_frame const nodes{.size = {5, 4, 3}};
    auto const m = dual_surface(everywhere, nodes, 0.0);
    REQUIRE(tafoni_test::manifold_defects(m) == 0);
    REQUIRE(volume(m) == Approx(4.0 * 3 * 2).epsilon(1e-12));
    REQUIRE(dual_surface(everywhere, nodes, 2.0).face_count() == 0);
}

TEST_CASE("a sphere's dual converges with order two", "[voxel][dual]") {
    double const truth = 4.18879020478639098;
    for (auto const placement : {dual_placement::sharp, dual_placement::mean}) {
        double const coarse = std::fabs(volume(dual_surface(ball{}, frame(16, 1.3), 0.0, {.placement = placement})) - truth);
        double const fine = std::fabs(volume(dual_surface(ball{}, frame(48, 1.3), 0.0, {.placement = placement})) - truth);
        REQUIRE(std::log2(coarse / fine) / std::log2(3.0) == Approx(2.0).margin(0.3));
    }
    auto const m = dual_surface(ball{}, frame(32, 1.3), 0.0);
    for (vec3 const& p : m.positions) REQUIRE(std::fabs(length(p) - 1) < 0.003);
}

TEST_CASE("a dual surface refuses what is no grid and no number", "[voxel][dual]") {
    REQUIRE_THROWS_AS(dual_surface(ball{}, grid_frame{.size = {0, 3, 3}}, 0.0), invalid_input);
    REQUIRE_THROWS_AS(dual_surface(ball{}, grid_frame{.size = {3, 3, 3}}, std::nan("")), invalid_input);
    auto const holed = [](vec3 const& p) { return p[0] > 1 ? std::numeric_limits<double>::infinity() : 0.0; };
    REQUIRE_THROWS_AS(dual_surface(holed, grid_frame{.size = {3, 3, 3}}, 0.5), invalid_input);
}
