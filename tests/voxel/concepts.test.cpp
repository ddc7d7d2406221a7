#include "support/code_of.hpp"

#include <catch2/catch.hpp>

#include <tafoni/decomposition/voxel_cells.hpp>
#include <tafoni/testing/archetypes.hpp>
#include <tafoni/testing/laws.hpp>
#include <tafoni/voxel/bit_grid.hpp>
#include <tafoni/voxel/copy_states.hpp>
#include <tafoni/voxel/dense_grid.hpp>
#include <tafoni/voxel/span_grid.hpp>
#include <tafoni/voxel/sparse_grid.hpp>
#include <tafoni/voxel/voxel_surface.hpp>

#include <functional>
#include <string>

using namespace tafoni;
using tafoni_test::code_of;

namespace {

/// What a grid of one's own can get wrong.
enum class fault { none, set_forgets, set_spills, set_shifts, answers_in_turn, unknown_state, flat, nan_spacing, lying_bytes };

struct faulty {
    fault what;
    mutable int calls = 0;
    double step = 1;
    std::vector<std::uint8_t> states = std::vector<std::uint8_t>(3 * 4 * 5, 1);
};

/// Without bytes, and with one voxel of no state.
struct strange {};

}  // namespace

template <>
struct tafoni::grid_access<strange> {
    static std::array<std::size_t, 3> size(strange const&) { return {3, 4, 5}; }
    static vec3 spacing(strange const&) { return vec3{1, 1, 1}; }
    static vec3 origin(strange const&) { return vec3{0, 0, 0}; }
    static voxel_state state(strange const&, std::size_t i, std::size_t j, std::size_t k) {
        return static_cast<voxel_state>(i == 2 && j == 1 && k == 3 ? 3 : 1);
    }
};

template <>
struct tafoni::grid_access<faulty> {
    static std::array<std::size_t, 3> size(faulty const& g) { return {3, 4, g.what == fault::flat ? 0U : 5U}; }
    static vec3 spacing(faulty const& g) { return vec3{1, g.what == fault::nan_spacing ? 0.0 / 0.0 : g.step, 1}; }
    static vec3 origin(faulty const&) { return vec3{0, 0, 0}; }
    static voxel_state state(faulty const& g, std::size_t i, std::size_t j, std::size_t k) {
        if (g.what == fault::answers_in_turn) return ++g.calls % 7 == 0 ? voxel_state::air : voxel_state::rock;
        if (g.what == fault::unknown_state && i + j + k == 9) return static_cast<voxel_state>(3);
        return static_cast<voxel_state>(g.states[i + 3 * (j + 4 * k)]);
    }
    static void set(faulty& g, std::size_t i, std::size_t j, std::size_t k, voxel_state s) {
        std::size_t const n = i + 3 * (j + 4 * k);
        if (g.what == fault::set_forgets && s == voxel_state::colluvium) s = voxel_state::rock;
        g.states[n] = static_cast<std::uint8_t>(s);
        if (g.what == fault::set_spills && n + 1 < g.states.size()) g.states[n + 1] = g.states[n];
        if (g.what == fault::set_shifts) g.step = 2;
    }
    static std::span<std::uint8_t const> bytes(faulty const& g) {
        return std::span(g.states).first(g.what == fault::lying_bytes ? 59 : 60);
    }
};

TEST_CASE("every model of a voxel grid keeps the laws") {
    grid_frame const frame{.size = {5, 70, 3}, .spacing = {1, 0.5, 2}, .origin = {-1, 2, 3}};
    dense_grid dense(frame, voxel_state::rock);
    CHECK(laws::editable_voxel_grid(dense) == std::vector<std::string>{});
    bit_grid bits(frame);
    CHECK(laws::editable_voxel_grid(bits) == std::vector<std::string>{});
    std::vector<std::uint8_t> bytes(5 * 70 * 3, 1);
    span_grid view(frame, std::span<std::uint8_t>(bytes));
    CHECK(laws::editable_voxel_grid(view) == std::vector<std::string>{});
    span_grid const reading(frame, std::span<std::uint8_t const>(bytes));
    CHECK(laws::voxel_grid(reading) == std::vector<std::string>{});
    for (int up = 0; up < 6; ++up) {
        sparse_grid sparse(frame, static_cast<up_axis>(up));
        CHECK(laws::editable_voxel_grid(sparse) == std::vector<std::string>{});
    }
}

TEST_CASE("law checks find grids that break their laws, each by its own words") {
    auto const broken = [](fault what) {
        faulty g{.what = what};
        auto const list = laws::editable_voxel_grid(g);
        return list.empty() ? std::string() : list.front();
    };
    CHECK(broken(fault::none).empty());
    CHECK(broken(fault::set_forgets) == "a voxel answers what was last set");
    CHECK(broken(fault::set_spills) == "voxels that are not set keep their states");
    CHECK(broken(fault::set_shifts) == "size, spacing and origin do not change under set");
    CHECK(broken(fault::answers_in_turn) == "a voxel answers the same every time");
    CHECK(broken(fault::unknown_state) == "states are air, rock or colluvium");
    CHECK(broken(fault::flat) == "a grid has at least one voxel along each axis");
    CHECK(broken(fault::nan_spacing) == "spacing is positive and finite");
    CHECK(broken(fault::lying_bytes) == "bytes are the states, x fastest");
}

