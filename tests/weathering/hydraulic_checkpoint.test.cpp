#include "reliability/failing_new.hpp"
#include "support/water_scenes.hpp"

#include <tafoni/fluid/rain_particles.hpp>
#include <tafoni/fluid/sph.hpp>
#include <tafoni/testing/fluid_archetypes.hpp>
#include <tafoni/weathering/hydraulic_run.hpp>

#include <catch2/catch.hpp>

using namespace tafoni;
using namespace tafoni_test;

namespace {

/// Short of life, so that loads are lost and drops are replaced.
rain_particles rain(std::uint32_t particles = 150, std::uint64_t seed = 3) {
    return rain_particles({.box = between(vec3{1.5, 1.5, -0.3}, vec3{3, 8.5, 0.2})}, {.keep = between(vec3{1, 1, -6}, vec3{9, 9, 5})},
                          {.particles = particles, .radius = 0.4, .lifetime = 1.1, .seed = seed});
}
sph<float> water() {
    return sph<float>({.box = between(vec3{2, 2, 0}, vec3{4, 8, 1}), .velocity = vec3{2, 0, -4}},
                      {.keep = between(vec3{0, 0, -7}, vec3{10, 10, 9})}, {.particles = 200, .spacing = 0.5, .sound_speed = 40});
}
partheniades_erosion const shear{.coefficient = 2e-3, .critical = 3};
hydraulic_options const refining{.refine_length = 0.9, .refine_every = 6};

errc code_of(auto const& action) {
    try {
        action();
    } catch (io_error const& e) {
        return e.code();
    } catch (invalid_input const& e) {
        return e.code();
    }
    return errc{};
}

/// Two particles that slide on, saved as a user would.
struct sliding {
    std::uint64_t steps = 0;
    std::size_t particle_count() const { return 2; }
    vec3 position(std::size_t i) const { return vec3{2 + 0.02 * static_cast<double>(steps), 4 + 2.0 * static_cast<double>(i), 0.1}; }
    vec3 velocity(std::size_t) const { return vec3{1, 0, 0}; }
    double reach() const { return 0.3; }
    double step(fluid_boundary auto const&, executor auto const&) { return ++steps, 0.1; }
    void save(auto& out) const { out.put(steps); }
    void load(auto& in) { steps = in.get(); }
};
static_assert(saved_fluid<sliding> && saved_fluid<rain_particles> && saved_fluid<sph<float>> && saved_fluid<sph<double>>);
static_assert(!saved_fluid<archetypes::fluid>);
template <class Run>
concept is_saved = requires(Run const& run) { run.checkpoint(); };
static_assert(is_saved<hydraulic_run<partheniades_erosion, sliding>>);
static_assert(!is_saved<hydraulic_run<partheniades_erosion, archetypes::fluid>>);

template <class Run>
bool same_state(Run const& a, Run const& b) {
    return a.surface() == b.surface() && std::equal(a.wear().begin(), a.wear().end(), b.wear().begin(), b.wear().end()) &&
           std::equal(a.flow().begin(), a.flow().end(), b.flow().begin(), b.flow().end()) && a.sediment() == b.sediment() &&
           a.report().iterations == b.report().iterations && a.report().time == b.report().time && a.report().contacts == b.report().contacts &&
           a.report().particles == b.report().particles && a.report().ledger.eroded == b.report().ledger.eroded &&
           a.report().ledger.deposited == b.report().ledger.deposited && a.report().ledger.carried == b.report().ledger.carried &&
           a.report().ledger.left == b.report().ledger.left;
}

}  // namespace

TEST_CASE("a hydraulic run that is saved and resumed ends with the same bytes as one without a break") {
    auto const equal = [](auto const& fluid, auto const& process, std::uint64_t first, std::uint64_t all, double drop = 5) {
        triangle_surface const s = slope(14, drop);
        hydraulic_run straight(s, fluid, process, refining);
        straight.run(all);
        REQUIRE(straight.report().ledger.eroded > 0);
        hydraulic_run half(s, fluid, process, refining);
        half.run(first);
        auto const bytes = half.checkpoint();
        hydraulic_run rest(s, fluid, process, refining);
        rest.run(3);  // what it did before does not matter
        rest.resume(bytes);
        CHECK(rest.checkpoint() == bytes);
        CHECK(same_state(rest, half));
        rest.run(all - first);
        CHECK(rest.checkpoint() == straight.checkpoint());
        CHECK(same_state(rest, straight));
        CHECK(rest.balanced());
    };
    for (std::uint64_t const first : {0u, 1u, 29u}) equal(rain(), shear, first, 60);
    equal(rain(), curvature_erosion<>{}, 17, 40);
    equal(water(), shear, 31, 60);
    equal(water(), curvature_erosion<>{}, 31, 50);
    equal(sliding{}, partheniades_erosion{.coefficient = 1e-3, .critical = 0.1}, 5, 20, 0.01);
}

