/// \file
/// Two fields mixed by a third.
#ifndef TAFONI_FIELD_BLEND_HPP
#define TAFONI_FIELD_BLEND_HPP

#include <tafoni/field/concepts.hpp>
#include <tafoni/field/detail/mix.hpp>

namespace tafoni {

/// (1 - t) first + t second with t = weight(p) clamped to [0, 1]: between the two. Models `scalar_field`.
template <scalar_field First, scalar_field Second, scalar_field Weight>
struct blend {
    [[no_unique_address]] First first{};
    [[no_unique_address]] Second second{};
    [[no_unique_address]] Weight weight{};

    /// Cost of the three fields.
    [[nodiscard]] double operator()(vec3 const& p) const {
        double const w = weight(p);
        double const t = w > 0 ? (w < 1 ? w : 1.0) : 0.0;
        double const a = first(p);
        double const b = second(p);
        return detail::mix(a, b, t);
    }

    /// Asks the three fields. \throws invalid_input  as they do.
    void validate() const {
        if constexpr (requires { first.validate(); }) first.validate();
        if constexpr (requires { second.validate(); }) second.validate();
        if constexpr (requires { weight.validate(); }) weight.validate();
    }
};

template <class First, class Second, class Weight>
blend(First, Second, Weight) -> blend<First, Second, Weight>;

}  // namespace tafoni

#endif
