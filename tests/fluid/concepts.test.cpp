#include "support/curved_surfaces.hpp"

#include <tafoni/fluid/rain_particles.hpp>
#include <tafoni/fluid/sph.hpp>
#include <tafoni/testing/fluid_archetypes.hpp>
#include <tafoni/testing/fluid_laws.hpp>

#include <catch2/catch.hpp>

#include <limits>

using namespace tafoni;
using namespace tafoni_test;

namespace {

box3 between(vec3 const& lo, vec3 const& hi) {
    box3 b;
    b.lo = lo;
    b.hi = hi;
    return b;
}

/// Breaks what it says: the executor shows, a velocity is none, ids repeat.
struct broken {
    std::size_t seen = 0;
    std::size_t particle_count() const { return 2; }
    vec3 position(std::size_t) const { return vec3{0, 0, static_cast<double>(seen)}; }
    vec3 velocity(std::size_t) const { return vec3{0, std::numeric_limits<double>::quiet_NaN(), 0}; }
    std::uint64_t id(std::size_t) const { return 7; }
    double reach() const { return 1; }
    double step(fluid_boundary auto const&, executor auto const& x) {
        seen += x.thread_count();
        return 0;
    }
};

}  // namespace

TEST_CASE("our fluids and the archetype keep the laws of a particle fluid") {
    box_emitter const from{.box = between(vec3{0, 0, 0.5}, vec3{3, 3, 2.5})};
    box_sink const keep{.keep = between(vec3{-9, -9, -9}, vec3{9, 9, 9})};
    CHECK(laws::fluid(rain_particles(from, keep, {.particles = 1500, .radius = 0.3})) == std::vector<std::string>{});
    CHECK(laws::fluid(sph<float>(from, keep, {.particles = 2000, .spacing = 0.25})) == std::vector<std::string>{});
    CHECK(laws::fluid(sph<double>(from, keep, {.particles = 2000, .spacing = 0.25})) == std::vector<std::string>{});
    CHECK(laws::fluid(archetypes::fluid(0)) == std::vector<std::string>{});
    CHECK(laws::fluid(broken{}).size() == 5);
}

TEST_CASE("our walls and the archetype keep the laws of a boundary") {
    std::vector<vec3> places;
    stream random(2, 0, 0);
    for (int k = 0; k < 500; ++k) {
        double const x = random.uniform(-1.6, 1.6);
        double const y = random.uniform(-1.6, 1.6);
        double const z = random.uniform(-0.6, 0.6);
        places.push_back(vec3{x, y, z});
    }
    triangle_surface const s = torus_surface(40, 24, 0.3).mesh;
    CHECK(laws::boundary(mesh_boundary(s.positions, s.triangles, 0.2), places, 0.2) == std::vector<std::string>{});
    CHECK(laws::boundary(archetypes::boundary(0), places, 0.2) == std::vector<std::string>{});
    CHECK(laws::boundary(open_space{}, places, 0.2) == std::vector<std::string>{});
}

TEST_CASE("fluids flow against walls that are no mesh") {
    rain_particles rain({.box = between(vec3{0, 0, 1}, vec3{1, 1, 1})}, {.keep = between(vec3{-9, -9, -9}, vec3{9, 9, 9})},
                        {.particles = 20, .radius = 0.2, .lifetime = 1e6});
    sph<double> water({.box = between(vec3{0, 0, 1}, vec3{0.5, 0.5, 1.2})}, {.keep = between(vec3{-99, -99, -9}, vec3{99, 99, 9})},
                      {.particles = 30, .spacing = 0.1, .sound_speed = 20});
    archetypes::boundary const half(0);
    for (int k = 0; k < 400; ++k) {
        rain.step(half, inline_executor{});
        water.step(half, inline_executor{});
    }
    for (std::size_t i = 0; i < rain.particle_count(); ++i) CHECK(rain.position(i)[2] > 0);
    for (std::size_t i = 0; i < water.particle_count(); ++i) CHECK(water.position(i)[2] > -0.05);
}
