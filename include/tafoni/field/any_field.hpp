/// \file
/// A field of any kind behind one type; a plain number costs no call.
#ifndef TAFONI_FIELD_ANY_FIELD_HPP
#define TAFONI_FIELD_ANY_FIELD_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/field/concepts.hpp>

#include <concepts>
#include <functional>
#include <memory>
#include <type_traits>
#include <utility>

namespace tafoni {

/// A number or any scalar field, for parameters that are mostly numbers. Copies share the field, which is
/// constant. Models `scalar_field`.
class any_field {
public:
    any_field() = default;
    any_field(double value) noexcept : value_(value) {}
    template <class F>
        requires(!std::same_as<F, any_field> && !std::is_arithmetic_v<F>) && scalar_field<F>
    any_field(F field) : field_(std::make_shared<std::function<double(vec3 const&)> const>(std::move(field))) {}

    /// O(1) beside the field's own cost.
    [[nodiscard]] double operator()(vec3 const& p) const { return field_ ? (*field_)(p) : value_; }
    /// Whether it is a number, the same everywhere.
    [[nodiscard]] bool is_constant() const noexcept { return !field_; }

private:
    double value_ = 0;
    std::shared_ptr<std::function<double(vec3 const&)> const> field_{};
};

static_assert(scalar_field<any_field>);

}  // namespace tafoni

#endif
