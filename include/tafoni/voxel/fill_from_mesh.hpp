/// \file
/// Fills a grid of voxels with what a mesh encloses, even where it has holes.
#ifndef TAFONI_VOXEL_FILL_FROM_MESH_HPP
#define TAFONI_VOXEL_FILL_FROM_MESH_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/geometry/concepts.hpp>
#include <tafoni/geometry/detail/checked_mesh.hpp>
#include <tafoni/geometry/triangulate.hpp>
#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/detail/fill_bricks.hpp>
#include <tafoni/voxel/detail/hole_levels.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace tafoni {

/// What `fill_from_mesh` found.
struct mesh_fill_report {
    std::size_t rock = 0;               ///< voxels of rock
    std::size_t holes = 0;              ///< connected boundaries, each closed by a fan for counting only
    std::size_t boundary_edges = 0;     ///< sides of faces without a counterpart
    std::size_t dropped_faces = 0;      ///< triangles with a corner twice
    std::size_t isolated_vertices = 0;  ///< that no face uses
    double volume = 0;                  ///< inside the capped surface, cubed length unit
};

namespace detail {

/// A surface closed by fans over its boundaries.
struct capped_surface {
    std::vector<vec3> positions{};                         ///< one per place, then one apex per hole
    std::vector<std::array<std::uint32_t, 3>> triangles{};
    std::vector<std::array<std::uint32_t, 3>> caps{};      ///< apex first
    mesh_fill_report report{};
};

/// Vertex -> the lowest vertex at the same place, so that seams of equal corners are no holes. O(n log n).
[[nodiscard]] inline std::vector<std::uint32_t> welded(std::vector<vec3> const& positions) {
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0U);
    auto const before = [&](std::uint32_t a, std::uint32_t b) {
        vec3 const& p = positions[a];
        vec3 const& q = positions[b];
        for (int d = 0; d < 3; ++d) {
            if (p[d] != q[d]) return p[d] < q[d] ? -1 : 1;
        }
        return 0;
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        int const c = before(a, b);
        return c != 0 ? c < 0 : a < b;
    });
    std::vector<std::uint32_t> to(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        to[order[i]] = i > 0 && before(order[i - 1], order[i]) == 0 ? to[order[i - 1]] : order[i];
    }
    return to;
}

/// Inside a closed chain; 0 for flat sheets, whatever the rounding. O(n).
[[nodiscard]] inline double volume_of(capped_surface const& s) {
    if (s.triangles.empty()) return 0;
    vec3 const base = s.positions[s.triangles[0][0]];
    double sum = 0;
    double size = 0;
    for (auto const& list : {&s.triangles, &s.caps}) {
        for (auto const& t : *list) {
            double const six = dot(s.positions[t[0]] - base, cross(s.positions[t[1]] - base, s.positions[t[2]] - base));
            sum += six;
            size += std::fabs(six);
        }
    }
    return std::fabs(sum) <= 1e-10 * size ? 0.0 : sum / 6;
}

