#include "curvature_command.hpp"

#include "curvature_session.hpp"
#include "mesh_options.hpp"

#include <string>

namespace weather {

CLI::App* add_curvature_command(CLI::App& app, curvature_arguments& a) {
    CLI::App* const c = app.add_subcommand("curvature", "Weathering of a mesh by its mean curvature: what sticks out goes first");
    c->footer(std::string(mesh_footer) + field_footer + result_footer +
              "Exit codes: 0 done, 1 bad input, 2 usage, 130 stopped by Ctrl-C (a checkpoint is written, see --checkpoint).");
    add_mesh_input(*c, a);
    c->add_option("--iterations", a.iterations, "in all, those before --resume included")->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 62))->capture_default_str();
    c->add_option("--power", a.power, "of the curvature: larger spares what is flat")->check(between(1.0, 100.0))->capture_default_str();
    c->add_option("--step", a.step, "no vertex moves farther in an iteration than the mean edge over this")->check(between(1.0, 1e100))->capture_default_str();
    add_estimator(*c, a.estimator);
    c->add_option("--ball", a.ball, "radius of the bubble estimator; 0: three mean edges")->check(between(0.0, 1e100))->capture_default_str();
    c->add_option("--direction", a.direction, "in which vertices move: laplacian, normal or blend")->check(CLI::IsMember({"laplacian", "normal", "blend"}))->capture_default_str();
    c->add_option("--durability", a.durability, "FIELD that divides the displacement")->capture_default_str();
    c->add_flag("--keep-topology", a.keep_topology, "vertices and triangles keep their numbers; no small faces are removed");
    c->add_option("--small-edge", a.small_edge, "edges below this share of the mean edge are removed")->check(between(0.0, 0.5))->capture_default_str();
    c->add_option("--check-every", a.check_every, "iterations between searches for triangles that cut each other; 0: never")->capture_default_str();
    c->add_option("--retries", a.retries, "how often in a row the surface may be taken back where a search finds some")->check(CLI::Range(0u, 60u))->capture_default_str();
    c->add_option("--hold-after", a.hold_after, "halvings of the step after which vertices that still cut are held still; as many as --retries: never")->check(CLI::Range(0u, 60u))->capture_default_str();
    c->add_flag("--map", a.map, "write map.txt: the vertex now of each vertex of INPUT, one per line");
    add_up(*c, a.up);
    add_mesh_run(*c, a);
    c->add_option("--snapshots", a.snapshots, "write a snapshot every so many iterations; 0: none")->capture_default_str();
    c->add_option("--checkpoint", a.checkpoint, "file to save the state to, with every snapshot and at the end; default: none, after Ctrl-C DIR/curvature.checkpoint");
    c->add_option("--resume", a.resume, "checkpoint to go on from; INPUT and all options must be given again as they were");
    return c;
}

bool run_curvature(curvature_arguments const& a) { return curvature_session(a).run(); }

}  // namespace weather
