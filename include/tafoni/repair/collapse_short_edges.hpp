/// \file
/// Removes triangles that have grown too small to matter and would soon tangle.
#ifndef TAFONI_REPAIR_COLLAPSE_SHORT_EDGES_HPP
#define TAFONI_REPAIR_COLLAPSE_SHORT_EDGES_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/geometry/triangle_surface.hpp>
#include <tafoni/geometry/vertex_rings.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni {

/// What a pass over the edges did.
struct collapse_report {
    std::size_t collapsed = 0;                 ///< edges, each with the triangles beside it
    std::vector<vertex_index> new_vertex{};    ///< old vertex -> new one; of an edge both ends lead to one vertex
    std::vector<face_index> new_face{};        ///< old triangle -> new one, not valid where it is gone
};

namespace detail {

/// One pass: edges whose surroundings no other edge of the pass has changed.
class edge_collapser {
public:
    /// `known` are the rings of the surface as it is, or null.
    edge_collapser(triangle_surface& s, double threshold, vertex_rings const* known)
        : surface_(s), limit_(threshold * threshold), known_(known) {}

    /// Number of collapsed edges; `survivor` leads every vertex to the one that it became. O(faces).
    std::size_t pass(std::vector<std::uint32_t>& survivor) {
        std::vector<std::array<std::uint32_t, 2>> const edges = short_edges();
        if (edges.empty()) return 0;
        if (known_ == nullptr) rings_ = vertex_rings(surface_.positions.size(), surface_.triangles);
        vertex_rings const& rings = known_ != nullptr ? *known_ : rings_;
        known_ = nullptr;
        touched_.assign(surface_.positions.size(), 0);
        std::size_t done = 0;
        for (auto const& [u, v] : edges) {
            if (collapse(rings, u, v)) {
                survivor[v] = u;
                ++done;
            }
        }
        return done;
    }

private:
    /// Shortest first, ties by place.
    [[nodiscard]] std::vector<std::array<std::uint32_t, 2>> short_edges() const {
        struct candidate {
            double square;
            std::array<std::uint32_t, 2> ends;
        };
        std::vector<candidate> found;
        auto const& p = surface_.positions;
        for (auto const& t : surface_.triangles) {
            for (std::size_t k = 0; k < 3; ++k) {
                std::uint32_t const u = std::min(t[k], t[(k + 1) % 3]);
                std::uint32_t const v = std::max(t[k], t[(k + 1) % 3]);
                double const square = squared_length(p[u] - p[v]);
                if (u != v && square < limit_) found.push_back({square, {u, v}});
            }
        }
        std::sort(found.begin(), found.end(), [&](candidate const& a, candidate const& b) {
            if (a.square != b.square) return a.square < b.square;
            if (p[a.ends[0]] != p[b.ends[0]]) return lexicographically_less(p[a.ends[0]], p[b.ends[0]]);
            if (p[a.ends[1]] != p[b.ends[1]]) return lexicographically_less(p[a.ends[1]], p[b.ends[1]]);
            return a.ends < b.ends;
        });
        std::vector<std::array<std::uint32_t, 2>> edges;
        for (candidate const& c : found) {
            if (edges.empty() || edges.back() != c.ends) edges.push_back(c.ends);
        }
        return edges;
    }

    bool collapse(vertex_rings const& rings, std::uint32_t u, std::uint32_t v) {
        if (touched_[u] != 0 || touched_[v] != 0) return false;
        auto const at_u = rings.neighbors(u);
        auto const at_v = rings.neighbors(v);
        // The link condition: the ends share no neighbours but the corners opposite the edge.
        common_.clear();
        std::set_intersection(at_u.begin(), at_u.end(), at_v.begin(), at_v.end(), std::back_inserter(common_));
        std::size_t beside = 0;
        for (auto const& c : rings.faces(u)) beside += has(surface_.triangles[c.face], v) ? 1U : 0U;
        if (beside == 0 || beside > 2 || common_.size() != beside) return false;
        bool const border_u = rings.is_border(u);
        bool const border_v = rings.is_border(v);
        if (beside == 2 && border_u && border_v) return false;  // would pinch the surface
        if (beside == 2 && rings.faces(u).size() + rings.faces(v).size() <= 6) return false;  // a tetrahedron would fold
        for (std::uint32_t const w : common_) {
            if (rings.neighbors(w).size() <= 3 && !rings.is_border(w)) return false;
        }
        for (auto const& ring : {at_u, at_v}) {
            for (std::uint32_t const w : ring) {
                if (touched_[w] != 0) return false;
            }
        }
        // A border keeps its line: the end that lies on it keeps its place.
        vec3 const p = surface_.positions[u];
        vec3 const q = surface_.positions[v];
        vec3 target = border_u == border_v ? vec3{0.5 * p + 0.5 * q} : border_u ? p : q;
        if (turns_over(rings, u, v, target) || turns_over(rings, v, u, target)) return false;
        surface_.positions[u] = target;
        for (auto const& c : rings.faces(v)) {
            for (std::uint32_t& corner : surface_.triangles[c.face]) {
                if (corner == v) corner = u;
            }
        }
        for (auto const& ring : {at_u, at_v}) {
            for (std::uint32_t const w : ring) touched_[w] = 1;
        }
        touched_[u] = touched_[v] = 1;
        return true;
    }

