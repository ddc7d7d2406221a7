#include <catch2/catch.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/io/detail/parse_number.hpp>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>

using namespace tafoni;
using detail::number_state;

namespace {

double value(std::string const& text) {
    auto const r = detail::parse_double(text.data(), text.data() + text.size());
    REQUIRE(r.state == number_state::ok);
    REQUIRE(r.next == text.data() + text.size());
    return r.value;
}

}  // namespace

TEST_CASE("short and long decimals are read as strtod reads them in the C locale") {
    stream random(3, stage::user, 0);
    for (int round = 0; round < 200000; ++round) {
        std::string text = random.chance(0.5) ? "-" : "";
        std::uint64_t const before = random.index_below(12);
        std::uint64_t const after = random.index_below(12);
        for (std::uint64_t k = 0; k < before; ++k) text += static_cast<char>('0' + random.index_below(10));
        text += '.';
        for (std::uint64_t k = 0; k < after; ++k) text += static_cast<char>('0' + random.index_below(10));
        if (before + after == 0) text += '1';
        if (random.chance(0.5)) text += "e" + std::to_string(static_cast<int>(random.index_below(60)) - 30);
        REQUIRE(value(text) == std::strtod(text.c_str(), nullptr));
        auto const single = detail::parse_float(text.data(), text.data() + text.size());
        float const expected = std::strtof(text.c_str(), nullptr);
        REQUIRE((single.state == number_state::overflow) == std::isinf(expected));
        if (!std::isinf(expected)) REQUIRE(single.value == static_cast<double>(expected));
    }
}

TEST_CASE("every double survives its shortest text") {
    stream random(4, stage::user, 0);
    for (int round = 0; round < 200000; ++round) {
        double const x = std::bit_cast<double>(random.bits());
        if (!(x - x == 0)) continue;
        char text[32];
        auto const end = std::to_chars(text, text + 32, x).ptr;
        auto const r = detail::parse_double(text, end);
        REQUIRE(std::bit_cast<std::uint64_t>(r.value) == std::bit_cast<std::uint64_t>(x));
    }
}

TEST_CASE("decimals half way between two floats are rounded once") {
    // Rounded to double first, this becomes a tie, and the tie goes the wrong way.
    std::string const text = "1.00000017881393432617187499";
    auto const r = detail::parse_float(text.data(), text.data() + text.size());
    CHECK(r.value == static_cast<double>(std::strtof(text.c_str(), nullptr)));
    CHECK(r.value == 1.00000011920928955078125);
    for (std::string const& s : {std::string("1e39"), std::string("3.5e38")}) {
        CHECK(detail::parse_float(s.data(), s.data() + s.size()).state == number_state::overflow);
    }
    std::string const tiny = "1e-60";
    CHECK(detail::parse_float(tiny.data(), tiny.data() + tiny.size()).value == 0);
}

TEST_CASE("too large is an error and too small is zero, however it is written") {
    for (std::string const& s : {std::string("1e999"), std::string("-1e400"), "1" + std::string(400, '0'), std::string("0.001e400"),
                                 std::string("1e99999999999999999999999")}) {
        CHECK(detail::parse_double(s.data(), s.data() + s.size()).state == number_state::overflow);
    }
    for (std::string const& s : {std::string("1e-999"), "0." + std::string(400, '0') + "1", std::string("100000e-500"),
                                 std::string("1e-99999999999999999999999"), std::string("0e99999")}) {
        CHECK(value(s) == 0);
    }
    CHECK(value("1" + std::string(400, '0') + "e-400") == 1);
    CHECK(value("0." + std::string(400, '0') + "1e401") == 1);
}

TEST_CASE("integers of any length are read or named too large") {
    auto const parse = [](std::string_view s) { return detail::parse_integer(s.data(), s.data() + s.size()); };
    CHECK(parse("18446744073709551615").magnitude == 18446744073709551615U);
    CHECK(parse("18446744073709551616").state == number_state::overflow);
    CHECK(parse("-7").negative);
    CHECK(parse("+7").magnitude == 7);
    CHECK(parse("-").state == number_state::malformed);
    CHECK(parse("").state == number_state::malformed);
}
