#include "frost_session.hpp"

#include "input.hpp"
#include "marks.hpp"
#include "site_choice.hpp"

#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/graph/make_link_graph.hpp>
#include <tafoni/io/graph_vtp.hpp>
#include <tafoni/version.hpp>

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace weather {

using namespace tafoni;

namespace {

class stopwatch {
public:
    /// Seconds since it was made or asked last.
    double lap() {
        auto const now = std::chrono::steady_clock::now();
        double const s = std::chrono::duration<double>(now - start_).count();
        start_ = now;
        return s;
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

progress_style style_of(std::string const& name) {
    if (name == "json") return progress_style::json;
    if (name == "bar") return progress_style::bar;
    if (name == "auto") return ::isatty(2) != 0 ? progress_style::bar : progress_style::none;
    return progress_style::none;
}

std::string numbered(char const* prefix, std::uint64_t n, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%s%0*llu", prefix, digits, static_cast<unsigned long long>(n));
    return text;
}

nlohmann::ordered_json json_of(vec3 const& v) { return {v[0], v[1], v[2]}; }

/// Made only once the input has been accepted, so that a refused run leaves nothing behind.
std::filesystem::path made_folder(std::string const& name) {
    std::error_code error;
    std::filesystem::create_directories(name, error);
    if (error || !std::filesystem::is_directory(name)) {
        detail::fail<io_error>(errc::write_failed, name + ": cannot be made a folder", {.kind = entity::file, .file = name});
    }
    return name;
}

}  // namespace

frost_session::frost_session(frost_arguments const& a)
    : a_(a),
      progress_(style_of(a.progress)),
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
    prepare();
    run_type run(links_, make_process(), preset_.options);
    mark(run);
    if (!a_.resume.empty()) resume(run);
    else if (a_.paths > 0 && a_.water > 0) run.validate();
    std::filesystem::path const folder = made_folder(a_.output);
    vec3 origin{0, 0, 0};
    for (int k = 0; k < 3; ++k) origin[k] = std::floor(body_.bounds.lo[k]);
    out_ = output_folder(folder, a_.formats, origin);
    if (a_.snapshots > 0) made_folder((folder / "snapshots").string());
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
        std::string const name = numbered("frost_", n, 8) + ".vtp";
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
                                    return step_control::proceed;
                                }},
                               context, threads);
        add_history(run);
        stopped_ = r.stopped == stop_reason::observer || interrupted();
        if (r.stopped == stop_reason::first_break || r.stopped == stop_reason::first_detachment) break;
    }
    if (run.paths() >= a_.paths) stopped_ = false;
}

surface_colours frost_session::colours(run_type const& run) const {
    surface_colours c;
    c.life = [&run](link_index l) { return run.life(l); };
    c.exposed = [&run](link_index l) { return run.state(l) == link_state::skin; };
    c.cell_life.assign(shards_.cell_count(), 0);
    for (std::size_t i = 0; i < c.cell_life.size(); ++i) {
        double area = 0;
        double sum = 0;
        for (link_index const l : links_.links_of(cell_index{i})) {
            if (!links_.is_interior(l)) continue;
            area += links_.link_area(l);
            sum += links_.link_area(l) * run.life(l);
        }
        c.cell_life[i] = area > 0 ? sum / area : 1;
    }
    return c;
}

surface_mesh frost_session::standing(run_type const& run) const {
    std::vector<std::uint8_t> stands(shards_.cell_count());
    for (std::size_t c = 0; c < stands.size(); ++c) stands[c] = run.cells()[c] != cell_state::air ? 1 : 0;
    surface_mesh s;
    append_surface(s, extract_surface(shards_, std::span<std::uint8_t const>(stands)), links_, colours(run), 0);
    return s;
}

void frost_session::write_snapshot(run_type const& run) {
    std::string const name = numbered("frost_", run.paths(), 8);
    out_.write("snapshots/" + name, standing(run));
    series_.push_back({.time = static_cast<double>(run.paths()), .file = name + ".vtp"});
}

