/// \file
/// The connected shells of a closed surface, and whether inward ones lie in a solid.
#ifndef TAFONI_GEOMETRY_DETAIL_SHELL_NESTING_HPP
#define TAFONI_GEOMETRY_DETAIL_SHELL_NESTING_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/geometry/bvh.hpp>
#include <tafoni/geometry/detail/edge_table.hpp>
#include <tafoni/geometry/solid.hpp>
#include <tafoni/geometry/winding_number.hpp>

#include <optional>
#include <string>
#include <vector>

namespace tafoni::detail {

/// A volume below this part of the summed sizes of its terms is rounding, not volume.
inline constexpr double volume_noise = 64 * 0x1p-53;

/// What a triangle adds to six times the volume, how much rounding that may hold, and twice its area.
struct volume_term {
    double six_volume;
    double size;  ///< sum of the sizes of the products
    double double_area;
};

/// The term of one triangle; coordinates relative to a point near the surface and about unit size. O(1).
[[nodiscard]] inline volume_term make_volume_term(vec3 const& a, vec3 const& b, vec3 const& c) noexcept {
    vec3 const u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    vec3 const v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    vec3 const n = cross(u, v);
    double const size = std::fabs(a[0]) * (std::fabs(u[1] * v[2]) + std::fabs(u[2] * v[1])) +
                        std::fabs(a[1]) * (std::fabs(u[2] * v[0]) + std::fabs(u[0] * v[2])) +
                        std::fabs(a[2]) * (std::fabs(u[0] * v[1]) + std::fabs(u[1] * v[0]));
    return {dot(a, n), size, length(n)};
}

/// Triangles joined through their edges.
struct shell_table {
    struct shell {
        std::uint32_t first_triangle;
        double six_volume = 0;  ///< in the frame of the given terms
        double six_size = 0;    ///< sum of their sizes
        box3 bounds{};
        vec3 lowest{0, 0, 0};   ///< its lexicographically lowest vertex, a point of its outer side
    };
    std::vector<std::uint32_t> shell_of{};  ///< per triangle
    std::vector<shell> shells{};            ///< by lowest triangle
};

/// Groups triangles; `terms` are those of the volume sum. O(triangles).
[[nodiscard]] inline shell_table find_shells(solid const& s, std::vector<volume_term> const& terms) {
    std::size_t const n = s.triangles.size();
    disjoint_sets sets(n);
    for (std::size_t h = 0; h < s.opposite.size(); ++h) {
        sets.join(static_cast<std::uint32_t>(h / 3), s.opposite[h] / 3);
    }
    shell_table r;
    r.shell_of.resize(n);
    for (std::uint32_t t = 0; t < n; ++t) {
        std::uint32_t const root = sets.root(t);
        if (root == t) {
            r.shell_of[t] = static_cast<std::uint32_t>(r.shells.size());
            r.shells.push_back({.first_triangle = t, .lowest = s.positions[s.triangles[t][0]]});
        } else {
            r.shell_of[t] = r.shell_of[root];
        }
        auto& shell = r.shells[r.shell_of[t]];
        shell.six_volume += terms[t].six_volume;
        shell.six_size += terms[t].size;
        for (std::uint32_t const v : s.triangles[t]) {
            vec3 const& p = s.positions[v];
            shell.bounds.include(p);
            if (lexicographically_less(p, shell.lowest)) shell.lowest = p;
        }
    }
    return r;
}

/// Throws `inverted_orientation` for a shell of negative volume that lies inside no other shell.
/// Shells without volume may face either way. O(triangles), and O(log n + triangles above) per inward
/// shell where there are many.
inline void require_outward_shells(char const* who, solid const& s, std::vector<volume_term> const& terms) {
    shell_table const table = find_shells(s, terms);
    std::vector<std::uint32_t> inward;
    for (std::uint32_t i = 0; i < table.shells.size(); ++i) {
        if (table.shells[i].six_volume < -volume_noise * table.shells[i].six_size) inward.push_back(i);
    }
    if (inward.empty()) return;
    // How often all shells go around the lowest vertex of an inward one, less what it adds itself.
    std::vector<int> around(table.shells.size(), 0);
    auto const crossing = [&](std::size_t t, vec3 const& p) {
        auto const& tri = s.triangles[t];
        return upward_crossing(s.positions[tri[0]], s.positions[tri[1]], s.positions[tri[2]], p);
    };
    if (table.shells.size() > 1) {
        for (std::size_t t = 0; t < s.triangles.size(); ++t) {
            std::uint32_t const i = table.shell_of[t];
            around[i] -= crossing(t, table.shells[i].lowest);
        }
        std::optional<bvh> tree;
        if (inward.size() > 8) tree.emplace(s);
        for (std::uint32_t const i : inward) {
            vec3 const& p = table.shells[i].lowest;
            around[i] += tree ? tree->winding_number(p) : winding_number(s, p);
        }
    }
    std::size_t inverted = 0;
    std::uint32_t first = 0;
    for (std::uint32_t const i : inward) {
        if (around[i] > 0) continue;
        if (inverted++ == 0) first = i;
    }
    if (inverted == 0) return;
    std::uint32_t const face = s.polygon_of[table.shells[first].first_triangle];
    fail<bad_topology>(errc::inverted_orientation,
                       std::string(who) + ": " + std::to_string(inverted) + " of " +
                           std::to_string(table.shells.size()) +
                           " shells enclose negative volume and lie in no other, the first with face " +
                           std::to_string(face),
                       {.kind = entity::face, .index = face, .value = static_cast<double>(inverted), .limit = 0});
}

}  // namespace tafoni::detail

#endif
