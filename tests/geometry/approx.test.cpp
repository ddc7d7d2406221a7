#include <tafoni/core/random.hpp>
#include <tafoni/geometry/approx.hpp>
#include <tafoni/geometry/wide_int.hpp>

#include <catch2/catch.hpp>

#include <cmath>

using namespace tafoni;

TEST_CASE("an approximate number is sure of its sign only when it is right") {
    stream random(5, stage::user, 0);
    auto const draw = [&random] {
        auto const shift = static_cast<int>(random.index_below(57));
        return (static_cast<std::int64_t>(random.bits()) >> 6) >> shift;
    };
    int sure = 0;
    int unsure = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        std::int64_t const a = draw();
        std::int64_t const b = draw();
        std::int64_t const c = draw();
        std::int64_t const d = draw();
        // Half of the products are nearly equal.
        bool const close = random.chance(0.5);
        std::int64_t const e = close ? b + static_cast<std::int64_t>(random.index_below(3)) - 1 : c;
        auto const value = [&]<class Num>(Num) { return (Num(a) * Num(b) - Num(a) * Num(e)) * Num(d) + Num(c) * Num(d) * Num(d); };
        int const fast = value(approx{}).sign();
        int const exact = value(wide_int<1>{}).sign();
        if (fast != 0) {
            REQUIRE(fast == exact);
            ++sure;
        } else {
            ++unsure;
        }
    }
    REQUIRE(sure > 10000);
    REQUIRE(unsure > 20);
}
