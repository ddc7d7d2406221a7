// weather wrinkles: folds, and cracks, along picked vertices of a mesh.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace weather {

/// The command line of `weather wrinkles`.
struct wrinkles_arguments {
    std::string input;
    std::string output;
    std::vector<std::string> paths;      ///< v,v,... each
    std::vector<std::string> through;    ///< x,y,z,x,y,z,... each: the nearest vertices
    std::vector<std::string> enlargements;
    double radius = -1;                  ///< below 0: a fortieth of the longest side, at least the mean edge
    double strength = std::numeric_limits<double>::quiet_NaN();  ///< unset: 1 for a fold, -1 for a groove
    std::string profile = "fold";
    std::uint32_t times = 1;
    double divisor = 10;
    std::uint32_t subdivisions = 2;
    bool as_printed = false;
    std::vector<std::string> wear_on;    ///< other meshes of the same topology
    std::uint64_t seed = 1;
    std::size_t threads = 1;
    std::uint32_t snapshots = 0;
    std::string checkpoint;
    std::string resume;
    std::vector<std::string> formats{"vtp", "obj"};
    std::string progress = "auto";
};

CLI::App* add_wrinkles_command(CLI::App& app, wrinkles_arguments& a);

/// Runs it. False when Ctrl-C ended it early; then the checkpoint is there.
bool run_wrinkles(wrinkles_arguments const& a);

}  // namespace weather
