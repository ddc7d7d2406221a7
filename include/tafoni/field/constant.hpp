/// \file
/// The same value everywhere.
#ifndef TAFONI_FIELD_CONSTANT_HPP
#define TAFONI_FIELD_CONSTANT_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/field/concepts.hpp>

namespace tafoni {

/// `value` at every point; as a resistance in [0, 1]. Models `scalar_field`.
struct constant_field {
    double value = 0.5;

    [[nodiscard]] double operator()(vec3 const&) const noexcept { return value; }

    /// \throws invalid_input  if `value` is not finite.
    void validate() const { detail::require_range("constant_field.value", value, -1e300, 1e300); }
};

static_assert(scalar_field<constant_field>);

}  // namespace tafoni

#endif
