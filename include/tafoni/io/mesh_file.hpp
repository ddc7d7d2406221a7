/// \file
/// What a mesh file holds: the mesh, and everything that hangs on its vertices, faces and corners.
#ifndef TAFONI_IO_MESH_FILE_HPP
#define TAFONI_IO_MESH_FILE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/geometry/indexed_mesh.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tafoni {

/// How a channel's values are stored in a file; in memory they are always double.
enum class channel_type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// How a writer stores coordinates. In float32 they are taken relative to an origin that the file
/// records, rounded to float, so that a model far from zero keeps its details.
enum class coordinate_type : std::uint8_t { float64, float32 };

/// A named number per vertex or per face, parallel to the vertices or faces of the mesh.
struct mesh_channel {
    std::string name{};            ///< bytes without white space, kept as they are
    std::vector<double> values{};  ///< NaN and infinities are carried unharmed
    channel_type type = channel_type::float64;
};

/// A run of faces with one name: from `first_face` to the next group's first face or the end.
struct face_group {
    std::string name{};  ///< bytes as in the file, any encoding
    std::size_t first_face = 0;
};

/// Everything besides positions and faces. Empty arrays mean "the file has none".
struct mesh_attributes {
    static constexpr std::uint32_t none = strong_index<struct any_tag>::none;

    std::vector<mesh_channel> vertex_channels{};
    std::vector<mesh_channel> face_channels{};
    std::vector<vec3> normals{};                            ///< as in the file, not normalised
    std::vector<std::array<double, 2>> texture{};           ///< texture coordinates u, v
    std::vector<std::uint32_t> corner_normals{};            ///< parallel to the corners: into `normals`, or `none`
    std::vector<std::uint32_t> corner_texture{};            ///< parallel to the corners: into `texture`, or `none`
    std::vector<face_group> objects{};                      ///< OBJ: `o`
    std::vector<face_group> groups{};                       ///< OBJ: `g`; STL: solids
    std::vector<face_group> materials{};                    ///< OBJ: `usemtl`
    std::vector<std::string> material_libraries{};          ///< OBJ: `mtllib`; names only, never opened

    /// The channel of that name, or null. O(channels).
    [[nodiscard]] static mesh_channel const* find(std::vector<mesh_channel> const& channels, std::string_view name) {
        for (mesh_channel const& c : channels) {
            if (c.name == name) return &c;
        }
        return nullptr;
    }
};

/// A mesh file in memory. Positions are in the user's frame: an origin that the file records is
/// added to them already, and told in `origin`.
///
/// A reader guarantees: every corner is below the vertex count, every face has at least three
/// corners, every coordinate is finite, channels are as long as what they belong to. It does not
/// guarantee a solid; `make_solid` checks that.
struct mesh_file {
    indexed_mesh mesh{};
    mesh_attributes attributes{};
    vec3 origin{0, 0, 0};
};

}  // namespace tafoni

#endif
