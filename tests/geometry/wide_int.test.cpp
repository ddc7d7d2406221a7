#include <tafoni/core/random.hpp>
#include <tafoni/geometry/wide_int.hpp>

#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>

namespace {

using namespace tafoni;
using boost::multiprecision::cpp_int;

template <std::size_t N>
cpp_int value(wide_int<N> const& a) {
    cpp_int v = 0;
    for (std::size_t k = N; k-- > 0;) v = (v << 64) + a.limb[k];
    if (a.negative()) v -= cpp_int(1) << static_cast<unsigned>(64 * N);
    return v;
}

// Random limbs with many that are all zeros or all ones, where carries and borrows run.
template <std::size_t N>
wide_int<N> any(stream& random, int spare) {
    wide_int<N> a;
    for (auto& l : a.limb) {
        auto const kind = random.index_below(4);
        l = kind == 0 ? 0 : kind == 1 ? ~std::uint64_t{0} : random.bits();
    }
    auto top = static_cast<std::int64_t>(a.limb[N - 1]) >> spare;
    a.limb[N - 1] = static_cast<std::uint64_t>(top);
    return a;
}

template <std::size_t N, std::size_t M>
void check(stream& random) {
    for (int trial = 0; trial < 2000; ++trial) {
        auto const a = any<N>(random, 0);
        auto const b = any<M>(random, 0);
        REQUIRE(value(a * b) == value(a) * value(b));
        auto const c = any<N>(random, 2);
        auto const d = any<M>(random, 2);
        REQUIRE(value(c + d) == value(c) + value(d));
        REQUIRE(value(c - d) == value(c) - value(d));
        REQUIRE(value(-c) == -value(c));
        REQUIRE((c - d).sign() == (value(c) - value(d)).sign());
        cpp_int const v = value(a);
        cpp_int const back(to_double(a));
        REQUIRE(abs(back - v) * (cpp_int(1) << 51) <= abs(v));
    }
}

}  // namespace

TEST_CASE("wide integers add, subtract, multiply and convert like integers") {
    stream random(7, stage::user, 0);
    check<1, 1>(random);
    check<2, 1>(random);
    check<1, 3>(random);
    check<3, 2>(random);
    check<2, 4>(random);
    check<6, 6>(random);
}

TEST_CASE("a wide integer widens with its sign") {
    REQUIRE(wide_int<4>(wide_int<2>(std::int64_t{-5})) == wide_int<4>(std::int64_t{-5}));
    REQUIRE(wide_int<4>(std::int64_t{-5}).sign() == -1);
    REQUIRE(wide_int<3>(std::int64_t{0}).sign() == 0);
    REQUIRE(to_double(wide_int<6>(std::int64_t{-3})) == -3.0);
}
