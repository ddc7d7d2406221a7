// A fluid of one's own: a film that creeps down the rock, without weight or pressure. Five members; checked against the
// laws, then it wears the rock that it wets, by curvature.
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/field/outcrop.hpp>
#include <tafoni/fluid/facing_contacts.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/io/hydraulic_channels.hpp>
#include <tafoni/io/write_ply.hpp>
#include <tafoni/testing/fluid_laws.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

using namespace tafoni;

struct creeping_film {
    std::vector<vec3> start{};                 // where water comes out, and again when it has run off
    double speed = 1;                          // m/s straight down, less on slopes
    double touch = 0.15;                       // m
    double bottom = 0;                         // z, m
    std::vector<vec3> at = start;
    std::vector<vec3> way = std::vector<vec3>(start.size(), vec3{0, 0, 0});

    std::size_t particle_count() const { return at.size(); }
    vec3 position(std::size_t i) const { return at[i]; }
    vec3 velocity(std::size_t i) const { return way[i]; }
    double reach() const { return touch; }

    double step(fluid_boundary auto const& walls, executor auto const& threads) {
        double const dt = 0.25 * touch / speed;
        threads.for_blocks(at.size(), 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                boundary_contact rock{.distance = 2 * touch};
                for_each_facing_contact(walls, at[i], touch, [&](boundary_contact const& c) {
                    if (std::fabs(c.distance) < std::fabs(rock.distance)) rock = c;
                });
                way[i] = vec3{0, 0, -speed};
                vec3 lift{0, 0, 0};  // keeps the film half a reach off the rock
                if (rock.distance < 2 * touch) {
                    way[i] = vec3{way[i] - dot(way[i], rock.normal) * rock.normal};
                    lift = vec3{(0.5 * touch - rock.distance) * rock.normal};
                }
                at[i] = vec3{at[i] + dt * way[i] + lift};
                if (at[i][2] < bottom) at[i] = start[i];
            }
        });
        return dt;  // s
    }
};
static_assert(particle_fluid<creeping_film>);

int main() {
    solid const rock = make_solid(make_outcrop(1, 24));  // 5 m high
    triangle_surface const surface{.positions = rock.positions, .triangles = rock.triangles};
    std::vector<vec3> springs;
    for (int k = 0; k < 900; ++k) springs.push_back(vec3{0.1 * (k % 30) - 1.5, 0.1 * (k / 30) - 1.5, rock.bounds.hi[2] + 0.1});

    auto const broken = laws::fluid(creeping_film{.start = springs});
    for (auto const& law : broken) std::printf("broken law: %s\n", law.c_str());

    hydraulic_run run(surface, creeping_film{.start = springs}, curvature_erosion{}, {.step_divisor = 20});
    thread_pool const threads(2);
    hydraulic_report const report = run.run(200, {}, threads);
    std::printf("the film took %.3g of %.3g m^3 in %.0f s\n", report.ledger.eroded, rock.volume, report.time);
    write_ply("film.ply", run.surface(), channels_of(run));  // flow: where it ran
    return broken.empty() && run.balanced() && report.ledger.eroded > 0.01 ? 0 : 1;
}
