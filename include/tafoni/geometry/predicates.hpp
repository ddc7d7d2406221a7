/// \file
/// Exact answers to "on which side of a bisector?", without ties.
#ifndef TAFONI_GEOMETRY_PREDICATES_HPP
#define TAFONI_GEOMETRY_PREDICATES_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/geometry/approx.hpp>
#include <tafoni/geometry/lattice.hpp>
#include <tafoni/geometry/wide_int.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

/// Signs about the Voronoi diagram of lattice points, exact and never zero.
///
/// Simulation of simplicity [Edelsbrunner and Muecke 1990] on the weights: site s has an
/// infinitesimal weight w_s, w_0 >> w_1 >> ... > 0 by rank, so a tie goes to the site of lower
/// rank. Point y (relative to site i) lies beyond the bisector of i and k, that is on k's side,
/// when  2 n.y > |n|^2 + w_i - w_k  with  n = k - i.  Every predicate is linear in the right-hand
/// sides, so where the polynomial vanishes its coefficients of the weights decide, lowest rank
/// first. The answers are those of one fixed generic diagram: never contradictory, and in it every
/// vertex has exactly four sites or walls. Ranks must be a function of coordinates (see
/// `voronoi_diagram`), and no two sites may be at one point.
///
/// Costs: about 20 to 60 ns where doubles suffice, 50 to 300 ns else. O(1), no allocation.
namespace tafoni::exact {

/// A site and its place in the order that breaks ties.
struct site {
    ivec3 at{};
    std::uint32_t rank = 0;
};

/// A face of the box: the points whose coordinate `axis` is `at`; beyond is above when `upper`, else below.
struct wall {
    int axis = 0;
    bool upper = false;
    std::int64_t at = 0;
};

/// A plane that bounds the cell of a base site: the bisector with another site, or a wall.
struct plane {
    ivec3 at{};              ///< the other site; of a wall only the component `axis`
    std::uint32_t rank = 0;  ///< the other site's
    std::int8_t axis = -1;   ///< 0, 1, 2 for a wall, -1 for a bisector
    bool upper = false;      ///< of a wall