    /// Whether a triangle at `moving`, but for those beside the edge, would face the other way.
    [[nodiscard]] bool turns_over(vertex_rings const& rings, std::uint32_t moving, std::uint32_t other, vec3 const& target) const {
        for (auto const& c : rings.faces(moving)) {
            auto const& t = surface_.triangles[c.face];
            if (has(t, other)) continue;
            vec3 const& a = surface_.positions[t[(c.place + 1) % 3]];
            vec3 const& b = surface_.positions[t[(c.place + 2) % 3]];
            vec3 const before = cross(a - surface_.positions[moving], b - surface_.positions[moving]);
            vec3 const after = cross(a - target, b - target);
            double const along = dot(before, after);
            if (along < 0.25 * length(before) * length(after)) return true;
        }
        return false;
    }

    [[nodiscard]] static bool has(std::array<std::uint32_t, 3> const& t, std::uint32_t v) noexcept {
        return t[0] == v || t[1] == v || t[2] == v;
    }

    triangle_surface& surface_;
    double limit_;
    vertex_rings const* known_;
    vertex_rings rings_{};
    std::vector<unsigned char> touched_{};
    std::vector<std::uint32_t> common_{};
};

struct collapse_short_edges_fn {
    /// Collapses edges shorter than `threshold` into their middle until none is left that may be, the shortest
    /// first; a closed manifold stays one, of the same genus. A triangle goes with its short side; a flat one whose
    /// sides are all long stays: nothing near it is small, it counts for no curvature, and to remove it would take a
    /// vertex of its neighbours'. O(faces) per pass, about log(edges to collapse) passes.
    /// \throws invalid_input  `bad_parameter` for a threshold that is negative or not finite, and as
    ///         `triangle_surface::validate`.
    collapse_report operator()(triangle_surface& surface, double threshold) const {
        require_range("collapse_short_edges: threshold", threshold, 0, 1e100);
        surface.validate();
        return trusted(surface, threshold, nullptr);
    }

    /// Of a surface that is known to be valid, with its rings where they are known.
    static collapse_report trusted(triangle_surface& surface, double threshold, vertex_rings const* known) {
        collapse_report report;
        std::vector<std::uint32_t> survivor(surface.positions.size());
        for (std::size_t v = 0; v < survivor.size(); ++v) survivor[v] = static_cast<std::uint32_t>(v);
        edge_collapser collapser(surface, threshold, known);
        while (std::size_t const done = collapser.pass(survivor)) {
            report.collapsed += done;
            // Triangles of a collapsed edge are gone at once, so that the next pass does not see them.
            for (auto& t : surface.triangles) {
                if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) t = {t[0], t[0], t[0]};
            }
        }
        renumber(surface, survivor, report);
        return report;
    }

private:
    static void renumber(triangle_surface& surface, std::span<std::uint32_t> survivor, collapse_report& report) {
        std::size_t const n = surface.positions.size();
        report.new_vertex.resize(n);
        report.new_face.resize(surface.triangles.size());
        if (report.collapsed == 0) {
            for (std::size_t v = 0; v < n; ++v) report.new_vertex[v] = vertex_index{v};
            for (std::size_t f = 0; f < report.new_face.size(); ++f) report.new_face[f] = face_index{f};
            return;
        }
        std::vector<std::uint32_t> number(n, 0);
        std::uint32_t kept = 0;
        for (std::size_t v = 0; v < n; ++v) {
            if (survivor[v] != v) continue;
            surface.positions[kept] = surface.positions[v];
            number[v] = kept++;
        }
        surface.positions.resize(kept);
        for (std::size_t v = 0; v < n; ++v) {
            std::uint32_t w = static_cast<std::uint32_t>(v);
            while (survivor[w] != w) w = survivor[w];
            survivor[v] = w;
            report.new_vertex[v] = vertex_index{number[w]};
        }
        std::size_t faces = 0;
        for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
            auto const t = surface.triangles[f];
            if (t[0] == t[1]) continue;
            report.new_face[f] = face_index{faces};
            surface.triangles[faces++] = {number[t[0]], number[t[1]], number[t[2]]};
        }
        surface.triangles.resize(faces);
    }
};

}  // namespace detail

/// `collapse_short_edges(surface, threshold)`; see `detail::collapse_short_edges_fn`.
inline constexpr detail::collapse_short_edges_fn collapse_short_edges{};

}  // namespace tafoni

#endif
