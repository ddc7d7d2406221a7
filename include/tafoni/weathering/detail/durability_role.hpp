/// \file
/// The member `durability` of a process.
#ifndef TAFONI_WEATHERING_DETAIL_DURABILITY_ROLE_HPP
#define TAFONI_WEATHERING_DETAIL_DURABILITY_ROLE_HPP

#include <tafoni/field/concepts.hpp>
#include <tafoni/field/constant.hpp>

#include <concepts>
#include <type_traits>

namespace tafoni::detail {

struct durability_role {
    template <class T>
    static constexpr bool fits = scalar_field<T>;
    template <class T>
    static constexpr bool resembles = std::is_arithmetic_v<T> || std::invocable<T const&, vec3>;
    template <class T>
    static void expect() {
        static_assert(fits<T>,
                      "`durability` takes a scalar_field: tafoni::constant_field{0.02}, or double operator()(vec3 const&) const");
    }
};

/// A field of 1 where the field is a constant, else the field's own default.
template <class Field>
[[nodiscard]] constexpr Field even_durability() {
    if constexpr (std::is_same_v<Field, constant_field>) return constant_field{1};
    else return Field{};
}

}  // namespace tafoni::detail

#endif
