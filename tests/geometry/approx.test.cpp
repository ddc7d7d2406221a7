#include <tafoni/geometry/approx.hpp>

#include <tafoni/core/random.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>

using namespace tafoni;

namespace {

__extension__ using i128 = __int128;

/// Values of polynomials in integers are whole, so the distance to the exact one is exact too.
bool holds(approx a, i128 exact) {
    i128 const off = exact - static_cast<i128>(a.value);
    return static_cast<double>(off < 0 ? -off : off) <= a.error * (1 + 1e-12);
}

int sign_of(i128 x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

std::int64_t draw(stream& random, int bits) {
    auto const size = static_cast<std::int64_t>(random.index_below(std::uint64_t{1} << bits));
    return random.chance(0.5) ? size : -size;
}

}  // namespace

TEST_CASE("the exact value lies within the error, and a sign that is given is right") {
    stream random(2, stage::user, 0);
    int certain = 0;
    int open = 0;
    for (int n = 0; n < 20000; ++n) {
        int const bits = n % 2 == 0 ? 57 : 38;
        std::int64_t const a = draw(random, bits);
        std::int64_t const b = draw(random, bits);
        // Every other case is a near tie: c and d are a and b but for a unit or two.
        std::int64_t const c = n % 4 < 2 ? draw(random, bits) : a + draw(random, 1);
        std::int64_t const d = n % 4 < 2 ? draw(random, bits) : b + draw(random, 1);
        approx const x = approx(a) * approx(b) - approx(c) * approx(d);
        i128 const exact = i128{a} * b - i128{c} * d;
        REQUIRE(holds(x, exact));
        if (x.sign() != 0) REQUIRE(x.sign() == sign_of(exact));
        (x.sign() != 0 ? certain : open) += 1;

        std::int64_t const e = draw(random, 38);
        std::int64_t const f = draw(random, 38);
        std::int64_t const g = draw(random, 38);
        approx const cubic = (approx(e) * approx(f) + approx(g) * approx(g)) * approx(f) - -approx(e);
        REQUIRE(holds(cubic, (i128{e} * f + i128{g} * g) * f + e));
    }
    CHECK(certain > 8000);
    CHECK(open > 1000);
}

TEST_CASE("integers of up to 53 bits are exact, larger ones within half a unit in the last place") {
    for (std::int64_t const v : {std::int64_t{0}, std::int64_t{-7}, (std::int64_t{1} << 53) - 1, -(std::int64_t{1} << 53) + 1}) {
        CHECK(approx(v).error == 0);
        CHECK(approx(v).value == static_cast<double>(v));
        CHECK(approx(v).sign() == sign_of(v));
    }
    std::int64_t const odd = (std::int64_t{1} << 57) - 7;
    CHECK(holds(approx(odd), odd));
    CHECK(approx(odd).error > 0);
    CHECK((approx(odd) - approx(odd)).sign() == 0);
}
