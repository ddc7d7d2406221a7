/// \file
/// Splits chosen triangles into four and mends their neighbours, so that no vertex lies within an edge.
#ifndef TAFONI_GEOMETRY_REFINE_FACES_HPP
#define TAFONI_GEOMETRY_REFINE_FACES_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/geometry/triangle_surface.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tafoni {

/// The triangles after a refinement, and where new vertices and triangles come from.
struct refined_faces {
    std::vector<std::array<std::uint32_t, 3>> triangles{};
    std::vector<std::array<std::uint32_t, 2>> midpoints{};  ///< of vertex `old count + k`: the ends of its edge
    std::vector<face_index> parent{};                       ///< of each triangle
};

namespace detail {

/// The edges of a mesh that get a vertex in their middle.
class split_edges {
public:
    /// Edges (a < b) in any order, repeated as they like. O(n log n).
    split_edges(std::vector<std::array<std::uint32_t, 2>> edges, std::size_t first_new)
        : edges_(std::move(edges)), first_new_(static_cast<std::uint32_t>(first_new)) {
        std::sort(edges_.begin(), edges_.end());
        edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    }
    static constexpr std::uint32_t none = vertex_index::none;
    /// The vertex in the middle of an edge, or `none`. O(log n).
    [[nodiscard]] std::uint32_t middle(std::uint32_t a, std::uint32_t b) const noexcept {
        std::array<std::uint32_t, 2> const e{std::min(a, b), std::max(a, b)};
        auto const at = std::lower_bound(edges_.begin(), edges_.end(), e);
        return at != edges_.end() && *at == e ? first_new_ + static_cast<std::uint32_t>(at - edges_.begin()) : none;
    }
    [[nodiscard]] std::vector<std::array<std::uint32_t, 2>>& list() noexcept { return edges_; }

private:
    std::vector<std::array<std::uint32_t, 2>> edges_;
    std::uint32_t first_new_;
};

/// Triangles with one, two or three split sides become two, three or four [thesis, 12.3, Figure 12.1]; of the two
/// ways to cut what two splits leave, the shorter diagonal, ties towards the lower corner number.
[[nodiscard]] inline refined_faces split_triangles(std::span<vec3 const> positions,
                                                   std::span<std::array<std::uint32_t, 3> const> triangles,
                                                   split_edges&& edges) {
    refined_faces out;
    out.triangles.reserve(triangles.size() + 3 * edges.list().size());
    out.parent.reserve(out.triangles.capacity());
    auto const add = [&](std::size_t f, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        out.triangles.push_back({a, b, c});
        out.parent.push_back(face_index{f});
    };
    for (std::size_t f = 0; f < triangles.size(); ++f) {
        auto const& t = triangles[f];
        std::array<std::uint32_t, 3> m{};
        std::size_t split = 0;
        std::size_t whole = 0;  // with two splits: the side that has none
        std::size_t cut = 0;    // with one split: the side that has it
        for (std::size_t k = 0; k < 3; ++k) {
            m[k] = edges.middle(t[k], t[(k + 1) % 3]);
            if (m[k] != split_edges::none) { ++split; cut = k; } else { whole = k; }
        }
        if (split == 0) {
            add(f, t[0], t[1], t[2]);
        } else if (split == 1) {
            std::uint32_t const top = t[(cut + 2) % 3];
            add(f, t[cut], m[cut], top);
            add(f, m[cut], t[(cut + 1) % 3], top);
        } else if (split == 2) {
            // Corner `top` lies between the two split sides; below it a quadrilateral a, b, y, x.
            std::uint32_t const a = t[whole];
            std::uint32_t const b = t[(whole + 1) % 3];
            std::uint32_t const top = t[(whole + 2) % 3];
            std::uint32_t const y = m[(whole + 1) % 3];
            std::uint32_t const x = m[(whole + 2) % 3];
            vec3 const py{0.5 * positions[b] + 0.5 * positions[top]};
            vec3 const px{0.5 * positions[top] + 0.5 * positions[a]};
            double const ay = squared_length(py - positions[a]);
            double const bx = squared_length(px - positions[b]);
            add(f, x, y, top);
            if (ay < bx || (ay == bx && a < b)) {
                add(f, a, b, y);
                add(f, a, y, x);
            } else {
                add(f, a, b, x);
                add(f, b, y, x);
            }
        } else {
            add(f, t[0], m[0], m[2]);
            add(f, m[0], t[1], m[1]);
            add(f, m[2], m[1], t[2]);
            add(f, m[0], m[1], m[2]);
        }
    }
    out.midpoints = std::move(edges.list());
    return out;
}

struct refine_faces_fn {
    /// Splits the triangles `chosen` (one entry per triangle, 0 = not) into four; those beside them into two or
    /// three, or into four where all sides are split. O(faces + splits log splits).
    /// \throws invalid_input  `attribute_length`, `size_overflow`.
    [[nodiscard]] refined_faces operator()(triangle_surface const& s, std::span<unsigned char const> chosen) const {
        if (chosen.size() != s.triangles.size()) {
            fail<invalid_input>(errc::attribute_length,
                                "refine_faces: got " + std::to_string(chosen.size()) + " choices for " +
                                    std::to_string(s.triangles.size()) + " triangles",
                                {.kind = entity::attribute, .value = static_cast<double>(chosen.size()),
                                 .limit = static_cast<double>(s.triangles.size())});
        }
        std::vector<std::array<std::uint32_t, 2>> edges;
        for (std::size_t f = 0; f < chosen.size(); ++f) {
            if (chosen[f] == 0) continue;
            auto const& t = s.triangles[f];
            if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
            }
        }
        split_edges splits(std::move(edges), s.positions.size());
        require_indexable("refine_faces: vertices", s.positions.size() + splits.list().size());
        return split_triangles(s.positions, s.triangles, std::move(splits));
    }
};

