/// \file
/// A standing wave, as in Figure 9 of the frost paper.
#ifndef TAFONI_FIELD_SINE_HPP
#define TAFONI_FIELD_SINE_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/error.hpp>
#include <tafoni/field/concepts.hpp>

namespace tafoni {

/// mean + amplitude sin(wave . p + phase)   [Mateos et al., Figure 9].
///
/// Within mean +- |amplitude|: a resistance for 0 <= mean - |amplitude| and mean + |amplitude| <= 1.
/// Models `scalar_field`.
struct sine_field {
    vec3 wave{0, 0, 1};     ///< radians per length unit; its direction is that of the wave
    double phase = 0;       ///< radians
    double mean = 0.5;
    double amplitude = 0.5;

    /// O(1), about 20 ns.
    [[nodiscard]] double operator()(vec3 const& p) const noexcept {
        return mean + amplitude * elementary::sin(dot(wave, p) + phase);
    }

    /// \throws invalid_input  if a parameter is not finite.
    void validate() const {
        for (int a = 0; a < 3; ++a) detail::require_range("sine_field.wave", wave[a], -1e300, 1e300);
        detail::require_range("sine_field.phase", phase, -1e300, 1e300);
        detail::require_range("sine_field.mean", mean, -1e300, 1e300);
        detail::require_range("sine_field.amplitude", amplitude, -1e300, 1e300);
    }
};

static_assert(scalar_field<sine_field>);

}  // namespace tafoni

#endif
