#include "frost_command.hpp"

#include "frost_session.hpp"
#include "option_checks.hpp"

#include <tafoni/version.hpp>

#include <CLI/CLI.hpp>

namespace weather {

std::string version_text() { return tafoni::version_string; }

CLI::App* add_frost_command(CLI::App& app, frost_arguments& a) {
    CLI::App* const c = app.add_subcommand("frost", "Freeze and thaw: water enters cracks, breaks bonds, blocks fall");
    c->footer(
        "SPEC is name:key=value,key=value. Lengths are in the unit of the model.\n"
        "  --sites       random | surface | grid | hex:axis=,layers=,vertical= | slabs:up=,spacings=,across= |\n"
        "                joints:up=,turn=,flat=,spacing=,variation=,left_out= |\n"
        "                poisson:radius=,ratio=,direction= | vertices:of=FILE | FILE (mesh, or lines x y z)\n"
        "  --resistance  constant:value= | layers:values=,tops=,thickness=,up=,fold=,wavelength= |\n"
        "                sine:direction=,wavelength=,mean=,amplitude=,phase= | ramp:direction=,low=,high= |\n"
        "                pockets:count=,radius=,value=,base= | noise:wavelength=,octaves=,low=,high= |\n"
        "                grid:path=FILE.nrrd,range=,low=,high=,place=fit\n"
        "  --core, --air none | all | plane:point=,normal= | box:lo=,hi= | bottom:share= | exterior |\n"
        "                exterior-except:direction=,angle= | artificial | file:path= (mesh, or cell numbers)\n"
        "Results and snapshots that an older run left in the output folder are replaced; other files stay.\n"
        "Exit codes: 0 done, 1 bad input, 2 usage, 130 stopped by Ctrl-C (a checkpoint is written).");
    c->add_option("INPUT", a.input, "mesh (.obj .ply .stl), elevation grid (.asc) or builtin:outcrop")->required();
    c->add_option("-o,--output", a.output, "folder for the results")->required();
    c->add_option("--shards", a.shards, "about how many shards")->check(CLI::Range(std::size_t{1}, std::size_t{100000000}))->capture_default_str();
    c->add_option("--sites", a.sites, "SPEC or file: where shards grow from")->capture_default_str();
    c->add_option("--jitter", a.jitter, "of grid, hex, slabs and joints, share of the spacing")->check(between(0.0, 1.0))->capture_default_str();
    c->add_option("--patch-angle", a.patch_angle, "degrees within which skin is one link")->check(between(0.0, 180.0))->capture_default_str();
    c->add_option("--paths", a.paths, "water paths in all, those before --resume included")->capture_default_str();
    c->add_option("--batch", a.batch, "paths that walk one frozen state")->check(CLI::Range(1u, 1u << 24))->capture_default_str();
    c->add_option("--seed", a.seed, "of everything that is drawn")->capture_default_str();
    c->add_option("--rain", a.rain, "direction of travel x,y,z; default: the preset's, along gravity for paper");
    c->add_option("--spread", a.spread, "half-angle of the rain around its direction, degrees")->check(between(0.0, 180.0))->capture_default_str();
    c->add_option("--water", a.water, "water of one path")->check(between(0.0, 1024.0))->capture_default_str();
    c->add_option("--absorb", a.absorb, "factor of all absorption coefficients")->check(between(0.0, 1e6))->capture_default_str();
    c->add_option("--gravity", a.gravity, "direction x,y,z")->capture_default_str();
    c->add_option("--resistance", a.resistance, "SPEC: how much the rock resists, 0 to 1")->capture_default_str();
    c->add_option("--core", a.core, "SPEC, repeatable: cells that never fall; default: artificial for .asc, else none");
    c->add_option("--air", a.air, "SPEC, repeatable: cells that are gone from the start");
    c->add_option("--roughness", a.roughness, "of fresh breaks, share of the mean shard's width")->check(between(0.0, 0.5))->capture_default_str();
    c->add_option("--preset", a.preset, "paper or addon")->check(CLI::IsMember({"paper", "addon"}))->capture_default_str();
    c->add_option("--threads", a.threads, "0: as many as the machine has")->check(CLI::Range(std::size_t{0}, std::size_t{1024}))->capture_default_str();
    c->add_option("--snapshots", a.snapshots, "write a snapshot every so many paths; 0: none")->capture_default_str();
    c->add_option("--checkpoint", a.checkpoint, "file to save the state to, with every snapshot and at the end");
    c->add_option("--resume", a.resume, "checkpoint to go on from");
    c->add_option("--format", a.formats, "obj,ply,stl,vtp")->delimiter(',')->check(CLI::IsMember({"obj", "ply", "stl", "vtp"}))->capture_default_str();
    c->add_option("--progress", a.progress, "bar, json or none; default: bar on a terminal")->check(CLI::IsMember({"bar", "json", "none", "auto"}));
    c->add_flag("--separate-blocks", a.separate_blocks, "one file for each fallen block");
    c->add_flag("--graphs", a.graphs, "write links.vtp, bonds.vtp and paths.vtp, to look at");
    c->add_flag("--stop-at-break", a.stop_at_break, "stop when the first link breaks");
    c->add_flag("--stop-at-fall", a.stop_at_fall, "stop when the first block falls");
    return c;
}

bool run_frost(frost_arguments const& a) { return frost_session(a).run(); }

}  // namespace weather