    constexpr plane() = default;
    constexpr plane(site const& s) noexcept : at(s.at), rank(s.rank) {}
    constexpr plane(wall const& w) noexcept : axis(static_cast<std::int8_t>(w.axis)), upper(w.upper) {
        at[static_cast<std::size_t>(w.axis)] = w.at;
    }
};

namespace detail {

using ivec = ivec3;

[[nodiscard]] constexpr ivec sub(ivec const& a, ivec const& b) noexcept {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <class T>
using vec = std::array<T, 3>;

template <class Num>
[[nodiscard]] vec<Num> lift(ivec const& a) noexcept {
    return {Num(a[0]), Num(a[1]), Num(a[2])};
}

template <class A, class B>
[[nodiscard]] auto dot(vec<A> const& a, vec<B> const& b) noexcept {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class A>
[[nodiscard]] auto cross(vec<A> const& a, vec<A> const& b) noexcept {
    using P = decltype(a[0] * b[0]);
    return vec<P>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A plane  n . Y = h  in doubled coordinates Y = 2 y relative to the base site.
template <class N, class H>
struct row {
    vec<N> n;
    H h;
};

template <class Num>
[[nodiscard]] auto site_row(ivec const& base, ivec const& other) noexcept {
    vec<Num> const n = lift<Num>(sub(other, base));
    auto h = dot(n, n);
    return row<Num, decltype(h)>{n, h};
}

template <class Num>
[[nodiscard]] auto plane_row(ivec const& base, plane const& p) noexcept {
    if (p.axis < 0) return site_row<Num>(base, p.at);
    auto const a = static_cast<std::size_t>(p.axis);
    std::int64_t const e = p.upper ? 1 : -1;
    vec<Num> n{Num(std::int64_t{0}), Num(std::int64_t{0}), Num(std::int64_t{0})};
    n[a] = Num(e);
    using H = decltype(n[0] * n[0]);
    return row<Num, H>{n, H(Num(2 * e * (p.at[a] - base[a])) * Num(std::int64_t{1}))};
}

/// The plane through a triangle of model vertices.
template <class Num>
[[nodiscard]] auto triangle_row(ivec const& base, ivec const& q0, ivec const& q1, ivec const& q2) noexcept {
    auto const n = cross(lift<Num>(sub(q1, q0)), lift<Num>(sub(q2, q0)));
    auto const y = lift<Num>({2 * (q0[0] - base[0]), 2 * (q0[1] - base[1]), 2 * (q0[2] - base[2])});
    auto h = dot(n, y);
    return row<typename std::remove_cvref_t<decltype(n)>::value_type, decltype(h)>{n, h};
}

template <class A, class B, class C>
[[nodiscard]] auto det3(vec<A> const& a, vec<B> const& b, vec<C> const& c) noexcept {
    return a[2] * (b[0] * c[1] - b[1] * c[0]) - b[2] * (a[0] * c[1] - a[1] * c[0]) + c[2] * (a[0] * b[1] - a[1] * b[0]);
}

/// The determinant of four rows (n, h), and its cofactors in the column h.
template <class Det, class A, class B, class C, class D>
struct expansion {
    Det det;
    A ca;
    B cb;
    C cc;
    D cd;
};

template <class RA, class RB, class RC, class RD>
[[nodiscard]] auto expand(RA const& a, RB const& b, RC const& c, RD const& d) noexcept {
    auto const ab = a.n[0] * b.n[1] - a.n[1] * b.n[0];
    auto const ac = a.n[0] * c.n[1] - a.n[1] * c.n[0];
    auto const bc = b.n[0] * c.n[1] - b.n[1] * c.n[0];
    auto const ad = a.n[0] * d.n[1] - a.n[1] * d.n[0];
    auto const bd = b.n[0] * d.n[1] - b.n[1] * d.n[0];
    auto const cd = c.n[0] * d.n[1] - c.n[1] * d.n[0];
    auto const ca = -(b.n[2] * cd - c.n[2] * bd + d.n[2] * bc);
    auto const cb = a.n[2] * cd - c.n[2] * ad + d.n[2] * ac;
    auto const cc = -(a.n[2] * bd - b.n[2] * ad + d.n[2] * ab);
    auto const cdd = a.n[2] * bc - b.n[2] * ac + c.n[2] * ab;
    auto const det = a.h * ca + b.h * cb + c.h * cc + d.h * cdd;
    return expansion{det, ca, cb, cc, cdd};
}

/// A site that takes part in a tie, and the sign of the coefficient of its weight.
struct vote {
    std::uint32_t rank = 0;
    int sign = 0;
};

/// The first vote, by rank, that is not zero.
template <std::size_t K>
[[nodiscard]] int decide(std::array<vote, K> votes, std::size_t count) noexcept {
    int best = 0;
    std::uint32_t rank = 0;
    for (std::size_t k = 0; k < count; ++k) {
        if (votes[k].sign != 0 && (best == 0 || votes[k].rank < rank)) {
            best = votes[k].sign;
            rank = votes[k].rank;
        }
    }
    TAFONI_ASSERT(best != 0, "simulation of simplicity leaves no tie");
    return best;
}

/// Twice a value on an edge, and what its weights are multiplied by.
template <class V, class B>
struct edge_terms {
    V value;
    B b;
    B d;
};

using limb = wide_int<1>;

}  // namespace detail

/// Where is the lattice point q?  1: beyond the bisector of i and k, -1: on i's side.
[[nodiscard]] inline int side1(site const& i, site const& k, ivec3 const& q) noexcept {
    ivec3 const n = detail::sub(k.at, i.at);
    // 2 n.(q - i) - n.n = n.((q - i) + (q - k)), at most 3 * 2^116: fits 128 bits.
    tafoni::detail::i128 s = 0;
    for (std::size_t a = 0; a < 3; ++a) s += tafoni::detail::i128{n[a]} * ((q[a] - i.at[a]) + (q[a] - k.at[a]));
    if (s != 0) return s > 0 ? 1 : -1;
    return i.rank < k.rank ? -1 : 1;
}

/// Where is the point at which the edge (va, vb) crosses the bisector of i and k?
/// 1: beyond the bisector of i and j, -1: on i's side. Expects side1(i, k, va) != side1(i, k, vb).
[[nodiscard]] inline int side2(site const& i, site const& k, site const& j, ivec3 const& va, ivec3 const& vb) noexcept {
    auto const terms = [&]<class Num>(Num) {
        using detail::lift;
        using detail::sub;
        auto const nk = lift<Num>(sub(k.at, i.at));
        auto const nj = lift<Num>(sub(j.at, i.at));
        auto const y2 = lift<Num>({2 * (va[0] - i.at[0]), 2 * (va[1] - i.at[1]), 2 * (va[2] - i.at[2])});
        auto const d2 = lift<Num>({2 * (vb[0] - va[0]), 2 * (vb[1] - va[1]), 2 * (vb[2] - va[2])});
        auto const a = detail::dot(nk, nk) - detail::dot(nk, y2);
        auto const b = detail::dot(nk, d2);
        auto const c = detail::dot(nj, y2) - detail::dot(nj, nj);
        auto const d = detail::dot(nj, d2);
        return detail::edge_terms{c * b + d * a, b, d};
    };
    {
        auto const t = terms(approx{});
        int const s = t.value.sign() * t.b.sign();
        if (s != 0) return s;
    }
    auto const t = terms(detail::limb{});
    int s = t.value.sign();
    if (s == 0) {
        s = detail::decide<3>({{{i.rank, (t.d - t.b).sign()}, {j.rank, t.b.sign()}, {k.rank, -t.d.sign()}}}, 3);
    }
    return s * t.b.sign();
}

/// Where is the point at which the plane of the triangle (q0, q1, q2) meets the bisectors (i, k) and (i, l)?
/// 1: beyond the bisector of i and j, -1: on i's side. Expects that the point exists.
[[nodiscard]] inline int side3(site const& i, site const& k, site const& l, site const& j, ivec3 const& q0,
                               ivec3 const& q1, ivec3 const& q2) noexcept {
    auto const rows = [&]<class Num>(Num) {
        return detail::expand(detail::triangle_row<Num>(i.at, q0, q1, q2), detail::site_row<Num>(i.at, k.at),
                              detail::site_row<Num>(i.at, l.at), detail::site_row<Num>(i.at, j.at));
    };
    {
        auto const x = rows(approx{});
        int const s = x.det.sign() * x.cd.sign();
        if (s != 0) return -s;
    }
    auto const x = rows(detail::limb{});
    int s = x.det.sign();
    if (s == 0) {
        s = detail::decide<4>({{{i.rank, (x.cb + x.cc + x.cd).sign()},
                                {k.rank, -x.cb.sign()},
                                {l.rank, -x.cc.sign()},
                                {j.rank, -x.cd.sign()}}},
                              4);
    }
    return -s * x.cd.sign();
}

/// As side4 below, without the filter: for callers that know that doubles do not decide.
[[nodiscard]] inline int side4_unfiltered(site const& i, plane const& a, plane const& b, plane const& c,
                                          plane const& d) noexcept {
    using detail::limb;
    auto const x = detail::expand(detail::plane_row<limb>(i.at, a), detail::plane_row<limb>(i.at, b),
                                  detail::plane_row<limb>(i.at, c), detail::plane_row<limb>(i.at, d));
    int s = x.det.sign();
    if (s == 0) {
        std::array<detail::vote, 5> votes{};
        std::size_t count = 1;
        auto sum = decltype(x.ca)(limb(std::int64_t{0}));
        auto const add = [&](plane const& p, auto const& cofactor) {
            if (p.axis >= 0) return;
            sum = sum + cofactor;
            votes[count++] = {p.rank, -cofactor.sign()};
        };
        add(a, x.ca);
        add(b, x.cb);
        add(c, x.cc);
        add(d, x.cd);
        votes[0] = {i.rank, sum.sign()};
        s = detail::decide(votes, count);
    }
    return -s * x.cd.sign();
}

/// Where is the vertex of i's cell on the planes a, b, c?  1: beyond plane d, -1: on i's side.
/// Expects that the vertex exists; d may be a wall as well.
[[nodiscard]] inline int side4(site const& i, plane const& a, plane const& b, plane const& c, plane const& d) noexcept {
    auto const x = detail::expand(detail::plane_row<approx>(i.at, a), detail::plane_row<approx>(i.at, b),
                                  detail::plane_row<approx>(i.at, c), detail::plane_row<approx>(i.at, d));
    int const s = x.det.sign() * x.cd.sign();
    return s != 0 ? -s : side4_unfiltered(i, a, b, c, d);
}

/// The sign of  N . (n_k x n_l): does the line of the bisectors (i, k) and (i, l), run along n_k x n_l,
/// leave through the front of the triangle with normal N = (q1 - q0) x (q2 - q0)?  0 when parallel.
[[nodiscard]] inline int line_sign(site const& i, site const& k, site const& l, ivec3 const& q0, ivec3 const& q1,
                                   ivec3 const& q2) noexcept {
    auto const value = [&]<class Num>(Num) {
        using detail::lift;
        using detail::sub;
        return detail::dot(detail::cross(lift<Num>(sub(q1, q0)), lift<Num>(sub(q2, q0))),
                           detail::cross(lift<Num>(sub(k.at, i.at)), lift<Num>(sub(l.at, i.at))));
    };
    int const s = value(approx{}).sign();
    return s != 0 ? s : value(detail::limb{}).sign();
}

}  // namespace tafoni::exact

#endif
