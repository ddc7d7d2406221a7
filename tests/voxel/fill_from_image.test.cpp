#include <catch2/catch.hpp>

#include "fill_testing.hpp"

#include <io/file_testing.hpp>

#include <tafoni/voxel/fill_from_image.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

#include <cmath>
#include <numbers>

using namespace tafoni;
using tafoni_test::differences;
using tafoni_test::failure_of;
using tafoni_test::plain_grid;

namespace {

gray_image noise_image(std::size_t width, std::size_t height, std::uint64_t key) {
    stream random(41, stage::user, key);
    gray_image image{width, height, {}};
    for (std::size_t i = 0; i < width * height; ++i) image.pixels.push_back(static_cast<std::uint8_t>(random.index_below(256)));
    return image;
}
gray_image black(std::size_t width, std::size_t height) {
    return {width, height, std::vector<std::uint8_t>(width * height, 0)};
}
bool rock(plain_grid const& g, std::size_t i, std::size_t j, std::size_t k) {
    return g.states[g.at(i, j, k)] == voxel_state::rock;
}

}  // namespace

TEST_CASE("drawn out, a voxel per pixel is dark where its pixel is, the lowest row at the bottom, padding air") {
    gray_image const image = noise_image(7, 5, 0);
    image_options const options{.sweep = image_sweep::along_y, .darkest_air = 100, .depth = 3};
    grid_frame const frame = frame_for_image(image, options);
    REQUIRE(frame.size == std::array<std::size_t, 3>{9, 5, 6});
    REQUIRE(frame.origin == vec3{-4.5, -2.5, 0});
    plain_grid grid(frame);
    fill_from_image(grid, image, options);
    for (std::size_t k = 0; k < 6; ++k) {
        for (std::size_t j = 0; j < 5; ++j) {
            for (std::size_t i = 0; i < 9; ++i) {
                bool const padded = i == 0 || i == 8 || j == 0 || j == 4 || k == 5;
                REQUIRE(rock(grid, i, j, k) == (!padded && image.at(i - 1, 4 - k) < 100));
            }
        }
    }
}

TEST_CASE("at twice the resolution every pixel is eight voxels") {
    gray_image const image = noise_image(6, 9, 1);
    image_options const options{.sweep = image_sweep::along_y, .resolution = 18, .padding = 0};
    plain_grid grid(frame_for_image(image, options));
    REQUIRE(grid.frame.size == std::array<std::size_t, 3>{12, 12, 18});
    fill_from_image(grid, image, options);
    for (std::size_t k = 0; k < 18; ++k) {
        for (std::size_t i = 0; i < 12; ++i) REQUIRE(rock(grid, i, 5, k) == (image.at(i / 2, 8 - k / 2) < 128));
    }
}

TEST_CASE("a black image turned around its middle is a cylinder, around its left edge one of twice the radius") {
    for (std::size_t const n : {32U, 33U}) {
        for (bool const half : {false, true}) {
            image_options const options{.sweep = half ? image_sweep::around_left_edge : image_sweep::around_middle};
            gray_image const image = black(n, 4);
            plain_grid grid(frame_for_image(image, options));
            double const r = half ? static_cast<double>(n) : 0.5 * static_cast<double>(n);
            REQUIRE(static_cast<double>(fill_from_image(grid, image, options)) == Approx(4 * std::numbers::pi * r * r).epsilon(0.02));
            for (std::size_t j = 0; j < grid.frame.size[1]; ++j) {
                for (std::size_t i = 0; i < grid.frame.size[0]; ++i) {
                    vec3 const p = grid.frame.centre({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j), 0});
                    double const d = std::sqrt(p[0] * p[0] + p[1] * p[1]);
                    REQUIRE(rock(grid, i, j, 0) == (d < r));
                }
            }
        }
    }
}

