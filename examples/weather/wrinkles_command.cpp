#include "wrinkles_command.hpp"

#include "mesh_options.hpp"
#include "wrinkles_session.hpp"

#include <string>

namespace weather {

CLI::App* add_wrinkles_command(CLI::App& app, wrinkles_arguments& a) {
    CLI::App* const c = app.add_subcommand("wrinkles", "Folds, sagging and cracks along picked vertices of a mesh");
    c->footer(std::string(mesh_footer) +
              "--path and --through are given once for each wrinkle; at least one of them, or --enlarge, is needed.\n" + result_footer +
              "Exit codes: 0 done, 1 bad input, 2 usage, 130 stopped by Ctrl-C (a checkpoint is written, see --checkpoint).");
    add_mesh_input(*c, a);
    c->add_option("--path", a.paths, "v,v,...: vertices that a wrinkle leads through, repeatable")->allow_extra_args(false);
    c->add_option("--through", a.through, "x,y,z,x,y,z,...: the same by points; the nearest vertices are taken")->allow_extra_args(false);
    c->add_option("--enlarge", a.enlargements, "v,radius,strength: the surface swells around a vertex, repeatable")->allow_extra_args(false);
    c->add_option("--radius", a.radius, "of the region that a wrinkle bends; default: a fortieth of the longest side, at least the mean edge")->check(between(1e-300, 1e100));
    c->add_option("--strength", a.strength, "negative carves; default: 1 for a fold, -2 for a groove, whose floor is then a quarter of the radius deep; cracks are narrow: -10 and a small radius")->check(between(-1e6, 1e6));
    c->add_option("--profile", a.profile, "fold: swells beside the line; groove: on it, with a negative strength a crack")->check(CLI::IsMember({"fold", "groove"}))->capture_default_str();
    c->add_option("--times", a.times, "how often it is applied, those before --resume included")->check(CLI::Range(0u, 10000u))->capture_default_str();
    c->add_option("--divisor", a.divisor, "of the displacement (a)")->check(between(1e-6, 1e12))->capture_default_str();
    c->add_option("--subdivisions", a.subdivisions, "of the faces around, within the radius, then within a third of it, a ninth, ...")->check(CLI::Range(0u, 6u))->capture_default_str();
    c->add_flag("--as-printed", a.as_printed, "sigma = r^2 / 3 as the source prints it, which depends on the model's unit");
    c->add_option("--wear-on", a.wear_on, "mesh of the same topology that wears the same wrinkles as worn_0, worn_1, ...; repeatable")->allow_extra_args(false);
    add_mesh_run(*c, a);
    c->add_option("--snapshots", a.snapshots, "write a snapshot every so many times; 0: none")->capture_default_str();
    c->add_option("--checkpoint", a.checkpoint, "file to save the state to, with every snapshot and at the end; default: none, after Ctrl-C DIR/wrinkles.checkpoint");
    c->add_option("--resume", a.resume, "checkpoint to go on from; INPUT and all options must be given again as they were");
    return c;
}

bool run_wrinkles(wrinkles_arguments const& a) { return wrinkles_session(a).run(); }

}  // namespace weather
