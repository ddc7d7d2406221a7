// weather hydraulic: running water wears a mesh.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace weather {

/// The command line of `weather hydraulic`. Values below 0, and empty texts, are chosen by the model's size.
struct hydraulic_arguments {
    std::string input;
    std::string output;
    std::string model = "partheniades";
    std::string fluid = "rain";
    std::uint32_t particles = 0;     ///< 0: by the vertices
    std::uint64_t iterations = 600;   ///< in all, those before --resume included
    std::string emitter;              ///< x0,y0,z0,x1,y1,z1
    std::string velocity = "0,0,0";
    std::string gravity;              ///< x,y,z
    std::string up = "z";
    double radius = -1;
    double friction = -1;
    double lifetime = -1;
    double adhesion = -1;             ///< below 0: 0.8
    double viscosity = -1;
    double sound_speed = -1;
    double frame = -1;                ///< below 0: for sph by gravity and L, else 0
    std::string k;
    std::string tau_c;
    std::string a = "1";
    std::string K = "1";
    std::string m = "1";
    double influence = -1;
    double power = 1;
    std::string estimator = "tensor";
    std::string durability = "1";
    double step = -1;                 ///< below 0: 10, for sph, whose steps are short, 100
    double refine = 0;
    std::uint32_t check_every = 20;
    std::uint64_t seed = 1;
    std::size_t threads = 1;
    std::uint64_t snapshots = 0;
    bool particles_out = false;       ///< the water as points beside every surface
    std::string checkpoint;
    std::string resume;
    std::vector<std::string> formats{"vtp", "obj"};
    std::string progress = "auto";
};

CLI::App* add_hydraulic_command(CLI::App& app, hydraulic_arguments& a);

/// Runs it. False when Ctrl-C ended it early; then the checkpoint is there.
bool run_hydraulic(hydraulic_arguments const& a);

}  // namespace weather
