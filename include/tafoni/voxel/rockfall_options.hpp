/// \file
/// What holds rock up: the ground, joints and friction.
#ifndef TAFONI_VOXEL_ROCKFALL_OPTIONS_HPP
#define TAFONI_VOXEL_ROCKFALL_OPTIONS_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/voxel/joints.hpp>
#include <tafoni/voxel/voxel.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace tafoni {

/// Whether the rock that touches a side of the grid is held there.
enum class ground_side : std::uint8_t {
    by_border,  ///< held where the border is `rock` or `extend`; never on the side that is up
    ground,     ///< held
    loose       ///< not held
};

/// How rockfall tells what stands [Jones et al., section 4; joints and friction as Ito et al. 2003].
///
/// The ground is the rock in the outermost layer of the sides that hold, and the rock voxels named by
/// `ground_voxels` and `ground_where`. Where no rock voxel is ground, the largest piece stays, of equal ones that with
/// the lowest voxel (turned axes), and friction is not asked.
struct rockfall_options {
    std::array<ground_side, 6> sides{};   ///< -x, +x, -y, +y, -z, +z of the user's grid
    std::vector<voxel> ground_voxels{};   ///< user's axes; those outside the grid or not rock are ignored
    /// Of the centre of a voxel in the user's space; a pure function. Asked once for every voxel that is rock when
    /// the process first sees the grid. Empty: none.
    std::function<bool(vec3 const&)> ground_where{};
    joint_set joints{};                   ///< where rock is cracked
    /// Degrees, in [0, 89]. A piece that is cut off stays while the joints that it rests on are no steeper than this;
    /// 0: every piece that is cut off falls, as in Jones et al.
    double friction_angle = 0;

    /// \throws invalid_input  `bad_parameter`; as `joint_set::validate`.
    void validate() const {
        detail::require_range("rockfall_options.friction_angle", friction_angle, 0, 89);
        joints.validate();
    }
};

}  // namespace tafoni

#endif
