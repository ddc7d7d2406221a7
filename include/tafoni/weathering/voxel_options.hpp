/// \file
/// What is fixed over a voxel run.
#ifndef TAFONI_WEATHERING_VOXEL_OPTIONS_HPP
#define TAFONI_WEATHERING_VOXEL_OPTIONS_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/voxel/grid_frame.hpp>
#include <tafoni/voxel/repose_rule.hpp>
#include <tafoni/voxel/rockfall_options.hpp>
#include <tafoni/weathering/voxel_report.hpp>

#include <cstdint>
#include <optional>

namespace tafoni {

/// What is fixed over a run. `up` and `border` are in the axes of the user's grid and are not looked at when the
/// run takes over a `sparse_grid`, which has its own.
struct voxel_options {
    curvature_measure measure = curvature_measure::air_share;
    int skin_depth = 1;  ///< 1: solid voxels with air beside one of their six sides; 2: their neighbours as well
    up_axis up = up_axis::plus_z;
    grid_border border{};  ///< what bubbles see beyond the sides
    /// Set: weathered rock becomes colluvium; else it vanishes. Colluvium that lies in the grid at the start, steep or in
    /// the air, stays until something opens beside it.
    std::optional<repose_rule> colluvium{};
    std::optional<rockfall_options> rockfall{};  ///< set: rock that loses its hold falls
    std::uint64_t seed = 0;

    /// \throws invalid_input  `bad_parameter`.
    void validate() const {
        detail::require_range("voxel_options.skin_depth", skin_depth, 1, 2);
        if (colluvium) colluvium->validate();
        if (rockfall) rockfall->validate();
    }
};

}  // namespace tafoni

#endif