TEST_CASE("a revolved silhouette keeps its width in every row and all its symmetries; what is dark on either side is rock") {
    // Rows of 2, 6, 12 dark pixels in the middle of 12, and one that is dark on the left only.
    gray_image image{12, 4, std::vector<std::uint8_t>(48, 255)};
    std::array<std::size_t, 4> const widths{2, 6, 12, 0};
    for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t c = 6 - widths[row] / 2; c < 6 + widths[row] / 2; ++c) image.pixels[12 * row + c] = 0;
    }
    image.pixels[12 * 3 + 2] = 0;  // a ring from radius 3 to 4
    plain_grid grid(frame_for_image(image));
    REQUIRE(grid.frame.size == std::array<std::size_t, 3>{14, 14, 5});
    fill_from_image(grid, image);
    for (std::size_t k = 0; k < 4; ++k) {
        std::size_t wide = 0;
        for (std::size_t i = 0; i < 14; ++i) wide += rock(grid, i, 7, k) ? 1U : 0U;
        if (k > 0) REQUIRE(wide == widths[3 - k]);
        for (std::size_t j = 0; j < 14; ++j) {
            for (std::size_t i = 0; i < 14; ++i) {
                REQUIRE(rock(grid, i, j, k) == rock(grid, j, i, k));
                REQUIRE(rock(grid, i, j, k) == rock(grid, 13 - i, j, k));
                if (k == 0) {
                    vec3 const p = grid.frame.centre({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j), 0});
                    double const d = std::sqrt(p[0] * p[0] + p[1] * p[1]);
                    REQUIRE(rock(grid, i, j, k) == (d >= 3 && d < 4));
                }
            }
        }
    }
    for (up_axis const up : {up_axis::plus_x, up_axis::minus_z, up_axis::minus_y}) {
        sparse_grid sparse(grid.frame, up);
        fill_from_image(sparse, image);
        REQUIRE(differences(sparse, grid) == 0);
    }
}

TEST_CASE("a silhouette of any scale is the same voxels, and voxels need not be cubes") {
    gray_image image{.width = 8, .height = 4, .pixels = std::vector<std::uint8_t>(32, 255)};
    for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t column = 1 + row % 2; column < 6; ++column) image.pixels[8 * row + column] = 0;
    }
    for (auto const sweep : {image_sweep::along_y, image_sweep::around_middle, image_sweep::around_left_edge}) {
        plain_grid unit(frame_for_image(image, {.sweep = sweep}));
        fill_from_image(unit, image, {.sweep = sweep});
        for (double const h : {1e-300, 1e-160, 1e99}) {
            grid_frame frame = unit.frame;
            frame.spacing = vec3{h, h, 7 * h};
            plain_grid scaled(frame);
            fill_from_image(scaled, image, {.sweep = sweep});
            REQUIRE(differences(scaled, unit) == 0);
        }
    }
}

TEST_CASE("images and options that make no column are refused, and the grid is as it was") {
    sparse_grid grid({.size = {3, 3, 3}});
    grid.set({0, 0, 0}, voxel_state::rock);
    auto const code_of = [&](gray_image const& image, image_options const& options) {
        auto const f = failure_of([&] { return fill_from_image(grid, image, options); });
        REQUIRE(f.happened);
        REQUIRE(failure_of([&] { return frame_for_image(image, options); }).happened == (f.code != errc::empty_input || image.pixels.empty()));
        REQUIRE(grid.count(voxel_plane::rock) == 1);
        return f.code;
    };
    REQUIRE(code_of({}, {}) == errc::empty_input);
    REQUIRE(code_of({2, 2, {1, 2, 3}}, {}) == errc::attribute_length);
    REQUIRE(code_of({std::size_t{1} << 33, 1, {}}, {}) == errc::size_overflow);
    REQUIRE(code_of(black(1, 1), {.sweep = static_cast<image_sweep>(3)}) == errc::bad_parameter);
    REQUIRE(code_of(black(1, 1), {.padding = 2}) == errc::empty_input);
    REQUIRE(failure_of([&] { return frame_for_image(black(1, 1), {.resolution = std::size_t{1} << 21}); }).code == errc::bad_parameter);
    REQUIRE(failure_of([&] { return frame_for_image(black(1, 1), {.padding = std::size_t{1} << 63}); }).code == errc::bad_parameter);
    REQUIRE(failure_of([&] { return frame_for_image(black(std::size_t{1} << 20, 1), {.sweep = image_sweep::around_left_edge}); }).code == errc::size_overflow);
}
