/// \file
/// Range checks that policies share in their `validate()`.
#ifndef TAFONI_RULES_PARAMETER_CHECKS_HPP
#define TAFONI_RULES_PARAMETER_CHECKS_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/vector.hpp>

#include <cmath>
#include <cstdint>
#include <string>

namespace tafoni::detail {

/// Coefficients beyond this are typing errors: one link would drink a million cycles' rain.
inline constexpr double coefficient_limit = 1e6;

/// Throws `bad_parameter` unless |d| = 1 within 1e-6; NaN and the zero vector fail.
inline void require_unit(char const* name, vec3 const& d) {
    double const l = length(d);
    if (!(std::fabs(l - 1) <= 1e-6)) {
        fail<invalid_input>(errc::bad_parameter,
                            std::string(name) + ": got length " + number_text(l) + ", allowed 1 (unit vector)",
                            {.kind = entity::parameter, .value = l, .limit = 1});
    }
}

/// Calls `f(policy)` for each part of a bundle, or once for a policy that is no bundle.
template <class Policy, class F>
void visit_policies(Policy const& policy, F const& f) {
    if constexpr (requires { policy.for_each_policy(f); }) {
        policy.for_each_policy([&f](auto const& part) { visit_policies(part, f); });
    } else {
        f(policy);
    }
}

/// Runs `validate()` of every part that has one.
template <class Policy>
void validate_policies(Policy const& policy) {
    visit_policies(policy, [](auto const& part) {
        if constexpr (requires { part.validate(); }) part.validate();
    });
}

}  // namespace tafoni::detail

#endif
