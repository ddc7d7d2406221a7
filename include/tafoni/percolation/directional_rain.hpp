/// \file
/// Rain that always travels the same way.
#ifndef TAFONI_PERCOLATION_DIRECTIONAL_RAIN_HPP
#define TAFONI_PERCOLATION_DIRECTIONAL_RAIN_HPP

#include <tafoni/percolation/concepts.hpp>
#include <tafoni/rules/parameter_checks.hpp>

#include <array>

namespace tafoni {

/// Every path's rain travels along `direction` [Mateos et al., section 5.1 and Figure 8].
///
/// The paper's omega_w points against the rain; here it is the direction of travel. The add-on's
/// default is (1, -0.5, -0.5), normalised. Draws nothing. Models `rain_policy`.
struct directional_rain {
    vec3 direction{0, 0, -1};  ///< the way the rain travels, unit length, dimensionless

    /// O(1).
    [[nodiscard]] vec3 draw(stream&) const noexcept { return direction; }

    /// \throws invalid_input  `bad_parameter` unless `direction` has unit length within 1e-6.
    void validate() const { detail::require_unit("directional_rain.direction", direction); }

    [[nodiscard]] std::array<double, 3> parameters() const noexcept {
        return {direction[0], direction[1], direction[2]};
    }
};

/// The name under which a reader of the paper may look for it.
using fixed_rain = directional_rain;

static_assert(rain_policy<directional_rain>);

}  // namespace tafoni

#endif
