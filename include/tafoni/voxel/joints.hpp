/// \file
/// Cracks in rock: discs that cut the bonds of voxels, without moving matter.
#ifndef TAFONI_VOXEL_JOINTS_HPP
#define TAFONI_VOXEL_JOINTS_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/vector.hpp>

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace tafoni {

/// A flat, round crack in the user's space [joints in rock after Ito et al. 2003].
struct joint_disc {
    vec3 centre{0, 0, 0};  ///< length unit
    vec3 normal{0, 0, 1};  ///< either of the two, of any length > 0
    double radius = 1;     ///< length unit, >= 0
};

/// Joints cut the bond of two voxels that share a face where the segment between their centres crosses a
/// disc, its rim included. A centre that lies in a disc's plane counts as above it (towards +z, else +y, else
/// +x, in the user's axes). Which side a centre is on depends on nothing but the centre and the plane, so a disc
/// that is wide enough always parts a body in two, without gaps. No matter is moved and nothing changes but
/// what hangs together.
struct joint_set {
    std::vector<joint_disc> discs{};

    /// O(discs). \throws invalid_input  `bad_parameter`, for a centre or normal that is not finite, a normal that
    ///         has no length between 1e-100 and 1e100 or a radius outside [0, 1e150].
    void validate() const {
        for (std::size_t i = 0; i < discs.size(); ++i) {
            joint_disc const& d = discs[i];
            std::string const name = "joint_set.discs[" + std::to_string(i) + "]";
            for (int a = 0; a < 3; ++a) {
                detail::require_range((name + ".centre").c_str(), d.centre[a], -1e150, 1e150);
                detail::require_range((name + ".normal").c_str(), d.normal[a], -1e100, 1e100);
            }
            detail::require_range((name + ".normal (length)").c_str(), length(d.normal), 1e-100, 1e101);
            detail::require_range((name + ".radius").c_str(), d.radius, 0, 1e150);
        }
    }
};

}  // namespace tafoni

#endif
