/// \file
/// A value that changes steadily from one place to another.
#ifndef TAFONI_FIELD_RAMP_HPP
#define TAFONI_FIELD_RAMP_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/field/concepts.hpp>
#include <tafoni/field/detail/mix.hpp>

namespace tafoni {

/// `at_start` before the plane through `start`, `at_end` behind the one through `end`, linear between
/// them; both planes are perpendicular to end - start. Within [at_start, at_end]. Models `scalar_field`.
struct ramp_field {
    vec3 start{0, 0, 0};
    vec3 end{0, 0, 1};
    double at_start = 0;
    double at_end = 1;

    /// O(1).
    [[nodiscard]] double operator()(vec3 const& p) const noexcept {
        vec3 const axis = end - start;
        vec3 const way = p - start;
        double const t = dot(way, axis) / dot(axis, axis);
        if (!(t > 0)) return at_start;
        return detail::mix(at_start, at_end, t);
    }

    /// \throws invalid_input  if start and end coincide or are not finite.
    void validate() const {
        vec3 const axis = end - start;
        detail::require_range("ramp_field.end - start", length(axis), 1e-150, 1e150);
        detail::require_range("ramp_field.at_start", at_start, -1e300, 1e300);
        detail::require_range("ramp_field.at_end", at_end, -1e300, 1e300);
    }
};

static_assert(scalar_field<ramp_field>);

}  // namespace tafoni

#endif
