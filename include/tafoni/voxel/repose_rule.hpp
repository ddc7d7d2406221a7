/// \file
/// How steep loose grains may lie, as the columns of a grid can tell.
#ifndef TAFONI_VOXEL_REPOSE_RULE_HPP
#define TAFONI_VOXEL_REPOSE_RULE_HPP

#include <tafoni/core/error.hpp>

#include <string>

namespace tafoni {

/// The angle of repose and how it is measured [Jones et al., section 4.2 and Fig. 5].
///
/// A grain at height z looks along +x, -x, +y and -y. The drop n(k) is the number of voxels of air in the
/// k-th column from height z downwards to the first that is not air; a grain on a plane sees 1. It is the
/// difference in height of two columns' tops, so the slope over k columns is  n(k) dz / (k dx).
/// With `baseline` L the grain looks at k = 1 .. L while the voxels at its own height are air, and the
/// place is too steep where
///     n(L) > floor(L dx tan(angle) / dz)    or    n(k) > ceil(k dx tan(angle) / dz) for k < L:
/// a plane of that slope, cut into voxels, drops by so much over k columns. Neither bound is below 1, for
/// nothing flatter than a single grain on a plane can be built of voxels.
///
/// With one column, as printed, the measure knows only arctan(n dz/dx): in a cubic grid every angle below
/// 63.4 degrees acts as 45, the next as 63.4, then 71.6. With L columns it knows arctan(m dz / (L dx)) for
/// m = 1 .. : L = 4 knows 14, 26.6, 36.9, 45, ... degrees, and asks for the steepest of them that is not
/// above `angle`.
struct repose_rule {
    static constexpr int longest_baseline = 16;

    double angle = 45;  ///< degrees, 0 (nothing steeper than one grain on a plane) .. 90 (grains only fall)
    int baseline = 1;   ///< columns, 1 .. `longest_baseline`

    /// \throws invalid_input  `bad_parameter`.
    void validate() const {
        detail::require_range("repose_rule.angle", angle, 0, 90);
        if (baseline < 1 || baseline > longest_baseline) {
            detail::fail<invalid_input>(errc::bad_parameter,
                                        "repose_rule.baseline: got " + std::to_string(baseline) + ", allowed [1, " +
                                            std::to_string(longest_baseline) + "]",
                                        {.kind = entity::parameter, .value = static_cast<double>(baseline),
                                         .limit = static_cast<double>(baseline < 1 ? 1 : longest_baseline)});
        }
    }
};

}  // namespace tafoni

#endif
