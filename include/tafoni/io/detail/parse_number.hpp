/// \file
/// Decimal numbers from text: correctly rounded, the same in every locale, fast for short ones.
#ifndef TAFONI_IO_DETAIL_PARSE_NUMBER_HPP
#define TAFONI_IO_DETAIL_PARSE_NUMBER_HPP

#include <bit>
#include <charconv>
#include <cstdint>
#include <limits>
#include <system_error>

namespace tafoni::detail {

enum class number_state : std::uint8_t { ok, malformed, overflow };

/// One number: where it ended, and whether it was one.
struct parsed_number {
    double value = 0;
    char const* next = nullptr;
    number_state state = number_state::malformed;
};

[[nodiscard]] inline bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

/// Tells 1e999 from 1e-999, which `from_chars` reports alike: true when the value is below one.
[[nodiscard]] inline bool decimal_is_tiny(char const* at, char const* end) noexcept {
    std::int64_t magnitude = 0;
    bool seen_nonzero = false;
    bool seen_point = false;
    for (; at != end && (is_digit(*at) || *at == '.' || *at == '-' || *at == '+'); ++at) {
        if (*at == '.') {
            seen_point = true;
        } else if (is_digit(*at)) {
            seen_nonzero = seen_nonzero || *at != '0';
            if (seen_nonzero && !seen_point) ++magnitude;
            if (!seen_nonzero && seen_point) --magnitude;
        }
    }
    if (at == end || (*at != 'e' && *at != 'E')) return magnitude < 0;
    ++at;
    bool const negative = at != end && *at == '-';
    if (at != end && (*at == '-' || *at == '+')) ++at;
    std::int64_t exponent = 0;
    for (; at != end && is_digit(*at); ++at) {
        if (exponent < std::numeric_limits<std::int64_t>::max() / 16) exponent = 10 * exponent + (*at - '0');
    }
    return magnitude + (negative ? -exponent : exponent) < 0;
}

/// Any form that `from_chars` knows (also nan and inf), with an optional leading plus.
[[nodiscard]] inline parsed_number parse_any_double(char const* first, char const* end) noexcept {
    char const* at = first;
    if (at != end && *at == '+') {
        ++at;
        if (at != end && (*at == '-' || *at == '+')) return {0, first, number_state::malformed};
    }
    double value = 0;
    auto const [next, error] = std::from_chars(at, end, value);
    if (error == std::errc{}) return {value, next, number_state::ok};
    if (error != std::errc::result_out_of_range) return {0, first, number_state::malformed};
    if (decimal_is_tiny(at, next)) return {*at == '-' ? -0.0 : 0.0, next, number_state::ok};
    return {0, next, number_state::overflow};
}

/// The decimal number at `first`, rounded to the nearest double; 1e-999 is zero, 1e999 is `overflow`.
///
/// Up to 19 digits whose integer part is exact and whose power of ten is exact need one rounding
/// only, so one product or quotient is correctly rounded (Clinger 1990); the rest takes the long way.
[[nodiscard]] inline parsed_number parse_double(char const* first, char const* end) noexcept {
    static constexpr double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                        1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    char const* at = first;
    bool const negative = at != end && *at == '-';
    if (at != end && (*at == '-' || *at == '+')) ++at;
    std::uint64_t mantissa = 0;
    char const* const integer = at;
    while (at != end && is_digit(*at)) mantissa = 10 * mantissa + static_cast<std::uint64_t>(*at++ - '0');
    std::int64_t digits = at - integer;
    std::int64_t exponent = 0;
    if (at != end && *at == '.') {
        char const* const fraction = ++at;
        while (at != end && is_digit(*at)) mantissa = 10 * mantissa + static_cast<std::uint64_t>(*at++ - '0');
        exponent = fraction - at;
        digits -= exponent;
    }
    if (digits == 0 || digits > 19) return parse_any_double(first, end);
    if (at != end && (*at == 'e' || *at == 'E')) {
        char const* power = at + 1;
        bool const below = power != end && *power == '-';
        if (power != end && (*power == '-' || *power == '+')) ++power;
        char const* const power_digits = power;
        std::int64_t e = 0;
        while (power != end && is_digit(*power) && power - power_digits < 4) e = 10 * e + (*power++ - '0');
        if (power == power_digits) return parse_any_double(first, end);
        exponent += below ? -e : e;
        at = power;
        if (at != end && is_digit(*at)) return parse_any_double(first, end);
    }
    if (mantissa > (std::uint64_t{1} << 53) || exponent < -22 || exponent > 22) return parse_any_double(first, end);
    double value = static_cast<double>(mantissa);
    value = exponent < 0 ? value / powers[-exponent] : value * powers[exponent];
    return {negative ? -value : value, at, number_state::ok};
}

/// The nearest float. The pass through memory keeps g++ 12 from dropping the rounding: at -O2 its
/// vectoriser takes `double(float(x))` on neighbouring values for x.
[[nodiscard]] inline double round_to_float(double x) noexcept {
    float volatile const rounded = static_cast<float>(x);
    return static_cast<double>(rounded);
}

/// As `parse_double`, rounded once to float.
[[nodiscard]] inline parsed_number parse_float(char const* first, char const* end) noexcept {
    parsed_number r = parse_double(first, end);
    if (r.state != number_state::ok) return r;
    bool const halfway = (std::bit_cast<std::uint64_t>(r.value) & 0x1fffffffU) == 0x10000000U;
    bool const in_range = r.value > -3.4e38 && r.value < 3.4e38;
    bool const normal = r.value > 1.2e-38 || r.value < -1.2e-38 || r.value == 0;
    if (!halfway && in_range && normal) {
        r.value = round_to_float(r.value);
        return r;
    }
    float value = 0;
    char const* const at = first != end && *first == '+' ? first + 1 : first;
    auto const [next, error] = std::from_chars(at, end, value);
    if (error == std::errc{}) {
        r.value = static_cast<double>(value);
    } else if (decimal_is_tiny(at, next)) {
        r.value = *at == '-' ? -0.0 : 0.0;
    } else {
        r.state = number_state::overflow;
    }
    return r;
}

/// One integer with its sign kept apart, so that every 64-bit value fits.
struct parsed_integer {
    std::uint64_t magnitude = 0;
    char const* next = nullptr;
    bool negative = false;
    number_state state = number_state::malformed;
};

[[nodiscard]] inline parsed_integer parse_integer(char const* first, char const* end) noexcept {
    constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
    parsed_integer r;
    char const* at = first;
    r.negative = at != end && *at == '-';
    if (at != end && (*at == '-' || *at == '+')) ++at;
    char const* const digits = at;
    bool overflow = false;
    for (; at != end && is_digit(*at); ++at) {
        std::uint64_t const d = static_cast<std::uint64_t>(*at - '0');
        if (r.magnitude >= most / 10 && (r.magnitude > most / 10 || d > most % 10)) overflow = true;
        r.magnitude = 10 * r.magnitude + d;
    }
    r.next = at;
    if (at != digits) r.state = overflow ? number_state::overflow : number_state::ok;
    return r;
}

}  // namespace tafoni::detail

#endif
