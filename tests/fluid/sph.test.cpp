#include "support/water_scenes.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/fluid/mesh_boundary.hpp>
#include <tafoni/fluid/sph.hpp>

#include <catch2/catch.hpp>

#include <limits>
#include <numeric>

using namespace tafoni;
using namespace tafoni_test;

namespace {

box_sink everywhere() { return {.keep = between(vec3{-1e6, -1e6, -1e6}, vec3{1e6, 1e6, 1e6})}; }

template <class Scalar>
sph<Scalar> placed(std::vector<fluid_particle> const& all, sph_options const& o) {
    sph<Scalar> f(std::vector<box_emitter>{}, everywhere(), o);
    f.place(all);
    return f;
}
/// A lattice of n^3 with the spacing given, moved by up to `jitter` spacings, with random velocities.
std::vector<fluid_particle> cloud(int n, double spacing, double jitter, double speed = 0) {
    std::vector<fluid_particle> all;
    stream random(5, 0, 0);
    auto const around = [&](double size) {
        double const a = random.uniform(-1, 1);
        double const b = random.uniform(-1, 1);
        double const c = random.uniform(-1, 1);
        return vec3{size * a, size * b, size * c};
    };
    for (int k = 0; k < n; ++k) {
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                vec3 const q{spacing * i, spacing * j, spacing * k};
                vec3 const shift = around(jitter * spacing);
                all.push_back({.id = all.size(), .position = q + shift, .velocity = around(speed)});
            }
        }
    }
    return all;
}
template <class Scalar>
std::vector<vec3> state(sph<Scalar> const& f) {
    std::vector<vec3> all;
    for (std::size_t i = 0; i < f.particle_count(); ++i) {
        all.push_back(f.position(i));
        all.push_back(f.velocity(i));
    }
    return all;
}
/// An open box without lid, faces to the inside.
triangle_surface tub(double wide, double high) {
    triangle_surface s;
    for (int k = 0; k < 8; ++k) s.positions.push_back(vec3{(k & 1) != 0 ? wide : 0.0, (k & 2) != 0 ? wide : 0.0, (k & 4) != 0 ? high : 0.0});
    s.triangles = {{0, 1, 3}, {0, 3, 2}, {0, 4, 5}, {0, 5, 1}, {1, 5, 7}, {1, 7, 3}, {3, 7, 6}, {3, 6, 2}, {2, 6, 4}, {2, 4, 0}};
    return s;
}

/// Throws when it has been asked so many times.
struct falling_wall {
    int* left;
    template <class Visit>
    void for_each_contact(vec3 const&, double, Visit const&) const {
        if (--*left == 0) throw std::runtime_error("no wall");
    }
};

}  // namespace

TEMPLATE_TEST_CASE("the kernel integrates to one", "", float, double) {
    // What a pair adds to its density is the kernel at its distance; a pair stands alone every 20 h.
    for (double const smoothing : {1.0, 1.3}) {
        double const h = 2 * smoothing;
        std::vector<fluid_particle> pairs;
        int const n = 400;
        for (int k = 0; k < n; ++k) {
            vec3 const at{20 * h * (k % 20), 20 * h * (k / 20), 0};
            pairs.push_back({.id = pairs.size(), .position = at});
            pairs.push_back({.id = pairs.size(), .position = at + vec3{0, 0, 2 * h * (k + 0.5) / n}});
        }
        pairs.push_back({.id = pairs.size(), .position = vec3{-50 * h, 0, 0}});
        auto f = placed<TestType>(pairs, {.spacing = 2, .smoothing = smoothing, .sound_speed = 1e-3});
        f.step(open_space{}, inline_executor{});
        double const alone = f.density(pairs.size() - 1);
        double sum = 0;
        for (int k = 0; k < n; ++k) {
            double const r = 2 * h * (k + 0.5) / n;
            sum += (f.density(2 * static_cast<std::size_t>(k)) - alone) * 2 * tau * r * r * (2 * h / n);
        }
        CHECK(sum == Approx(8).epsilon(1e-3));  // the volume of a particle
    }
}

TEMPLATE_TEST_CASE("inside a lattice the density is that at rest, within a hundredth", "", float, double) {
    for (double const smoothing : {0.95, 1.0, 1.2, 1.5}) {
        auto f = placed<TestType>(cloud(11, 0.01, 0), {.spacing = 0.01, .smoothing = smoothing});
        f.step(open_space{}, inline_executor{});
        CHECK(f.density(5 + 11 * (5 + 11 * 5)) == Approx(1).epsilon(0.01));
    }
}

