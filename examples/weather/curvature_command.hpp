// weather curvature: what sticks out of a mesh wears away.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace weather {

/// The command line of `weather curvature`.
struct curvature_arguments {
    std::string input;
    std::string output;
    std::uint64_t iterations = 50;    ///< in all, those before --resume included
    double power = 1;
    double step = 10;                 ///< no vertex moves farther in an iteration than the mean edge over this
    std::string estimator = "tensor";
    double ball = 0;                  ///< radius of the bubble estimator, length unit; 0: three mean edges
    std::string direction = "laplacian";
    std::string durability = "1";
    bool keep_topology = false;
    double small_edge = 0.1;
    std::uint32_t check_every = 0;
    std::uint32_t retries = 6;
    std::uint32_t hold_after = 2;
    bool map = false;                 ///< write where each vertex of the input went
    std::string up = "z";
    std::uint64_t seed = 1;
    std::size_t threads = 1;
    std::uint64_t snapshots = 0;
    std::string checkpoint;
    std::string resume;
    std::vector<std::string> formats{"vtp", "obj"};
    std::string progress = "auto";
};

CLI::App* add_curvature_command(CLI::App& app, curvature_arguments& a);

/// Runs it. False when Ctrl-C ended it early; then the checkpoint is there.
bool run_curvature(curvature_arguments const& a);

}  // namespace weather
