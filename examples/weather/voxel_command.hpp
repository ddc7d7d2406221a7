// weather voxel: spheroidal and cavernous weathering by bubbles [Jones et al.].
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace weather {

/// The command line of `weather voxel`, as text where a value depends on another.
struct voxel_arguments {
    static constexpr std::uint64_t unset = std::numeric_limits<std::uint64_t>::max();

    std::string input;
    std::string output;
    std::size_t resolution = 128;
    std::uint64_t margin = unset;  ///< voxels of air around the rock; unset: what the process needs
    std::string up = "z";
    std::string image = "revolve";
    double level = std::numeric_limits<double>::quiet_NaN();  ///< of samples from which on there is rock; unset: halfway
    std::string border;            ///< empty: extend for terrain, ground otherwise
    std::vector<std::string> bubbles;  ///< empty: one sphere
    double radius = 5;
    std::string rate = "cubic";
    std::string measure = "share";
    double spheroidal = 1;
    double cavernous = -1;         ///< below 0: 1 with a schedule, else 0
    std::string schedule;
    std::uint64_t steps = unset;   ///< unset: one round of the schedule, or 50
    bool events = false;
    std::string durability = "constant";
    std::string noise;
    bool colluvium = false;
    double repose = 45;
    std::uint32_t baseline = 1;
    bool rockfall = false;
    double friction = 0;
    std::vector<std::string> joints;
    int depth = 1;
    std::uint32_t smooth = 3;
    std::uint64_t seed = 1;
    std::size_t threads = 1;
    std::uint64_t snapshots = 0;
    std::string checkpoint;
    std::string resume;
    std::vector<std::string> formats{"vtp", "obj"};
    std::string progress = "auto";
    bool separate_blocks = false;
};

CLI::App* add_voxel_command(CLI::App& app, voxel_arguments& a);

/// Runs it. False when Ctrl-C ended it early; then the checkpoint is there.
bool run_voxel(voxel_arguments const& a);

}  // namespace weather
