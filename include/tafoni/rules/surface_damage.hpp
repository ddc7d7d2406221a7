/// \file
/// Absorbed water wears a bond, spread over the bond's area.
#ifndef TAFONI_RULES_SURFACE_DAMAGE_HPP
#define TAFONI_RULES_SURFACE_DAMAGE_HPP

#include <tafoni/rules/concepts.hpp>
#include <tafoni/rules/parameter_checks.hpp>

#include <array>

namespace tafoni {

/// Loss of life k_dmg w A / a, with w the absorbed water, a the link's area and A the mean area at the
/// start [Mateos et al., section 5.2: k_dmg = 0.5 A]. Models `damage_rule`.
struct surface_damage {
    double k_dmg = 0.5;  ///< life per water on a link of mean area, in [0, 1e6]

    /// Life that `absorbed` water takes, >= 0; the engine stops at life 0. O(1).
    [[nodiscard]] double damage(link_view const& l, double absorbed, link_scale const& scale) const noexcept {
        return k_dmg * absorbed * (scale.mean_area / l.area);
    }

    /// \throws invalid_input  `bad_parameter` for a coefficient out of range.
    void validate() const { detail::require_range("surface_damage.k_dmg", k_dmg, 0, detail::coefficient_limit); }

    [[nodiscard]] std::array<double, 1> parameters() const noexcept { return {k_dmg}; }
};

static_assert(damage_rule<surface_damage>);

}  // namespace tafoni

#endif
