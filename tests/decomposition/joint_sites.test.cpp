#include <tafoni/decomposition/joint_sites.hpp>

#include <tafoni/geometry/make_solid.hpp>

#include <support/shapes.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>

using namespace tafoni;

namespace {

solid const& long_box() {
    static solid const s = make_solid(tafoni_test::box({0, 0, 0}, {4, 2, 1}));
    return s;
}

}  // namespace

TEST_CASE("joint sites are a grid whose spacings vary within bounds, some of it left out") {
    joint_sites const pattern{.spacing = {0.2, 0.1, 0.05}, .variation = 0.5, .left_out = 0.3, .jitter = 0};
    auto const sites = pattern(long_box(), 1);
    double places = 1;
    for (int a = 0; a < 3; ++a) {
        std::set<double> lines;
        for (vec3 const& p : sites) lines.insert(p[a]);
        places *= static_cast<double>(lines.size());
        double least = 1e9;
        double most = 0;
        for (auto l = lines.begin(); std::next(l) != lines.end(); ++l) {
            least = std::min(least, *std::next(l) - *l);
            most = std::max(most, *std::next(l) - *l);
        }
        CHECK(least >= 0.5 * pattern.spacing[a] * (1 - 1e-9));
        CHECK(most <= 1.5 * pattern.spacing[a] * (1 + 1e-9));
        CHECK(most > 1.5 * least);
    }
    CHECK(static_cast<double>(sites.size()) / places == Approx(0.7).margin(0.02));
    // In a frame that is turned and tilted the lines lie across the frame's axes.
    joint_sites const turned{.up = normalized({0.2, 0.1, 1}), .spacing = {0.3, 0.3, 0.2}, .turn = 25, .left_out = 0, .jitter = 0};
    std::set<long> beds;
    for (vec3 const& p : turned(long_box(), 1)) beds.insert(std::lround(dot(p, turned.up) * 1e6));
    CHECK(beds.size() < 20);
}

TEST_CASE("joint sites are pure, follow their seed and stay in the solid's box") {
    joint_sites const pattern{.up = normalized({0.3, 0, 1}), .spacing = {0.2, 0.2, 0.1}, .turn = 30};
    auto const sites = pattern(long_box(), 5);
    CHECK(sites == pattern(long_box(), 5));
    CHECK_FALSE(sites == pattern(long_box(), 6));
    for (vec3 const& p : sites) REQUIRE(long_box().bounds.contains(p));
    CHECK(joint_sites{.spacing = {100, 100, 100}, .left_out = 0.9}(long_box(), 1).size() == 1);
}

TEST_CASE("bad parameters of joint sites are refused") {
    CHECK_THROWS_AS((joint_sites{.spacing = {1, 0, 1}}(long_box(), 1)), invalid_input);
    CHECK_THROWS_AS((joint_sites{.left_out = std::numeric_limits<double>::quiet_NaN()}(long_box(), 1)), invalid_input);
    CHECK_THROWS_AS((joint_sites{.variation = 1}(long_box(), 1)), invalid_input);
    CHECK_THROWS_AS((joint_sites{.up = {0, 0, 2}}(long_box(), 1)), invalid_input);
    CHECK_THROWS_AS((joint_sites{.spacing = {1e-12, 1e-12, 1e-12}}(long_box(), 1)), invalid_input);
}