TEMPLATE_TEST_CASE("without gravity and walls momentum stays", "", float, double) {
    auto f = placed<TestType>(cloud(8, 1, 0.4, 3), {.spacing = 1, .sound_speed = 20, .viscosity = 0.05, .gravity = vec3{0, 0, 0}});
    auto const momentum = [&] {
        vec3 sum{0, 0, 0};
        for (std::size_t i = 0; i < f.particle_count(); ++i) sum += f.velocity(i);
        return sum;
    };
    auto const motion = [&] {
        double sum = 0;
        for (std::size_t i = 0; i < f.particle_count(); ++i) sum += length(f.velocity(i));
        return sum;
    };
    vec3 const before = momentum();
    double changed = 0;
    double const first = motion();
    for (int k = 0; k < 40; ++k) {
        f.step(open_space{}, inline_executor{});
        changed = std::max(changed, std::fabs(motion() - first));
    }
    CHECK(changed > 0.02 * first);  // forces did act
    CHECK(length(momentum() - before) < (sizeof(TestType) == 8 ? 1e-12 : 1e-5) * motion());
}

TEMPLATE_TEST_CASE("two particles push each other apart by equal and opposite forces", "", float, double) {
    auto f = placed<TestType>({{.id = 3, .position = vec3{0, 0, 0}}, {.id = 9, .position = vec3{0.3, 0.1, -0.2}}},
                              {.spacing = 1, .smoothing = 0.9, .sound_speed = 5, .gravity = vec3{0, 0, 0}});
    for (int k = 0; k < 5; ++k) f.step(open_space{}, inline_executor{});
    CHECK(f.id(0) == 3);
    CHECK(f.id(1) == 9);
    CHECK(f.velocity(0) == -f.velocity(1));
    // A pair is lighter than water: nothing pulls, and at rest nothing moves.
    CHECK(f.velocity(0) == vec3{0, 0, 0});
    auto crowd = placed<TestType>(cloud(3, 0.5, 0), {.spacing = 1, .sound_speed = 5, .gravity = vec3{0, 0, 0}});
    crowd.step(open_space{}, inline_executor{});
    CHECK(crowd.velocity(0)[0] < 0);
    CHECK(crowd.velocity(26)[0] > 0);
}

TEMPLATE_TEST_CASE("neighbours by the grid are those of brute force, and symmetric", "", float, double) {
    for (int scene = 0; scene < 4; ++scene) {
        std::vector<TestType> x;
        std::vector<TestType> y;
        std::vector<TestType> z;
        stream random(8, 0, static_cast<std::uint64_t>(scene));
        double const size = scene == 3 ? 1e5 : 9;  // the last: cells grow
        for (int k = 0; k < 700; ++k) {
            double const a = random.uniform(-size, size);
            double const b = random.uniform(-size, size);
            double const c = random.uniform(-size, size);
            bool const whole = scene == 1 || scene == 3;  // on the edges of cells, and in a plane
            x.push_back(static_cast<TestType>(whole ? std::floor(a) : a));
            y.push_back(static_cast<TestType>(whole ? 2 * std::floor(b / 2) : b));
            z.push_back(static_cast<TestType>(scene == 2 ? 0 : whole ? 2 * std::floor(c / 2) : c));
        }
        tafoni::detail::particle_grid<TestType> grid;
        grid.build(std::span<TestType const>(x), std::span<TestType const>(y), std::span<TestType const>(z), inline_executor{});
        auto const close = [&](std::size_t i, std::size_t j) {
            TestType const dx = x[i] - x[j];
            TestType const dy = y[i] - y[j];
            TestType const dz = z[i] - z[j];
            return dx * dx + dy * dy + dz * dz < 4;
        };
        std::vector<std::vector<std::size_t>> found(x.size());
        for (std::size_t i = 0; i < x.size(); ++i) {
            tafoni::detail::sph_spans spans;
            grid.around(x[i], y[i], z[i], spans);
            for (std::uint32_t r = 0; r < spans.count; ++r) {
                for (std::uint32_t k = spans.row[r].begin; k < spans.row[r].end; ++k) {
                    if (close(i, grid.order()[k])) found[i].push_back(grid.order()[k]);
                }
            }
            std::sort(found[i].begin(), found[i].end());
        }
        std::size_t pairs = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            std::vector<std::size_t> expected;
            for (std::size_t j = 0; j < x.size(); ++j) {
                if (close(i, j)) expected.push_back(j);
            }
            REQUIRE(found[i] == expected);
            pairs += expected.size() - 1;
            for (std::size_t const j : found[i]) REQUIRE(std::binary_search(found[j].begin(), found[j].end(), i));
        }
        CHECK((scene == 3 || pairs > 500));
    }
}

TEMPLATE_TEST_CASE("the order in which particles are given changes nothing", "", float, double) {
    auto all = cloud(9, 1, 0.45, 2);
    sph_options const o{.spacing = 1, .sound_speed = 30};
    auto a = placed<TestType>(all, o);
    stream random(1, 0, 0);
    for (std::size_t k = all.size(); k > 1; --k) std::swap(all[k - 1], all[random.index_below(k)]);
    auto b = placed<TestType>(all, o);
    for (int k = 0; k < 15; ++k) {
        a.step(open_space{}, inline_executor{});
        b.step(open_space{}, inline_executor{});
    }
    CHECK(state(a) == state(b));
    for (std::size_t i = 1; i < a.particle_count(); ++i) REQUIRE(a.id(i - 1) < a.id(i));
}

