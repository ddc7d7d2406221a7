// weather: weathers a rock. One subcommand per process; all share INPUT, -o DIR and the exit codes
// 0 (done), 1 (bad input), 2 (usage), 130 (stopped by Ctrl-C, resumable).
#include "frost_command.hpp"
#include "progress.hpp"
#include "spec.hpp"

#include <tafoni/core/error.hpp>
#include <tafoni/version.hpp>

#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>

namespace {

constexpr int exit_bad_input = 1;
constexpr int exit_usage = 2;
constexpr int exit_interrupted = 130;

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Weathers rock: frost wedging of a solid cut into shards."};
    app.require_subcommand(1);
    app.set_version_flag("--version", weather::version_text());
    weather::frost_arguments frost;
    CLI::App* const frost_command = weather::add_frost_command(app, frost);
    try {
        app.parse(argc, argv);
    } catch (CLI::ParseError const& e) {
        return app.exit(e) == 0 ? 0 : exit_usage;
    }
    weather::catch_interrupt();
    try {
        if (frost_command->parsed()) return weather::run_frost(frost) ? 0 : exit_interrupted;
    } catch (weather::usage_error const& e) {
        std::fprintf(stderr, "weather: %s\n", e.what());
        return exit_usage;
    } catch (tafoni::cancelled const&) {
        std::fprintf(stderr, "weather: stopped before the first path; nothing was written\n");
        return exit_interrupted;
    } catch (std::exception const& e) {
        std::fprintf(stderr, "weather: %s\n", e.what());
        return exit_bad_input;
    }
    return 0;
}
