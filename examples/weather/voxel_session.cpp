#include "voxel_session.hpp"

#include "input.hpp"
#include "spec.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <span>

namespace weather {

using namespace tafoni;

namespace {

/// Those beside a side beyond which the grid knows only air. O(voxels of the sides).
std::size_t voxels_at_air_sides(sparse_grid const& grid) {
    std::size_t count = 0;
    for (std::size_t side = 0; side < 6; ++side) {
        if (grid.border().sides[side] != border_kind::air) continue;
        std::size_t const across = side / 2;
        std::size_t const u = (across + 1) % 3;
        std::size_t const v = (across + 2) % 3;
        std::array<std::int32_t, 3> at{};
        at[across] = side % 2 == 0 ? 0 : static_cast<std::int32_t>(grid.size()[across]) - 1;
        for (at[u] = 0; at[u] < static_cast<std::int32_t>(grid.size()[u]); ++at[u]) {
            for (at[v] = 0; at[v] < static_cast<std::int32_t>(grid.size()[v]); ++at[v]) {
                if (grid.is_solid({at[0], at[1], at[2]})) ++count;
            }
        }
    }
    return count;
}

}  // namespace

voxel_session::voxel_session(voxel_arguments const& a)
    : a_(a),
      progress_(progress_style_of(a.progress)),
      phases_(parse_schedule(a.schedule, a.steps, a.spheroidal, a.cavernous)),
      threads_(a.threads),
      out_(a.output, a.formats, vec3{0, 0, 0}) {
    for (voxel_phase const& p : phases_) steps_ += p.steps;
    // A SPEC that cannot be read is told before the work begins.
    height_range const any{};
    box3 const box{.lo = {0, 0, 0}, .hi = {1, 1, 1}};
    static_cast<void>(parse_bubbles(a_.bubbles, a_.radius, any, a_.seed));
    static_cast<void>(any_rate::parse(a_.rate));
    static_cast<void>(make_durability(a_.durability, a_.noise, any, box, a_.seed));
    static_cast<void>(parse_joints(a_.joints, box, a_.seed));
}

bool voxel_session::run() {
    require_makable(a_.output);
    if (!a_.checkpoint.empty()) {
        std::filesystem::path const folder = std::filesystem::path(a_.checkpoint).parent_path();
        require_makable(folder.empty() ? "." : folder.string());
    }
    stopwatch watch;
    progress_.context().tick("read", 0);
    voxel_source const source = load_voxels(a_);
    progress_.context().tick("read", 1);
    border_ = source.border;
    up_ = source.up_direction;
    bounds_ = source.bounds;
    repaired_ = source.repaired;
    for (auto const& [what, count] : repaired_.items()) {
        if (count != 0) std::fprintf(stderr, "repaired: %s %s\n", count.dump().c_str(), what.c_str());
    }
    seconds_["read"] = watch.lap();
    progress_.context().tick("voxelise", 0);
    sparse_grid grid = source.voxelise();
    progress_.context().tick("voxelise", 1);
    if (grid.count(voxel_plane::rock) == 0) {
        detail::fail<invalid_input>(errc::empty_input, a_.input + ": no voxel of rock; is it closed, or is --resolution too low?",
                                    {.kind = entity::voxel, .value = 0, .limit = 1});
    }
    seconds_["voxelise"] = watch.lap();

    run_type run(std::move(grid), make_process(source), make_options(source), threads_);
    if (!a_.resume.empty()) resume(run);
    // Made only now that the input has been accepted, so that a refused run leaves nothing behind.
    std::filesystem::path const folder = made_folder(a_.output);
    vec3 origin{0, 0, 0};
    for (int k = 0; k < 3; ++k) origin[k] = std::floor(bounds_.lo[k]);
    out_ = output_folder(folder, a_.formats, origin);
    if (a_.snapshots > 0) made_folder((folder / "snapshots").string());
    out_.remove_old("voxel", [&](std::uint64_t n) { return !a_.resume.empty() && n <= run.steps(); });
    weather(run);
    seconds_["weather"] = watch.lap() - surface_seconds_ - snapshot_seconds_;
    double const before = surface_seconds_;
    write_results(run);
    double const after = watch.lap() - (surface_seconds_ - before);
    seconds_["surface"] = surface_seconds_;
    seconds_["write"] = after + snapshot_seconds_;
    write_report(run);
    voxel_report const r = run.report();
    if (std::size_t const touching = voxels_at_air_sides(run.grid()); touching + r.voxels_left > 0) {
        std::fprintf(stderr, "at the sides of the grid: %zu voxels rest there and %llu slid beyond; a larger --margin makes room\n", touching,
                     static_cast<unsigned long long>(r.voxels_left));
    }
    std::fprintf(stderr, "%s: %llu steps, %llu of %llu voxels are rock, %llu colluvium, %llu fell in %llu blocks\n",
                 a_.output.c_str(), static_cast<unsigned long long>(r.steps), static_cast<unsigned long long>(r.voxels_rock),
                 static_cast<unsigned long long>(r.voxels_initial), static_cast<unsigned long long>(r.voxels_colluvium),
                 static_cast<unsigned long long>(r.voxels_fallen), static_cast<unsigned long long>(r.blocks));
    return !stopped_;
}

voxel_session::process voxel_session::make_process(voxel_source const& source) const {
    process p;
    p.bubbles = parse_bubbles(a_.bubbles, a_.radius, source.heights(), a_.seed);
    p.rate = any_rate::parse(a_.rate);
    p.durability = make_durability(a_.durability, a_.noise, source.heights(), source.bounds, a_.seed);
    return p;
}

voxel_options voxel_session::make_options(voxel_source const& source) {
    voxel_options o;
    if (a_.measure == "excess") o.measure = curvature_measure::signed_excess;
    if (a_.measure == "flat") o.measure = curvature_measure::flat_excess;
    o.skin_depth = a_.depth;
    o.seed = a_.seed;
    if (a_.colluvium) o.colluvium = repose_rule{.angle = a_.repose, .baseline = static_cast<int>(a_.baseline)};
    if (a_.rockfall) {
        o.rockfall = rockfall_options{.joints = parse_joints(a_.joints, source.bounds, a_.seed), .friction_angle = a_.friction};
        joints_ = o.rockfall->joints.discs.size();
    }
    return o;
}

void voxel_session::resume(run_type& run) {
    std::string const bytes = load_bytes(a_.resume);
    run.resume(std::as_bytes(std::span(bytes.data(), bytes.size())));
    if (run.steps() > steps_) {
        throw usage_error("--steps " + std::to_string(steps_) + ": the checkpoint has " + std::to_string(run.steps()));
    }
}

void voxel_session::recall(run_type const& run) {
    std::string row;
    for (char const c : a_.resume.empty() ? std::string() : out_.read_text("history.csv")) {
        row += c;
        if (c != '\n') continue;
        if (row[0] >= '0' && row[0] <= '9' && std::strtoull(row.c_str(), nullptr, 10) < run.steps()) history_.push_back(row);
        row.clear();
    }
    for (std::uint64_t n = 0; a_.snapshots > 0 && n < run.steps(); n += a_.snapshots) {
        std::string const name = numbered_name("voxel_", n, 8) + ".vtp";
        if (std::filesystem::exists(out_.folder() / "snapshots" / name)) {
            series_.push_back({.time = static_cast<double>(n), .file = name});
        }
    }
}

void voxel_session::weather(run_type& run) {
    recall(run);
    add_history(run);
    if (a_.snapshots > 0 && run.steps() % a_.snapshots == 0) write_snapshot(run);
    run_context const context{.on_progress = [&](progress_event const&) {
        voxel_report const r = run.report();
        double const fraction = steps_ == 0 ? 1 : static_cast<double>(r.steps) / static_cast<double>(steps_);
        return progress_.show("weather", fraction, std::to_string(r.steps) + " steps, " + std::to_string(r.voxels_rock) + " rock");
    }};
    // About 200 rows of history, at steps that do not depend on where a run was resumed.
    std::uint64_t const row = std::max<std::uint64_t>(1, steps_ / 200);
    voxel_schedule schedule{.phases = phases_, .clock = a_.events ? voxel_clock::events : voxel_clock::steps, .snapshot_every = 1};
    schedule = schedule.after(run.steps());
    schedule.on_snapshot = [&](std::uint64_t n) {
        if (n % row == 0) add_history(run);
        if (a_.snapshots > 0 && n % a_.snapshots == 0) {
            stopwatch watch;
            double const before = surface_seconds_;
            write_snapshot(run);
            write_history();
            if (!a_.checkpoint.empty()) write_checkpoint(run, a_.checkpoint);
            snapshot_seconds_ += watch.lap() - (surface_seconds_ - before);
        }
        return step_control::proceed;
    };
    voxel_report const r = run.run(schedule, context, threads_);
    add_history(run);
    stopped_ = r.stopped == voxel_stop::observer && r.steps < steps_;
}

}  // namespace weather