TEMPLATE_TEST_CASE("the sums are the same bits with and without AVX2", "", float, double) {
    auto const n = std::size_t{500};
    std::size_t const pad = tafoni::detail::sph_lane_count<TestType>;
    std::array<std::vector<TestType>, 8> in;
    stream random(4, 0, 0);
    for (auto& a : in) {
        for (std::size_t k = 0; k < n + pad; ++k) a.push_back(static_cast<TestType>(k < n ? random.uniform(0, 5) : 0.0));
    }
    tafoni::detail::particle_grid<TestType> grid;
    auto const part = [&](std::size_t d) { return std::span<TestType const>(in[d]).first(n); };
    grid.build(part(0), part(1), part(2), inline_executor{});
    std::array<std::vector<TestType>, 8> sorted = in;
    std::vector<tafoni::detail::sph_spans> spans(n);
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t d = 0; d < 8; ++d) sorted[d][k] = in[d][grid.order()[k]];
        grid.around(sorted[0][k], sorted[1][k], sorted[2][k], spans[k]);
    }
    std::array<std::vector<std::vector<TestType>>, 2> out;
    for (bool const avx2 : {false, true}) {
        auto& o = out[avx2 ? 1 : 0];
        o.assign(5, std::vector<TestType>(n + pad, TestType(0)));
        o[4] = sorted[7];
        tafoni::detail::sph_arrays<TestType> const a{
            .x = sorted[0].data(), .y = sorted[1].data(), .z = sorted[2].data(), .u = sorted[3].data(), .v = sorted[4].data(),
            .w = sorted[5].data(), .density = o[0].data(), .pressure = o[4].data(), .spans = spans.data(), .ax = o[1].data(),
            .ay = o[2].data(), .az = o[3].data()};
        bool const wide = avx2 && tafoni::detail::sph_has_avx2();
        tafoni::detail::sph_densities(a, 0, n, TestType(0.3), wide);
        tafoni::detail::sph_forces(a, 0, n, TestType(0.3), TestType(0.7), wide);
        // And those of a plain loop, but for rounding.
        for (std::size_t i = 0; i < n; i += 7) {
            double rho = 0;
            vec3 force{0, 0, 0};
            for (std::size_t j = 0; j < n; ++j) {
                auto const difference = [&](std::size_t d) { return static_cast<double>(sorted[d][i]) - static_cast<double>(sorted[d][j]); };
                vec3 const d{difference(0), difference(1), difference(2)};
                vec3 const v{difference(3), difference(4), difference(5)};
                double const q = length(d);
                if (q >= 2) continue;
                rho += q < 1 ? 1 - 1.5 * q * q + 0.75 * q * q * q : 0.25 * (2 - q) * (2 - q) * (2 - q);
                if (i == j) continue;
                double const slope = q < 1 ? -3 * q + 2.25 * q * q : -0.75 * (2 - q) * (2 - q);
                double const both = static_cast<double>(o[0][i]) + static_cast<double>(o[0][j]);
                double const p = static_cast<double>(o[4][i]) + static_cast<double>(o[4][j]) - 0.7 * dot(d, v) / (both * (q * q + 0.01));
                force += -0.3 * p * slope / q * d;
            }
            double const precise = sizeof(TestType) == 8 ? 1e-12 : 1e-4;
            CHECK(static_cast<double>(o[0][i]) == Approx(0.3 * rho).epsilon(precise));
            for (std::size_t d = 0; d < 3; ++d) {
                CHECK(static_cast<double>(o[1 + d][i]) == Approx(force[static_cast<int>(d)]).margin(precise * 100));
            }
        }
    }
    CHECK(out[0] == out[1]);
}

