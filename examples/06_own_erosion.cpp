// A rule of one's own for how water takes rock: stream power, which goes with the square of the speed along the surface.
// Fast water takes rock, soft beds first; slow water lays down what it carries. Checked against the laws; a rock
// in the rain then shows its beds.
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/field/outcrop.hpp>
#include <tafoni/fluid/rain_particles.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/io/hydraulic_channels.hpp>
#include <tafoni/io/write_ply.hpp>
#include <tafoni/testing/exchange_laws.hpp>

#include <array>
#include <cmath>
#include <cstdio>

using namespace tafoni;

// Beds of 0.4 m, every second one soft.
bool soft(vec3 const& p) { return std::fmod(p[2], 0.8) < 0.4; }

struct stream_power {
    double coefficient = 1e-3;  // m of hard rock per second, for water that is 1 m/s faster than the slow one
    double slow = 0.5;          // m/s

    // m/s that the surface goes down by; below 0 it rises, by no more than what the particle carries.
    double rate(wash_point const& at) const {
        vec3 const along{at.velocity - dot(at.velocity, at.normal) * at.normal};
        double const excess = squared_length(along) - slow * slow;
        return coefficient * excess * (excess > 0 && soft(at.position) ? 5 : 1);
    }
    std::array<double, 2> parameters() const { return {coefficient, slow}; }  // by which checkpoints tell runs apart
};
static_assert(exchange_rule<stream_power>);

int main() {
    auto const broken = laws::exchange(stream_power{}, 0.15);
    for (auto const& law : broken) std::printf("broken law: %s\n", law.c_str());

    solid const rock = make_solid(make_outcrop(1, 24));  // 5 m high
    triangle_surface const surface{.positions = rock.positions, .triangles = rock.triangles};
    vec3 const& lo = rock.bounds.lo;
    vec3 const& hi = rock.bounds.hi;
    rain_particles const rain({.box = {{lo[0], lo[1], hi[2] + 0.2}, {hi[0], hi[1], hi[2] + 1}}, .velocity = {0, 0, -4}},
                              {.keep = {{lo[0] - 1, lo[1] - 1, 0}, {hi[0] + 1, hi[1] + 1, hi[2] + 2}}},
                              {.particles = 1500, .radius = 0.15, .friction = 2});
    hydraulic_run run(surface, rain, stream_power{});
    thread_pool const threads(2);
    sediment_ledger const l = run.run(250, {}, threads).ledger;
    std::printf("eroded %.3g m^3 = deposited %.3g + carried %.3g + left %.3g\n", l.eroded, l.deposited, l.carried, l.left);
    write_ply("beds.ply", run.surface(), channels_of(run));  // curvature, wear, flow, sediment per vertex

    double wear[2] = {0, 0};
    double wet[2] = {0, 0};
    for (std::size_t v = 0; v < run.wear().size(); ++v) {
        wear[soft(surface.positions[v])] += run.wear()[v];
        wet[soft(surface.positions[v])] += static_cast<double>(run.flow()[v]);
    }
    double const ratio = wear[1] / wet[1] / (wear[0] / wet[0]);
    std::printf("a contact takes %.1f times as much from soft beds as from hard ones\n", ratio);
    return broken.empty() && run.balanced() && l.deposited > 0 && ratio > 2 ? 0 : 1;
}
