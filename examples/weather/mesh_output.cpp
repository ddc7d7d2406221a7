#include "mesh_output.hpp"

#include <tafoni/curvature/vertex_normals.hpp>
#include <tafoni/geometry/vertex_rings.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

namespace weather {

using namespace tafoni;

namespace {

/// Not the volumes of very large or small models.
bool fits_float(std::vector<double> const& values) {
    double largest = 0;
    for (double const v : values) largest = std::max(largest, std::fabs(v));
    return largest == 0 || (largest > 1e-30 && largest < 1e38);
}

}  // namespace

void tell_repairs(mesh_input const& input) {
    for (auto const& [what, count] : input.repaired.items()) {
        if (count != 0) std::fprintf(stderr, "repaired: %s %s\n", count.dump().c_str(), what.c_str());
    }
}

surface_mesh mesh_with(triangle_surface const& surface, std::vector<mesh_channel> channels) {
    surface_mesh out;
    out.mesh.positions = surface.positions;
    out.mesh.corners.reserve(3 * surface.triangles.size());
    out.mesh.offsets.reserve(surface.triangles.size() + 1);
    for (auto const& t : surface.triangles) {
        out.mesh.corners.insert(out.mesh.corners.end(), t.begin(), t.end());
        out.mesh.offsets.push_back(out.mesh.corners.size());
    }
    std::vector<vec3> normal(surface.positions.size());
    vertex_rings const rings(surface.positions.size(), surface.triangles);
    vertex_normals(surface_view{.positions = surface.positions, .triangles = surface.triangles, .rings = &rings}, normal);
    char const* const names[3] = {"nx", "ny", "nz"};
    for (int a = 0; a < 3; ++a) {
        std::vector<double> along(normal.size());
        for (std::size_t v = 0; v < along.size(); ++v) along[v] = normal[v][a];
        channels.push_back(vertex_numbers(names[a], std::move(along)));
    }
    for (mesh_channel& c : channels) {
        if (c.type == channel_type::float32 && !fits_float(c.values)) c.type = channel_type::float64;
    }
    out.attributes.vertex_channels = std::move(channels);
    return out;
}

mesh_channel vertex_numbers(char const* name, std::vector<double> values) {
    return {.name = name, .values = std::move(values), .type = channel_type::float32};
}

double volume_of(triangle_surface const& surface, box3 const& bounds) {
    vec3 const o{0.5 * (bounds.lo[0] + bounds.hi[0]), 0.5 * (bounds.lo[1] + bounds.hi[1]), 0.5 * (bounds.lo[2] + bounds.hi[2])};
    double six = 0;
    for (auto const& t : surface.triangles) {
        vec3 const a{surface.positions[t[0]] - o};
        vec3 const b{surface.positions[t[1]] - o};
        vec3 const c{surface.positions[t[2]] - o};
        six += dot(a, cross(b, c));
    }
    return six / 6;
}

void snapshot_series::recall(output_folder const& out, std::uint64_t every, std::uint64_t until) {
    for (std::uint64_t n = 0; every > 0 && n < until; n += every) {
        std::string const name = numbered_name((process_ + "_").c_str(), n, 8) + ".vtp";
        if (std::filesystem::exists(out.folder() / "snapshots" / name)) series_.push_back({.time = static_cast<double>(n), .file = name});
    }
}

void snapshot_series::write(output_folder const& out, std::uint64_t iteration, surface_mesh const& surface) {
    out.write(add(iteration), surface);
}

std::string snapshot_series::add(std::uint64_t iteration) {
    std::string const name = numbered_name((process_ + "_").c_str(), iteration, 8);
    series_.push_back({.time = static_cast<double>(iteration), .file = name + ".vtp"});
    return "snapshots/" + name;
}

void snapshot_series::finish(output_folder const& out) const {
    write_pvd(out.folder() / "snapshots" / (process_ + ".pvd"), series_);
}

void history_table::recall(output_folder const& out, std::uint64_t until) {
    std::string row;
    for (char const c : out.read_text("history.csv")) {
        row += c;
        if (c != '\n') continue;
        if (row[0] >= '0' && row[0] <= '9' && std::strtoull(row.c_str(), nullptr, 10) < until) rows_.push_back(row);
        row.clear();
    }
}

void history_table::add(std::string row) {
    row += '\n';
    if (rows_.empty() || rows_.back() != row) rows_.push_back(std::move(row));
}

void history_table::write(output_folder const& out) const {
    std::string text = heading_ + "\n";
    for (std::string const& row : rows_) text += row;
    out.write_text("history.csv", text);
}

nlohmann::ordered_json json_of(vec3 const& v) { return {v[0], v[1], v[2]}; }

nlohmann::ordered_json json_of(mesh_input const& input) {
    return {{"vertices", input.surface.positions.size()}, {"faces", input.surface.triangles.size()}, {"open_edges", input.open_edges},
            {"isolated_vertices", input.isolated_vertices}, {"crowded_edges", input.crowded_edges}, {"duplicate_faces", input.duplicate_faces},
            {"terrain", input.terrain}, {"mean_edge", input.mean_edge()}};
}

std::string text_of(double v) {
    char text[64];
    auto const r = std::to_chars(text, text + sizeof text, v);
    return std::string(text, r.ptr);
}

}  // namespace weather
