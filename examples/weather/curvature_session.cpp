#include "curvature_session.hpp"

#include "field_choice.hpp"
#include "input.hpp"
#include "notes.hpp"
#include "spec.hpp"

#include <tafoni/io/curvature_channels.hpp>
#include <tafoni/version.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>

namespace weather {

using namespace tafoni;

namespace {

constexpr double least_durability = curvature_weathering<>::least_durability;

char const* reason(curvature_stop s, bool interrupted) {
    if (interrupted) return "interrupted";
    if (s == curvature_stop::self_intersection) return "self_intersection";
    return s == curvature_stop::worn_away ? "worn_away" : "finished";
}

}  // namespace

curvature_session::curvature_session(curvature_arguments const& a)
    : a_(a), progress_(progress_style_of(a.progress)), threads_(a.threads), out_(a.output, a.formats, vec3{0, 0, 0}) {
    // A FIELD that cannot be read is told before the work begins.
    box3 const any{.lo = {0, 0, 0}, .hi = {1, 1, 1}};
    static_cast<void>(make_field("--durability", a_.durability, least_durability, 1e9, {.bounds = any, .up = parse_up(a_.up), .seed = a_.seed}));
    if (a_.estimator != "bubble") unused_.tell("without --estimator bubble", {{"--ball", a_.ball > 0}});
    if (a_.keep_topology) unused_.tell("with --keep-topology", {{"--small-edge", a_.small_edge != curvature_arguments{}.small_edge}});
    if (a_.check_every == 0) {
        unused_.tell("without --check-every", {{"--retries", a_.retries != curvature_arguments{}.retries}, {"--hold-after", a_.hold_after != curvature_arguments{}.hold_after}});
    }
}

bool curvature_session::run() {
    require_makable(a_.output);
    if (!a_.checkpoint.empty()) {
        std::filesystem::path const folder = std::filesystem::path(a_.checkpoint).parent_path();
        require_makable(folder.empty() ? "." : folder.string());
    }
    stopwatch watch;
    progress_.context().tick("read", 0);
    input_ = load_surface(a_.input, a_.seed);
    tell_repairs(input_);
    progress_.context().tick("read", 1);
    seconds_["read"] = watch.lap();
    durability_ = make_field("--durability", a_.durability, least_durability, 1e9,
                             {.bounds = input_.bounds, .up = parse_up(a_.up), .seed = a_.seed});
    double const rim = 1e-12 * input_.size;
    if (a_.direction == "normal") {
        if (input_.terrain) run_with(within_sides<inward_normal>{{}, input_.bounds, rim});
        else run_with(inward_normal{});
    } else if (a_.direction == "blend") {
        if (input_.terrain) run_with(within_sides<blended_direction>{{}, input_.bounds, rim});
        else run_with(blended_direction{});
    } else if (input_.terrain) {
        run_with(within_sides<laplacian_direction>{{}, input_.bounds, rim});
    } else {
        run_with(laplacian_direction{});
    }
    return !stopped_;
}

template <class Direction>
void curvature_session::run_with(Direction direction) {
    any_estimator estimator = parse_estimator(a_.estimator);
    estimator.radius = a_.ball;
    curvature_options const options{.power = a_.power, .step_divisor = a_.step, .small_edge = a_.small_edge,
                                    .topology = a_.keep_topology ? mesh_topology::keep : mesh_topology::adapt,
                                    .check_every = a_.check_every, .retries = a_.retries, .hold_after = a_.hold_after};
    curvature_run run(input_.surface, curvature_weathering{.estimator = estimator, .direction = direction, .durability = durability_}, options);
    if (!a_.resume.empty()) {
        std::string const bytes = load_bytes(a_.resume);
        try {
            run.resume(std::as_bytes(std::span(bytes.data(), bytes.size())));
        } catch (io_error const& e) {
            detail::fail<io_error>(e.code(), a_.resume + ": " + e.what(), {.kind = entity::file, .file = a_.resume});
        }
        if (run.report().iterations > a_.iterations) {
            throw usage_error("--iterations " + std::to_string(a_.iterations) + ": the checkpoint has " +
                              std::to_string(run.report().iterations));
        }
    }
    // Made only now that the input has been accepted, so that a refused run leaves nothing behind.
    std::filesystem::path const folder = made_folder(a_.output);
    vec3 origin{0, 0, 0};
    for (int k = 0; k < 3; ++k) origin[k] = std::floor(input_.bounds.lo[k]);
    out_ = output_folder(folder, a_.formats, origin);
    if (a_.snapshots > 0) made_folder((folder / "snapshots").string());
    std::uint64_t const begin = run.report().iterations;
    out_.remove_old("curvature", [&](std::uint64_t n) { return !a_.resume.empty() && n <= begin; });
    stopwatch watch;
    weather(run);
    seconds_["weather"] = watch.lap() - aside_;
    write_results(run);
    seconds_["write"] = watch.lap() + aside_;
    cut_counts const cuts = cut_counts::of(input_.surface, run.surface());
    seconds_["check"] = watch.lap();
    write_report(run, cuts);
    curvature_report const& r = run.report();
    std::fprintf(stderr, "%s: %llu iterations, %zu vertices, %llu edges collapsed, volume less by %.4g\n", a_.output.c_str(),
                 static_cast<unsigned long long>(r.iterations), run.surface().positions.size(),
                 static_cast<unsigned long long>(r.edges_collapsed), r.removed_volume);
    cuts.tell(a_.check_every == 0 ? "--check-every 10 prevents it" : "a smaller --check-every may help");
    if (r.held > 0) {
        std::fprintf(stderr, "%llu vertices were held still, where triangles would have cut each other\n", static_cast<unsigned long long>(r.held));
    }
    if (r.stopped == curvature_stop::self_intersection) {
        std::fprintf(stderr,
                     "ended early, after %llu of %llu iterations: triangles would cut each other, however short the step; what may help: "
                     "--estimator quadric, shorter steps (--step %g), a smaller --check-every, more --retries\n",
                     static_cast<unsigned long long>(r.iterations), static_cast<unsigned long long>(a_.iterations), 3 * a_.step);
    } else if (r.stopped == curvature_stop::worn_away && r.iterations < a_.iterations) {
        std::fprintf(stderr, "ended early, after %llu of %llu iterations: nothing is left that curvature moves\n",
                     static_cast<unsigned long long>(r.iterations), static_cast<unsigned long long>(a_.iterations));
    }
}

template <class Run>
void curvature_session::weather(Run& run) {
    if (!a_.resume.empty()) {
        history_.recall(out_, run.report().iterations);
        series_.recall(out_, a_.snapshots, run.report().iterations);
    }
    std::uint64_t const begin = run.report().iterations;
    std::uint64_t last = ~std::uint64_t{0};
    run_context const context{.on_progress = [&](progress_event const&) {
        std::uint64_t const n = run.report().iterations;
        if (n != last) {
            last = n;
            stopwatch watch;
            if (history_table::has_row(n)) add_history(run);
            if (a_.snapshots > 0 && n % a_.snapshots == 0) {
                series_.write(out_, n, surface(run));
                history_.write(out_);
                if (!a_.checkpoint.empty()) write_checkpoint(run, a_.checkpoint);
            }
            aside_ += watch.lap();
        }
        double const share = a_.iterations == 0 ? 1 : static_cast<double>(n) / static_cast<double>(a_.iterations);
        return progress_.show("weather", share, std::to_string(n) + " iterations");
    }};
    curvature_report const r = run.run(a_.iterations - begin, context, threads_);
    stopped_ = r.stopped == curvature_stop::observer && r.iterations < a_.iterations;
}

template <class Run>
surface_mesh curvature_session::surface(Run& run) {
    return mesh_with(run.surface(), channels_of(run, threads_).vertex_channels);
}

template <class Run>
void curvature_session::add_history(Run& run) {
    triangle_surface const s = run.surface();
    curvature_report const& r = run.report();
    history_.add(std::to_string(r.iterations) + "," + std::to_string(s.positions.size()) + "," + std::to_string(s.triangles.size()) + "," +
                 std::to_string(r.edges_collapsed) + "," + text_of(volume_of(s, input_.bounds)));
}

template <class Run>
void curvature_session::write_checkpoint(Run const& run, std::string const& path) const {
    auto const bytes = run.checkpoint();
    detail::write_file("weather", path, {reinterpret_cast<char const*>(bytes.data()), bytes.size()});
}

template <class Run>
void curvature_session::write_results(Run& run) {
    progress_.show("write", 0);
    add_history(run);
    out_.write("weathered", surface(run));
    history_.write(out_);
    if (a_.map) {
        std::string text;
        for (vertex_index const v : run.new_vertex()) text += std::to_string(v.value) + "\n";
        out_.write_text("map.txt", text);
    }
    std::string checkpoint = a_.checkpoint;
    if (checkpoint.empty() && stopped_) checkpoint = (out_.folder() / "curvature.checkpoint").string();
    if (!checkpoint.empty()) write_checkpoint(run, checkpoint);
    if (stopped_) std::fprintf(stderr, "stopped; go on with --resume %s\n", checkpoint.c_str());
    // Last, so that it names only what is there.
    if (a_.snapshots > 0 && out_.writes("vtp")) series_.finish(out_);
    progress_.show("write", 1);
}

template <class Run>
void curvature_session::write_report(Run& run, cut_counts const& cuts) const {
    curvature_report const& r = run.report();
    triangle_surface const s = run.surface();
    std::vector<double> const wear = run.wear();
    nlohmann::ordered_json j;
    j["schema"] = "tafoni.weather.curvature/1";
    j["version"] = version_string;
    j["process"] = "curvature";
    j["input"] = a_.input;
    j["seed"] = a_.seed;
    j["parameters"] = {{"iterations", a_.iterations}, {"power", a_.power}, {"step", a_.step}, {"estimator", a_.estimator},
                       {"ball", a_.estimator == "bubble" && a_.ball == 0 ? 3 * input_.mean_edge() : a_.ball}, {"direction", a_.direction},
                       {"durability", a_.durability}, {"keep_topology", a_.keep_topology}, {"small_edge", a_.small_edge},
                       {"check_every", a_.check_every}, {"retries", a_.retries}, {"hold_after", a_.hold_after}, {"up", a_.up}, {"snapshots", a_.snapshots},
                       {"format", a_.formats}};
    j["unused"] = unused_.json();
    j["mesh"] = json_of(input_);
    j["bounds"] = {{"lo", json_of(input_.bounds.lo)}, {"hi", json_of(input_.bounds.hi)}};
    j["threads"] = a_.threads;
    j["stopped"] = reason(r.stopped, stopped_);
    j["repaired"] = input_.repaired;
    j["iterations"] = r.iterations;
    j["vertices"] = s.positions.size();
    j["faces"] = s.triangles.size();
    j["edges_collapsed"] = r.edges_collapsed;
    j["retries"] = r.retries;
    j["held"] = r.held;
    j["step"] = r.step;
    j["volume_before"] = volume_of(input_.surface, input_.bounds);
    j["self_intersections"] = cuts.json();
    j["volume_removed"] = r.removed_volume;
    j["largest_wear"] = wear.empty() ? 0.0 : *std::max_element(wear.begin(), wear.end());
    j["seconds"] = seconds_;
    out_.write_text("report.json", j.dump(2) + "\n");
}

}  // namespace weather