/// Cuts the faces into triangles and closes what they leave open. O(n log n).
template <polygon_mesh M>
[[nodiscard]] capped_surface cap_holes(char const* who, M const& mesh) {
    indexed_mesh const copy = checked_copy(who, mesh);
    capped_surface out;
    out.positions = copy.positions;
    std::vector<std::uint32_t> const to = welded(copy.positions);
    std::vector<std::uint8_t> used(copy.vertex_count(), 0);
    ear_clipper clip;
    std::vector<vec3> loop;
    std::vector<std::array<std::uint32_t, 3>> cut;
    for (std::size_t f = 0; f < copy.face_count(); ++f) {
        auto const face = copy.face(f);
        if (face.size() < 3) {
            fail<invalid_input>(errc::degenerate_face,
                                std::string(who) + ": face " + std::to_string(f) + " has " + std::to_string(face.size()) +
                                    " corners, at least 3 are needed",
                                {.kind = entity::face, .index = f, .value = static_cast<double>(face.size()), .limit = 3});
        }
        loop.clear();
        for (std::uint32_t const v : face) {
            used[v] = 1;
            loop.push_back(copy.positions[v]);
        }
        cut.clear();
        clip(loop, cut);
        for (auto const& t : cut) {
            std::array<std::uint32_t, 3> const v{to[face[t[0]]], to[face[t[1]]], to[face[t[2]]]};
            if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
                ++out.report.dropped_faces;
            } else {
                out.triangles.push_back(v);
            }
        }
    }
    out.report.isolated_vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), std::uint8_t{0}));

    // Sides by their two ends; those that run one way as often as the other are closed.
    struct side {
        std::uint32_t low, high;
        int forward;
    };
    std::vector<side> sides;
    sides.reserve(3 * out.triangles.size());
    for (auto const& t : out.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t const a = t[k];
            std::uint32_t const b = t[(k + 1) % 3];
            sides.push_back(a < b ? side{a, b, 1} : side{b, a, -1});
        }
    }
    std::sort(sides.begin(), sides.end(), [](side const& a, side const& b) {
        return a.low != b.low ? a.low < b.low : a.high < b.high;
    });
    std::vector<std::pair<std::uint32_t, std::uint32_t>> open;  // as the faces run
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t const first = i;
        int sum = 0;
        for (; i < sides.size() && sides[i].low == sides[first].low && sides[i].high == sides[first].high; ++i) sum += sides[i].forward;
        for (; sum > 0; --sum) open.emplace_back(sides[first].low, sides[first].high);
        for (; sum < 0; ++sum) open.emplace_back(sides[first].high, sides[first].low);
    }
    out.report.boundary_edges = open.size();
    if (open.empty()) {
        out.report.volume = volume_of(out);
        return out;
    }

    // Each connected boundary gets its apex near the middle of its edges. Not in it: the middle of a tidy hole
    // lies on lines of voxels, and a lid in a plane of them.
    std::vector<std::uint32_t> root(copy.vertex_count());
    std::iota(root.begin(), root.end(), 0U);
    auto const find = [&root](std::uint32_t v) {
        while (root[v] != v) v = root[v] = root[root[v]];
        return v;
    };
    for (auto const& [a, b] : open) {
        std::uint32_t const x = find(a);
        std::uint32_t const y = find(b);
        if (x != y) root[std::max(x, y)] = std::min(x, y);
    }
    std::vector<std::uint32_t> apex(copy.vertex_count(), 0);
    std::vector<double> edges;
    for (auto const& [a, b] : open) {
        std::uint32_t& own = apex[find(a)];
        if (own == 0) {
            own = static_cast<std::uint32_t>(out.positions.size());
            require_indexable(who, out.positions.size() + 1);
            out.positions.push_back(vec3{0, 0, 0});
            edges.push_back(0);
        }
        std::size_t const hole = own - copy.vertex_count();
        // A running mean stays within the range of doubles.
        edges[hole] += 1;
        vec3 const middle = vec3(0.5 * copy.positions[a] + 0.5 * copy.positions[b]);
        out.positions[own] += vec3((middle - out.positions[own]) / edges[hole]);
        out.caps.push_back({own, b, a});
    }
    out.report.volume = volume_of(out);
    std::vector<box3> around(edges.size());
    for (std::size_t e = 0; e < open.size(); ++e) {
        box3& box = around[out.caps[e][0] - copy.vertex_count()];
        box.include(copy.positions[open[e].first]);
        box.include(copy.positions[open[e].second]);
    }
    for (std::size_t hole = 0; hole < edges.size(); ++hole) {
        vec3 const extent = around[hole].extent();
        double const longest = std::max({extent[0], extent[1], extent[2]});
        out.positions[copy.vertex_count() + hole] += vec3{0.0337519 * longest, -0.0194823 * longest, 0.0454187 * longest};
    }
    out.report.holes = edges.size();
    return out;
}

struct fill_from_mesh_fn {
    /// Rock where the generalised winding number of a voxel's centre is 1/2 or more [Jacobson et al. 2013], air
    /// elsewhere, whatever the grid held: solids with holes, doubled faces, edges of many faces and shells that
    /// overlap keep their shape, and over a hole the rock ends in a smooth lid. On a closed mesh the same as
    /// `fill_from_solid`. An empty mesh leaves nothing but air.
    ///
    /// Vertices at equal places count as one; those that no face uses are passed over, and faces of four corners
    /// and more are cut by `triangulate`. The number is exact but for 1e-9, and the bits are the same everywhere.
    /// O(n log n + crossings log crossings) as for a solid, plus O(log holes + edges of near holes) per
    /// brick and per voxel near the lids: where the number is 1/2, and there only.
    /// \throws invalid_input  `non_finite_vertex`, `index_out_of_range`, `degenerate_face`, `size_overflow`; as
    ///         `grid_frame::validate`; `out_of_range` for a surface 2^38 voxels away.
    /// \throws bad_topology  `inverted_orientation` where the capped surface encloses a negative volume.
    ///         The grid is then as it was.
    template <editable_voxel_grid G, polygon_mesh M>
    mesh_fill_report operator()(G& grid, M const& mesh) const {
        char const* const who = "fill_from_mesh";
        capped_surface surface = cap_holes(who, mesh);
        grid_frame const frame = frame_of(grid);
        frame.validate();
        brick_target<G> target(grid);
        row_crossings rows(who, frame, row_axes::along_up(target.rotation()));
        std::vector<row_crossings::corner> corners;
        corners.reserve(surface.positions.size());
        for (vec3 const& p : surface.positions) corners.push_back(rows.place(p));
        if (surface.report.volume < 0) {
            fail<bad_topology>(errc::inverted_orientation,
                               std::string(who) + ": the surface encloses a negative volume, " +
                                   number_text(surface.report.volume) + "; turn its faces round",
                               {.value = surface.report.volume, .limit = 0});
        }
        for (auto const& list : {&surface.triangles, &surface.caps}) {
            for (auto const& t : *list) rows.add({corners[t[0]], corners[t[1]], corners[t[2]]});
        }
        rows.sort();
        hole_levels least(rows, target.size(), frame.spacing, corners, surface.caps);
        surface.report.rock = fill_bricks(target, rows, least);
        return surface.report;
    }
};

}  // namespace detail

/// `fill_from_mesh(grid, mesh)`; see `detail::fill_from_mesh_fn`.
inline constexpr detail::fill_from_mesh_fn fill_from_mesh{};

}  // namespace tafoni

#endif
