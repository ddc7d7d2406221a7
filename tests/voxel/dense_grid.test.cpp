#include <catch2/catch.hpp>

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/voxel/copy_states.hpp>
#include <tafoni/voxel/dense_grid.hpp>
#include <tafoni/voxel/span_grid.hpp>

using namespace tafoni;

namespace {

template <class F>
invalid_input error_of(F const& f) {
    try {
        f();
    } catch (invalid_input const& e) {
        return e;
    }
    return {errc{}, "nothing thrown"};
}

}  // namespace

TEST_CASE("bytes lie x fastest, then y, then z") {
    std::vector<std::uint8_t> states(2 * 3 * 4, 0);
    states[1 + 2 * (2 + 3 * 3)] = 2;
    states[0 + 2 * (1 + 3 * 0)] = 1;
    dense_grid const g({.size = {2, 3, 4}, .spacing = {1, 2, 3}, .origin = {7, 8, 9}}, states);
    CHECK(g.at({1, 2, 3}) == voxel_state::colluvium);
    CHECK(g.at({0, 1, 0}) == voxel_state::rock);
    CHECK(g.count(voxel_state::air) == 22);
    CHECK(g.frame().centre({1, 2, 3}) == vec3{8.5, 13, 19.5});
    CHECK(grid_access<dense_grid>::state(g, 1, 2, 3) == voxel_state::colluvium);
    CHECK(g.bytes() >= 24);
}

TEST_CASE("a voxel beyond a dense grid is named") {
    dense_grid const g({.size = {2, 3, 4}});
    for (voxel const v : {voxel{-1, 0, 0}, voxel{2, 0, 0}, voxel{0, 3, 0}, voxel{0, 0, 4}, voxel{0, 0, -1}}) {
        CHECK(error_of([&] { (void)g.at(v); }).code() == errc::index_out_of_range);
    }
    CHECK(std::string(error_of([&] { (void)g.at({2, -5, 0}); }).what()) ==
          "dense_grid::at: voxel (2, -5, 0) of a grid of 2 x 3 x 4");
    CHECK(g.at({1, 2, 3}) == voxel_state::air);
}

TEST_CASE("a dense grid of no voxels, too many, or other than its bytes is refused", "[V1][V5][V6]") {
    CHECK(error_of([] { dense_grid({.size = {0, 1, 1}}); }).code() == errc::empty_input);
    std::size_t const huge = 0xFFFFFFFF;
    CHECK(error_of([&] { dense_grid({.size = {huge, huge, huge}}); }).code() == errc::size_overflow);
    std::size_t const mega = grid_frame::longest;
    auto const many = error_of([&] { dense_grid({.size = {mega, mega, mega}}); });
    CHECK(many.code() == errc::size_overflow);
    CHECK(std::string(many.what()).find("1152921504606846976 voxels") != std::string::npos);

    auto const few = error_of([] { dense_grid({.size = {2, 2, 2}}, std::vector<std::uint8_t>(7)); });
    CHECK(few.code() == errc::attribute_length);
    CHECK(std::string(few.what()) == "dense_grid: got 7 states, the grid has 8 voxels");
    CHECK(error_of([] { dense_grid({.size = {2, 2, 2}}, std::vector<std::uint8_t>(9)); }).code() == errc::attribute_length);

    std::vector<std::uint8_t> states(24, 1);
    states[1 + 2 * (2 + 3 * 3)] = 3;
    auto const wrong = error_of([&] { dense_grid({.size = {2, 3, 4}}, states); });
    CHECK(wrong.code() == errc::out_of_range);
    CHECK(std::string(wrong.what()) == "dense_grid: state of voxel (1, 2, 3): got 3, at most 2");
    CHECK(wrong.place().index == 23);
    CHECK(wrong.place().value == 3);
}

TEST_CASE("spacing and origin of a grid are finite, spacing is positive", "[V13]") {
    double const nan = std::numeric_limits<double>::quiet_NaN();
    for (double const s : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
        CHECK(error_of([&] { dense_grid({.size = {1, 1, 1}, .spacing = {1, s, 1}}); }).code() == errc::bad_parameter);
    }
    CHECK(error_of([&] { dense_grid({.size = {1, 1, 1}, .origin = {0, 0, nan}}); }).code() == errc::bad_parameter);
    CHECK_NOTHROW(dense_grid({.size = {1, 1, 1}, .spacing = {1e-6, 1, 1e6}}));
}

TEST_CASE("a view reads and writes the user's bytes where they lie") {
    std::vector<std::uint8_t> states(24, 1);
    grid_frame const frame{.size = {2, 3, 4}};
    span_grid view(frame, std::span<std::uint8_t>(states));
    grid_access<span_grid<std::uint8_t>>::set(view, 1, 2, 3, voxel_state::colluvium);
    CHECK(states[23] == 2);
    states[0] = 0;
    CHECK(grid_access<span_grid<std::uint8_t>>::state(view, 0, 0, 0) == voxel_state::air);
    CHECK(error_of([&] { span_grid(frame, std::span<std::uint8_t>(states).first(23)); }).code() == errc::attribute_length);
    states[5] = 77;
    CHECK(error_of([&] { span_grid(frame, std::span<std::uint8_t const>(states)); }).code() == errc::out_of_range);
}

TEST_CASE("a dense grid that was moved from has no voxels") {
    dense_grid a({.size = {2, 3, 4}}, voxel_state::rock);
    dense_grid const b = std::move(a);
    CHECK(a == dense_grid{});
    CHECK(b.count(voxel_state::rock) == 24);
    a = dense_grid(b);
    CHECK(a == b);
}

TEST_CASE("different voxels of a dense grid, and different stored bricks, may be set by several threads", "[threads]") {
    grid_frame const frame{.size = {64, 40, 70}};
    auto const wanted = [](voxel v) { return static_cast<voxel_state>((v.x * 7 + v.y * 5 + v.z * 3) % 3); };
    thread_pool const threads(4);
    dense_grid dense(frame);
    threads.for_blocks(frame.size[2], 1, [&](std::size_t begin, std::size_t) {
        auto const z = static_cast<std::int32_t>(begin);
        for (int y = 0; y < 40; ++y) {
            for (int x = 0; x < 64; ++x) dense.set({x, y, z}, wanted({x, y, z}));
        }
    });
    sparse_grid sparse(frame);
    for (std::size_t b = 0; b < sparse.brick_count(); ++b) (void)sparse.make_mixed(b);
    threads.for_blocks(sparse.brick_count(), 1, [&](std::size_t b, std::size_t) {
        voxel const low = sparse.brick_corner(b);
        for (int n = 0; n < 32 * 32 * 32; ++n) {
            voxel const v = low + voxel{n & 31, n >> 5 & 31, n >> 10};
            if (sparse.contains(v)) sparse.set(v, wanted(v));
        }
    });
    dense_grid back(frame);
    copy_states(sparse, back);
    CHECK(back == dense);
    CHECK(dense.at({1, 0, 0}) == voxel_state::rock);
}
