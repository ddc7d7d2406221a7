// Options that all processes on meshes share.
#pragma once

#include "option_checks.hpp"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>

namespace weather {

inline constexpr char const* field_footer =
    "A FIELD is a number, a SPEC (name:key=value,key=value), or a FILE of lines `altitude value [amplitude frequency]`:\n"
    "  constant:value= | layers:values=,thickness=,up=,fold=,wavelength= | ramp:direction=,low=,high= |\n"
    "  noise:wavelength=,octaves=,low=,high= | grid:path=FILE.nrrd,low=,high=,place=fit\n";
inline constexpr char const* mesh_footer =
    "INPUT may be open; terrain (.asc) becomes an open height surface without sides and base. Lengths are in its unit.\n"
    "  builtin:      cube:squares= | sphere:squares= | bust:resolution= | hand:resolution= | outcrop:resolution=,seed= |\n"
    "                canyon:resolution=,width=,depth=,seed= | valley:resolution=,width=,depth=,fall=,seed=\n";
inline constexpr char const* result_footer =
    "Results and snapshots that an older run left in the output folder are replaced; other files stay.\n";

template <class Arguments>
void add_mesh_input(CLI::App& c, Arguments& a) {
    c.add_option("INPUT", a.input, "mesh (.obj .ply .stl), open or closed, elevation grid (.asc), or builtin:SPEC")->required();
    c.add_option("-o,--output", a.output, "folder DIR for the results")->required();
}

template <class Arguments>
void add_mesh_run(CLI::App& c, Arguments& a) {
    c.add_option("--seed", a.seed, "of everything that is drawn")->capture_default_str();
    c.add_option("--threads", a.threads, "0: as many as the machine has")->check(CLI::Range(std::size_t{0}, std::size_t{1024}))->capture_default_str();
    c.add_option("--format", a.formats, "obj,ply,stl,vtp")->allow_extra_args(false)->delimiter(',')->check(CLI::IsMember({"obj", "ply", "stl", "vtp"}))->capture_default_str();
    c.add_option("--progress", a.progress, "bar, json or none; default: bar on a terminal")->check(CLI::IsMember({"bar", "json", "none", "auto"}));
}

inline CLI::Option* add_up(CLI::App& c, std::string& up) {
    return c.add_option("--up", up, "axis that points up: x, y, z, -x, -y or -z")->check(CLI::IsMember({"x", "y", "z", "-x", "-y", "-z"}))->capture_default_str();
}

inline CLI::Option* add_estimator(CLI::App& c, std::string& estimator) {
    return c.add_option("--estimator", estimator, "of mean curvature: tensor, cotangent, quadric (for irregular meshes) or bubble")
        ->check(CLI::IsMember({"tensor", "cotangent", "quadric", "bubble"}))->capture_default_str();
}

}  // namespace weather
