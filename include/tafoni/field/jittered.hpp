/// \file
/// A field whose boundaries wander: folded layers, ragged pockets.
#ifndef TAFONI_FIELD_JITTERED_HPP
#define TAFONI_FIELD_JITTERED_HPP

#include <tafoni/field/fractal_noise.hpp>

namespace tafoni {

/// `base` at p displaced by up to `amplitude` along each axis, as three fractal noises say. The range
/// is that of `base`. Models `scalar_field`.
template <scalar_field Base>
struct jittered {
    [[no_unique_address]] Base base{};
    double amplitude = 0;   ///< length unit, >= 0
    fractal_noise noise{};

    /// Cost of `base` and of three noises.
    [[nodiscard]] double operator()(vec3 const& p) const {
        vec3 q = p;
        fractal_noise n = noise;
        for (int a = 0; a < 3; ++a) {
            q[a] += amplitude * n(p);
            n.seed += 0xA0761D6478BD642FULL;
        }
        return base(q);
    }

    /// \throws invalid_input  if a parameter lies outside its range.
    void validate() const {
        detail::require_range("jittered.amplitude", amplitude, 0, 1e300);
        noise.validate();
        if constexpr (requires { base.validate(); }) base.validate();
    }
};

template <class Base>
jittered(Base, double, fractal_noise) -> jittered<Base>;
template <class Base>
jittered(Base, double) -> jittered<Base>;

}  // namespace tafoni

#endif
