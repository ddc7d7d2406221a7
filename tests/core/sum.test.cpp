#include <tafoni/core/random.hpp>
#include <tafoni/core/sum.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <numeric>
#include <vector>

using namespace tafoni;

TEST_CASE("a pairwise sum of integers is exact, whatever the range") {
    auto const identity = [](std::size_t i) { return static_cast<double>(i); };
    for (std::size_t n : {0U, 1U, 2U, 31U, 32U, 33U, 64U, 65U, 1000U, 100'001U}) {
        double const nd = static_cast<double>(n);
        CHECK(pairwise_sum(0, n, identity) == (n == 0 ? 0 : nd * (nd - 1) / 2));
    }
    CHECK(pairwise_sum(10, 13, identity) == 33);
}

TEST_CASE("every term is asked for once") {
    std::vector<int> asked(1000);
    (void)pairwise_sum(0, asked.size(), [&](std::size_t i) { return static_cast<double>(++asked[i]); });
    for (int const a : asked) CHECK(a == 1);
}

TEST_CASE("a pairwise sum of ten million tenths loses fewer digits than a plain one") {
    constexpr std::size_t n = 10'000'000;
    double plain = 0;
    for (std::size_t i = 0; i < n; ++i) plain += 0.1;
    double const pairwise = pairwise_sum(0, n, [](std::size_t) { return 0.1; });
    CHECK(std::fabs(pairwise - 1e6) < 1e-8);
    CHECK(std::fabs(plain - 1e6) > 1e-5);
}

TEST_CASE("fixed-point shares add up without regard to order") {
    stream s(1, stage::user, 0);
    double const total = 123.456;
    std::vector<std::int64_t> parts;
    for (int i = 0; i < 1000; ++i) parts.push_back(to_fixed(s.uniform01() * total, total));
    auto const forward = std::accumulate(parts.begin(), parts.end(), std::int64_t{0});
    auto const backward = std::accumulate(parts.rbegin(), parts.rend(), std::int64_t{0});
    CHECK(forward == backward);
}

TEST_CASE("fixed point keeps a part to half a unit of 2^-52 of the total") {
    stream s(2, stage::user, 0);
    for (double const total : {1.0, 3e-30, 7e30}) {
        CHECK(to_fixed(0, total) == 0);
        CHECK(to_fixed(total, total) == std::int64_t{1} << 52);
        CHECK(from_fixed(std::int64_t{1} << 52, total) == total);
        for (int i = 0; i < 1000; ++i) {
            double const part = s.uniform01() * total;
            CHECK(std::fabs(from_fixed(to_fixed(part, total), total) - part) <= 0x1p-52 * total);
        }
    }
}
