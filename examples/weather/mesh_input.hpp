// INPUT of the processes on meshes: any triangles, open or closed, terrain, or a builtin shape.
#pragma once

#include <tafoni/geometry/indexed_mesh.hpp>
#include <tafoni/geometry/triangle_surface.hpp>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>

namespace weather {

struct mesh_input {
    tafoni::triangle_surface surface;
    tafoni::box3 bounds;               ///< of the vertices that triangles use
    double size = 1;                   ///< the longest side of the bounds
    bool terrain = false;              ///< from an elevation grid: an open height surface that ends at the sides of the box
    std::size_t open_edges = 0;
    std::size_t isolated_vertices = 0; ///< that no face names; they stay where they are
    std::size_t crowded_edges = 0;     ///< of more than two faces
    std::size_t duplicate_faces = 0;   ///< with the outline of an earlier one
    nlohmann::ordered_json repaired;   ///< what was mended, as counts

    [[nodiscard]] double mean_edge() const { return surface.mean_edge_length(); }
};

/// Reads .obj, .ply or .stl as it is, polygons cut into triangles; .asc as an open height surface without sides and base;
/// or makes `builtin:SPEC`. Faces with a corner twice are dropped, faces of closed meshes turned outwards, those of open
/// ones only where neighbours disagree; what has one side only, as a Moebius strip, is refused. \throws usage_error, and errors of the library
mesh_input load_surface(std::string const& name, std::uint64_t seed);

/// cube, sphere, bust, hand, canyon, valley or outcrop; `text` is the SPEC behind `builtin:`. z points up.
tafoni::indexed_mesh make_builtin_mesh(std::string const& text, std::uint64_t seed);

}  // namespace weather