TEST_CASE("archetypes of grids keep the laws, and everything that takes a grid compiles with them") {
    archetypes::voxel_grid const reading;
    archetypes::editable_voxel_grid writing;
    CHECK(laws::voxel_grid(reading).empty());
    CHECK(laws::editable_voxel_grid(writing).empty());

    sparse_grid work = sparse_grid::copy_of(reading, up_axis::plus_y, {.sides = {border_kind::rock}});
    CHECK(work.count(voxel_plane::rock) == 48);
    work.set({0, 0, 0}, voxel_state::colluvium);
    copy_states(work, writing);
    CHECK(writing.states[0] == voxel_state::colluvium);
    copy_states(reading, writing);
    CHECK(writing.states[0] == voxel_state::rock);
    CHECK(voxel_cells::from_grid(reading).cell_count() == 48);
    CHECK(extract_voxel_surface(reading) == extract_voxel_surface(sparse_grid::copy_of(reading)));
}

TEST_CASE("states are copied between grids of any two kinds") {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        INFO("seed " << seed);
        stream random(seed, stage::user, 0);
        grid_frame frame;
        for (std::size_t& n : frame.size) n = 1 + random.index_below(70);
        std::vector<std::uint8_t> states(frame.voxel_count());
        for (std::uint8_t& s : states) s = static_cast<std::uint8_t>(random.index_below(3));
        if (seed % 4 == 0) std::fill(states.begin(), states.end(), std::uint8_t{1});  // nothing is stored
        dense_grid const dense(frame, states);
        auto const turned = [&](std::uint64_t by) { return static_cast<up_axis>((seed + by) % 6); };

        bit_grid bits(frame);
        copy_states(dense, bits);
        sparse_grid sparse(frame, turned(0));
        copy_states(bits, sparse);
        sparse_grid other = sparse_grid::copy_of(dense, turned(1));
        other.set({0, 0, 0}, voxel_state::colluvium);
        copy_states(sparse, other);
        for (std::size_t b = 0; b < sparse.brick_count(); ++b) {
            if (seed % 4 == 0) REQUIRE(sparse.is_rock_brick(b));
        }
        dense_grid back(frame, voxel_state::colluvium);
        copy_states(other, back);
        REQUIRE(back == dense);
        std::vector<std::uint8_t> mine(states.size(), 2);
        span_grid view(frame, std::span<std::uint8_t>(mine));
        copy_states(bits, view);
        REQUIRE(mine == states);
    }
}

TEST_CASE("copying between grids of different sizes is refused and changes nothing") {
    dense_grid const from({.size = {3, 4, 5}}, voxel_state::rock);
    dense_grid turned({.size = {5, 4, 3}});
    CHECK(code_of([&] { copy_states(from, turned); }) == errc::attribute_length);
    CHECK(turned.count(voxel_state::air) == 60);
    sparse_grid sparse({.size = {3, 4, 6}});
    CHECK(code_of([&] { copy_states(from, sparse); }) == errc::attribute_length);
    CHECK(code_of([&] { copy_states(sparse, turned); }) == errc::attribute_length);
    try {
        copy_states(from, turned);
    } catch (invalid_input const& e) {
        CHECK(std::string(e.what()) == "copy_states: got a grid of 3 x 4 x 5 voxels for one of 5 x 4 x 3");
    }
}

TEST_CASE("a grid that answers what is no state, or bytes for other voxels, is refused with the voxel and nothing is copied", "[V6]") {
    faulty const lying{fault::lying_bytes};
    for (auto const up : {up_axis::plus_z, up_axis::minus_x, up_axis::plus_y}) {
        CHECK(code_of([&] { (void)sparse_grid::copy_of(lying, up); }) == errc::attribute_length);
        sparse_grid to({.size = {3, 4, 5}}, up);
        CHECK(code_of([&] { copy_states(lying, to); }) == errc::attribute_length);
        CHECK(to.count(voxel_plane::solid) == 0);
    }
    // Bytes are read where they are offered.
    faulty bad{fault::none};
    bad.states[2 + 3 * (1 + 4 * 3)] = 3;
    dense_grid dense({.size = {3, 4, 5}});
    for (auto const& call : {std::function<void()>([&] { (void)sparse_grid::copy_of(bad); }),
                             std::function<void()>([&] { (void)sparse_grid::copy_of(bad, up_axis::minus_x); }),
                             std::function<void()>([&] { copy_states(bad, dense); }),
                             std::function<void()>([&] { (void)sparse_grid::copy_of(strange{}, up_axis::plus_y); }),
                             std::function<void()>([&] { copy_states(strange{}, dense); })}) {
        try {
            call();
            FAIL("accepted");
        } catch (invalid_input const& e) {
            CHECK(e.code() == errc::out_of_range);
            CHECK(std::string(e.what()).find("(2, 1, 3): got 3") != std::string::npos);
        }
    }
}
