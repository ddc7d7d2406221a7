#include "support/curved_surfaces.hpp"

#include <tafoni/curvature/cotangent.hpp>
#include <tafoni/weathering/curvature_run.hpp>

#include <catch2/catch.hpp>

#include <bit>

using namespace tafoni;
using namespace tafoni_test;

namespace {

curvature_options const wearing{.power = 2, .step_divisor = 3, .small_edge = 0.3};

/// Collapses edges within a few iterations.
triangle_surface ring() { return torus_surface(60, 24, 0.4).mesh; }

bool same_bits(std::vector<vec3> const& a, std::vector<vec3> const& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](vec3 const& p, vec3 const& q) {
        for (int d = 0; d < 3; ++d) {
            if (std::bit_cast<std::uint64_t>(p[d]) != std::bit_cast<std::uint64_t>(q[d])) return false;
        }
        return true;
    });
}

errc code_of(auto const& action) {
    try {
        action();
    } catch (io_error const& e) {
        return e.code();
    }
    return errc{};
}

}  // namespace

TEST_CASE("a curvature run that is saved and resumed ends with the same bytes as one without a break") {
    for (std::uint32_t const check : {0u, 4u}) {
        curvature_options o = wearing;
        o.check_every = check;
        curvature_run straight(ring(), curvature_weathering{}, o);
        straight.run(20);
        REQUIRE(straight.report().edges_collapsed > 0);
        curvature_run half(ring(), curvature_weathering{}, o);
        half.run(8);
        auto const bytes = half.checkpoint();
        curvature_run rest(ring(), curvature_weathering{}, o);
        rest.resume(bytes);
        CHECK(rest.checkpoint() == bytes);
        CHECK(rest.report().iterations == 8);
        CHECK(rest.report().removed_volume == half.report().removed_volume);
        rest.run(12);
        CHECK(rest.checkpoint() == straight.checkpoint());
        CHECK(same_bits(rest.surface().positions, straight.surface().positions));
        CHECK(rest.surface().triangles == straight.surface().triangles);
        CHECK(rest.wear() == straight.wear());
        CHECK(rest.report().removed_volume == straight.report().removed_volume);
    }
}

TEST_CASE("a checkpoint of another mesh or with other parameters is refused, and nothing is changed") {
    curvature_run run(ring(), curvature_weathering{}, wearing);
    run.run(3);
    auto const bytes = run.checkpoint();
    curvature_run other_mesh(torus_surface(60, 24, 0.41).mesh, curvature_weathering{}, wearing);
    CHECK(code_of([&] { other_mesh.resume(bytes); }) == errc::checkpoint_mismatch);
    curvature_options power = wearing;
    power.power = 3;
    curvature_run other_power(ring(), curvature_weathering{}, power);
    CHECK(code_of([&] { other_power.resume(bytes); }) == errc::checkpoint_mismatch);
    curvature_run other_rock(ring(), curvature_weathering{.durability = constant_field{2}}, wearing);
    CHECK(code_of([&] { other_rock.resume(bytes); }) == errc::checkpoint_mismatch);
    CHECK(other_rock.report().iterations == 0);
}

TEST_CASE("damaged checkpoints are refused wherever they are damaged") {
    curvature_run run(sphere(1).mesh, curvature_weathering{}, {.check_every = 2});
    run.run(3);
    auto const good = run.checkpoint();
    curvature_run fresh(sphere(1).mesh, curvature_weathering{}, {.check_every = 2});
    auto const before = fresh.checkpoint();
    for (std::size_t n = 0; n < good.size(); n += 7) {
        auto const cut = std::vector<std::byte>(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(n));
        CHECK(code_of([&] { fresh.resume(cut); }) != errc{});
        auto bent = good;
        bent[n] ^= std::byte{0x55};
        CHECK(code_of([&] { fresh.resume(bent); }) != errc{});
    }
    auto longer = good;
    longer.push_back(std::byte{0});
    CHECK(code_of([&] { fresh.resume(longer); }) != errc{});
    CHECK(fresh.checkpoint() == before);
}
