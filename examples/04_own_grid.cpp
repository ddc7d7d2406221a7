// A grid of one's own: blocks of a game world, y up. Checked against the laws, weathered until a roof falls, written back.
#include <tafoni/io/write_ply.hpp>
#include <tafoni/testing/laws.hpp>
#include <tafoni/voxel/copy_states.hpp>
#include <tafoni/voxel/voxel_surface.hpp>
#include <tafoni/weathering/voxel_run.hpp>

#include <algorithm>
#include <cstdio>

using namespace tafoni;

enum class block : unsigned short { none, granite, sandstone, rubble };

// Chunks in the game's own order: y slowest, then x, then z.
struct world {
    static constexpr std::size_t width = 48, height = 40, depth = 32;
    std::vector<block> blocks = std::vector<block>(width * height * depth, block::none);

    block& at(std::size_t x, std::size_t y, std::size_t z) { return blocks[z + depth * (x + width * y)]; }
    block const& at(std::size_t x, std::size_t y, std::size_t z) const { return blocks[z + depth * (x + width * y)]; }
};

template <>
struct tafoni::grid_access<world> {
    static std::array<std::size_t, 3> size(world const&) { return {world::width, world::height, world::depth}; }
    static vec3 spacing(world const&) { return {0.5, 0.5, 0.5}; }  // metres
    static vec3 origin(world const&) { return {-12, 0, -8}; }
    static voxel_state state(world const& w, std::size_t i, std::size_t j, std::size_t k) {
        switch (w.at(i, j, k)) {
            case block::none: return voxel_state::air;
            case block::rubble: return voxel_state::colluvium;
            default: return voxel_state::rock;
        }
    }
    static void set(world& w, std::size_t i, std::size_t j, std::size_t k, voxel_state s) {
        block& b = w.at(i, j, k);
        if (s == voxel_state::air) b = block::none;
        if (s == voxel_state::colluvium) b = block::rubble;
        if (s == voxel_state::rock && state(w, i, j, k) != s) b = block::sandstone;  // what is rock stays what it is
    }
};

// A ledge of hard granite on a thick layer of soft sandstone, on granite ground.
world ledge() {
    world w;
    for (std::size_t y = 0; y < 36; ++y) {
        for (std::size_t x = 0; x < world::width; ++x) {
            for (std::size_t z = 0; z < world::depth; ++z) {
                bool const on_ground = y >= 4;
                if (on_ground && (x < 12 || x >= 36 || z < 8 || z >= 24)) continue;
                w.at(x, y, z) = !on_ground || y >= 28 ? block::granite : block::sandstone;
            }
        }
    }
    return w;
}

int main() {
    world mine = ledge();
    for (auto const& broken : laws::editable_voxel_grid(mine)) return std::printf("broken law: %s\n", broken.c_str()), 1;

    auto const hardness = [](vec3 const& p) { return p[1] > 2 && p[1] < 14 ? 0.02 : 0.2; };  // steps per per cent; metres
    grid_border border;
    border.sides[2] = border_kind::rock;  // -y, the ground
    voxel_run run(mine, voxel_weathering{.bubbles = single_bubble{sphere_bubble{4}}, .durability = hardness},
                  {.up = up_axis::plus_y, .border = border, .colluvium = repose_rule{}, .rockfall = rockfall_options{}});
    voxel_report const report = run.run({.phases = {{.steps = 60, .spheroidal = 1, .cavernous = 0.2}}});
    copy_states(run.grid(), mine);

    auto const rubble = static_cast<std::uint64_t>(std::count(mine.blocks.begin(), mine.blocks.end(), block::rubble));
    auto const number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
    std::printf("%llu of %llu blocks fell, %llu are rubble, %llu are gone\n", number(report.voxels_fallen),
                number(report.voxels_initial), number(rubble), number(report.voxels_vanished));
    voxel_surface const surface = extract_voxel_surface(run.grid());
    write_ply("ledge.ply", surface.rock.mesh);
    write_ply("ledge_rubble.ply", surface.colluvium.mesh);
    return report.voxels_colluvium == rubble && report.voxels_fallen > 2000 ? 0 : 1;
}
