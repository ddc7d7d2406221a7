/// \file
/// Strong index types: a cell can not be passed where a link is meant.
#ifndef TAFONI_CORE_INDEX_HPP
#define TAFONI_CORE_INDEX_HPP

#include <tafoni/core/error.hpp>

#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>

namespace tafoni {

/// An index of 32 bits whose tag says what it counts; `none` means "no such element".
template <class Tag>
struct strong_index {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    std::uint32_t value = none;

    constexpr strong_index() = default;
    /// From any whole number below 2^32 - 1; see `detail::require_indexable`.
    template <std::integral Number>
    constexpr explicit strong_index(Number v) noexcept : value(static_cast<std::uint32_t>(v)) {}

    [[nodiscard]] constexpr bool valid() const noexcept { return value != none; }
    friend constexpr auto operator<=>(strong_index, strong_index) = default;
};

using vertex_index = strong_index<struct vertex_tag>;
using face_index = strong_index<struct face_tag>;
using cell_index = strong_index<struct cell_tag>;
using link_index = strong_index<struct link_tag>;
using site_index = strong_index<struct site_tag>;
using patch_index = strong_index<struct patch_tag>;

namespace detail {

/// Throws `size_overflow` when `count` elements cannot be numbered with 32 bits.
inline void require_indexable(char const* who, std::size_t count) {
    if (count >= strong_index<struct any_tag>::none) {
        fail<invalid_input>(errc::size_overflow,
                            std::string(who) + ": " + std::to_string(count) + " elements exceed 32-bit indices");
    }
}

}  // namespace detail
}  // namespace tafoni

template <class Tag>
struct std::hash<tafoni::strong_index<Tag>> {
    std::size_t operator()(tafoni::strong_index<Tag> i) const noexcept { return i.value; }
};

#endif
