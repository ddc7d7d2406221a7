/// \file
/// The same value everywhere.
#ifndef TAFONI_FIELD_CONSTANT_HPP
#define TAFONI_FIELD_CONSTANT_HPP

#include <tafoni/field/concepts.hpp>

namespace tafoni {

/// `value` at every point; as a resistance in [0, 1]. Models `scalar_field`.
struct constant_field {
    double value = 0.5;

    [[nodiscard]] double operator()(vec3 const&) const noexcept { return value; }
};

static_assert(scalar_field<constant_field>);

}  // namespace tafoni

#endif
