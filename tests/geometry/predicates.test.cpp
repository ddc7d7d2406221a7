#include <tafoni/core/random.hpp>
#include <tafoni/geometry/predicates.hpp>

#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>

#include <algorithm>
#include <vector>

namespace {

using namespace tafoni;
using big = boost::multiprecision::cpp_rational;
using bvec = std::array<big, 3>;

// A rational plus a polynomial of first degree in the weights; w_0 >> w_1 >> ...
struct perturbed {
    big value = 0;
    std::vector<big> weight = std::vector<big>(8, big(0));

    [[nodiscard]] int sign() const {
        if (value != 0) return value > 0 ? 1 : -1;
        for (auto const& w : weight)
            if (w != 0) return w > 0 ? 1 : -1;
        return 0;
    }
    friend perturbed operator*(perturbed a, big const& f) {
        a.value *= f;
        for (auto& w : a.weight) w *= f;
        return a;
    }
    friend perturbed operator+(perturbed a, perturbed const& b) {
        a.value += b.value;
        for (std::size_t k = 0; k < a.weight.size(); ++k) a.weight[k] += b.weight[k];
        return a;
    }
};

bvec rel(ivec3 const& a, ivec3 const& b) { return {big(a[0] - b[0]), big(a[1] - b[1]), big(a[2] - b[2])}; }
big dot(bvec const& a, bvec const& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
bvec cross(bvec const& a, bvec const& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct oracle_plane {
    bvec n;
    perturbed h;
};
oracle_plane make(exact::site const& i, exact::plane const& p) {
    oracle_plane r;
    if (p.axis >= 0) {
        auto const a = static_cast<std::size_t>(p.axis);
        r.n = {big(0), big(0), big(0)};
        r.n[a] = p.upper ? 1 : -1;
        r.h.value = r.n[a] * big(p.at[a] - i.at[a]);
    } else {
        bvec const n = rel(p.at, i.at);
        r.n = {2 * n[0], 2 * n[1], 2 * n[2]};
        r.h.value = dot(n, n);
        r.h.weight[i.rank] += 1;
        r.h.weight[p.rank] -= 1;
    }
    return r;
}
oracle_plane triangle(exact::site const& i, ivec3 const& q0, ivec3 const& q1, ivec3 const& q2) {
    oracle_plane r;
    r.n = cross(rel(q1, q0), rel(q2, q0));
    r.h.value = dot(r.n, rel(q0, i.at));
    return r;
}

// Solves the three planes by Cramer's rule and puts the point into the fourth; 0 when there is no such point.
int oracle(oracle_plane const& a, oracle_plane const& b, oracle_plane const& c, oracle_plane const& d) {
    bvec const bc = cross(b.n, c.n);
    bvec const ca = cross(c.n, a.n);
    bvec const ab = cross(a.n, b.n);
    big const det = dot(a.n, bc);
    if (det == 0) return 0;
    perturbed s = d.h * big(-1);
    s = s + a.h * (dot(d.n, bc) / det) + b.h * (dot(d.n, ca) / det) + c.h * (dot(d.n, ab) / det);
    return s.sign();
}

ivec3 point(stream& random, std::int64_t range, std::int64_t step) {
    ivec3 p{};
    for (auto& c : p) c = step * static_cast<std::int64_t>(random.index_below(static_cast<std::uint64_t>(range)));
    return p;
}

// Coarse lattices make nearly every case a tie; the full one none; the shifted ones near ties.
struct scene {
    std::int64_t range;
    std::int64_t step;
};
constexpr std::array scenes{scene{2, 1}, scene{3, std::int64_t{1} << 54}, scene{4, 7}, scene{lattice_frame::limit, 1}};

}  // namespace

TEST_CASE("side4 agrees with rational arithmetic for sites and walls, ties included") {
    stream random(1, stage::user, 0);
    int ties = 0;
    int cases = 0;
    for (auto const& sc : scenes) {
        for (int trial = 0; trial < 4000; ++trial) {
            std::array<exact::site, 5> s;
            for (std::uint32_t k = 0; k < 5; ++k) s[k] = {point(random, sc.range, sc.step), k};
            std::array<std::uint32_t, 5> rank{0, 1, 2, 3, 4};
            for (std::size_t k = 4; k > 0; --k) std::swap(rank[k], rank[random.index_below(k + 1)]);
            bool distinct = true;
            for (std::size_t k = 0; k < 5; ++k) {
                s[k].rank = rank[k];
                for (std::size_t l = 0; l < k; ++l) distinct = distinct && s[k].at != s[l].at;
            }
            if (!distinct) continue;
            std::array<exact::plane, 4> p;
            for (std::size_t k = 0; k < 4; ++k) {
                p[k] = s[k + 1];
                if (random.chance(0.2)) {
                    p[k] = exact::wall{static_cast<int>(random.index_below(3)), random.chance(0.5), s[k + 1].at[0]};
                }
            }
            int const expected = oracle(make(s[0], p[0]), make(s[0], p[1]), make(s[0], p[2]), make(s[0], p[3]));
            if (expected == 0) continue;  // no such vertex, or four walls through one point
            ++cases;
            auto const x = exact::detail::expand(
                exact::detail::plane_row<exact::detail::limb>(s[0].at, p[0]),
                exact::detail::plane_row<exact::detail::limb>(s[0].at, p[1]),
                exact::detail::plane_row<exact::detail::limb>(s[0].at, p[2]),
                exact::detail::plane_row<exact::detail::limb>(s[0].at, p[3]));
            ties += x.det.sign() == 0;
            REQUIRE(exact::side4(s[0], p[0], p[1], p[2], p[3]) == expected);
        }
    }
    REQUIRE(cases > 6000);
    REQUIRE(ties > 500);
}

TEST_CASE("side1 and side2 agree with rational arithmetic") {
    stream random(2, stage::user, 0);
    int cases = 0;
    for (auto const& sc : scenes) {
        for (int trial = 0; trial < 4000; ++trial) {
            exact::site i{point(random, sc.range, sc.step), 0};
            exact::site k{point(random, sc.range, sc.step), 1};
            exact::site j{point(random, sc.range, sc.step), 2};
            if (i.at == k.at || i.at == j.at || j.at == k.at) continue;
            switch (random.index_below(3)) {
                case 1: std::swap(i.rank, j.rank); break;
                case 2: std::swap(i.rank, k.rank); break;
                default: break;
            }
            ivec3 const va = point(random, sc.range, sc.step);
            ivec3 const vb = point(random, sc.range, sc.step);
            auto const pk = make(i, k);
            auto const pj = make(i, j);
            auto const beyond = [&](oracle_plane const& p, bvec const& y) {
                perturbed s = p.h * big(-1);
                s.value += dot(p.n, y);
                return s;
            };
            perturbed const sa = beyond(pk, rel(va, i.at));
            perturbed const sb = beyond(pk, rel(vb, i.at));
            REQUIRE(exact::side1(i, k, va) == sa.sign());
            if (sa.sign() == sb.sign()) continue;
            ++cases;
            // t = -sa / (sb - sa) is linear in the weights because sb - sa holds none.
            big const span = sb.value - sa.value;
            bvec const d = rel(vb, va);
            perturbed s = beyond(pj, rel(va, i.at)) + sa * (-dot(pj.n, d) / span);
            REQUIRE(exact::side2(i, k, j, va, vb) == s.sign());
            REQUIRE(exact::side2(i, k, j, vb, va) == s.sign());
        }
    }
    REQUIRE(cases > 2000);
}

TEST_CASE("side3 and line_sign agree with rational arithmetic") {
    stream random(3, stage::user, 0);
    int cases = 0;
    for (auto const& sc : scenes) {
        for (int trial = 0; trial < 4000; ++trial) {
            std::array<exact::site, 4> s;
            bool distinct = true;
            auto const turn = static_cast<std::uint32_t>(random.index_below(4));
            for (std::uint32_t k = 0; k < 4; ++k) {
                s[k] = {point(random, sc.range, sc.step), (k + turn) % 4};
                for (std::uint32_t l = 0; l < k; ++l) distinct = distinct && s[k].at != s[l].at;
            }
            ivec3 const q0 = point(random, sc.range, sc.step);
            ivec3 const q1 = point(random, sc.range, sc.step);
            ivec3 const q2 = point(random, sc.range, sc.step);
            if (!distinct) continue;
            auto const t = triangle(s[0], q0, q1, q2);
            big const line = dot(t.n, cross(rel(s[1].at, s[0].at), rel(s[2].at, s[0].at)));
            REQUIRE(exact::line_sign(s[0], s[1], s[2], q0, q1, q2) == (line > 0 ? 1 : line < 0 ? -1 : 0));
            int const expected = oracle(t, make(s[0], s[1]), make(s[0], s[2]), make(s[0], s[3]));
            if (expected == 0) continue;
            ++cases;
            REQUIRE(exact::side3(s[0], s[1], s[2], s[3], q0, q1, q2) == expected);
        }
    }
    REQUIRE(cases > 4000);
}