TEMPLATE_TEST_CASE("a pool in a tub settles and stays", "", float, double) {
    double const s = 0.1;
    triangle_surface const walls_of = tub(0.6, 3);
    sph_options const o{.particles = 216, .spacing = s, .sound_speed = 20, .damping = 0.3};
    sph<TestType> f({.box = between(vec3{0.05, 0.05, 0.05}, vec3{0.55, 0.55, 0.55})}, everywhere(), o);
    mesh_boundary const walls(walls_of.positions, walls_of.triangles, f.reach());
    double t = 0;
    while (t < 2) t += f.step(walls, inline_executor{});
    REQUIRE(f.particle_count() == 216);
    auto const middle = [&] {
        vec3 sum{0, 0, 0};
        for (std::size_t i = 0; i < f.particle_count(); ++i) sum += f.position(i);
        return vec3{sum / static_cast<double>(f.particle_count())};
    };
    vec3 const before = middle();
    while (t < 2.5) t += f.step(walls, inline_executor{});
    vec3 const after = middle();
    double fastest = 0;
    box3 wet;
    for (std::size_t i = 0; i < f.particle_count(); ++i) {
        fastest = std::max(fastest, length(f.velocity(i)));
        wet.include(f.position(i));
    }
    CHECK(length(after - before) < 0.02 * s);
    CHECK(fastest < 0.01 * f.sound_speed());
    CHECK(wet.lo.minCoeff() > -0.5 * s);
    CHECK(wet.hi[0] < 0.6 + 0.5 * s);
    CHECK(wet.hi[1] < 0.6 + 0.5 * s);
    CHECK(wet.hi[2] < 0.9);
    CHECK(wet.hi[2] > 0.35);
}

TEMPLATE_TEST_CASE("a particle alone falls as the parabola says, to the centre where that is asked", "", float, double) {
    auto f = placed<TestType>({{.id = 0, .position = vec3{0, 0, 100}, .velocity = vec3{3, 0, 0}}},
                              {.spacing = 0.1, .gravity = vec3{0, 0, -10}, .largest_step = 0.001});
    double t = 0;
    while (t < 2) t += f.step(open_space{}, inline_executor{});
    CHECK(f.velocity(0)[2] == Approx(-10 * t).epsilon(1e-3));
    CHECK(f.position(0)[2] == Approx(100 - 5 * t * t).epsilon(1e-3));
    CHECK(f.position(0)[0] == Approx(3 * t).epsilon(1e-3));
    auto g = placed<TestType>({{.id = 0, .position = vec3{3, 4, 0}}}, {.spacing = 0.1, .gravity = vec3{0, 0, 0}, .centre = vec3{0, 0, 0}, .toward = 5});
    double const dt = g.step(open_space{}, inline_executor{});
    CHECK(g.velocity(0)[0] == Approx(-3 * dt));
    CHECK(g.velocity(0)[1] == Approx(-4 * dt));
}

TEMPLATE_TEST_CASE("a wall pushes by the stiffness times the penetration less the damping", "", float, double) {
    triangle_surface const ground{.positions = {vec3{-9, -9, 0}, vec3{9, -9, 0}, vec3{0, 9, 0}}, .triangles = {{0, 1, 2}}};
    auto f = placed<TestType>({{.id = 0, .position = vec3{0, 0, 0.3}, .velocity = vec3{1, 0, -2}}},
                              {.spacing = 1, .sound_speed = 10, .reach = 0.8, .wall_stiffness = 60, .wall_damping = 7, .gravity = vec3{0, 0, -4}});
    mesh_boundary const walls(ground.positions, ground.triangles, f.reach());
    double const dt = f.step(walls, inline_executor{});
    CHECK(f.velocity(0)[2] == Approx(-2 + dt * (60 * 0.5 + 7 * 2 - 4)).epsilon(1e-6));
    CHECK(f.velocity(0)[0] == Approx(1));
    CHECK(f.position(0)[2] == Approx(0.3 + dt * f.velocity(0)[2]).epsilon(1e-6));
}

TEMPLATE_TEST_CASE("viscosity slows a shear flow by nu times its second derivative", "", float, double) {
    auto all = cloud(13, 1, 0);
    for (fluid_particle& p : all) p.velocity = vec3{0.5 * (p.position[1] - 6) * (p.position[1] - 6), 0, 0};
    for (double const nu : {0.5, 2.0}) {
        auto f = placed<TestType>(all, {.spacing = 1, .smoothing = 1.3, .sound_speed = 500, .viscosity = nu, .damping = 0, .gravity = vec3{0, 0, 0}});
        double const dt = f.step(open_space{}, inline_executor{});
        CHECK(f.velocity(6 + 13 * (6 + 13 * 6))[0] == Approx(nu * dt).epsilon(0.15));  // of a lattice's sum
    }
}

TEST_CASE("speed of sound and walls follow from gravity and emitters where they are not given") {
    triangle_surface const ground{.positions = {vec3{-9, -9, 0}, vec3{9, -9, 0}, vec3{0, 9, 0}}, .triangles = {{0, 1, 2}}};
    auto f = placed<double>({{.id = 0, .position = vec3{0, 0, 0.3}, .velocity = vec3{0, 0, -2}}}, {.spacing = 0.5});
    double const c = 10 * std::sqrt(2 * 9.81 * 16 * 0.5);
    CHECK(f.sound_speed() == Approx(c));
    CHECK(f.reach() == 0.5);
    mesh_boundary const walls(ground.positions, ground.triangles, f.reach());
    double const dt = f.step(walls, inline_executor{});
    double const pace = c / (5 * 0.5);
    CHECK(f.velocity(0)[2] == Approx(-2 + dt * (pace * pace * 0.2 + pace * 2 - 9.81)));
    box_emitter const fast{.box = between(vec3{0, 0, 0}, vec3{1, 1, 1}), .velocity = vec3{0, 30, -40}};
    CHECK(sph<double>(fast, everywhere(), {.spacing = 0.5}).sound_speed() == Approx(500));
    CHECK(sph<double>(fast, everywhere(), {.spacing = 1, .gravity = vec3{0, 0, 0}, .toward = -1250}).sound_speed() == Approx(2000));
}

