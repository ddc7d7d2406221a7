/// \file
/// The less water is left, the likelier a link drinks it all.
#ifndef TAFONI_RULES_DEPLETION_SOAKING_HPP
#define TAFONI_RULES_DEPLETION_SOAKING_HPP

#include <tafoni/rules/concepts.hpp>
#include <tafoni/rules/parameter_checks.hpp>

#include <array>

namespace tafoni {

/// Chance 1 - c w / (t w_in) while w < t w_in, else 0. With the defaults t = c = 1 this is the paper's
/// total absorption, 1 - w / w_in [Mateos et al., section 5.2].
///
/// The authors' add-on: t = 0.25, c = 0.9, and of the rest of the water 75 % wears the link (`wearing`);
/// 25 % is lost without effect. (Its threshold is an absolute amount; the same for its w_in of 1.)
/// Models `soaking_rule`.
struct depletion_soaking {
    double threshold = 1;        ///< t, share of w_in, in [0, 1]; 0 switches the event off
    double continue_chance = 1;  ///< c, chance to flow on at the threshold, in [0, 1]
    double wearing = 1;          ///< share of the rest that the link absorbs, in [0, 1]; what remains is lost

    /// Chance that the link drinks all that is left, in [0, 1]. O(1).
    [[nodiscard]] double soak_chance(link_view const&, water const& w) const noexcept {
        double const limit = threshold * w.initial;
        if (!(w.now < limit)) return 0;
        return 1 - continue_chance * (w.now / limit);
    }

    /// Share of the soaked water that wears the link, in [0, 1]. O(1).
    [[nodiscard]] double soaked_share(link_view const&) const noexcept { return wearing; }

    /// \throws invalid_input  `bad_parameter` for a share or chance outside [0, 1].
    void validate() const {
        detail::require_range("depletion_soaking.threshold", threshold, 0, 1);
        detail::require_range("depletion_soaking.continue_chance", continue_chance, 0, 1);
        detail::require_range("depletion_soaking.wearing", wearing, 0, 1);
    }

    [[nodiscard]] std::array<double, 3> parameters() const noexcept { return {threshold, continue_chance, wearing}; }
};

static_assert(soaking_rule<depletion_soaking>);

}  // namespace tafoni

#endif
