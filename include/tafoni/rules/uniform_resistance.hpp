/// \file
/// The same resistance everywhere.
#ifndef TAFONI_RULES_UNIFORM_RESISTANCE_HPP
#define TAFONI_RULES_UNIFORM_RESISTANCE_HPP

#include <tafoni/core/vector.hpp>
#include <tafoni/field/concepts.hpp>
#include <tafoni/rules/parameter_checks.hpp>

#include <array>

namespace tafoni {

/// rho(x) = value. The default of 0.5 is a decision: with 1 and full life, 1 - f_r = 0 and no water ever
/// enters [Mateos et al., section 5.1]. Models `scalar_field`.
struct uniform_resistance {
    double value = 0.5;  ///< rho, dimensionless, in [0, 1]

    /// O(1).
    [[nodiscard]] double operator()(vec3 const&) const noexcept { return value; }

    /// \throws invalid_input  `bad_parameter` for a value outside [0, 1].
    void validate() const { detail::require_range("uniform_resistance.value", value, 0, 1); }

    [[nodiscard]] std::array<double, 1> parameters() const noexcept { return {value}; }
};

static_assert(scalar_field<uniform_resistance>);

}  // namespace tafoni

#endif