TEMPLATE_TEST_CASE("gravity acts on all of many particles, and what stays when others go keeps what it is", "", float, double) {
    std::vector<fluid_particle> apart;
    for (std::uint64_t k = 0; k < 2100; ++k) apart.push_back({.id = k, .position = vec3{5.0 * static_cast<double>(k % 50), 5.0 * static_cast<double>(k / 50), 0}});
    auto many = placed<TestType>(apart, {.spacing = 1});
    double const dt = many.step(open_space{}, inline_executor{});
    for (std::size_t i = 0; i < 2100; ++i) REQUIRE(many.velocity(i)[2] == Approx(-9.81 * dt));

    // A pair behind one that leaves.
    sph<TestType> left(std::vector<box_emitter>{}, {.keep = between(vec3{-1, -1, -1}, vec3{9, 1, 1})}, {.particles = 3, .spacing = 1, .sound_speed = 10, .gravity = vec3{0, 0, 0}});
    left.place(std::vector<fluid_particle>{{.id = 0, .position = vec3{-1, 0, 0}, .velocity = vec3{-9, 0, 0}},
                                           {.id = 1, .position = vec3{5, 0, 0}, .velocity = vec3{0, 1, 0}},
                                           {.id = 2, .position = vec3{5.5, 0, 0}, .velocity = vec3{0, 1, 0}}});
    left.step(open_space{}, inline_executor{});
    REQUIRE(left.particle_count() == 2);
    CHECK(left.id(0) == 1);
    CHECK(left.position(0)[0] == Approx(5));
    CHECK(left.velocity(0)[1] == Approx(1));
    CHECK(left.density(0) > 1.1 * many.density(0));

    sph<TestType> sent({.box = between(vec3{0, 0, 0}, vec3{1, 1, 0}), .velocity = vec3{4, 5, 6}}, everywhere(), {.spacing = 1, .gravity = vec3{0, 0, 0}});
    sent.step(open_space{}, inline_executor{});
    REQUIRE(sent.particle_count() == 4);
    for (std::size_t i = 0; i < 4; ++i) CHECK(length(sent.velocity(i) - vec3{4, 5, 6}) < 1e-5);
}

TEMPLATE_TEST_CASE("the step keeps to its limits", "", float, double) {
    sph_options const o{.spacing = 0.5, .sound_speed = 40, .damping = 0, .gravity = vec3{0, 0, 0}, .courant = 0.25};
    auto at_rest = placed<TestType>({{.id = 0}}, o);
    CHECK(at_rest.step(open_space{}, inline_executor{}) == Approx(0.25 * 0.5 / 40));
    auto fast = placed<TestType>({{.id = 0, .velocity = vec3{0, 960, 0}}}, o);
    CHECK(fast.step(open_space{}, inline_executor{}) == Approx(0.25 * 0.5 / 1000));
    auto thick = o;
    thick.viscosity = 100;
    CHECK(placed<TestType>({{.id = 0}}, thick).step(open_space{}, inline_executor{}) == Approx(0.25 * 0.25 / 1200));
    auto pulled = o;
    pulled.gravity = vec3{0, -8e5, 0};
    CHECK(placed<TestType>({{.id = 0}}, pulled).step(open_space{}, inline_executor{}) == Approx(0.25 * 0.5 * std::sqrt(0.5 / 8e5)));
    auto stiff = o;
    stiff.wall_stiffness = 1e8;
    CHECK(placed<TestType>({{.id = 0}}, stiff).step(open_space{}, inline_executor{}) == Approx(0.25 / 1e4));
    auto tough = o;
    tough.wall_damping = 1e5;
    CHECK(placed<TestType>({{.id = 0}}, tough).step(open_space{}, inline_executor{}) == Approx(0.25 / 1e5));
    auto short_step = o;
    short_step.largest_step = 1e-6;
    CHECK(placed<TestType>({{.id = 0}}, short_step).step(open_space{}, inline_executor{}) == 1e-6);
}

