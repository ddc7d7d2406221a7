// What a run leaves behind: surfaces, blocks, history, report.
#include "voxel_session.hpp"

#include <tafoni/version.hpp>
#include <tafoni/weathering/weathered_voxels.hpp>

#include <algorithm>
#include <cstdio>

namespace weather {

using namespace tafoni;

namespace {

nlohmann::ordered_json json_of(vec3 const& v) { return {v[0], v[1], v[2]}; }

/// The box around voxels in turned axes, and the voxels as a grid of their own with one of air around.
sparse_grid grid_of(std::vector<voxel> const& voxels, sparse_grid const& whole) {
    voxel lo = voxels.front();
    voxel hi = lo;
    for (voxel const v : voxels) {
        voxel const u = whole.to_user(v);
        if (v == voxels.front()) lo = hi = u;
        lo = {std::min(lo.x, u.x), std::min(lo.y, u.y), std::min(lo.z, u.z)};
        hi = {std::max(hi.x, u.x), std::max(hi.y, u.y), std::max(hi.z, u.z)};
    }
    grid_frame frame = whole.user_frame();
    std::array<std::int32_t, 3> const low{lo.x - 1, lo.y - 1, lo.z - 1};
    std::array<std::int32_t, 3> const high{hi.x + 1, hi.y + 1, hi.z + 1};
    for (std::size_t d = 0; d < 3; ++d) {
        auto const a = static_cast<Eigen::Index>(d);
        frame.size[d] = static_cast<std::size_t>(high[d] - low[d] + 1);
        frame.origin[a] += frame.spacing[a] * static_cast<double>(low[d]);
    }
    sparse_grid out(frame);
    for (voxel const v : voxels) {
        voxel const u = whole.to_user(v);
        out.set({u.x - low[0], u.y - low[1], u.z - low[2]}, voxel_state::rock);
    }
    return out;
}

void append(surface_mesh& out, voxel_mesh const& part) {
    auto const first = static_cast<std::uint32_t>(out.mesh.positions.size());
    out.mesh.positions.insert(out.mesh.positions.end(), part.mesh.positions.begin(), part.mesh.positions.end());
    std::size_t const corners = out.mesh.corners.size();
    for (std::uint32_t const c : part.mesh.corners) out.mesh.corners.push_back(first + c);
    for (std::size_t f = 1; f < part.mesh.offsets.size(); ++f) out.mesh.offsets.push_back(corners + part.mesh.offsets[f]);
}

}  // namespace

surface_mesh voxel_session::surface(run_type const& run) {
    stopwatch watch;
    weathered_voxels const skin = extract_weathered_voxels(run, {.smoothing = static_cast<int>(a_.smooth)}, threads_);
    surface_mesh out;
    auto& face = out.attributes.face_channels;
    face = {{.name = "material", .values = {}, .type = channel_type::uint8}, {.name = "contact", .values = {}, .type = channel_type::uint8}};
    struct vertex_numbers {
        char const* name;
        std::vector<double> voxel_attributes::* of;
    };
    auto& vertex = out.attributes.vertex_channels;
    for (auto const& [name, of] : {vertex_numbers{"curvature", &voxel_attributes::curvature}, {"durability", &voxel_attributes::durability},
                                   {"decimation", &voxel_attributes::decimation}, {"cavernous", &voxel_attributes::cavernous}}) {
        vertex.push_back({.name = name, .values = skin.rock.*of, .type = channel_type::float32});
        vertex.back().values.insert(vertex.back().values.end(), (skin.colluvium.*of).begin(), (skin.colluvium.*of).end());
    }
    for (int material = 0; material < 2; ++material) {
        voxel_mesh const& part = material == 0 ? skin.surface.rock : skin.surface.colluvium;
        if (part.mesh.face_count() > 0) {
            out.attributes.groups.push_back({.name = material == 0 ? "rock" : "colluvium", .first_face = face[0].values.size()});
        }
        append(out, part);
        face[0].values.insert(face[0].values.end(), part.triangle_face.size(), material);
        for (voxel_face const f : part.triangle_face) face[1].values.push_back(f == voxel_face::open ? 0 : 1);
    }
    // For pictures: durability of rock from 0 to 1 over its range, colluvium at -1.
    auto const& durability = skin.rock.durability;
    auto const [softest, hardest] = std::minmax_element(durability.begin(), durability.end());
    mesh_channel tint{.name = "tint", .values = {}, .type = channel_type::float32};
    for (double const d : durability) tint.values.push_back(*hardest > *softest ? (d - *softest) / (*hardest - *softest) : 0);
    tint.values.resize(out.mesh.positions.size(), -1);
    vertex.push_back(std::move(tint));
    surface_seconds_ += watch.lap();
    return out;
}

void voxel_session::write_snapshot(run_type const& run) {
    std::string const name = numbered_name("voxel_", run.steps(), 8);
    out_.write("snapshots/" + name, surface(run));
    series_.push_back({.time = static_cast<double>(run.steps()), .file = name + ".vtp"});
}

void voxel_session::add_history(run_type const& run) {
    voxel_report const r = run.report();
    std::string row;
    for (std::uint64_t const n : {r.steps, r.voxels_rock, r.voxels_colluvium, r.voxels_vanished, r.voxels_fallen, r.voxels_left, r.surface_voxels}) {
        row += (row.empty() ? "" : ",") + std::to_string(n);
    }
    row += '\n';
    if (history_.empty() || history_.back() != row) history_.push_back(row);
}

void voxel_session::write_history() const {
    std::string history = "steps,voxels_rock,voxels_colluvium,voxels_vanished,voxels_fallen,voxels_left,surface_voxels\n";
    for (std::string const& row : history_) history += row;
    out_.write_text("history.csv", history);
}

void voxel_session::write_checkpoint(run_type const& run, std::string const& path) const {
    auto const bytes = run.checkpoint();
    detail::write_file("weather", path, {reinterpret_cast<char const*>(bytes.data()), bytes.size()});
}

void voxel_session::write_blocks(run_type const& run) {
    nlohmann::ordered_json manifest = nlohmann::ordered_json::array();
    surface_mesh all;
    mesh_channel number{.name = "block", .values = {}, .type = channel_type::int32};
    if (a_.separate_blocks && !run.blocks().empty()) made_folder((out_.folder() / "blocks").string());
    for (std::size_t b = 0; b < run.blocks().size(); ++b) {
        fallen_block const& block = run.blocks()[b];
        voxel_surface const skin = extract_voxel_surface(grid_of(block.voxels, run.grid()), {.smoothing = static_cast<int>(a_.smooth)});
        nlohmann::ordered_json entry{{"block", b}, {"step", block.step}, {"voxels", block.voxels.size()}};
        surface_mesh one;
        append(a_.separate_blocks ? one : all, skin.rock);
        number.values.insert(number.values.end(), skin.rock.triangle_face.size(), static_cast<double>(b));
        if (a_.separate_blocks) {
            std::string const name = numbered_name("blocks/block_", b, 6);
            out_.write(name, one);
            entry["file"] = name;
        }
        manifest.push_back(std::move(entry));
    }
    if (!a_.separate_blocks) {
        all.attributes.face_channels.push_back(std::move(number));
        out_.write("blocks", all);
    }
    out_.write_text("blocks.json", manifest.dump(1) + "\n");
}

void voxel_session::write_results(run_type const& run) {
    progress_.show("write", 0);
    out_.write("weathered", surface(run));
    write_blocks(run);
    write_history();
    std::string checkpoint = a_.checkpoint;
    if (checkpoint.empty() && stopped_) checkpoint = (out_.folder() / "voxel.checkpoint").string();
    if (!checkpoint.empty()) write_checkpoint(run, checkpoint);
    if (stopped_) std::fprintf(stderr, "stopped; go on with --resume %s\n", checkpoint.c_str());
    // Last, so that it names only what is there.
    if (a_.snapshots > 0 && out_.writes("vtp")) write_pvd(out_.folder() / "snapshots" / "voxel.pvd", series_);
    progress_.show("write", 1);
}

void voxel_session::write_report(run_type const& run) {
    voxel_report const r = run.report();
    sparse_grid const& grid = run.grid();
    nlohmann::ordered_json phases = nlohmann::ordered_json::array();
    for (voxel_phase const& p : phases_) {
        phases.push_back({{"steps", p.steps}, {"spheroidal", p.spheroidal}, {"cavernous", p.cavernous}});
        if (phases.size() == 100) break;
    }
    nlohmann::ordered_json j;
    j["schema"] = "tafoni.weather.voxel/1";
    j["version"] = version_string;
    j["process"] = "voxel";
    j["input"] = a_.input;
    j["seed"] = a_.seed;
    j["parameters"] = {{"resolution", a_.resolution}, {"up", a_.up}, {"border", border_}, {"image", a_.image},
                       {"bubble", a_.bubbles.empty() ? std::vector<std::string>{"sphere"} : a_.bubbles}, {"radius", a_.radius},
                       {"rate", a_.rate}, {"measure", a_.measure}, {"schedule", a_.schedule}, {"phases", phases}, {"steps", steps_},
                       {"events", a_.events}, {"durability", a_.durability}, {"noise", a_.noise}, {"colluvium", a_.colluvium},
                       {"repose", a_.repose}, {"baseline", a_.baseline}, {"rockfall", a_.rockfall}, {"joints", a_.joints},
                       {"friction", a_.friction}, {"depth", a_.depth}, {"smooth", a_.smooth}, {"snapshots", a_.snapshots},
                       {"format", a_.formats}, {"separate_blocks", a_.separate_blocks}};
    j["bounds"] = {{"lo", json_of(bounds_.lo)}, {"hi", json_of(bounds_.hi)}};
    j["grid"] = {{"size", grid.user_frame().size}, {"spacing", json_of(grid.user_frame().spacing)}, {"origin", json_of(grid.user_frame().origin)},
                 {"bytes", grid.bytes()}};
    j["joint_discs"] = joints_;
    j["threads"] = a_.threads;
    j["stopped"] = stopped_ ? "interrupted" : "finished";
    j["repaired"] = repaired_;
    j["steps"] = r.steps;
    j["voxels_initial"] = r.voxels_initial;
    j["voxels_rock"] = r.voxels_rock;
    j["voxels_colluvium"] = r.voxels_colluvium;
    j["voxels_vanished"] = r.voxels_vanished;
    j["voxels_fallen"] = r.voxels_fallen;
    j["voxels_left"] = r.voxels_left;
    j["surface_voxels"] = r.surface_voxels;
    j["blocks"] = r.blocks;
    vec3 const edge = grid.spacing();
    j["volume_voxel"] = edge[0] * edge[1] * edge[2];
    j["seconds"] = seconds_;
    out_.write_text("report.json", j.dump(2) + "\n");
}

}  // namespace weather
