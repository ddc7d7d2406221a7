#include <catch2/catch.hpp>

#include "fill_testing.hpp"

#include <io/file_testing.hpp>

#include <tafoni/voxel/fill_from_samples.hpp>

#include <cmath>
#include <limits>

using namespace tafoni;
using tafoni_test::differences;
using tafoni_test::failure_of;
using tafoni_test::plain_grid;

TEST_CASE("a voxel is rock where its own sample says so, for every up") {
    sample_volume volume{.frame = {.size = {5, 34, 3}, .spacing = {1, 2, 3}}};
    stream random(51, stage::user, 0);
    for (std::size_t i = 0; i < 5 * 34 * 3; ++i) volume.samples.push_back(static_cast<float>(random.uniform(0, 1)));
    volume.samples[7] = std::numeric_limits<float>::quiet_NaN();
    volume.samples[8] = std::numeric_limits<float>::infinity();
    plain_grid dense(volume.frame);
    std::size_t const rock = fill_from_samples(dense, volume, 0.5F);
    std::size_t expected = 0;
    for (std::size_t i = 0; i < volume.samples.size(); ++i) {
        REQUIRE((dense.states[i] == voxel_state::rock) == (volume.samples[i] >= 0.5F));
        expected += volume.samples[i] >= 0.5F ? 1U : 0U;
    }
    REQUIRE(rock == expected);
    REQUIRE(dense.states[7] == voxel_state::air);
    for (up_axis const up : {up_axis::plus_z, up_axis::plus_x, up_axis::minus_y}) {
        sparse_grid sparse({.size = volume.frame.size}, up);  // wherever the frames lie
        fill_from_samples(sparse, volume, [](float s) { return s >= 0.5F; });
        REQUIRE(differences(sparse, dense) == 0);
    }
}

TEST_CASE("samples that do not fit are refused, and the grid is as it was") {
    sparse_grid grid({.size = {2, 2, 2}});
    grid.set({0, 0, 0}, voxel_state::rock);
    auto const code_of = [&](sample_volume const& v) {
        auto const f = failure_of([&] { return fill_from_samples(grid, v, 0.0F); });
        REQUIRE(f.happened);
        REQUIRE(grid.count(voxel_plane::rock) == 1);
        return f.code;
    };
    REQUIRE(code_of({}) == errc::empty_input);
    REQUIRE(code_of({.frame = {.size = {2, 2, 2}}, .samples = {1, 2}}) == errc::attribute_length);
    REQUIRE(code_of({.frame = {.size = {2, 2, 1}}, .samples = {1, 2, 3, 4}}) == errc::bad_count);
    REQUIRE(code_of({.frame = {.size = {0xffffffffU, 0xffffffffU, 0xffffffffU}}, .samples = {1}}) == errc::size_overflow);
}
