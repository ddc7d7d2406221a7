#include <tafoni/core/random.hpp>

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

namespace {

using tafoni::stream;

std::array<std::uint32_t, 4> block(std::array<std::uint32_t, 4> c, std::array<std::uint32_t, 2> k) {
    return tafoni::detail::philox(c, k);
}

/// Pearson's statistic as a standard normal deviate [Wilson, Hilferty 1931].
double chi_square_deviate(std::vector<double> const& counts) {
    double total = 0;
    for (double const c : counts) total += c;
    double const expected = total / static_cast<double>(counts.size());
    double statistic = 0;
    for (double const c : counts) statistic += (c - expected) * (c - expected) / expected;
    double const freedom = static_cast<double>(counts.size() - 1);
    return (std::cbrt(statistic / freedom) - (1 - 2 / (9 * freedom))) / std::sqrt(2 / (9 * freedom));
}

/// Two-sided bound for alpha = 1e-6.
constexpr double rare = 4.9;

}  // namespace

TEST_CASE("the generator is Philox4x32-10: the known answers of Random123") {
    using words = std::array<std::uint32_t, 4>;
    CHECK(block({0, 0, 0, 0}, {0, 0}) == words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
    CHECK(block({~0U, ~0U, ~0U, ~0U}, {~0U, ~0U}) == words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
    CHECK(block({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
          words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("a stream starts at the block that its three arguments name") {
    stream s(0, 0, 0);
    CHECK(s.bits() == 0xe169c58d6627e8d5);
    CHECK(s.bits() == 0x9b00dbd8bc57ac4c);
    std::uint64_t const seed = 0x299f31d0a4093822;
    auto const b = block({0, 7, 0x89abcdef, 0x01234567}, {0xa4093822, 0x299f31d0});
    stream t(seed, 7, 0x0123456789abcdef);
    CHECK(t.bits() == (std::uint64_t{b[1]} << 32 | b[0]));
    CHECK(t.bits() == (std::uint64_t{b[3]} << 32 | b[2]));
    auto const next = block({1, 7, 0x89abcdef, 0x01234567}, {0xa4093822, 0x299f31d0});
    CHECK(t.bits() == (std::uint64_t{next[1]} << 32 | next[0]));
}

TEST_CASE("streams can be evaluated by the compiler and copied with their position") {
    constexpr std::uint64_t first = [] {
        stream s(1, 2, 3);
        return s.bits();
    }();
    stream s(1, 2, 3);
    CHECK(s.bits() == first);
    stream copy = s;
    for (int i = 0; i < 10; ++i) CHECK(copy.bits() == s.bits());
}

TEST_CASE("uniform draws fill 4096 bins evenly [law 54]") {
    std::vector<double> high(4096);
    std::vector<double> low(4096);
    stream s(2024, tafoni::stage::user, 0);
    for (int i = 0; i < 1'000'000; ++i) {
        ++high[static_cast<std::size_t>(s.uniform01() * 4096)];
        ++low[s.bits() & 4095];
    }
    CHECK(std::fabs(chi_square_deviate(high)) < rare);
    CHECK(std::fabs(chi_square_deviate(low)) < rare);
}

TEST_CASE("first draws of neighbouring streams are as even as draws of one stream [law 54]") {
    for (int which = 0; which < 3; ++which) {
        std::vector<double> bins(1024);
        for (std::uint64_t i = 0; i < 200'000; ++i) {
            stream s(which == 0 ? i : 5, which == 1 ? static_cast<std::uint32_t>(i) : 5, which == 2 ? i : 5);
            ++bins[static_cast<std::size_t>(s.uniform01() * 1024)];
        }
        CHECK(std::fabs(chi_square_deviate(bins)) < rare);
    }
}

TEST_CASE("draws are not correlated with later draws or with those of the next stream [law 54]") {
    constexpr int n = 500'000;
    stream a(11, tafoni::stage::flow, 0);
    stream b(11, tafoni::stage::flow, 1);
    std::vector<double> x;
    std::vector<double> y;
    for (int i = 0; i < n + 16; ++i) {
        x.push_back(a.uniform01() - 0.5);
        y.push_back(b.uniform01() - 0.5);
    }
    // A product of two centred uniforms has variance 1 / 144.
    double const deviation = std::sqrt(n / 144.0);
    for (std::size_t lag : {1U, 2U, 3U, 4U, 7U, 16U}) {
        double sum = 0;
        for (std::size_t i = 0; i < n; ++i) sum += x[i] * x[i + lag];
        CHECK(std::fabs(sum / deviation) < rare);
    }
    double across = 0;
    for (std::size_t i = 0; i < n; ++i) across += x[i] * y[i];
    CHECK(std::fabs(across / deviation) < rare);
}

TEST_CASE("streams that differ in one argument share no draws") {
    std::set<std::uint64_t> seen;
    std::size_t draws = 0;
    for (std::uint64_t seed : {0ULL, 1ULL, ~0ULL, 1ULL << 32}) {
        for (std::uint32_t stage : {0U, 1U, ~0U}) {
            for (std::uint64_t index : {0ULL, 1ULL, 1ULL << 32, ~0ULL}) {
                stream s(seed, stage, index);
                for (int i = 0; i < 50; ++i, ++draws) seen.insert(s.bits());
            }
        }
    }
    CHECK(seen.size() == draws);
}

TEST_CASE("uniform draws stay in their range") {
    stream s(3, tafoni::stage::user, 0);
    double least = 1;
    double most = 0;
    for (int i = 0; i < 100'000; ++i) {
        double const u = s.uniform01();
        least = std::fmin(least, u);
        most = std::fmax(most, u);
        REQUIRE((u >= 0 && u < 1));
        REQUIRE(u * 0x1p53 == std::floor(u * 0x1p53));
        double const v = s.uniform(-2, 6);
        REQUIRE((v >= -2 && v < 6));
    }
    CHECK(least < 1e-3);
    CHECK(most > 1 - 1e-3);
}

TEST_CASE("index_below is even for sizes that do not divide 2^64") {
    for (std::uint64_t const n : {1ULL, 2ULL, 3ULL, 7ULL, 1000ULL}) {
        stream s(4, tafoni::stage::user, n);
        std::vector<double> bins(n);
        for (int i = 0; i < 100'000; ++i) {
            std::uint64_t const k = s.index_below(n);
            REQUIRE(k < n);
            ++bins[k];
        }
        if (n > 1) CHECK(std::fabs(chi_square_deviate(bins)) < rare);
    }
    // Two thirds of 2^64: without rejection the lower half of the answers would come twice as often.
    std::uint64_t const large = 0xAAAAAAAAAAAAAAAAULL;
    stream s(5, tafoni::stage::user, 0);
    std::vector<double> halves(2);
    for (int i = 0; i < 100'000; ++i) ++halves[s.index_below(large) < large / 2 ? 0 : 1];
    CHECK(std::fabs(halves[0] - halves[1]) < rare * std::sqrt(100'000.0));
}

TEST_CASE("chance is exact at its ends and takes one draw") {
    stream s(6, tafoni::stage::user, 0);
    stream t = s;
    int hits = 0;
    for (int i = 0; i < 10'000; ++i) {
        REQUIRE_FALSE(s.chance(0));
        REQUIRE_FALSE(s.chance(-1));
        REQUIRE(s.chance(1));
        REQUIRE(s.chance(2));
        hits += s.chance(0.25) ? 1 : 0;
        for (int k = 0; k < 5; ++k) (void)t.bits();
    }
    CHECK(s.bits() == t.bits());
    CHECK(std::fabs(hits - 2500) < rare * std::sqrt(10'000 * 0.25 * 0.75));
}

TEST_CASE("unit vectors are of unit length and favour no direction") {
    stream s(7, tafoni::stage::user, 0);
    constexpr int n = 100'000;
    tafoni::vec3 sum{0, 0, 0};
    std::vector<double> heights(64);
    for (int i = 0; i < n; ++i) {
        tafoni::vec3 const v = s.unit_vector();
        REQUIRE(std::fabs(tafoni::length(v) - 1) < 1e-15);
        sum += v;
        // Archimedes: every coordinate of a uniform point on the sphere is uniform.
        ++heights[static_cast<std::size_t>(std::fmin((v[2] + 1) * 32, 63.0))];
    }
    for (int axis = 0; axis < 3; ++axis) CHECK(std::fabs(sum[axis]) < rare * std::sqrt(n / 3.0));
    CHECK(std::fabs(chi_square_deviate(heights)) < rare);
}
