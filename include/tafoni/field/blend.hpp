/// \file
/// Two fields mixed by a third.
#ifndef TAFONI_FIELD_BLEND_HPP
#define TAFONI_FIELD_BLEND_HPP

#include <tafoni/field/concepts.hpp>

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
        return a + t * (second(p) - a);
    }
};

template <class First, class Second, class Weight>
blend(First, Second, Weight) -> blend<First, Second, Weight>;

}  // namespace tafoni

#endif
