// What a run leaves behind: surfaces, blocks, graphs, history, report.
#include "frost_session.hpp"

#include <tafoni/core/elementary.hpp>
#include <tafoni/decomposition/displaced_faces.hpp>
#include <tafoni/field/fractal_noise.hpp>
#include <tafoni/field/remapped.hpp>
#include <tafoni/io/graph_vtp.hpp>
#include <tafoni/version.hpp>

#include <algorithm>
#include <cstdio>

namespace weather {

using namespace tafoni;

namespace {

nlohmann::ordered_json json_of(vec3 const& v) { return {v[0], v[1], v[2]}; }

}  // namespace

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

shard_surface frost_session::roughened(shard_surface surface) const {
    if (a_.roughness == 0) return surface;
    // Of the mean shard; the noise has waves as long as a shard and finer ones.
    double const width = elementary::pow(body_.volume / static_cast<double>(std::max<std::size_t>(shards_.cell_count(), 1)), 1.0 / 3);
    fractal_noise const noise{.seed = a_.seed, .frequency = 1 / width, .octaves = 4, .gain = 0.55};
    field_displacement const crack{remapped{noise, -0.5, 0.5, 0.0, 1.0}, a_.roughness * width, vec3{17 * width, 31 * width, 53 * width}};
    return displaced_faces(std::move(surface), crack, {.edge_length = 0.25 * width, .max_halvings = 4});
}

surface_mesh frost_session::standing(run_type const& run) const {
    std::vector<std::uint8_t> stands(shards_.cell_count());
    for (std::size_t c = 0; c < stands.size(); ++c) stands[c] = run.cells()[c] != cell_state::air ? 1 : 0;
    surface_mesh s;
    append_surface(s, roughened(extract_surface(shards_, std::span<std::uint8_t const>(stands))), links_, colours(run), 0);
    return s;
}

void frost_session::write_snapshot(run_type const& run) {
    std::string const name = numbered_name("frost_", run.paths(), 8);
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

void frost_session::write_history() const {
    std::string history = "paths,links_broken,cells_detached,volume_standing\n";
    for (std::string const& row : history_) history += row;
    out_.write_text("history.csv", history);
}

void frost_session::write_checkpoint(run_type const& run, std::string const& path) const {
    auto const bytes = run.checkpoint();
    detail::write_file("weather", path, {reinterpret_cast<char const*>(bytes.data()), bytes.size()});
}

void frost_session::write_blocks(run_type const& run) {
    surface_colours const look = colours(run);
    nlohmann::ordered_json manifest = nlohmann::ordered_json::array();
    surface_mesh all;
    if (a_.separate_blocks && !run.blocks().empty()) made_folder((out_.folder() / "blocks").string());
    for (std::size_t b = 0; b < run.blocks().size(); ++b) {
        detached_block const& block = run.blocks()[b];
        surface_mesh one;
        append_surface(a_.separate_blocks ? one : all, roughened(extract_surface(shards_, block.cells)), links_, look, b);
        nlohmann::ordered_json entry{{"block", b}, {"path", block.path}, {"cells", block.cells.size()}, {"volume", block.volume}};
        if (a_.separate_blocks) {
            std::string const name = numbered_name("blocks/block_", b, 6);
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
    write_history();
    std::string checkpoint = a_.checkpoint;
    if (checkpoint.empty() && stopped_) checkpoint = (out_.folder() / "frost.checkpoint").string();
    if (!checkpoint.empty()) write_checkpoint(run, checkpoint);
    if (stopped_) std::fprintf(stderr, "stopped; go on with --resume %s\n", checkpoint.c_str());
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
                       {"snapshots", a_.snapshots}, {"format", a_.formats}, {"roughness", a_.roughness}, {"separate_blocks", a_.separate_blocks}};
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
