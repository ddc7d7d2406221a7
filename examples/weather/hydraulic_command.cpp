#include "hydraulic_command.hpp"

#include "hydraulic_session.hpp"
#include "mesh_options.hpp"

#include <string>

namespace weather {

CLI::App* add_hydraulic_command(CLI::App& app, hydraulic_arguments& a) {
    CLI::App* const c = app.add_subcommand("hydraulic", "Erosion of a mesh by running water: particles flow, take rock along and lay it down");
    c->footer(std::string(mesh_footer) + field_footer +
              "Defaults depend on the longest side L of INPUT: gravity is 10 L / s^2 downwards and water rises above the\n"
              "model, so that a result does not depend on its unit; give --gravity and the rest for a model in metres.\n"
              "Options that have no effect with the others are named on stderr and in report.json.\n" + result_footer +
              "Exit codes: 0 done, 1 bad input, 2 usage, 130 stopped by Ctrl-C (a checkpoint is written, see --checkpoint).");
    add_mesh_input(*c, a);
    c->add_option("--model", a.model, "partheniades: k (tau - tau_c)^a with tau = K theta^m; curvature: ridges under water first")
        ->check(CLI::IsMember({"partheniades", "curvature"}))->capture_default_str();
    c->add_option("--iterations", a.iterations, "steps of the water, in all, those before --resume included")->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 62))->capture_default_str();
    c->add_option("--fluid", a.fluid, "rain: drops that fall and run off; sph: water with pressure")->check(CLI::IsMember(hydraulic_fluids()))->capture_default_str();
    c->add_option("--particles", a.particles, "of water; default: half of the vertices, from 10000 to 100000")->check(CLI::Range(1u, 1u << 24));
    c->add_option("--emitter", a.emitter, "BOX x0,y0,z0,x1,y1,z1 that water starts in; default: above the model");
    c->add_option("--velocity", a.velocity, "x,y,z of new water, length unit / s")->capture_default_str();
    c->add_option("--gravity", a.gravity, "x,y,z, length unit / s^2; default: 10 L downwards");
    add_up(*c, a.up);
    c->add_option("--radius", a.radius, "at which a particle touches rock; default: the mean edge")->check(between(1e-300, 1e100));
    c->add_option("--friction", a.friction, "share of the velocity lost on rock per second; default: of rain by gravity and L, of sph sqrt(g / radius) / 4, which holds "
                  "streams on slopes at a Froude number of 4 sin(slope)")->check(between(0.0, 1e6));
    c->add_option("--lifetime", a.lifetime, "of rain: seconds until a drop seeps away; default: by gravity and L")->check(between(1e-12, 1e12));
    c->add_option("--adhesion", a.adhesion, "of rain: pull of rock on a drop that touches it, over gravity; default: 0.8")->check(between(0.0, 10.0));
    c->add_option("--frame", a.frame, "seconds that an iteration takes; 0: one stable step; default: 0, with sph by gravity and L")->check(between(0.0, 1e12));
    c->add_option("--viscosity", a.viscosity, "of sph: length unit^2 / s; default: by gravity and L")->check(between(0.0, 1e100));
    c->add_option("--sound-speed", a.sound_speed, "of sph, length unit / s: 10 times the fastest that water gets; default: by gravity and the emitter's velocity")->check(between(1e-100, 1e100));
    c->add_option("--k", a.k, "FIELD, erosion rate of partheniades; default: by gravity and L, with sph and the radius");
    c->add_option("--tau-c", a.tau_c, "FIELD, stress below which particles lay down; default: by gravity and L, with sph by gravity and the radius");
    c->add_option("--a", a.a, "FIELD, exponent of the stress")->capture_default_str();
    c->add_option("--K", a.K, "FIELD, consistency of the fluid")->capture_default_str();
    c->add_option("--m", a.m, "FIELD, power of the shear rate: 1 water, below 1 mud that thins")->capture_default_str();
    c->add_option("--influence", a.influence, "of model curvature: distance that a particle acts over; default: the mean edge (a flood: 3 of them), with sph and the radius that it rests off rock")->check(between(1e-300, 1e100));
    c->add_option("--power", a.power, "of model curvature: of the curvature")->check(between(1.0, 100.0))->capture_default_str();
    add_estimator(*c, a.estimator);
    c->add_option("--durability", a.durability, "FIELD that divides the erosion of either model")->capture_default_str();
    c->add_option("--step", a.step, "no vertex moves farther in an iteration than the mean edge over this; default: 10, with sph, whose steps are short, 100")->check(between(1.0, 1e100));
    c->add_option("--refine", a.refine, "edges under water longer than this are split; 0: none")->check(between(0.0, 1e100))->capture_default_str();
    c->add_option("--check-every", a.check_every, "iterations between looks at the walls around moving vertices, so that they do not cut each other; 20 adds about a quarter to the time; 0: never")->capture_default_str();
    add_mesh_run(*c, a);
    c->add_option("--snapshots", a.snapshots, "write a snapshot every so many iterations; 0: none")->capture_default_str();
    c->add_flag("--particles-out", a.particles_out, "write the particles too, as points with velocities vx, vy, vz: water.vtp, and snapshots/water_%08d.vtp with every snapshot");
    c->add_option("--checkpoint", a.checkpoint, "file to save the state to, with every snapshot and at the end; default: none, after Ctrl-C DIR/hydraulic.checkpoint");
    c->add_option("--resume", a.resume, "checkpoint to go on from");
    return c;
}

bool run_hydraulic(hydraulic_arguments const& a) { return hydraulic_session(a).run(); }

}  // namespace weather
