/// \file
/// A weakened bond may give way at once.
#ifndef TAFONI_RULES_LOW_LIFE_BREAKAGE_HPP
#define TAFONI_RULES_LOW_LIFE_BREAKAGE_HPP

#include <tafoni/rules/concepts.hpp>
#include <tafoni/rules/parameter_checks.hpp>

#include <array>

namespace tafoni {

/// Chance p_max + (p_min - p_max) life / k_break below life k_break, else 0.
///
/// The paper: k_break = 0.4, p_max = 0.9, p_min = 0, so 0.9 (1 - life/0.4) [Mateos et al., section 5.2].
/// The authors' add-on: 1 - 0.9 life/0.4, that is p_max = 1, p_min = 0.1. Models `breakage_rule`.
struct low_life_breakage {
    double k_break = 0.4;  ///< life below which a link may break, in [0, 1]; 0 switches the event off
    double p_max = 0.9;    ///< chance at life 0, in [0, 1]
    double p_min = 0;      ///< chance just below k_break, in [0, p_max]

    /// Chance that the link breaks now, in [0, 1]; asked with the life after damage. O(1).
    [[nodiscard]] double break_chance(link_view const& l) const noexcept {
        if (!(l.life < k_break)) return 0;
        return p_max + (p_min - p_max) * (l.life / k_break);
    }

    /// \throws invalid_input  `bad_parameter` for a value outside its range.
    void validate() const {
        detail::require_range("low_life_breakage.k_break", k_break, 0, 1);
        detail::require_range("low_life_breakage.p_max", p_max, 0, 1);
        detail::require_range("low_life_breakage.p_min", p_min, 0, p_max);
    }

    [[nodiscard]] std::array<double, 3> parameters() const noexcept { return {k_break, p_max, p_min}; }
};

static_assert(breakage_rule<low_life_breakage>);

}  // namespace tafoni

#endif
