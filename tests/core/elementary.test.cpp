#include <tafoni/core/elementary.hpp>

#include <tafoni/core/random.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

namespace el = tafoni::elementary;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

/// |got - want| in units in the last place of `want`.
double ulps(double got, long double want) {
    auto const w = static_cast<double>(want);
    if (std::isnan(w)) return std::isnan(got) ? 0 : inf;
    if (std::isinf(w) || std::isinf(got)) return got == w ? 0 : inf;
    int e = 0;
    std::frexp(w, &e);
    double const ulp = std::ldexp(1.0, std::max(e - 53, -1074));
    return static_cast<double>(std::fabs(static_cast<long double>(got) - want)) / ulp;
}

struct worst {
    double error = 0;
    double at = 0;
    void see(double got, long double want, double x) {
        double const e = ulps(got, want);
        if (!(e <= error)) {
            error = e;
            at = x;
        }
    }
};

/// A positive double with a uniform exponent.
double any_scale(tafoni::stream& random, int lo, int hi) {
    double const m = random.uniform(1, 2);
    auto const e = static_cast<int>(random.index_below(static_cast<std::uint64_t>(hi - lo)));
    return std::ldexp(m, lo + e);
}

template <class F, class G, class Draw>
void check(F const& f, G const& g, Draw const& draw, int n) {
    tafoni::stream random(11, tafoni::stage::user, 0);
    worst w;
    for (int i = 0; i < n; ++i) {
        double const x = draw(random);
        w.see(f(x), g(static_cast<long double>(x)), x);
    }
    CAPTURE(w.error, w.at);
    CHECK(w.error <= 2);
}

}  // namespace

TEST_CASE("exp is within 2 ulp over its range, subnormal results included") {
    auto const f = [](double x) { return el::exp(x); };
    auto const g = [](long double x) { return std::exp(x); };
    check(f, g, [](tafoni::stream& r) { return r.uniform(-745.2, 709.8); }, 400000);
    check(f, g, [](tafoni::stream& r) { return r.uniform(-1, 1); }, 400000);
    CHECK(el::exp(0) == 1);
    CHECK(el::exp(inf) == inf);
    CHECK(el::exp(-inf) == 0);
    CHECK(el::exp(710) == inf);
    CHECK(std::isnan(el::exp(std::nan(""))));
}

TEST_CASE("log is within 2 ulp from subnormals to the largest double") {
    auto const f = [](double x) { return el::log(x); };
    auto const g = [](long double x) { return std::log(x); };
    check(f, g, [](tafoni::stream& r) { return any_scale(r, -1074, 1023); }, 400000);
    check(f, g, [](tafoni::stream& r) { return r.uniform(0.5, 2); }, 400000);
    check(f, g, [](tafoni::stream& r) { return 1 + r.uniform(-1e-6, 1e-6); }, 200000);
    CHECK(el::log(1) == 0);
    CHECK(el::log(0.0) == -inf);
    CHECK(el::log(inf) == inf);
    CHECK(std::isnan(el::log(-1)));
    CHECK(std::isnan(el::log(std::nan(""))));
}

TEST_CASE("sin and cos are within 2 ulp for small, large and the worst known arguments") {
    auto const s = [](double x) { return el::sin(x); };
    auto const c = [](double x) { return el::cos(x); };
    auto const sl = [](long double x) { return std::sin(x); };
    auto const cl = [](long double x) { return std::cos(x); };
    auto const small = [](tafoni::stream& r) { return r.uniform(-20, 20); };
    auto const any = [](tafoni::stream& r) { return (r.chance(0.5) ? 1 : -1) * any_scale(r, -60, 1023); };
    auto const zeros = [](tafoni::stream& r) {
        return static_cast<double>(r.index_below(1u << 20)) * 1.5707963267948966;
    };
    check(s, sl, small, 300000);
    check(c, cl, small, 300000);
    check(s, sl, any, 300000);
    check(c, cl, any, 300000);
    check(s, sl, zeros, 100000);
    check(c, cl, zeros, 100000);
    CHECK(ulps(el::cos(0x1.6ac5b262ca1ffp+849), std::cos(0x1.6ac5b262ca1ffp+849L)) <= 2);
    CHECK(el::sin(0.0) == 0);
    CHECK(std::signbit(el::sin(-0.0)));
    CHECK(el::cos(0.0) == 1);
    CHECK(std::isnan(el::sin(inf)));
    CHECK(std::isnan(el::cos(-inf)));
}

TEST_CASE("acos is within 2 ulp up to the ends of its range") {
    auto const f = [](double x) { return el::acos(x); };
    auto const g = [](long double x) { return std::acos(x); };
    check(f, g, [](tafoni::stream& r) { return r.uniform(-1, 1); }, 400000);
    check(f, g, [](tafoni::stream& r) { return 1 - any_scale(r, -52, -1); }, 200000);
    check(f, g, [](tafoni::stream& r) { return any_scale(r, -52, -1) - 1; }, 200000);
    check(f, g, [](tafoni::stream& r) { return any_scale(r, -300, -1); }, 100000);
    CHECK(el::acos(1) == 0);
    CHECK(ulps(el::acos(-1), std::acos(-1.0L)) <= 1);
    CHECK(std::isnan(el::acos(1.0000001)));
    CHECK(std::isnan(el::acos(std::nan(""))));
}

TEST_CASE("pow is within 2 ulp and agrees with C on special values") {
    tafoni::stream random(5, tafoni::stage::user, 0);
    worst w;
    for (int i = 0; i < 500000; ++i) {
        double const x = any_scale(random, -1074, 1023);
        double const limit = 746 / (std::fabs(std::log(x)) + 1e-3);
        double const y = random.uniform(-limit, limit);
        long double const want = std::pow(static_cast<long double>(x), static_cast<long double>(y));
        w.see(el::pow(x, y), want, x);
    }
    for (int i = 0; i < 300000; ++i) {
        double const x = random.uniform(0.9, 1.1);
        double const y = random.uniform(-6000, 6000);
        w.see(el::pow(x, y), std::pow(static_cast<long double>(x), static_cast<long double>(y)), x);
    }
    CAPTURE(w.error, w.at);
    CHECK(w.error <= 2);
    double const odd[] = {0.0,  -0.0, 1.0, -1.0, 2.0,  -2.0, 0.5,  -0.5, 3.0, -3.0, inf, -inf, 2.5,
                          -2.5, 1e300, -1e300, 5e-324, -5e-324, 0x1p53, 0x1p53 + 2, std::nan("")};
    for (double const x : odd) {
        for (double const y : odd) {
            CAPTURE(x, y);
            double const want = std::pow(x, y);
            double const got = el::pow(x, y);
            CHECK((std::isnan(want) ? std::isnan(got) : ulps(got, want) <= 2));
            if (want == 0) CHECK(std::signbit(want) == std::signbit(got));
        }
    }
}
