#include <catch2/catch.hpp>

#include <io/file_testing.hpp>

#include <tafoni/voxel/frame_for.hpp>

#include <cmath>
#include <limits>

using namespace tafoni;
using tafoni_test::failure_of;

TEST_CASE("the longest side takes the resolution, the box lies in the middle, padding around it") {
    stream random(21, stage::user, 0);
    for (int round = 0; round < 2000; ++round) {
        box3 box;
        vec3 lo;
        vec3 extent;
        for (int d = 0; d < 3; ++d) {
            lo[d] = random.uniform(-100, 100);
            extent[d] = random.uniform(0, 50);
        }
        box.include(lo);
        box.include(lo + extent);
        std::size_t const n = 1 + random.index_below(300);
        std::array<std::size_t, 6> pad{};
        for (std::size_t& p : pad) p = random.index_below(4);
        grid_frame const frame = frame_for(box, n, pad);
        double const edge = frame.spacing[0];
        REQUIRE((frame.spacing[1] == edge && frame.spacing[2] == edge));
        std::size_t longest = 0;
        for (std::size_t d = 0; d < 3; ++d) {
            auto const a = static_cast<Eigen::Index>(d);
            std::size_t const inner = frame.size[d] - pad[2 * d] - pad[2 * d + 1];
            longest = std::max(longest, inner);
            double const below = box.lo[a] - (frame.origin[a] + static_cast<double>(pad[2 * d]) * edge);
            double const above = frame.origin[a] + static_cast<double>(frame.size[d] - pad[2 * d + 1]) * edge - box.hi[a];
            REQUIRE(below >= -1e-9);
            REQUIRE(below < 0.5 * edge + 1e-9);
            REQUIRE(below == Approx(above).margin(1e-9));
        }
        REQUIRE(longest == n);
    }
}

TEST_CASE("a cube gets as many voxels along every side, at any scale") {
    for (double const scale : {1e-30, 1.0 / 3, 1.0, 1e9, 1e30}) {
        for (std::size_t const n : {1U, 3U, 7U, 100U, 255U}) {
            grid_frame const frame = frame_for({{0.1 * scale, 0.1 * scale, 0.1 * scale}, {1.4 * scale, 1.4 * scale, 1.4 * scale}}, n);
            REQUIRE(frame.size == std::array<std::size_t, 3>{n + 2, n + 2, n + 2});
        }
    }
    REQUIRE(frame_for({{0, 0, 0}, {4, 0, 0}}, 8, 0).size == std::array<std::size_t, 3>{8, 1, 1});
}

TEST_CASE("boxes and resolutions that make no grid are refused") {
    box3 const box{{0, 0, 0}, {1, 1, 1}};
    auto const code_of = [](auto const& f) {
        auto const r = failure_of(f);
        REQUIRE(r.happened);
        return r.code;
    };
    double const inf = std::numeric_limits<double>::infinity();
    REQUIRE(code_of([&] { return frame_for(box3{}, 8); }) == errc::empty_input);
    REQUIRE(code_of([&] { return frame_for({{1, 1, 1}, {1, 1, 1}}, 8); }) == errc::empty_input);
    REQUIRE(code_of([&] { return frame_for({{0, 0, 0}, {NAN, 1, 1}}, 8); }) == errc::empty_input);
    REQUIRE(code_of([&] { return frame_for({{0, 0, 0}, {inf, 1, 1}}, 8); }) == errc::out_of_range);
    REQUIRE(code_of([&] { return frame_for({{-1e200, 0, 0}, {1, 1, 1}}, 8); }) == errc::out_of_range);
    REQUIRE(code_of([&] { return frame_for(box, 0); }) == errc::bad_parameter);
    REQUIRE(code_of([&] { return frame_for(box, std::size_t{1} << 21); }) == errc::bad_parameter);
    REQUIRE(code_of([&] { return frame_for(box, std::numeric_limits<std::size_t>::max()); }) == errc::bad_parameter);
    REQUIRE(code_of([&] { return frame_for(box, 8, std::numeric_limits<std::size_t>::max()); }) == errc::bad_parameter);
    REQUIRE(code_of([&] { return frame_for(box, std::size_t{1} << 20); }) == errc::size_overflow);  // with its padding
}
