// INPUT of `weather voxel`: a mesh, terrain, voxels, an image, or a builtin shape.
#pragma once

#include "voxel_command.hpp"
#include "voxel_rules.hpp"

#include <tafoni/voxel/sparse_grid.hpp>

#include <nlohmann/json.hpp>

#include <functional>
#include <string>

namespace weather {

/// What was read, and how it becomes voxels.
struct voxel_source {
    tafoni::box3 bounds;               ///< of the rock, in the user's space
    nlohmann::ordered_json repaired;   ///< what was mended, as counts
    tafoni::up_axis up = tafoni::up_axis::plus_z;
    tafoni::vec3 up_direction{0, 0, 1};
    std::string border;                ///< ground, open or extend
    std::function<tafoni::sparse_grid()> voxelise;

    [[nodiscard]] height_range heights() const;
};

/// Reads it. \throws usage_error, and errors of the library
voxel_source load_voxels(voxel_arguments const& a);

/// A rock that is made here: inside or not. Altitudes run along z of the shape's own axes.
struct builtin_shape {
    tafoni::box3 bounds;
    std::function<bool(tafoni::vec3 const&)> contains;
};
/// hoodoo, cube, corner or cliff; `text` is the SPEC behind `builtin:`. The longest side is 1.
builtin_shape make_builtin(std::string const& text, std::uint64_t seed);

}  // namespace weather