struct refine_edges_fn {
    /// `wanted(a, b)` with a < b is asked once for every triangle at an edge; those around become two, three or four.
    /// O(faces + splits log splits). \throws invalid_input  `size_overflow`.
    template <class Wanted>
    [[nodiscard]] refined_faces operator()(triangle_surface const& s, Wanted const& wanted) const {
        std::vector<std::array<std::uint32_t, 2>> edges;
        for (auto const& t : s.triangles) {
            if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                std::uint32_t const a = std::min(t[k], t[(k + 1) % 3]);
                std::uint32_t const b = std::max(t[k], t[(k + 1) % 3]);
                if (wanted(a, b)) edges.push_back({a, b});
            }
        }
        split_edges splits(std::move(edges), s.positions.size());
        require_indexable("refine_edges: vertices", s.positions.size() + splits.list().size());
        return split_triangles(s.positions, s.triangles, std::move(splits));
    }
};

}  // namespace detail

/// `refine_faces(surface, chosen)`: 1-to-4 subdivision of some triangles, closed against the rest.
inline constexpr detail::refine_faces_fn refine_faces{};
/// `refine_edges(surface, wanted)`: a vertex in the middle of every edge (a < b) that `wanted(a, b)` names.
inline constexpr detail::refine_edges_fn refine_edges{};

/// Adds the middles of a refinement to positions of the same topology. O(midpoints).
inline void add_midpoints(std::vector<vec3>& positions, std::span<std::array<std::uint32_t, 2> const> midpoints) {
    positions.reserve(positions.size() + midpoints.size());
    for (auto const& m : midpoints) {
        vec3 const& a = positions[m[0]];
        vec3 const& b = positions[m[1]];
        positions.push_back(vec3{0.5 * a[0] + 0.5 * b[0], 0.5 * a[1] + 0.5 * b[1], 0.5 * a[2] + 0.5 * b[2]});
    }
}

}  // namespace tafoni

#endif