TEST_CASE("a hydraulic checkpoint of another run is refused, and nothing is changed") {
    triangle_surface const s = slope(10, 5);
    hydraulic_run run(s, rain(), shear, refining);
    run.run(9);
    auto const bytes = run.checkpoint();
    auto const refused = [&](auto other) {
        other.run(2);
        auto const before = other.checkpoint();
        errc const code = code_of([&] { other.resume(bytes); });
        CHECK(other.checkpoint() == before);
        return code;
    };
    CHECK(refused(hydraulic_run(slope(10, 5.01), rain(), shear, refining)) == errc::checkpoint_mismatch);
    CHECK(refused(hydraulic_run(s, rain(), shear, {.refine_length = 0.8, .refine_every = 6})) == errc::checkpoint_mismatch);
    CHECK(refused(hydraulic_run(s, rain(), shear, {.step_divisor = 11, .refine_length = 0.9, .refine_every = 6})) == errc::checkpoint_mismatch);
    CHECK(refused(hydraulic_run(s, rain(), partheniades_erosion{.coefficient = 2e-3, .critical = 4}, refining)) == errc::checkpoint_mismatch);
    CHECK(refused(hydraulic_run(s, rain(), curvature_erosion<>{}, refining)) == errc::checkpoint_mismatch);
    struct soft_half {
        double operator()(vec3 const& p) const { return p[0] < 5 ? 2e-3 : 2.1e-3; }
    };
    CHECK(refused(hydraulic_run(s, rain(), partheniades_erosion{.coefficient = soft_half{}, .critical = 3}, refining)) == errc::checkpoint_mismatch);
    CHECK(refused(hydraulic_run(s, rain(150, 4), shear, refining)) == errc::checkpoint_mismatch);
    CHECK(refused(hydraulic_run(s, rain(140), shear, refining)) == errc::checkpoint_mismatch);
    CHECK(refused(hydraulic_run(s, water(), shear, refining)) == errc::wrong_format);
}

TEST_CASE("damaged hydraulic checkpoints are refused wherever they are damaged") {
    triangle_surface const s = slope(4, 2);
    hydraulic_run run(s, rain(8), shear);
    run.run(12);
    auto const good = run.checkpoint();
    hydraulic_run fresh(s, rain(8), shear);
    auto const before = fresh.checkpoint();
    for (std::size_t n = 0; n < good.size(); n += 11) {
        auto const cut = std::vector<std::byte>(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(n));
        CHECK(code_of([&] { fresh.resume(cut); }) != errc{});
        auto bent = good;
        bent[n] ^= std::byte{0x55};
        CHECK(code_of([&] { fresh.resume(bent); }) != errc{});
        // Numbers that the sum of the bytes agrees with are looked at as well.
        if (n + 8 >= good.size()) continue;
        std::fill(bent.begin() + static_cast<std::ptrdiff_t>(n), bent.begin() + static_cast<std::ptrdiff_t>(n) + 8, std::byte{0xFF});
        detail::byte_writer sum;
        sum.put(detail::byte_hash(std::span(bent).first(bent.size() - 8)));
        std::copy(sum.bytes().begin(), sum.bytes().end(), bent.end() - 8);
        try {
            hydraulic_run other(s, rain(8), shear);
            other.resume(bent);
            other.run(1);
            CHECK(other.balanced());
        } catch (std::exception const&) {
        }
    }
    auto longer = good;
    longer.push_back(std::byte{0});
    CHECK(code_of([&] { fresh.resume(longer); }) != errc{});
    CHECK(fresh.checkpoint() == before);
}

TEST_CASE("C3: when memory runs out at any point of a hydraulic run, whole iterations stay and it goes on to the same bits") {
    auto const holds = [](auto const& process) {
        std::uint64_t const last = 7;
        using run_type = hydraulic_run<std::remove_cvref_t<decltype(process)>, sliding>;
        hydraulic_options const options{.refine_length = 1.3, .refine_every = 2};
        std::vector<run_type> after{run_type(slope(8, 0.01), sliding{}, process, options)};
        for (std::uint64_t k = 0; k < last; ++k) {
            after.push_back(after.back());
            after.back().run(1);
        }
        REQUIRE(after.back().report().vertices_added > 0);
        REQUIRE(after.back().report().ledger.eroded > 0);
        bool failed = true;
        long k = 0;
        for (; failed && k < 20000; ++k) {
            run_type run = after.front();
            failed = false;
            allocations_left = k;
            try {
                run.run(last);
            } catch (std::bad_alloc const&) {
                failed = true;
            }
            allocations_left = -1;
            std::uint64_t const done = run.report().iterations;
            REQUIRE(done <= last);
            REQUIRE(same_state(run, after[done]));
            // Saved and resumed there, and gone on with as it is.
            run_type other = after.front();
            other.resume(run.checkpoint());
            other.run(last - done);
            REQUIRE(same_state(other, after[last]));
            run.run(last - done);
            REQUIRE(same_state(run, after[last]));
        }
        CHECK(k > 50);
        CHECK_FALSE(failed);
    };
    holds(partheniades_erosion{.coefficient = 1e-3, .critical = 0.1});
    holds(curvature_erosion<>{.influence = 1});
}

TEST_CASE("a run that looks around goes on from right after edges were split") {
    hydraulic_options const both{.refine_length = 0.9, .refine_every = 6, .check_every = 4};
    triangle_surface const ground = slope(10, 5);
    hydraulic_run whole(ground, rain(), shear, both);
    whole.run(6);
    REQUIRE(whole.report().vertices_added > 0);
    hydraulic_run resumed(ground, rain(), shear, both);
    resumed.resume(whole.checkpoint());
    CHECK(same_state(whole, resumed));
    whole.run(9);
    resumed.run(9);
    CHECK(same_state(whole, resumed));
}
