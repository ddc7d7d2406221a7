// The loop of the paper (section 4.2, Figure 5), written down voxel by voxel, as the oracle of the engine.
#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/voxel/bubble_mixture.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/weathering/voxel_run.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <vector>

using namespace tafoni;

namespace {

constexpr voxel sides[6] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};

struct rates {
    double spheroidal = 1;
    double cavernous = 0;
};

/// Nothing is kept from step to step but the grid and what is left of the voxels that have weathered.
template <class Process>
class paper_loop {
public:
    paper_loop(sparse_grid rock, Process process, voxel_options options)
        : grid(std::move(rock)), process_(std::move(process)), options_(std::move(options)) {}

    sparse_grid grid;
    std::map<voxel, double> left;
    std::size_t vanished = 0;
    std::size_t fallen = 0;
    std::size_t gone = 0;
    std::uint64_t steps = 0;

    void step(rates const& r) {
        std::vector<voxel> fallers;
        for (voxel const v : skin()) {
            auto const [it, fresh] = left.try_emplace(v, 100.0);
            it->second -= loss(v, r);
            if (it->second <= 0) fallers.push_back(v);
        }
        std::vector<voxel> released;
        std::vector<voxel> opened = fallers;
        for (voxel const v : fallers) {
            bool const loose = grid.state(v) == voxel_state::colluvium;
            if (options_.colluvium && !loose) released.push_back(v);
            else ++vanished;
            clear(v);
        }
        if (options_.rockfall) {
            for (voxel const v : hanging()) {
                ++fallen;
                opened.push_back(v);
                clear(v);
            }
        }
        std::sort(opened.begin(), opened.end());
        if (options_.colluvium && !opened.empty()) {
            std::vector<voxel_change> changes;
            gone += settle(grid, released, opened, *options_.colluvium, options_.seed, steps, inline_executor{}, changes).left;
            for (voxel_change const& c : changes) left.erase(c.at);
        }
        ++steps;
    }

private:
    template <class F>
    void for_each_voxel(F const& f) const {
        auto const& n = grid.size();
        for (std::int32_t z = 0; z < static_cast<std::int32_t>(n[2]); ++z) {
            for (std::int32_t y = 0; y < static_cast<std::int32_t>(n[1]); ++y) {
                for (std::int32_t x = 0; x < static_cast<std::int32_t>(n[0]); ++x) f(voxel{x, y, z});
            }
        }
    }
    [[nodiscard]] bool beside_air(voxel v) const {
        return std::any_of(sides, sides + 6, [&](voxel s) { return !grid.is_solid(v + s); });
    }
    [[nodiscard]] std::vector<voxel> skin() const {
        std::vector<voxel> out;
        for_each_voxel([&](voxel v) {
            if (!grid.is_solid(v)) return;
            bool bare = beside_air(v);
            for (voxel const s : sides) bare = bare || (options_.skin_depth > 1 && grid.is_solid(v + s) && beside_air(v + s));
            if (bare) out.push_back(v);
        });
        return out;
    }
    [[nodiscard]] double loss(voxel v, rates const& r) const {
        bubble_stencil const& b = process_.bubbles.stencils()[process_.bubbles.choose(grid.centre(v))];
        std::uint32_t air = 0;
        for (auto const& row : b.rows()) {
            for (int dz = -b.reach(); dz <= b.reach(); ++dz) {
                if (b.contains(row.dx, row.dy, dz) && !grid.is_solid(v + voxel{row.dx, row.dy, dz})) ++air;
            }
        }
        double const size = b.size();
        double const durability = std::max(process_.durability(grid.centre(v)), 1e-3);
        return (r.spheroidal * process_.rate(air / size) + r.cavernous * process_.rate((b.size() - air) / size)) / durability;
    }
    void clear(voxel v) {
        grid.set(v, voxel_state::air);
        left.erase(v);
    }
    /// Rock that no path of rock leads from the lowest layer to.
    [[nodiscard]] std::vector<voxel> hanging() const {
        std::set<voxel> held;
        std::vector<voxel> open;
        auto const reach = [&](voxel v) {
            if (grid.contains(v) && grid.is_rock(v) && held.insert(v).second) open.push_back(v);
        };
        for_each_voxel([&](voxel v) {
            if (v.z == 0) reach(v);
        });
        while (!open.empty()) {
            voxel const v = open.back();
            open.pop_back();
            for (voxel const s : sides) reach(v + s);
        }
        std::vector<voxel> out;
        for_each_voxel([&](voxel v) {
            if (grid.is_rock(v) && held.count(v) == 0) out.push_back(v);
        });
        return out;
    }

