// Layers of a rock column as the paper on directable weathering shows them: Figures 15 to 18.
#include "paper/voxel_scene.hpp"

#include <tafoni/field/durability_profile.hpp>
#include <tafoni/voxel/bubble_mixture.hpp>
#include <tafoni/voxel/bubble_profile.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/weathering/weathered_voxels.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

using namespace tafoni;
using namespace tafoni_test;

namespace {

single_bubble ball(double radius) { return {sphere_bubble{.radius = radius}}; }

struct band {
    double radius = 0;
    double deviation = 0;
};
/// The skin of a column between two heights.
template <class Run>
band between(Run const& run, std::int32_t low, std::int32_t high) {
    double const middle = static_cast<double>(run.grid().size()[0]) / 2;
    double sum = 0;
    double square = 0;
    double n = 0;
    for (skin_voxel const& v : run.skin()) {
        if (v.at.z < low || v.at.z >= high) continue;
        double const x = v.at.x + 0.5 - middle;
        double const y = v.at.y + 0.5 - middle;
        double const r = std::sqrt(x * x + y * y);
        sum += r;
        square += r * r;
        ++n;
    }
    return {sum / n, std::sqrt(square / n - sum / n * (sum / n))};
}

}  // namespace

TEST_CASE("Figure 15: the silhouette follows the durability profile", "[paper]") {
    durability_profile<> const first{
        .points = {{0, 0.06}, {20, 0.06}, {20, 0.03}, {36, 0.03}, {50, 0.08}, {60, 0.04}, {75, 0.04}, {75, 0.07}, {100, 0.07}}};
    durability_profile<> const second{.points = {{0, 0.03}, {30, 0.08}, {45, 0.03}, {60, 0.07}, {70, 0.07}, {80, 0.04}, {100, 0.06}}};
    for (auto const& durability : {first, second}) {
        voxel_run run(column(96, 100, 36), voxel_weathering{.bubbles = ball(4), .durability = durability}, {.colluvium = repose_rule{}});
        for (int const steps : {20, 20, 10}) {
            run.run({.phases = {{.steps = static_cast<std::uint64_t>(steps)}}});
            auto const radius = profile(run.grid());
            std::vector<double> shape;
            std::vector<double> wanted;
            for (std::int32_t z = 0; z < 88; ++z) {  // without the top layer
                bool loose = false;
                for (std::int32_t y = 0; y < 96; ++y) {
                    for (std::int32_t x = 0; x < 96; ++x) loose = loose || run.grid().state({x, y, z}) == voxel_state::colluvium;
                }
                if (loose) continue;  // and without what colluvium covers
                shape.push_back(radius[static_cast<std::size_t>(z)]);
                wanted.push_back(durability(vec3{0, 0, z + 0.5}));
            }
            INFO("steps " << run.steps() << ", rows " << shape.size());
            REQUIRE(shape.size() >= 60);
            CHECK(correlation(shape, wanted) > 0.9);
        }
    }
}

TEST_CASE("Figure 15: the top layer weathers faster than a layer as durable below", "[paper]") {
    voxel_run run(column(64, 80, 24), voxel_weathering{.bubbles = ball(4), .durability = constant_field{.value = 0.04}});
    run.run({.phases = {{.steps = 30}}});
    auto const radius = profile(run.grid());
    std::size_t top = radius.size() - 1;
    while (radius[top] == 0) --top;
    CHECK(top < 79);
    CHECK(radius[top - 1] < radius[40] - 1);
}

TEST_CASE("Figure 16: the preview finds where caverns will grow", "[paper]") {
    sparse_grid fold({.size = {48, 48, 48}}, up_axis::plus_z, on_ground);
    fill_box(fold, {4, 4, 0}, {44, 44, 44});
    fill_box(fold, {24, 24, 0}, {48, 48, 48}, voxel_state::air);
    for (curvature_measure const measure : {curvature_measure::signed_excess, curvature_measure::flat_excess}) {
        bool const flat = measure == curvature_measure::flat_excess;
        voxel_run run(fold, voxel_weathering{.bubbles = ball(5), .durability = constant_field{.value = 0.02}}, {.measure = measure});
        auto const preview = extract_weathered_voxels(run);
        std::vector<double> shown;
        std::vector<double> taken;
        std::size_t untouched = 0;
        run.run({.phases = {{.steps = 1, .spheroidal = 0, .cavernous = 1}}});
        for (std::size_t i = 0; i < preview.rock.cavernous.size(); ++i) {
            auto const now = run.at(preview.surface.rock.vertex_voxel[i]);
            if (!now) continue;
            if (preview.rock.cavernous[i] == 0) REQUIRE(now->decimation == 100);
            if (preview.rock.cavernous[i] > 0) REQUIRE(now->decimation < 100);
            untouched += preview.rock.curvature[i] == 0 ? 1u : 0u;
            shown.push_back(std::pow(preview.rock.cavernous[i], 3));
            taken.push_back(100 - now->decimation);
        }
        REQUIRE(*std::max_element(taken.begin(), taken.end()) > 1);
        CHECK(correlation(shown, taken) > 0.99);  // f is cubic, durability constant
        if (flat) CHECK(untouched > shown.size() / 3);  // the flat walls
    }
}

TEST_CASE("Figure 17: noise within a layer makes its rock vary", "[paper]") {
    auto const weathered = [](double bottom, double top) {
        voxel_run run(column(96, 80, 36),
                      voxel_weathering{.bubbles = ball(4),
                                       .durability = durability_profile<>{.points = {{0, 0.02, bottom, 0.07}, {40, 0.03, top, 0.02}, {80, 0.03, top, 0.02}}}});
        run.run({.phases = {{.steps = 60}}});
        return std::pair{between(run, 4, 36).deviation, between(run, 44, 64).deviation};
    };
    auto const plain = weathered(0, 0);
    auto const noisy = weathered(0.018, 0.006);
    CHECK(noisy.first > 1.5 * plain.first);
    CHECK(noisy.second > 1.05 * plain.second);
    CHECK(noisy.first > 2 * noisy.second);  // strong noise of high frequency below, weak and slow above
}

TEST_CASE("Figure 18: a small disc weathers faster than a sphere, and mixed bubbles make the rock vary", "[paper]") {
    auto const weathered = [](auto bubbles) {
        voxel_run run(column(64, 80, 20), voxel_weathering{.bubbles = bubbles, .durability = constant_field{.value = 0.02}});
        run.run({.phases = {{.steps = 70}}});
        return std::pair{between(run, 8, 32), between(run, 46, 58)};
    };
    auto const sphere = weathered(ball(4));
    auto const disc = weathered(bubble_profile<>{.bubbles = {disc_bubble{.radius = 4, .thickness = 1}, sphere_bubble{.radius = 4}},
                                                 .layers = {{.top = 40, .mix = {0}}, {.mix = {1}}}});
    auto const mixed = weathered(bubble_mixture<>{.bubbles = {disc_bubble{.radius = 6, .thickness = 1}, sphere_bubble{.radius = 6}, sphere_bubble{.radius = 3}},
                                                  .field = gradient_noise{.seed = 4, .frequency = 0.12},
                                                  .lowest = -0.6,
                                                  .highest = 0.6});
    CHECK(disc.first.radius < sphere.first.radius - 0.5);
    CHECK(disc.second.radius == Approx(sphere.second.radius).margin(0.1));
    CHECK(mixed.first.deviation > 1.4 * sphere.first.deviation);
}
