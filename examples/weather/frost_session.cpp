#include "frost_session.hpp"

#include "input.hpp"
#include "marks.hpp"
#include "site_choice.hpp"

#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/graph/make_link_graph.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace weather {

using namespace tafoni;

frost_session::frost_session(frost_arguments const& a)
    : a_(a),
      progress_(progress_style_of(a.progress)),
      gravity_(parse_direction("--gravity", a.gravity)),
      up_(-gravity_),
      preset_(a.preset == "addon" ? addon_preset() : paper_preset()),
      out_(a.output, a.formats, vec3{0, 0, 0}) {
    rain_ = a.preset == "paper" ? gravity_ : preset_.process.rain.rain.direction;
    if (!a.rain.empty()) rain_ = parse_direction("--rain", a.rain);
    preset_.options.seed = a.seed;
    preset_.options.water = a.water;
    // A SPEC that cannot be read is told before the work begins.
    for (auto const* const list : {&a_.core, &a_.air}) {
        for (std::string const& text : *list) static_cast<void>(spec::parse(list == &a_.core ? "--core" : "--air", text));
    }
    static_cast<void>(spec::parse("--resistance", a.resistance));
}

bool frost_session::run() {
    require_makable(a_.output);
    if (!a_.checkpoint.empty()) {
        std::filesystem::path const folder = std::filesystem::path(a_.checkpoint).parent_path();
        require_makable(folder.empty() ? "." : folder.string());
    }
    prepare();
    run_type run(links_, make_process(), preset_.options);
    mark(run);
    if (!a_.resume.empty()) resume(run);
    else if (a_.paths > 0 && a_.water > 0) run.validate();
    // Made only now that the input has been accepted, so that a refused run leaves nothing behind.
    std::filesystem::path const folder = made_folder(a_.output);
    vec3 origin{0, 0, 0};
    for (int k = 0; k < 3; ++k) origin[k] = std::floor(body_.bounds.lo[k]);
    out_ = output_folder(folder, a_.formats, origin);
    if (a_.snapshots > 0) made_folder((folder / "snapshots").string());
    out_.remove_old("frost", [&](std::uint64_t n) { return !a_.resume.empty() && n <= run.paths(); });
    stopwatch watch;
    weather(run);
    seconds_["weather"] = watch.lap();
    write_results(run);
    seconds_["write"] = watch.lap();
    write_report(run);
    auto const r = run.report();
    std::fprintf(stderr, "%s: %zu shards, %llu paths, %llu links broken, %llu cells in %llu blocks fell\n",
                 a_.output.c_str(), shards_.cell_count(), static_cast<unsigned long long>(r.paths),
                 static_cast<unsigned long long>(r.links_broken), static_cast<unsigned long long>(r.cells_detached),
                 static_cast<unsigned long long>(r.blocks));
    return !stopped_;
}

void frost_session::prepare() {
    stopwatch watch;
    progress_.context().tick("read", 0);
    rock_input rock = load_rock(a_.input, a_.seed);
    body_ = std::move(rock.body);
    terrain_ = rock.terrain;
    repaired_ = std::move(rock.repaired);
    progress_.context().tick("read", 1);
    seconds_["read"] = watch.lap();

    thread_pool const threads(a_.threads);
    auto const sites = choose_sites(a_.sites, body_, a_.shards, a_.jitter, up_, a_.seed);
    site_count_ = sites.size();
    shards_ = voronoi_shards(body_, sites,
                             {.duplicates = duplicate_sites::merge, .outside = outside_sites::drop, .patch_angle = a_.patch_angle},
                             threads, progress_.context());
    repaired_["merged_sites"] = shards_.merged_sites;
    repaired_["sites_outside"] = shards_.dropped_sites;
    repaired_["merged_slivers"] = shards_.merged_slivers;
    for (auto const& [what, count] : repaired_.items()) {
        if (count != 0) std::fprintf(stderr, "repaired: %s %s\n", count.dump().c_str(), what.c_str());
    }
    seconds_["shards"] = watch.lap();
    links_ = make_link_graph(shards_, {}, threads, progress_.context());
    seconds_["graphs"] = watch.lap();
}

