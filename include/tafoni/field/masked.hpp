/// \file
/// A field that holds inside a box only.
#ifndef TAFONI_FIELD_MASKED_HPP
#define TAFONI_FIELD_MASKED_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/field/concepts.hpp>

namespace tafoni {

/// `base` inside the closed box, `outside` elsewhere. Models `scalar_field`.
template <scalar_field Base>
struct masked {
    [[no_unique_address]] Base base{};
    box3 box{};          ///< length unit; the default is empty
    double outside = 0;  ///< in the range of `base`

    /// Cost of `base`.
    [[nodiscard]] double operator()(vec3 const& p) const { return box.contains(p) ? base(p) : outside; }

    /// \throws invalid_input  if `outside` is not finite, and as `base` does.
    void validate() const {
        detail::require_range("masked.outside", outside, -1e300, 1e300);
        if constexpr (requires { base.validate(); }) base.validate();
    }
};

template <class Base>
masked(Base, box3, double) -> masked<Base>;
template <class Base>
masked(Base, box3) -> masked<Base>;

}  // namespace tafoni

#endif
