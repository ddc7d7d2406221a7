#include "voxel_command.hpp"

#include "option_checks.hpp"
#include "voxel_session.hpp"

#include <CLI/CLI.hpp>

namespace weather {

namespace {

void add_rock_options(CLI::App& c, voxel_arguments& a) {
    c.add_option("INPUT", a.input,
                 "mesh (.obj .ply .stl), elevation grid (.asc), voxels (.vox .nrrd), image (.png .pgm) or builtin:SPEC")
        ->required();
    c.add_option("-o,--output", a.output, "folder DIR for the results")->required();
    c.add_option("--resolution", a.resolution, "voxels along the longest side")->check(CLI::Range(std::size_t{1}, std::size_t{65536}))->capture_default_str();
    c.add_option("--margin", a.margin, "voxels of air around the rock; default: 2, with --colluvium a quarter of the resolution")->check(CLI::Range(std::uint64_t{0}, std::uint64_t{65536}));
    c.add_option("--up", a.up, "axis that points up: x, y, z, -x, -y or -z")->check(CLI::IsMember({"x", "y", "z", "-x", "-y", "-z"}))->capture_default_str();
    c.add_option("--image", a.image, "SPEC: how an image becomes rock")->capture_default_str();
    c.add_option("--level", a.level, "samples of a .nrrd from which on there is rock; default: halfway between least and largest")->check(between(-1e300, 1e300));
    c.add_option("--border", a.border, "ground, open or extend; default: extend for .asc and builtin:cliff, else ground")->check(CLI::IsMember({"ground", "open", "extend"}));
}

void add_process_options(CLI::App& c, voxel_arguments& a) {
    c.add_option("--bubble", a.bubbles, "SPEC, repeatable with above=: what curvature is estimated with; default: sphere")->allow_extra_args(false);
    c.add_option("--radius", a.radius, "of bubbles that say none, voxels")->check(between(0.1, 48.0))->capture_default_str();
    c.add_option("--rate", a.rate, "SPEC: decay over the estimate")->capture_default_str();
    c.add_option("--measure", a.measure, "share: of air in the bubble; excess: what it differs by from one half; flat: from what flat rock shows")->check(CLI::IsMember({"share", "excess", "flat"}))->capture_default_str();
    c.add_option("--spheroidal", a.spheroidal, "factor of spheroidal weathering")->check(between(0.0, 1e6))->capture_default_str();
    c.add_option("--cavernous", a.cavernous, "factor of cavernous weathering; default: 0, 1 with --schedule")->check(between(0.0, 1e6));
    c.add_option("--schedule", a.schedule, "which acts when, as 17c,1s,2c or 5sc (both); goes round until --steps")->check(filled());
    c.add_option("--steps", a.steps, "steps in all, those before --resume included; default: one round of the schedule, or 50")->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 62));
    c.add_flag("--events", a.events, "voxels fall at the times they are used up, not all at the end of a step");
    c.add_option("--durability", a.durability, "SPEC or file: steps per per cent of a voxel at a rate of 1")->capture_default_str();
    c.add_option("--noise", a.noise, "SPEC, added to the durability");
    CLI::Option* const colluvium = c.add_flag("--colluvium", a.colluvium, "weathered rock slides, rests and protects what it covers");
    c.add_option("--repose", a.repose, "angle of repose of --colluvium, degrees")->check(between(0.0, 89.0))->needs(colluvium)->capture_default_str();
    c.add_option("--baseline", a.baseline, "columns over which the slope of --colluvium is measured")->check(CLI::Range(1u, 16u))->needs(colluvium)->capture_default_str();
    CLI::Option* const rockfall = c.add_flag("--rockfall", a.rockfall, "rock that nothing holds falls");
    c.add_option("--joints", a.joints, "SPEC, repeatable: cracks that cut rock for --rockfall")->needs(rockfall)->allow_extra_args(false);
    c.add_option("--friction", a.friction, "degrees up to which a block cut off in --rockfall stays on its joint")->check(between(0.0, 89.0))->needs(rockfall)->capture_default_str();
    c.add_option("--depth", a.depth, "1: voxels beside air weather; 2: the next ones too")->check(CLI::Range(1, 2))->capture_default_str();
}

void add_run_options(CLI::App& c, voxel_arguments& a) {
    c.add_option("--smooth", a.smooth, "rounds in which vertices of the surface move to the mean of their neighbours")->check(CLI::Range(0u, 1000u))->capture_default_str();
    c.add_option("--seed", a.seed, "of everything that is drawn")->capture_default_str();
    c.add_option("--threads", a.threads, "0: as many as the machine has")->check(CLI::Range(std::size_t{0}, std::size_t{1024}))->capture_default_str();
    c.add_option("--snapshots", a.snapshots, "write a snapshot every so many steps; 0: none")->capture_default_str();
    c.add_option("--checkpoint", a.checkpoint, "file to save the state to, with every snapshot and at the end; default: none, after Ctrl-C DIR/voxel.checkpoint");
    c.add_option("--resume", a.resume, "checkpoint to go on from");
    c.add_option("--format", a.formats, "obj,ply,stl,vtp")->allow_extra_args(false)->delimiter(',')->check(CLI::IsMember({"obj", "ply", "stl", "vtp"}))->capture_default_str();
    c.add_option("--progress", a.progress, "bar, json or none; default: bar on a terminal")->check(CLI::IsMember({"bar", "json", "none", "auto"}));
    c.add_flag("--separate-blocks", a.separate_blocks, "one file for each fallen block");
}

}  // namespace

CLI::App* add_voxel_command(CLI::App& app, voxel_arguments& a) {
    CLI::App* const c = app.add_subcommand("voxel", "Spheroidal and cavernous weathering: edges round off, hollows grow");
    c->footer(
        "SPEC is name:key=value,key=value. Radii of bubbles are in voxels, other lengths in the unit of the model.\n"
        "  builtin:      hoodoo:radius=,plinth=,bulge=,seed= | cube | corner:wall=,height= |\n"
        "                cliff:dents=,wavelength=,seed= | outcrop:resolution=,seed=\n"
        "  --image       revolve:axis=middle|left,dark= | sweep:depth=,dark= (depth as a share of the width)\n"
        "  --bubble      sphere | ellipsoid:axes= | gumdrop:base= | disc:thickness= | all: radius=,above= (share of\n"
        "                the height from which it holds) | mixture:shapes=,radii=,wavelength=,above=\n"
        "  --rate        cubic | linear | quartic, each: scale=,lowest=,highest=\n"
        "  --durability  constant:value= | profile:at=,values=,amplitude=,frequency= | layers:values=,thickness= |\n"
        "                grid:path=FILE.nrrd,low=,high= | FILE (lines: altitude durability [amplitude frequency])\n"
        "  --noise       noise:amplitude=,wavelength=,octaves=\n"
        "  --joints      planes:normal=,spacing=,offset= | discs:normal=,spread=,spacing=,radius= | file:path=\n"
        "Results and snapshots that an older run left in the output folder are replaced; other files stay.\n"
        "Exit codes: 0 done, 1 bad input, 2 usage, 130 stopped by Ctrl-C (a checkpoint is written, see --checkpoint).");
    add_rock_options(*c, a);
    add_process_options(*c, a);
    add_run_options(*c, a);
    return c;
}

bool run_voxel(voxel_arguments const& a) { return voxel_session(a).run(); }

}  // namespace weather
