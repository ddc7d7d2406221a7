#include <tafoni/core/random_normal.hpp>

#include <catch2/catch.hpp>

#include <cmath>

TEST_CASE("normal draws have the moments of the normal distribution") {
    tafoni::stream random(3, tafoni::stage::user, 7);
    int const n = 400000;
    double s1 = 0;
    double s2 = 0;
    double s4 = 0;
    int beyond = 0;
    for (int i = 0; i < n; ++i) {
        double const x = tafoni::random_normal(random);
        s1 += x;
        s2 += x * x;
        s4 += x * x * x * x;
        beyond += std::fabs(x) > 1.959964 ? 1 : 0;
    }
    // five standard errors each
    CHECK(std::fabs(s1 / n) < 5 / std::sqrt(double{n}));
    CHECK(std::fabs(s2 / n - 1) < 5 * std::sqrt(2.0 / n));
    CHECK(std::fabs(s4 / n - 3) < 5 * std::sqrt(96.0 / n));
    CHECK(std::fabs(beyond / double{n} - 0.05) < 5 * std::sqrt(0.05 * 0.95 / n));
}

TEST_CASE("a normal draw takes pairs of draws, and equal streams give equal draws") {
    for (std::uint64_t index = 0; index < 200; ++index) {
        tafoni::stream a(9, tafoni::stage::user, index);
        tafoni::stream b = a;
        REQUIRE(tafoni::random_normal(a) == tafoni::random_normal(b));
        tafoni::stream fresh(9, tafoni::stage::user, index);
        std::uint64_t const next = a.bits();
        int pairs = 0;
        bool found = false;
        while (!found && ++pairs < 50) {
            (void)fresh.bits();
            (void)fresh.bits();
            tafoni::stream peek = fresh;
            found = peek.bits() == next;
        }
        REQUIRE(found);
    }
}