    Process process_;
    voxel_options options_;
};

sparse_grid rubble(std::array<std::size_t, 3> size, std::uint64_t seed, grid_border const& border, double loose) {
    sparse_grid g({.size = size, .spacing = {0.5, 0.5, 0.5}}, up_axis::plus_z, border);
    stream random(seed, stage::user, 0);
    for (std::int32_t z = 0; z < static_cast<std::int32_t>(size[2]); ++z) {
        for (std::int32_t y = 0; y < static_cast<std::int32_t>(size[1]); ++y) {
            for (std::int32_t x = 0; x < static_cast<std::int32_t>(size[0]); ++x) {
                double const u = random.uniform01();
                double const w = random.uniform01();
                if (u < 0.85) g.set({x, y, z}, w < loose ? voxel_state::colluvium : voxel_state::rock);
            }
        }
    }
    return g;
}

}  // namespace

TEST_CASE("the engine is the loop of the paper, voxel by voxel, to the bit") {
    grid_border const ground{{border_kind::air, border_kind::extend, border_kind::air, border_kind::rock, border_kind::rock, border_kind::air}};
    auto const durability = [](vec3 const& p) { return p[2] < 6 ? 0.03 : p[2] < 9 ? 1e-5 : 0.015; };
    auto const process = voxel_weathering{
        .bubbles = bubble_mixture{.bubbles = {sphere_bubble{.radius = 2}, disc_bubble{.radius = 4, .thickness = 2}, gumdrop_bubble{.radius = 4}},
                                  .field = gradient_noise{.seed = 5, .frequency = 0.3}},
        .durability = durability};
    std::size_t deposited = 0;
    std::size_t fallen = 0;
    std::size_t gone = 0;
    for (int kind = 0; kind < 8; ++kind) {
        INFO("kind " << kind);
        voxel_options options{.skin_depth = kind % 4 == 3 ? 2 : 1, .seed = 9};
        if (kind % 2 > 0) options.colluvium = repose_rule{.angle = 50, .baseline = 1 + kind / 4};
        if (kind % 4 > 1) {  // the ground is the lowest layer alone, as in the loop
            options.rockfall = rockfall_options{};
            options.rockfall->sides.fill(ground_side::loose);
            options.rockfall->sides[4] = ground_side::ground;
        }
        thread_pool const pool(1 + static_cast<std::size_t>(kind % 3));
        sparse_grid const rock = rubble({35, 5, 34}, static_cast<std::uint64_t>(kind), ground, kind % 2 > 0 ? 0.1 : 0.0);
        paper_loop loop(rock, process, options);
        voxel_run run(rock, process, options);
        for (rates const& r : std::vector<rates>{{1, 0}, {0.5, 1}, {2, 0.25}, {0, 2}, {1, 0}, {1, 1}}) {
            loop.step(r);
            run.run({.phases = {{.steps = 1, .spheroidal = r.spheroidal, .cavernous = r.cavernous}}}, {}, pool);
            voxel_report const report = run.report();
            REQUIRE(report.voxels_vanished == loop.vanished);
            REQUIRE(report.voxels_fallen == loop.fallen);
            REQUIRE(report.voxels_left == loop.gone);
            bool same = true;
            for (std::int32_t z = 0; z < 34; ++z) {
                for (std::int32_t y = 0; y < 5; ++y) {
                    for (std::int32_t x = 0; x < 35; ++x) {
                        voxel const v{x, y, z};
                        same = same && run.grid().state(v) == loop.grid.state(v);
                        if (!loop.grid.is_solid(v)) continue;
                        auto const known = loop.left.find(v);
                        auto const mine = run.at(v);
                        double const left = mine ? mine->decimation : run.look(v).decimation;
                        same = same && left == (known == loop.left.end() ? 100 : known->second);
                    }
                }
            }
            REQUIRE(same);
        }
        deposited += run.report().voxels_colluvium;
        fallen += run.report().voxels_fallen;
        gone += run.report().voxels_left;
    }
    REQUIRE(deposited > 500);
    REQUIRE(fallen > 100);
    REQUIRE(gone > 100);
}
