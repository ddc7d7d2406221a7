/// \file
/// A field brought into another range, such as noise made a resistance.
#ifndef TAFONI_FIELD_REMAPPED_HPP
#define TAFONI_FIELD_REMAPPED_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/field/concepts.hpp>
#include <tafoni/field/detail/mix.hpp>

namespace tafoni {

/// [from_low, from_high] of `base` to [to_low, to_high], linear and clamped. The defaults turn noise
/// into a resistance. Models `scalar_field`.
template <scalar_field Base>
struct remapped {
    [[no_unique_address]] Base base{};
    double from_low = -1;
    double from_high = 1;  ///< > from_low
    double to_low = 0;
    double to_high = 1;

    /// Cost of `base`.
    [[nodiscard]] double operator()(vec3 const& p) const {
        double const t = (base(p) - from_low) / (from_high - from_low);
        if (!(t > 0)) return to_low;
        return detail::mix(to_low, to_high, t);
    }

    /// \throws invalid_input  if the range that is read is empty or a bound is not finite.
    void validate() const {
        detail::require_range("remapped.from_high - from_low", from_high - from_low, 1e-300, 1e300);
        detail::require_range("remapped.to_low", to_low, -1e300, 1e300);
        detail::require_range("remapped.to_high", to_high, -1e300, 1e300);
        if constexpr (requires { base.validate(); }) base.validate();
    }
};

template <class Base, class... Bounds>
remapped(Base, Bounds...) -> remapped<Base>;

}  // namespace tafoni

#endif