void frost_session::add_history(run_type const& run) {
    auto const r = run.report();
    double standing = 0;
    for (std::size_t c = 0; c < shards_.cell_count(); ++c) {
        if (run.cells()[c] != cell_state::air) standing += shards_.volumes[c];
    }
    char row[160];
    std::snprintf(row, sizeof row, "%llu,%llu,%llu,%.17g\n", static_cast<unsigned long long>(r.paths),
                  static_cast<unsigned long long>(r.links_broken), static_cast<unsigned long long>(r.cells_detached), standing);
    if (history_.empty() || history_.back() != row) history_.push_back(row);
}

void frost_session::write_blocks(run_type const& run) {
    surface_colours const look = colours(run);
    nlohmann::ordered_json manifest = nlohmann::ordered_json::array();
    surface_mesh all;
    if (a_.separate_blocks && !run.blocks().empty()) made_folder((out_.folder() / "blocks").string());
    for (std::size_t b = 0; b < run.blocks().size(); ++b) {
        detached_block const& block = run.blocks()[b];
        surface_mesh one;
        append_surface(a_.separate_blocks ? one : all, extract_surface(shards_, block.cells), links_, look, b);
        nlohmann::ordered_json entry{{"block", b}, {"path", block.path}, {"cells", block.cells.size()}, {"volume", block.volume}};
        if (a_.separate_blocks) {
            std::string const name = numbered("blocks/block_", b, 6);
            out_.write(name, one);
            entry["file"] = name;
        }
        manifest.push_back(std::move(entry));
    }
    if (!a_.separate_blocks) out_.write("blocks", all);
    out_.write_text("blocks.json", manifest.dump(1) + "\n");
}

void frost_session::write_graphs(run_type const& run) const {
    std::vector<double> life;
    std::vector<link_state> states;
    for (std::size_t l = 0; l < links_.link_count(); ++l) {
        life.push_back(run.life(link_index{l}));
        states.push_back(run.state(link_index{l}));
    }
    write_links(out_.folder() / "links.vtp", links_, {.life = life, .states = states});
    write_bonds(out_.folder() / "bonds.vtp", links_, shards_.centroids, {.life = life, .states = states});
    // The paths that would come next; looking changes nothing.
    std::size_t const count = 200;
    std::vector<std::vector<link_index>> ways(count);
    std::vector<std::vector<double>> left(count);
    std::vector<water_path> paths;
    std::vector<path_visit> visits;
    for (std::size_t k = 0; k < count; ++k) {
        visits.clear();
        path_trace const trace = run.trace(run.paths() + k, visits);
        if (!trace.entry.valid() || trace.inflow <= 0) continue;
        std::int64_t water = trace.inflow;
        ways[k].push_back(trace.entry);
        left[k].push_back(1);
        for (path_visit const& v : visits) {
            ways[k].push_back(v.link);
            left[k].push_back(static_cast<double>(water) / static_cast<double>(trace.inflow));
            water -= v.absorbed;
        }
        paths.push_back({.links = ways[k], .water = left[k]});
    }
    write_paths(out_.folder() / "paths.vtp", links_, std::span<water_path const>(paths));
}

void frost_session::write_results(run_type const& run) {
    progress_.show("write", 0);
    out_.write("weathered", standing(run));
    write_blocks(run);
    if (a_.graphs) write_graphs(run);
    std::string history = "paths,links_broken,cells_detached,volume_standing\n";
    for (std::string const& row : history_) history += row;
    out_.write_text("history.csv", history);
    std::string checkpoint = a_.checkpoint;
    if (checkpoint.empty() && stopped_) checkpoint = (out_.folder() / "frost.checkpoint").string();
    if (!checkpoint.empty()) {
        auto const bytes = run.checkpoint();
        detail::write_file("weather", checkpoint, {reinterpret_cast<char const*>(bytes.data()), bytes.size()});
        if (stopped_) std::fprintf(stderr, "stopped; go on with --resume %s\n", checkpoint.c_str());
    }
    // Last, so that it names only what is there.
    if (a_.snapshots > 0 && out_.writes("vtp")) write_pvd(out_.folder() / "snapshots" / "frost.pvd", series_);
    progress_.show("write", 1);
}

