/// \file
/// Water enters where the rock faces the rain.
#ifndef TAFONI_PERCOLATION_FACING_INFILTRATION_HPP
#define TAFONI_PERCOLATION_FACING_INFILTRATION_HPP

#include <tafoni/percolation/concepts.hpp>
#include <tafoni/rules/parameter_checks.hpp>

#include <array>

namespace tafoni {

/// Acceptance max(-n . d, 0), n out of the rock, d the rain's direction of travel [Mateos et al.,
/// section 5.1; the paper's sign is for the opposite convention]. Models `infiltration_policy`.
///
/// With a `cutoff` c > 0, as in the authors' add-on (there 0.05): 0 below c, and (a - c) / (1 - c) above,
/// so that grazing rain does not enter and head-on rain enters as before.
struct facing_infiltration {
    double cutoff = 0;  ///< alignment below which nothing enters, dimensionless, in [0, 1)

    /// Share of the rain on `skin` that enters, in [0, 1]. O(1).
    [[nodiscard]] double acceptance(link_view const& skin, vec3 const& rain) const noexcept {
        double const a = -dot(skin.normal, rain);
        if (!(a > cutoff)) return 0;
        double const r = (a - cutoff) / (1 - cutoff);
        return r < 1 ? r : 1.0;
    }

    /// \throws invalid_input  `bad_parameter` for a cutoff out of range.
    void validate() const { detail::require_range("facing_infiltration.cutoff", cutoff, 0, 0.999); }

    [[nodiscard]] std::array<double, 1> parameters() const noexcept { return {cutoff}; }
};

static_assert(infiltration_policy<facing_infiltration>);

}  // namespace tafoni

#endif
