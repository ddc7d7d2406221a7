/// \file
/// Water drunk in proportion to the wetted surface and to the link's resistance.
#ifndef TAFONI_RULES_SURFACE_ABSORPTION_HPP
#define TAFONI_RULES_SURFACE_ABSORPTION_HPP

#include <tafoni/rules/concepts.hpp>
#include <tafoni/rules/parameter_checks.hpp>

#include <array>

namespace tafoni {

/// Bonded: a/A k_solid + f_r k_res; else: a/A k_air, with a the link's area and A the mean area at
/// the start [Mateos et al., section 5.2: k_solid = 0.1/A, k_air = 0.05/A, k_res = 0.25].
///
/// The add-on weighs the resistance by 0.75 here too, and its mean runs over skin links as well.
/// Models `absorption_rule`.
struct surface_absorption {
    double k_solid = 0.1;          ///< water per mean area of a bonded link, in [0, 1e6]
    double k_air = 0.05;           ///< water per mean area of a broken link or skin, in [0, 1e6]
    double k_res = 0.25;           ///< water at full flow resistance, in [0, 1e6]
    double resistance_weight = 1;  ///< factor on f_r, dimensionless, in [0, 10]

    /// Water that the link drinks, >= 0, in the unit of w_in. O(1).
    [[nodiscard]] double absorbed(link_view const& l, water const&, link_scale const& scale) const noexcept {
        double const a = l.area / scale.mean_area;
        if (l.state != link_state::bonded) return a * k_air;
        return a * k_solid + resistance_weight * l.flow_resistance() * k_res;
    }

    /// \throws invalid_input  `bad_parameter` for a coefficient out of range.
    void validate() const {
        detail::require_range("surface_absorption.k_solid", k_solid, 0, detail::coefficient_limit);
        detail::require_range("surface_absorption.k_air", k_air, 0, detail::coefficient_limit);
        detail::require_range("surface_absorption.k_res", k_res, 0, detail::coefficient_limit);
        detail::require_range("surface_absorption.resistance_weight", resistance_weight, 0, 10);
    }

    [[nodiscard]] std::array<double, 4> parameters() const noexcept {
        return {k_solid, k_air, k_res, resistance_weight};
    }
};

static_assert(absorption_rule<surface_absorption>);

}  // namespace tafoni

#endif