TEMPLATE_TEST_CASE("a frame takes as many stable steps as it needs, and no longer than it is", "", float, double) {
    std::vector<fluid_particle> const one{{.id = 0, .position = vec3{0, 0, 100}, .velocity = vec3{3, 0, 0}}};
    sph_options o{.spacing = 0.1, .gravity = vec3{0, 0, -10}, .frame = 0.25};
    auto f = placed<TestType>(one, o);
    for (int k = 0; k < 4; ++k) REQUIRE(f.step(open_space{}, inline_executor{}) == 0.25);
    CHECK(f.velocity(0)[2] == Approx(-10).epsilon(1e-5));
    CHECK(f.position(0)[2] == Approx(95).epsilon(1e-3));
    CHECK(f.position(0)[0] == Approx(3).epsilon(1e-5));

    // A frame that one step fills is that step; a longer one goes through the states of its steps.
    auto crowd = cloud(5, 1, 0.3, 2);
    o = {.spacing = 1, .sound_speed = 30, .frame = 1e-3};
    auto framed = placed<TestType>(crowd, o);
    o.frame = 0;
    o.largest_step = 1e-3;
    auto stepped = placed<TestType>(crowd, o);
    for (int k = 0; k < 6; ++k) REQUIRE(framed.step(open_space{}, inline_executor{}) == stepped.step(open_space{}, inline_executor{}));
    CHECK(state(framed) == state(stepped));
    o.largest_step = 1e-2;
    auto single = placed<TestType>(crowd, o);
    double const dt = single.step(open_space{}, inline_executor{});
    o.frame = 2 * dt * (1 - 1e-9);  // halves of it are stable
    auto two = placed<TestType>(crowd, o);
    two.step(open_space{}, inline_executor{});
    o.frame = 0;
    o.largest_step = dt * (1 - 1e-9);
    auto halves = placed<TestType>(crowd, o);
    for (int k = 0; k < 2; ++k) halves.step(open_space{}, inline_executor{});
    for (std::size_t i = 0; i < crowd.size(); ++i) CHECK(length(two.position(i) - halves.position(i)) < 1e-3);

    o.frame = 1e9;
    auto endless = placed<TestType>(crowd, o);
    auto const before = state(endless);
    CHECK_THROWS_WITH(endless.step(open_space{}, inline_executor{}), Catch::Contains("10^6 steps"));
    CHECK(state(endless) == before);
}

TEST_CASE("a frame that walls cut short is gone on with") {
    auto const crowd = cloud(4, 1, 0.3, 2);
    sph_options const o{.spacing = 1, .sound_speed = 30, .frame = 0.3};
    auto whole = placed<double>(crowd, o);
    auto cut = placed<double>(crowd, o);
    whole.step(open_space{}, inline_executor{});
    int left = 64 * 7 + 5;
    CHECK_THROWS_AS(cut.step(falling_wall{&left}, inline_executor{}), std::runtime_error);
    tafoni::detail::byte_writer out;
    cut.save(out);
    tafoni::detail::byte_reader in(out.bytes(), "here");
    auto other = placed<double>({}, o);
    other.load(in);
    for (auto* f : {&cut, &other}) {
        CHECK(f->step(open_space{}, inline_executor{}) == 0.3);
        CHECK(state(*f) == state(whole));
    }
}

TEMPLATE_TEST_CASE("emitters keep to the spacing and the number, and sinks make room", "", float, double) {
    sph_options const o{.particles = 60, .spacing = 1};
    sph<TestType> f({.box = between(vec3{0, 0, 10}, vec3{3, 3, 11}), .velocity = vec3{0, 0, -5}},
                    {.keep = between(vec3{-5, -5, 0}, vec3{8, 8, 20})}, o);
    CHECK(f.particle_count() == 0);
    double closest = 1e9;
    std::uint64_t last = 0;
    for (int k = 0; k < 1500; ++k) {
        f.step(open_space{}, inline_executor{});
        REQUIRE(f.particle_count() <= 60);
        if (k == 0) CHECK(f.particle_count() == 32);
        for (std::size_t i = 0; i < f.particle_count(); ++i) {
            REQUIRE(f.position(i)[2] >= 0);
            if (i > 0) REQUIRE(f.id(i - 1) < f.id(i));
            for (std::size_t j = 0; j < i; ++j) closest = std::min(closest, length(f.position(i) - f.position(j)));
            last = std::max(last, f.id(i));
        }
    }
    CHECK(closest > 0.8);
    CHECK(last > 150);
}

TEST_CASE("an emitter with more places than particles fills its box evenly, at first and as others leave") {
    sph<float> f({.box = between(vec3{0, 0, 0}, vec3{20, 20, 4})}, {.keep = between(vec3{-1, -1, -1}, vec3{21, 21, 5})},
                 {.particles = 400, .spacing = 0.5, .gravity = vec3{0, 0, -4}});
    std::vector<int> born(32, 0);  // in boxes of 5 x 5 x 2
    std::uint64_t seen = 0;
    for (int k = 0; k < 600; ++k) {
        f.step(open_space{}, inline_executor{});
        for (std::size_t i = 0; i < f.particle_count(); ++i) {
            if (f.id(i) < seen) continue;
            vec3 const p = f.position(i);
            auto const part = [](double x, double wide, int n) { return std::clamp(static_cast<int>(x / wide), 0, n - 1); };
            ++born[static_cast<std::size_t>(part(p[0], 5, 4) + 4 * part(p[1], 5, 4) + 16 * part(p[2], 2, 2))];
            seen = std::max(seen, f.id(i) + 1);
        }
        if (k == 0) {
            REQUIRE(f.particle_count() == 400);
            for (int const n : born) CHECK(std::abs(n - 400 / 32) <= 6);
        }
    }
    CHECK(seen > 600);  // others did leave
    double const mean = static_cast<double>(seen) / 32;
    for (int const n : born) CHECK(std::fabs(n - mean) < 0.5 * mean);
}

