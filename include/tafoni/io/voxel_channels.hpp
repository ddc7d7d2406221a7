/// \file
/// The numbers of weathered voxels as channels that the writers of PLY and VTP store.
#ifndef TAFONI_IO_VOXEL_CHANNELS_HPP
#define TAFONI_IO_VOXEL_CHANNELS_HPP

#include <tafoni/io/mesh_file.hpp>
#include <tafoni/weathering/weathered_voxels.hpp>

#include <vector>

namespace tafoni {

/// Vertex channels curvature, durability, decimation and cavernous (float32) of the rock or the colluvium of
/// `weathered_voxels w`: `write_vtp("rock.vtp", w.surface.rock.mesh, channels_of(w.rock))`. O(vertices).
[[nodiscard]] inline mesh_attributes channels_of(voxel_attributes const& a) {
    mesh_attributes out;
    auto const add = [&out](char const* name, std::vector<double> const& numbers) {
        out.vertex_channels.push_back({.name = name, .values = numbers, .type = channel_type::float32});
    };
    add("curvature", a.curvature);
    add("durability", a.durability);
    add("decimation", a.decimation);
    add("cavernous", a.cavernous);
    return out;
}

}  // namespace tafoni

#endif
