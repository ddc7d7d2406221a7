/// \file
/// Gravity-driven flow: water prefers the neighbouring link that lies downhill and opposes least.
#ifndef TAFONI_PERCOLATION_GRAVITY_FLOW_HPP
#define TAFONI_PERCOLATION_GRAVITY_FLOW_HPP

#include <tafoni/percolation/concepts.hpp>
#include <tafoni/rules/parameter_checks.hpp>

#include <array>
#include <cmath>

namespace tafoni {

/// Weight  max(0, g . (x_j - x_i) / |x_j - x_i|) (1 - life_j rho_j)   [Mateos et al., section 5.1].
///
/// What the authors' add-on adds, with its values in brackets:
/// - `alignment_cutoff` c [0.05]: the first factor a becomes 0 below c and (a - c) / (1 - c) above.
/// - `resistance_weight` r [0.75]: the resistance of a bonded link is r life_j rho_j.
/// - `passage_floor` f [0.001]: the second factor of a bonded link is at least f, so that full
///   resistance still lets a path through when there is no other way.
/// - `exit_weight` e [0.75, "exit avoidance"]: the weight of a link that is not bonded (broken, or a skin
///   where the water may leave the rock) is multiplied by e.
/// Its direction weight of 0.75 multiplies every candidate alike and cancels; it is left out.
/// The defaults are the paper's. Stateless: two equal policies always act alike. Models `flow_policy`.
struct gravity_flow {
    vec3 down{0, 0, -1};          ///< direction of gravity, unit length, dimensionless
    double alignment_cutoff = 0;  ///< in [0, 0.999], dimensionless
    double resistance_weight = 1; ///< in [0, 10], dimensionless
    double passage_floor = 0;     ///< in [0, 1], dimensionless
    double exit_weight = 1;       ///< in [0, 1], dimensionless

    /// Preference for the step from `here` to `there`, in [0, 1], dimensionless. O(1).
    [[nodiscard]] double weight(link_view const& here, link_view const& there, water const&) const noexcept {
        vec3 const d{there.centroid[0] - here.centroid[0], there.centroid[1] - here.centroid[1],
                     there.centroid[2] - here.centroid[2]};
        double const fall = dot(down, d);
        if (!(fall > 0)) return 0;
        double a = fall / length(d);
        if (alignment_cutoff > 0) {
            if (!(a > alignment_cutoff)) return 0;
            a = (a - alignment_cutoff) / (1 - alignment_cutoff);
        }
        if (there.state != link_state::bonded) return a * exit_weight;
        double const passage = 1 - resistance_weight * there.flow_resistance();
        return a * (passage > passage_floor ? passage : passage_floor);
    }

    /// \throws invalid_input  `bad_parameter` for `down` not of unit length or an option out of range.
    void validate() const {
        detail::require_unit("gravity_flow.down", down);
        detail::require_range("gravity_flow.alignment_cutoff", alignment_cutoff, 0, 0.999);
        detail::require_range("gravity_flow.resistance_weight", resistance_weight, 0, 10);
        detail::require_range("gravity_flow.passage_floor", passage_floor, 0, 1);
        detail::require_range("gravity_flow.exit_weight", exit_weight, 0, 1);
    }

    [[nodiscard]] std::array<double, 7> parameters() const noexcept {
        return {down[0], down[1], down[2], alignment_cutoff, resistance_weight, passage_floor, exit_weight};
    }
};

static_assert(flow_policy<gravity_flow>);

}  // namespace tafoni

#endif