TEST_CASE("threads change no bit of a fluid", "[threads]") {
    triangle_surface const walls_of = tub(14, 60);
    auto const poured = [&](auto const& threads) {
        sph<float> f({.box = between(vec3{1, 1, 1}, vec3{9, 13, 30})}, everywhere(), {.particles = 3500, .spacing = 1});
        mesh_boundary const walls(walls_of.positions, walls_of.triangles, f.reach());
        for (int k = 0; k < 12; ++k) f.step(walls, threads);
        return state(f);
    };
    auto const one = poured(inline_executor{});
    for (std::size_t n : {2U, 3U, 7U}) CHECK(one == poured(thread_pool(n)));
}

TEMPLATE_TEST_CASE("a saved fluid goes on to the bit, and takes no other's bytes", "", float, double) {
    using bytes = std::vector<std::byte>;
    box_emitter const from{.box = between(vec3{1, 1, 6}, vec3{3, 4, 8}), .velocity = vec3{1, 0, -5}};
    box_sink const keep{.keep = between(vec3{0, 0, -2}, vec3{8, 3.6, 12})};
    sph_options const o{.particles = 40, .spacing = 1};
    triangle_surface const walls_of = tub(6, 3);
    auto const saved = [](sph<TestType> const& f) {
        tafoni::detail::byte_writer out;
        f.save(out);
        return out.bytes();
    };
    auto const load = [](sph<TestType>& f, bytes const& b) {
        tafoni::detail::byte_reader in(b, "here");
        f.load(in);
        CHECK(in.left() == 0);
    };
    sph<TestType> f(from, keep, o);
    mesh_boundary const walls(walls_of.positions, walls_of.triangles, f.reach());
    for (int k = 0; k < 500; ++k) f.step(walls, inline_executor{});
    bytes const then = saved(f);
    sph<TestType> g(from, keep, o);
    load(g, then);
    CHECK(saved(g) == then);
    for (int k = 0; k < 50; ++k) REQUIRE(f.step(walls, inline_executor{}) == g.step(walls, inline_executor{}));
    CHECK(state(f) == state(g));
    CHECK(saved(f) == saved(g));
    CHECK(f.id(f.particle_count() - 1) > 40);  // emitters did run and sinks did take

    auto const refused = [&](sph<TestType> other) {
        bytes const before = saved(other);
        CHECK_THROWS_AS(load(other, then), invalid_input);
        CHECK(saved(other) == before);
    };
    auto more = o;
    more.particles = 41;
    auto thick = o;
    thick.viscosity = 2e-6;
    auto pulled = o;
    pulled.toward = 1;
    for (sph_options const& other : {more, thick, pulled}) refused({from, keep, other});
    refused({from, everywhere(), o});
    refused({{.box = from.box, .velocity = vec3{1, 0, -4}}, keep, o});
    refused({std::vector<box_emitter>{from, from}, keep, o});
    refused({std::vector<box_emitter>{}, keep, o});
    for (std::size_t k = 0; k < then.size(); k += 5) {
        bytes damaged = then;
        damaged[k] ^= std::byte{4};
        REQUIRE_THROWS_AS(load(g, damaged), io_error);
    }
    for (std::size_t k = 0; k < then.size(); k += 31) REQUIRE_THROWS_AS(load(g, bytes(then.begin(), then.begin() + static_cast<long>(k))), io_error);
    using other_scalar = std::conditional_t<sizeof(TestType) == 4, double, float>;
    sph<other_scalar> wide(from, keep, o);
    tafoni::detail::byte_reader in(then, "here");
    CHECK_THROWS_WITH(wide.load(in), Catch::Contains("another kind"));
    CHECK(saved(f) == saved(g));

    auto placed_one = placed<TestType>(cloud(4, 1, 0.3, 1), {.particles = 64, .spacing = 1});
    sph<TestType> again(std::vector<box_emitter>{}, everywhere(), {.particles = 64, .spacing = 1});
    load(again, saved(placed_one));
    for (int k = 0; k < 5; ++k) {
        placed_one.step(open_space{}, inline_executor{});
        again.step(open_space{}, inline_executor{});
    }
    CHECK(state(placed_one) == state(again));
}

