#include <tafoni/fluid/mesh_boundary.hpp>
#include <tafoni/fluid/sph.hpp>

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

using namespace tafoni;

namespace {

constexpr double fall = 0.5;  // of the slope, per length

/// A slope of 80 x 8 that goes down along x.
struct slope {
    std::vector<vec3> positions{vec3{-2, -4, 2 * fall}, vec3{78, -4, -78 * fall}, vec3{78, 4, -78 * fall}, vec3{-2, 4, 2 * fall}};
    std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
};

sph<double> water(double friction) {
    return sph<double>(std::vector<box_emitter>{}, {.keep = {.lo = {-2, -4, -50}, .hi = {78, 4, 50}}},
                       {.particles = 8, .spacing = 0.2, .sound_speed = 60, .friction = friction, .gravity = vec3{0, 0, -10}, .largest_step = 0.01});
}

/// Speed down the slope after some seconds of one particle that starts at rest on it.
double speed_after(double friction, double seconds) {
    slope const s;
    mesh_boundary const walls(s.positions, s.triangles, 0.2);
    sph<double> one = water(friction);
    one.place(std::vector<fluid_particle>{{.id = 1, .position = vec3{0, 0, 0.2}}});
    for (double t = 0; t < seconds;) t += one.step(walls, inline_executor{});
    REQUIRE(one.particle_count() == 1);
    return length(one.velocity(0));
}

double const down = 10 * fall / std::sqrt(1 + fall * fall);  // acceleration along the slope

}  // namespace

TEST_CASE("friction holds water on a slope at the acceleration over it") {
    CHECK(speed_after(2, 6) == Approx(down / 2).epsilon(0.05));
    CHECK(speed_after(4, 6) == Approx(down / 4).epsilon(0.05));
}

TEST_CASE("on smooth ground water goes on to run faster") {
    CHECK(speed_after(0, 2) == Approx(2 * down).epsilon(0.05));
    CHECK(speed_after(0, 4) == Approx(4 * down).epsilon(0.05));
}

TEST_CASE("friction brakes nothing away from walls, and shortens steps that it would overshoot in") {
    slope const s;
    mesh_boundary const walls(s.positions, s.triangles, 0.2);
    for (double const friction : {0.0, 3.0}) {
        sph<double> one = water(friction);
        one.place(std::vector<fluid_particle>{{.id = 1, .position = vec3{0, 0, 20}, .velocity = vec3{3, 0, 0}}});
        for (int k = 0; k < 40; ++k) static_cast<void>(one.step(walls, inline_executor{}));
        CHECK(one.velocity(0)[0] == Approx(3).epsilon(1e-12));
    }
    sph<double> rough = water(1e5);
    rough.place(std::vector<fluid_particle>{{.id = 1, .position = vec3{0, 0, 0.2}, .velocity = vec3{5, 0, 0}}});
    CHECK(rough.step(walls, inline_executor{}) == Approx(0.8e-5));
    for (int k = 0; k < 100; ++k) static_cast<void>(rough.step(walls, inline_executor{}));
    CHECK(length(rough.velocity(0)) < 0.1);
}

TEST_CASE("friction out of range is refused, and saved water goes on with the friction that it had") {
    CHECK_THROWS_AS(water(-1), invalid_input);
    CHECK_THROWS_AS(water(std::nan("")), invalid_input);
    auto const bytes = [](sph<double> const& w) {
        detail::byte_writer out;
        w.save(out);
        return std::vector<std::byte>(out.bytes().begin(), out.bytes().end());
    };
    auto const load = [](sph<double>& w, std::vector<std::byte> const& saved) {
        detail::byte_reader in(saved, "here");
        w.load(in);
    };
    std::vector<std::byte> const saved = bytes(water(2));
    sph<double> same = water(2);
    CHECK_NOTHROW(load(same, saved));
    for (double const other : {0.0, 3.0}) {
        sph<double> w = water(other);
        CHECK_THROWS_AS(load(w, saved), invalid_input);
    }
}
