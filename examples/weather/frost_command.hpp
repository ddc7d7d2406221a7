// weather frost: freeze and thaw [Mateos et al.].
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace weather {

[[nodiscard]] std::string version_text();

/// The command line of `weather frost`, as text where a value depends on another.
struct frost_arguments {
    std::string input;
    std::string output;
    std::size_t shards = 1000;
    std::string sites = "random";
    double jitter = 0.5;
    double patch_angle = 15;
    std::uint64_t paths = 10000;
    std::uint32_t batch = 1;
    std::uint64_t seed = 1;
    std::string rain;  ///< empty: the preset's, along gravity where that is down
    double spread = 0;
    double water = 1;
    double absorb = 1;
    std::string gravity = "0,0,-1";
    std::string resistance = "constant:value=0.5";
    std::vector<std::string> core;  ///< empty: artificial for terrain, none otherwise
    std::vector<std::string> air;
    std::string preset = "paper";
    double roughness = 0;
    std::size_t threads = 1;
    std::uint64_t snapshots = 0;
    std::string checkpoint;
    std::string resume;
    std::vector<std::string> formats{"vtp", "obj"};
    std::string progress = "auto";
    bool separate_blocks = false;
    bool graphs = false;
    bool stop_at_break = false;
    bool stop_at_fall = false;
};

CLI::App* add_frost_command(CLI::App& app, frost_arguments& a);

/// Runs it. False when Ctrl-C ended it early; then the checkpoint is there.
bool run_frost(frost_arguments const& a);

}  // namespace weather