void frost_session::write_report(run_type const& run) {
    auto const r = run.report();
    char const* const reasons[] = {"finished", "first_break", "first_detachment", "interrupted"};
    auto core = a_.core;
    if (core.empty() && terrain_) core.push_back("artificial");
    nlohmann::ordered_json j;
    j["schema"] = "tafoni.weather.frost/1";
    j["version"] = version_string;
    j["process"] = "frost";
    j["input"] = a_.input;
    j["seed"] = a_.seed;
    j["parameters"] = {{"shards", a_.shards}, {"sites", a_.sites}, {"jitter", a_.jitter}, {"patch_angle", a_.patch_angle},
                       {"paths", a_.paths}, {"batch", a_.batch}, {"rain", json_of(rain_)}, {"spread", a_.spread},
                       {"water", a_.water}, {"absorb", a_.absorb}, {"gravity", json_of(gravity_)},
                       {"resistance", a_.resistance}, {"core", core}, {"air", a_.air}, {"preset", a_.preset},
                       {"snapshots", a_.snapshots}, {"format", a_.formats}, {"separate_blocks", a_.separate_blocks}};
    auto const& absorption = run.process().absorb.absorption;
    auto const& soaking = run.process().absorb.soaking;
    auto const& breakage = run.process().wear.breakage;
    auto const& flow = run.process().flow.flow;
    // k_solid, k_air and k_dmg are those for a link of the mean area.
    j["coefficients"] = {{"mean_area", run.scale().mean_area}, {"k_solid", absorption.k_solid}, {"k_air", absorption.k_air},
                         {"k_res", absorption.k_res}, {"k_dmg", run.process().wear.harm.k_dmg},
                         {"resistance_weight", flow.resistance_weight}, {"alignment_cutoff", flow.alignment_cutoff},
                         {"passage_floor", flow.passage_floor}, {"exit_weight", flow.exit_weight},
                         {"entry_cutoff", run.process().rain.infiltration.cutoff}, {"soak_threshold", soaking.threshold},
                         {"soak_continue_chance", soaking.continue_chance}, {"soak_wearing", soaking.wearing},
                         {"k_break", breakage.k_break}, {"break_p_max", breakage.p_max}, {"break_p_min", breakage.p_min}};
    j["bounds"] = {{"lo", json_of(body_.bounds.lo)}, {"hi", json_of(body_.bounds.hi)}};
    j["threads"] = a_.threads;
    j["stopped"] = reasons[stopped_ ? 3 : r.paths < a_.paths ? static_cast<int>(r.stopped) : 0];
    j["repaired"] = repaired_;
    j["sites"] = site_count_;
    j["cells"] = shards_.cell_count();
    j["cells_core"] = core_cells_;
    j["cells_air_at_start"] = air_cells_;
    j["links_interior"] = links_.interior_link_count();
    j["links_exterior"] = links_.exterior_link_count();
    j["volume_solid"] = body_.volume;
    double cells = 0;
    for (double const v : shards_.volumes) cells += v;
    j["volume_cells"] = cells;
    j["paths"] = r.paths;
    j["paths_without_entry"] = r.paths_without_entry;
    j["links_traversed"] = r.links_traversed;
    j["links_broken"] = r.links_broken;
    j["cells_detached"] = r.cells_detached;
    j["blocks"] = r.blocks;
    j["volume_detached"] = r.volume_detached;
    j["water"] = {{"in", r.water_in}, {"absorbed", r.water_absorbed}, {"lost", r.water_lost}, {"drained", r.water_drained}};
    j["seconds"] = seconds_;
    out_.write_text("report.json", j.dump(2) + "\n");
}

}  // namespace weather
