#include "mesh_input.hpp"

#include "input.hpp"

#include <tafoni/geometry/inspect_mesh.hpp>
#include <tafoni/geometry/repair_mesh.hpp>
#include <tafoni/geometry/terrain_solid.hpp>
#include <tafoni/geometry/triangulate.hpp>
#include <tafoni/io/esri_ascii.hpp>
#include <tafoni/io/read_mesh.hpp>

#include <algorithm>

namespace weather {

using namespace tafoni;

namespace {

/// Without the nodes that have no height.
indexed_mesh terrain_surface(std::string const& path) {
    height_grid const grid = read_esri_ascii(std::filesystem::path(path));
    detail::require_valid_grid(grid);
    indexed_mesh const top = detail::terrain_top(grid);
    std::vector<std::uint32_t> number(top.positions.size(), vertex_index::none);
    for (std::uint32_t const c : top.corners) number[c] = 0;
    indexed_mesh out;
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] == 0) number[v] = out.add_vertex(top.positions[v]).value;
    }
    out.offsets = top.offsets;
    for (std::uint32_t const c : top.corners) out.corners.push_back(number[c]);
    return out;
}

triangle_surface triangles_of(indexed_mesh const& mesh) {
    triangle_surface s{.positions = mesh.positions, .triangles = {}};
    s.triangles.reserve(mesh.face_count());
    std::vector<vec3> loop;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        auto const corners = mesh.face(f);
        if (corners.size() == 3) {
            s.triangles.push_back({corners[0], corners[1], corners[2]});
            continue;
        }
        loop.clear();
        for (std::uint32_t const c : corners) loop.push_back(mesh.positions[c]);
        for (auto const& t : triangulate(loop)) s.triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
    }
    return s;
}

}  // namespace

mesh_input load_surface(std::string const& name, std::uint64_t seed) {
    mesh_input out;
    indexed_mesh mesh;
    if (name.rfind("builtin:", 0) == 0) {
        mesh = make_builtin_mesh(name.substr(8), seed);
    } else if (extension_of(name) == "asc") {
        mesh = terrain_surface(name);
        out.terrain = true;
    } else {
        mesh = read_model(name, "an elevation grid (.asc) or builtin:SPEC").mesh;
    }
    inspect_report look = inspect_mesh(mesh);
    std::size_t const degenerate = look.degenerate_faces;
    if (degenerate > 0) {
        mesh = repair_mesh(mesh, {.drop_degenerate = true}).mesh;
        look = inspect_mesh(mesh);
    }
    if (!look.orientable) {
        detail::fail<bad_topology>(errc::non_orientable, name + ": the surface is not orientable: it has one side only, as a Moebius strip, so that nothing is inwards",
                                   {.kind = entity::file, .file = name});
    }
    std::size_t turned = 0;
    if (look.inconsistent_edges > 0 || (look.open_edges == 0 && look.crowded_edges == 0)) {
        repaired_mesh mended = repair_mesh(mesh, {.orient = true});
        turned = mended.report.turned_faces.size();
        if (turned > 0) mesh = std::move(mended.mesh);
    }
    out.open_edges = look.open_edges;
    out.isolated_vertices = look.unused_vertices;
    out.crowded_edges = look.crowded_edges;
    out.duplicate_faces = look.duplicate_faces;
    out.repaired = {{"turned_faces", turned}, {"dropped_faces", degenerate}};
    out.surface = triangles_of(mesh);
    for (auto const& t : out.surface.triangles) {
        for (std::uint32_t const c : t) out.bounds.include(out.surface.positions[c]);
    }
    if (out.surface.triangles.empty()) {
        detail::fail<invalid_input>(errc::empty_input, name + ": there is no face", {.kind = entity::file, .file = name});
    }
    vec3 const e = out.bounds.extent();
    out.size = std::max({e[0], e[1], e[2]});
    if (!(out.size > 0)) {
        detail::fail<invalid_input>(errc::out_of_range, name + ": all vertices lie in one place", {.kind = entity::file, .file = name});
    }
    return out;
}

}  // namespace weather
