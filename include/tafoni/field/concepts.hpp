/// \file
/// Scalar fields over space: resistance, durability, radii.
#ifndef TAFONI_FIELD_CONCEPTS_HPP
#define TAFONI_FIELD_CONCEPTS_HPP

#include <tafoni/core/vector.hpp>

#include <concepts>

namespace tafoni {

/// A number at every point of space.
///
/// Laws: pure; finite for finite points; the range is stated by each model.
/// Model: `struct mine { double operator()(vec3 const& p) const { return p.z() > 0 ? 0.2 : 0.8; } };`
template <class F>
concept scalar_field = std::copy_constructible<F> && requires(F const& f, vec3 const& p) {
    { f(p) } -> std::same_as<double>;
};

}  // namespace tafoni

#endif