TEMPLATE_TEST_CASE("no particles, one point for all, and far too many near each other", "", float, double) {
    sph<TestType> none(std::vector<box_emitter>{}, everywhere(), {.particles = 0});
    CHECK(none.step(open_space{}, inline_executor{}) == none.options().largest_step);
    CHECK(none.particle_count() == 0);

    std::vector<fluid_particle> all;
    for (std::uint64_t k = 0; k < 1000; ++k) all.push_back({.id = k, .position = vec3{2, 3, 4}});
    auto f = placed<TestType>(all, {});
    for (int k = 0; k < 5; ++k) f.step(open_space{}, inline_executor{});
    for (std::size_t i = 0; i < f.particle_count(); ++i) {
        REQUIRE(is_finite(f.position(i)));
        REQUIRE(f.velocity(i) == f.velocity(0));
    }
    for (std::uint64_t k = 1000; k < 1025; ++k) all.push_back({.id = k, .position = vec3{2, 3, 4}});
    f.place(all);
    auto const before = state(f);
    CHECK_THROWS_WITH(f.step(open_space{}, inline_executor{}), Catch::Contains("within one cell"));
    CHECK(state(f) == before);
}

TEST_CASE("what a fluid is told is checked by name") {
    double const nan = std::numeric_limits<double>::quiet_NaN();
    double const inf = std::numeric_limits<double>::infinity();
    auto const refused = [&](sph_options const& o, char const* what) {
        CHECK_THROWS_WITH(sph<float>(std::vector<box_emitter>{}, everywhere(), o), Catch::Contains(what));
    };
    refused({.particles = (1u << 24) + 1}, "particles");
    for (double const bad : {0.0, -1.0, nan, inf}) refused({.spacing = bad}, "spacing");
    for (double const bad : {0.0, -1.0, 2.0, nan}) refused({.smoothing = bad}, "smoothing");
    for (double const bad : {-1.0, nan, inf}) {
        refused({.sound_speed = bad}, "sound_speed");
        refused({.viscosity = bad}, "viscosity");
        refused({.damping = bad}, "damping");
        refused({.reach = bad}, "reach");
        refused({.wall_stiffness = bad}, "wall_stiffness");
        refused({.wall_damping = bad}, "wall_damping");
    }
    for (double const bad : {nan, inf, -inf}) {
        refused({.gravity = vec3{0, bad, 0}}, "gravity");
        refused({.centre = vec3{bad, 0, 0}}, "centre");
        refused({.toward = bad}, "toward");
    }
    for (double const bad : {0.0, -1.0, 1.1, nan}) refused({.courant = bad}, "courant");
    for (double const bad : {0.0, -1.0, nan, inf}) refused({.largest_step = bad}, "largest_step");
    for (double const bad : {-1.0, nan, inf}) refused({.frame = bad}, "frame");
    refused({.gravity = vec3{0, 0, 0}}, "sound_speed");  // nothing that it could follow from
    auto const box = between(vec3{0, 0, 0}, vec3{1e4, 1e4, 1});
    CHECK_THROWS_WITH(sph<float>({.box = box}, everywhere()), Catch::Contains("places"));
    CHECK_THROWS_AS(sph<float>({.box = between(vec3{1, 0, 0}, vec3{0, 1, 1})}, everywhere()), invalid_input);
    sph<float> f(std::vector<box_emitter>{}, everywhere(), {.particles = 2});
    CHECK_THROWS_WITH(f.place(std::vector<fluid_particle>(3)), Catch::Contains("more particles"));
    CHECK_THROWS_WITH(f.place(std::vector<fluid_particle>(2)), Catch::Contains("twice"));
    f.place(std::vector<fluid_particle>{{.id = 3, .position = vec3{7, 7, 7}}});
    auto const before = state(f);
    for (double const bad : {nan, inf, -inf, 1e300}) {
        CHECK_THROWS_WITH(f.place(std::vector<fluid_particle>{{}, {.id = 1, .position = vec3{0, bad, 0}}}), Catch::Contains("particle 1 is not finite"));
        CHECK_THROWS_WITH(f.place(std::vector<fluid_particle>{{.id = 9, .velocity = vec3{0, 0, bad}}}), Catch::Contains("particle 0 is not finite"));
    }
    CHECK_THROWS_WITH(f.place(std::vector<fluid_particle>{{.id = ~std::uint64_t{0}}}), Catch::Contains("2^63"));
    CHECK(state(f) == before);
    box_emitter const here{.box = between(vec3{0, 0, 0}, vec3{0, 0, 0})};
    box_emitter const there{.box = between(vec3{1e60, 0, 0}, vec3{1e60, 0, 0})};
    CHECK_THROWS_WITH(sph<float>(std::vector<box_emitter>{here, there}, everywhere()), Catch::Contains("too far"));
}
