#include <tafoni/geometry/detail/exact_sign.hpp>

#include <tafoni/core/random.hpp>

#include <catch2/catch.hpp>

#include <cstdint>

using namespace tafoni;

namespace {

__extension__ using i128 = __int128;

int sign(i128 x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

i128 det3(std::array<std::array<std::int64_t, 3>, 3> const& m) {
    auto const term = [&](std::size_t i, std::size_t j, std::size_t k) { return i128{m[0][i]} * m[1][j] * m[2][k]; };
    return term(0, 1, 2) + term(1, 2, 0) + term(2, 0, 1) - term(2, 1, 0) - term(1, 0, 2) - term(0, 2, 1);
}

vec3 as_vec3(std::array<std::int64_t, 3> const& p) {
    return vec3{static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

}  // namespace

TEST_CASE("signs agree with whole numbers of 128 bits, also where doubles round to zero") {
    int zeros = 0;
    for (std::uint64_t seed = 0; seed < 20000; ++seed) {
        stream draw(seed, stage::user, 13);
        std::int64_t const range = std::int64_t{1} << (2 + seed % 38);
        auto const number = [&] {
            return static_cast<std::int64_t>(draw.index_below(static_cast<std::uint64_t>(2 * range))) - range;
        };
        std::array<std::array<std::int64_t, 3>, 4> p{};
        for (auto& q : p) {
            for (auto& x : q) x = number();
        }
        if (seed % 2 == 0) {
            // The fourth on, or one unit beside, the plane of the others.
            for (std::size_t a = 0; a < 3; ++a) p[3][a] = p[0][a] + (p[1][a] - p[0][a]) + (p[2][a] - p[0][a]);
            if (seed % 4 == 0) p[3][seed % 3] += 1;
        }
        std::array<std::array<std::int64_t, 3>, 3> rows{};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t a = 0; a < 3; ++a) rows[i][a] = p[i + 1][a] - p[0][a];
        }
        int const side = sign(det3(rows));
        zeros += side == 0 ? 1 : 0;
        CHECK(detail::side_sign(as_vec3(p[0]), as_vec3(p[1]), as_vec3(p[2]), as_vec3(p[3])) == side);
        CHECK(detail::side_sign(as_vec3(p[1]), as_vec3(p[0]), as_vec3(p[2]), as_vec3(p[3])) == -side);
        i128 const turn = i128{p[1][0] - p[0][0]} * (p[2][1] - p[0][1]) - i128{p[1][1] - p[0][1]} * (p[2][0] - p[0][0]);
        auto const d = [](std::int64_t x) { return static_cast<double>(x); };
        CHECK(detail::turn_sign(d(p[0][0]), d(p[0][1]), d(p[1][0]), d(p[1][1]), d(p[2][0]), d(p[2][1])) == sign(turn));
    }
    CHECK(zeros > 4000);
}

TEST_CASE("a turn by one unit in the last place of far coordinates is seen") {
    double const far = 0x1p40;
    double const step = 0x1p-12;
    CHECK(detail::turn_sign(far, far, far + step, far + step, far + 2 * step, far + 2 * step) == 0);
    CHECK(detail::turn_sign(far, far, far + step, far + step, far + 2 * step, far + 3 * step) == 1);
    CHECK(detail::turn_sign(0, 0, 1e300 * 1e-200, 1, 2e100, std::nextafter(2.0, 3.0)) == 1);
}
