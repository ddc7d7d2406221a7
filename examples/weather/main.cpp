// weather: weathers a rock. One subcommand per process; all share INPUT, -o DIR and the exit codes
// 0 (done), 1 (bad input), 2 (usage), 130 (stopped by Ctrl-C, resumable).
#include "curvature_command.hpp"
#include "frost_command.hpp"
#include "hydraulic_command.hpp"
#include "progress.hpp"
#include "spec.hpp"
#include "voxel_command.hpp"
#include "wrinkles_command.hpp"

#include <tafoni/core/error.hpp>
#include <tafoni/version.hpp>

#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <string>
#include <string_view>

namespace {

constexpr int exit_bad_input = 1;
constexpr int exit_usage = 2;
constexpr int exit_interrupted = 130;

/// What the tool's own files are refused with begins with its name already.
void tell(std::string_view what) {
    constexpr std::string_view own = "weather: ";
    if (what.substr(0, own.size()) == own) what.remove_prefix(own.size());
    std::fprintf(stderr, "weather: %.*s\n", static_cast<int>(what.size()), what.data());
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Weathers rock: frost wedges shards off, bubbles of air round edges off and hollow caverns out, meshes wear by "
                 "their curvature and under running water, wrinkles fold and crack them."};
    app.require_subcommand(1);
    app.set_version_flag("--version", weather::version_text());
    weather::frost_arguments frost;
    CLI::App* const frost_command = weather::add_frost_command(app, frost);
    weather::voxel_arguments voxel;
    CLI::App* const voxel_command = weather::add_voxel_command(app, voxel);
    weather::curvature_arguments curvature;
    CLI::App* const curvature_command = weather::add_curvature_command(app, curvature);
    weather::hydraulic_arguments hydraulic;
    CLI::App* const hydraulic_command = weather::add_hydraulic_command(app, hydraulic);
    weather::wrinkles_arguments wrinkles;
    CLI::App* const wrinkles_command = weather::add_wrinkles_command(app, wrinkles);
    if (argc > 1 && argv[1][0] != '-') {
        std::string names;
        bool known = false;
        for (CLI::App const* c : app.get_subcommands([](CLI::App*) { return true; })) {
            names += (names.empty() ? "" : ", ") + c->get_name();
            known = known || c->get_name() == argv[1];
        }
        if (!known) {
            tell("'" + std::string(argv[1]) + "' is none of " + names);
            return exit_usage;
        }
    }
    try {
        app.parse(argc, argv);
    } catch (CLI::ParseError const& e) {
        return app.exit(e) == 0 ? 0 : exit_usage;
    }
    weather::catch_interrupt();
    try {
        if (frost_command->parsed()) return weather::run_frost(frost) ? 0 : exit_interrupted;
        if (voxel_command->parsed()) return weather::run_voxel(voxel) ? 0 : exit_interrupted;
        if (curvature_command->parsed()) return weather::run_curvature(curvature) ? 0 : exit_interrupted;
        if (hydraulic_command->parsed()) return weather::run_hydraulic(hydraulic) ? 0 : exit_interrupted;
        if (wrinkles_command->parsed()) return weather::run_wrinkles(wrinkles) ? 0 : exit_interrupted;
    } catch (weather::usage_error const& e) {
        tell(e.what());
        return exit_usage;
    } catch (tafoni::cancelled const&) {
        std::fprintf(stderr, "weather: stopped before the work began; nothing was written\n");
        return exit_interrupted;
    } catch (std::exception const& e) {
        tell(e.what());
        return exit_bad_input;
    }
    return 0;
}
