/// \file
/// Separates the sheets of a closed triangle soup where they touch, so that it becomes a 2-manifold.
#ifndef TAFONI_DECOMPOSITION_DETAIL_SPLIT_NONMANIFOLD_HPP
#define TAFONI_DECOMPOSITION_DETAIL_SPLIT_NONMANIFOLD_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// Half-edge h = 3 t + k runs from corner k to corner k + 1 of triangle t.
[[nodiscard]] inline std::size_t next_corner(std::size_t h) noexcept { return h % 3 == 2 ? h - 2 : h + 1; }

/// Which of the triangles stay when pairs with the same three corners, seen from opposite sides, are taken out.
/// They enclose nothing, and the rest is as closed as before. O(n log n).
[[nodiscard]] inline std::vector<std::uint8_t> without_opposites(std::span<std::array<std::uint32_t, 3> const> triangles) {
    struct entry {
        std::array<std::uint32_t, 3> sorted;
        bool even;
        std::uint32_t t;
    };
    std::vector<entry> entries(triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        auto v = triangles[t];
        bool const even = ((v[0] < v[1]) + (v[1] < v[2]) + (v[2] < v[0])) == 2;
        std::sort(v.begin(), v.end());
        entries[t] = {v, even, t};
    }
    std::sort(entries.begin(), entries.end(), [](entry const& x, entry const& y) {
        if (x.sorted != y.sorted) return x.sorted < y.sorted;
        return x.even != y.even ? x.even : x.t < y.t;
    });
    std::vector<std::uint8_t> stays(triangles.size(), 1);
    for (std::size_t first = 0; first < entries.size();) {
        std::size_t turn = first;
        while (turn < entries.size() && entries[turn].sorted == entries[first].sorted && entries[turn].even) ++turn;
        std::size_t last = turn;
        while (last < entries.size() && entries[last].sorted == entries[first].sorted) ++last;
        for (std::size_t a = first, b = turn; a < turn && b < last; ++a, ++b) {
            stays[entries[a].t] = 0;
            stays[entries[b].t] = 0;
        }
        first = last;
    }
    return stays;
}

/// Pairs the half-edges of closed, oriented triangles: each with the one that bounds the same wedge
/// of the solid. Where more than two triangles meet at an edge they are sorted by angle around it
/// (without trigonometry), and `crowded` is set. O(n log n).
template <class Places>
[[nodiscard]] std::vector<std::uint32_t> pair_half_edges(std::span<std::array<std::uint32_t, 3> const> triangles,
                                                         Places const& places, bool& crowded) {
    struct side {
        std::uint32_t low;
        std::uint32_t high;
        std::uint32_t h;
        double turn;
    };
    auto const vertex = [&](std::size_t h) { return triangles[h / 3][h % 3]; };
    std::vector<side> sides(3 * triangles.size());
    for (std::size_t h = 0; h < sides.size(); ++h) {
        std::uint32_t const a = vertex(h);
        std::uint32_t const b = vertex(next_corner(h));
        sides[h] = {a < b ? a : b, a < b ? b : a, static_cast<std::uint32_t>(h), 0};
    }
    std::sort(sides.begin(), sides.end(), [](side const& x, side const& y) {
        if (x.low != y.low) return x.low < y.low;
        return x.high != y.high ? x.high < y.high : x.h < y.h;
    });
    std::vector<std::uint32_t> opposite(sides.size());
    for (std::uint32_t h = 0; h < opposite.size(); ++h) opposite[h] = h;
    auto const forward = [&](side const& s) { return vertex(s.h) == s.low; };
    auto const pair = [&](side const& x, side const& y) {
        opposite[x.h] = y.h;
        opposite[y.h] = x.h;
    };
    for (std::size_t first = 0; first < sides.size();) {
        std::size_t last = first + 1;
        while (last < sides.size() && sides[last].low == sides[first].low && sides[last].high == sides[first].high) ++last;
        std::size_t const n = last - first;
        if (n == 2) {
            pair(sides[first], sides[first + 1]);
        } else {
            crowded = true;
            // Seen against the edge, the solid lies behind a forward triangle and before a backward one.
            vec3 const o = places(sides[first].low);
            vec3 const axis = normalized(vec3(places(sides[first].high) - o));
            auto const away = [&](side const& s) {
                vec3 const d = places(vertex(next_corner(next_corner(s.h)))) - o;
                double const along = dot(d, axis);
                return vec3{d[0] - along * axis[0], d[1] - along * axis[1], d[2] - along * axis[2]};
            };
            vec3 const u = away(sides[first]);
            vec3 const v = cross(axis, u);
            for (std::size_t k = first; k < last; ++k) {
                vec3 const d = away(sides[k]);
                double const x = dot(d, u);
                double const y = dot(d, v);
                double const sum = std::fabs(x) + std::fabs(y);
                double const part = sum > 0 ? y / sum : 0;
                sides[k].turn = x >= 0 ? (y >= 0 ? part : 4 + part) : 2 - part;
            }
            auto const begin = sides.begin() + static_cast<std::ptrdiff_t>(first);
            auto const end = sides.begin() + static_cast<std::ptrdiff_t>(last);
            std::sort(begin, end, [](side const& x, side const& y) { return x.turn != y.turn ? x.turn < y.turn : x.h < y.h; });
            // Like brackets, around the circle: a backward one opens a wedge, the next free forward one closes it.
            std::vector<std::size_t> open;
            std::vector<std::uint8_t> done(n, 0);
            for (std::size_t k = 0; k < 2 * n; ++k) {
                std::size_t const at = k % n;
                if (done[at] != 0) continue;
                if (!forward(sides[first + at])) {
                    if (k < n) open.push_back(at);
                } else if (!open.empty()) {
                    pair(sides[first + open.back()], sides[first + at]);
                    done[at] = 1;
                    done[open.back()] = 1;
                    open.pop_back();
                }
            }
        }
        first = last;
    }
    return opposite;
}

/// Which corners are one vertex of the 2-manifold that the pairing makes: corner -> vertex, numbered
/// by first corner; `of_corner` is filled, the number of vertices returned. O(n).
inline std::uint32_t weld_corners(std::span<std::uint32_t const> opposite, std::vector<std::uint32_t>& of_corner) {
    std::vector<std::uint32_t> parent(opposite.size());
    for (std::uint32_t c = 0; c < parent.size(); ++c) parent[c] = c;
    auto const root = [&parent](std::uint32_t c) {
        while (parent[c] != c) {
            parent[c] = parent[parent[c]];
            c = parent[c];
        }
        return c;
    };
    auto const join = [&](std::size_t x, std::size_t y) {
        std::uint32_t const a = root(static_cast<std::uint32_t>(x));
        std::uint32_t const b = root(static_cast<std::uint32_t>(y));
        parent[a < b ? b : a] = a < b ? a : b;
    };
    for (std::size_t h = 0; h < opposite.size(); ++h) {
        if (opposite[h] == h) continue;
        join(h, next_corner(opposite[h]));
        join(next_corner(h), opposite[h]);
    }
    of_corner.resize(opposite.size());
    std::uint32_t count = 0;
    for (std::uint32_t c = 0; c < parent.size(); ++c) {
        std::uint32_t const r = root(c);
        of_corner[c] = r == c ? count++ : of_corner[r];
    }
    return count;
}

}  // namespace tafoni::detail

#endif
