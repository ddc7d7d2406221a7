#include <tafoni/core/random.hpp>
#include <tafoni/voxel/bubble_mixture.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/weathering/voxel_run.hpp>

#include <catch2/catch.hpp>

#include <string>
#include <vector>

using namespace tafoni;

namespace {

sparse_grid ruin() {
    grid_border const ground{{border_kind::air, border_kind::air, border_kind::air, border_kind::air, border_kind::rock,
                              border_kind::air}};
    sparse_grid g({.size = {40, 12, 35}}, up_axis::plus_z, ground);
    stream random(4, stage::user, 0);
    for (std::int32_t z = 0; z < 30; ++z) {
        for (std::int32_t y = 2; y < 10; ++y) {
            for (std::int32_t x = 3; x < 37; ++x) {
                if (random.uniform01() < 0.9) g.set({x, y, z}, voxel_state::rock);
            }
        }
    }
    return g;
}

auto process() {
    return voxel_weathering{.bubbles = bubble_mixture{.bubbles = {sphere_bubble{.radius = 3}, sphere_bubble{.radius = 5}},
                                                      .field = gradient_noise{.seed = 2, .frequency = 0.1}},
                            .durability = constant_field{.value = 0.02}};
}
constexpr int every = 3;

voxel_options options() { return {.colluvium = repose_rule{}, .rockfall = rockfall_options{}, .seed = 6}; }

errc code_of(auto&& act) {
    try {
        act();
    } catch (io_error const& e) {
        return e.code();
    }
    return errc{};
}

}  // namespace

TEST_CASE("a run that goes on from a checkpoint ends with the bytes of the run that was never stopped") {
    for (voxel_clock const clock : {voxel_clock::steps, voxel_clock::events}) {
        voxel_schedule const half{.phases = {{.steps = every, .spheroidal = 1, .cavernous = 0.5}}, .clock = clock};
        voxel_run whole(ruin(), process(), options());
        whole.run(half);
        auto const saved = whole.checkpoint();
        whole.run(half);

        voxel_run again(ruin(), process(), options());
        again.resume(saved);
        REQUIRE(again.checkpoint() == saved);
        REQUIRE(again.report().steps == every);
        again.run(half);
        REQUIRE(again.checkpoint() == whole.checkpoint());
        REQUIRE(whole.report().voxels_colluvium > 0);
        REQUIRE(std::equal(again.blocks().begin(), again.blocks().end(), whole.blocks().begin(), whole.blocks().end()));
    }
}

TEST_CASE("a checkpoint of another grid, other parameters or damaged bytes is refused, and nothing changes") {
    voxel_run run(ruin(), process(), options());
    run.run({.phases = {{.steps = every}}});
    auto const saved = run.checkpoint();
    auto const refused = [&](auto& other) {
        auto const before = other.checkpoint();
        errc const e = code_of([&] { other.resume(saved); });
        REQUIRE(other.checkpoint() == before);
        return e;
    };
    sparse_grid changed = ruin();
    changed.set({20, 5, 31}, voxel_state::rock);
    voxel_run other_grid(changed, process(), options());
    REQUIRE(refused(other_grid) == errc::checkpoint_mismatch);
    voxel_run other_options(ruin(), process(), {.colluvium = repose_rule{.angle = 30, .baseline = 2}});
    REQUIRE(refused(other_options) == errc::checkpoint_mismatch);
    auto harder = process();
    harder.durability.value = 0.03;
    voxel_run other_durability(ruin(), harder, options());
    REQUIRE(refused(other_durability) == errc::checkpoint_mismatch);
    auto faster = process();
    faster.rate.scale = 2;
    voxel_run other_rate(ruin(), faster, options());
    REQUIRE(refused(other_rate) == errc::checkpoint_mismatch);

    voxel_run fresh(ruin(), process(), options());
    auto const before = fresh.checkpoint();
    std::vector<std::byte> const nothing;
    REQUIRE(code_of([&] { fresh.resume(nothing); }) == errc::wrong_format);
    for (std::size_t n = 8; n < saved.size(); n += saved.size() / 40 + 1) {
        std::vector<std::byte> const part(saved.begin(), saved.begin() + static_cast<std::ptrdiff_t>(n));
        REQUIRE(code_of([&] { fresh.resume(part); }) != errc{});
    }
    for (std::size_t n = 0; n < saved.size(); n += saved.size() / 40 + 1) {
        std::vector<std::byte> wrong = saved;
        wrong[n] ^= std::byte{16};
        REQUIRE(code_of([&] { fresh.resume(wrong); }) != errc{});
    }
    REQUIRE(fresh.checkpoint() == before);
    fresh.resume(saved);
    REQUIRE(fresh.checkpoint() == saved);
}