frost_session::process frost_session::make_process() const {
    process p;
    p.rain.rain = {.axis = rain_, .spread = a_.spread};
    p.rain.infiltration = preset_.process.rain.infiltration;
    p.flow.flow = preset_.process.flow.flow;
    p.flow.flow.down = gravity_;
    p.flow.resistance = make_resistance(a_.resistance, body_, up_, a_.seed);
    p.absorb = preset_.process.absorb;
    p.absorb.absorption.k_solid *= a_.absorb;
    p.absorb.absorption.k_air *= a_.absorb;
    p.absorb.absorption.k_res *= a_.absorb;
    p.wear = preset_.process.wear;
    return p;
}

void frost_session::mark(run_type& run) {
    auto core = a_.core;
    if (core.empty() && terrain_) core.push_back("artificial");
    for (std::string const& text : core) run.mark(choose_cells("--core", text, shards_, links_, up_), cell_state::core);
    for (std::string const& text : a_.air) run.mark(choose_cells("--air", text, shards_, links_, up_), cell_state::air);
    for (cell_state const s : run.cells()) {
        core_cells_ += s == cell_state::core ? 1 : 0;
        air_cells_ += s == cell_state::air ? 1 : 0;
    }
}

void frost_session::resume(run_type& run) {
    std::string const bytes = load_bytes(a_.resume);
    std::vector<cell_state> const marked(run.cells().begin(), run.cells().end());
    run.resume(std::as_bytes(std::span(bytes.data(), bytes.size())));
    for (std::size_t c = 0; c < marked.size(); ++c) {
        cell_state const now = run.cells()[c];
        bool const fits = marked[c] == cell_state::solid ? now != cell_state::core : now == marked[c];
        if (!fits) {
            detail::fail<io_error>(errc::checkpoint_mismatch, a_.resume + ": was made with other --core or --air marks",
                                   {.kind = entity::file, .file = a_.resume});
        }
    }
    if (run.paths() > a_.paths) {
        throw usage_error("--paths " + std::to_string(a_.paths) + ": the checkpoint has " + std::to_string(run.paths()));
    }
}

void frost_session::weather(run_type& run) {
    thread_pool const threads(a_.threads);
    // About 200 rows of history, at numbers of paths that do not depend on where a run was resumed.
    std::uint64_t const step = std::max<std::uint64_t>(1, (a_.paths / 200 + a_.batch) / a_.batch) * a_.batch;
    history_.clear();
    std::string row;
    for (char const c : a_.resume.empty() ? std::string() : out_.read_text("history.csv")) {
        row += c;
        if (c != '\n') continue;
        if (row[0] >= '0' && row[0] <= '9' && std::strtoull(row.c_str(), nullptr, 10) < run.paths()) history_.push_back(row);
        row.clear();
    }
    series_.clear();
    for (std::uint64_t n = 0; a_.snapshots > 0 && n < run.paths(); n += a_.snapshots) {
        std::string const name = numbered_name("frost_", n, 8) + ".vtp";
        if (std::filesystem::exists(out_.folder() / "snapshots" / name)) {
            series_.push_back({.time = static_cast<double>(n), .file = name});
        }
    }
    add_history(run);
    if (a_.snapshots > 0 && run.paths() % a_.snapshots == 0) write_snapshot(run);
    run_context const context{.on_progress = [&](progress_event const&) {
        auto const r = run.report();
        double const fraction = a_.paths == 0 ? 1 : static_cast<double>(r.paths) / static_cast<double>(a_.paths);
        return progress_.show("weather", fraction,
                              std::to_string(r.paths) + " paths, " + std::to_string(r.links_broken) + " broken, " +
                                  std::to_string(r.cells_detached) + " fallen");
    }};
    while (run.paths() < a_.paths && !stopped_) {
        std::uint64_t const next = std::min(a_.paths, (run.paths() / step + 1) * step);
        auto const r = run.run({.paths = next - run.paths(),
                                .batch = a_.batch,
                                .stop = a_.stop_at_break  ? stop_when::first_break
                                        : a_.stop_at_fall ? stop_when::first_detachment
                                                          : stop_when::never,
                                .snapshot_every = a_.snapshots,
                                .on_snapshot = [&](std::uint64_t) {
                                    write_snapshot(run);
                                    write_history();
                                    if (!a_.checkpoint.empty()) write_checkpoint(run, a_.checkpoint);
                                    return step_control::proceed;
                                }},
                               context, threads);
        add_history(run);
        stopped_ = r.stopped == stop_reason::observer || interrupted();
        if (r.stopped == stop_reason::first_break || r.stopped == stop_reason::first_detachment) break;
    }
    if (run.paths() >= a_.paths) stopped_ = false;
}

}  // namespace weather
