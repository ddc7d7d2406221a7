/// \file
/// Numbers as text and as little-endian bytes, the same in every locale.
#ifndef TAFONI_IO_DETAIL_FORMAT_NUMBER_HPP
#define TAFONI_IO_DETAIL_FORMAT_NUMBER_HPP

#include <tafoni/core/vector.hpp>
#include <tafoni/io/detail/parse_number.hpp>
#include <tafoni/io/mesh_file.hpp>

#include <bit>
#include <charconv>
#include <cstdint>
#include <string>
#include <type_traits>

namespace tafoni::detail {

/// The shortest text that reads back as the same number.
template <class Number>
void append_number(std::string& out, Number value) {
    char text[32];
    auto const result = std::to_chars(text, text + sizeof(text), value);
    out.append(text, static_cast<std::size_t>(result.ptr - text));
}

/// The bytes of a number, little end first on every machine.
template <class Number>
void append_little(std::string& out, Number value) {
    using bits_t = std::conditional_t<sizeof(Number) == 8, std::uint64_t,
                   std::conditional_t<sizeof(Number) == 4, std::uint32_t,
                   std::conditional_t<sizeof(Number) == 2, std::uint16_t, std::uint8_t>>>;
    bits_t const bits = std::bit_cast<bits_t>(value);
    char bytes[sizeof(Number)];
    for (std::size_t k = 0; k < sizeof(Number); ++k) bytes[k] = static_cast<char>((bits >> (8 * k)) & 0xffU);
    out.append(bytes, sizeof(Number));
}

/// Calls `f` with `value` converted to the C++ type that `type` names. The value has been checked to fit.
template <class F>
void as_type(channel_type type, double value, F&& f) {
    switch (type) {
        case channel_type::int8: return f(static_cast<std::int8_t>(value));
        case channel_type::uint8: return f(static_cast<std::uint8_t>(value));
        case channel_type::int16: return f(static_cast<std::int16_t>(value));
        case channel_type::uint16: return f(static_cast<std::uint16_t>(value));
        case channel_type::int32: return f(static_cast<std::int32_t>(value));
        case channel_type::uint32: return f(static_cast<std::uint32_t>(value));
        case channel_type::float32: return f(static_cast<float>(value));
        case channel_type::float64: return f(value);
    }
}

/// The origin as a file records it: rounded to float, whose text is short.
[[nodiscard]] inline vec3 float_origin(vec3 const& origin) noexcept {
    return vec3{round_to_float(origin[0]), round_to_float(origin[1]), round_to_float(origin[2])};
}

inline void append_origin(std::string& out, vec3 const& origin) {
    out += "tafoni origin ";
    for (int axis = 0; axis < 3; ++axis) {
        if (axis != 0) out += ' ';
        append_number(out, static_cast<float>(origin[axis]));
    }
}

}  // namespace tafoni::detail

#endif
