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
#include <optional>
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

struct short_edge {
    double square = 0;                   ///< of its length
    std::array<std::uint32_t, 2> ends{};  ///< ascending
};

/// Adds the edges between `begin` <= lower end < `end` whose squared length is below `limit`. O(edges there).
inline void find_short_edges(std::span<vec3 const> positions, vertex_rings const& rings, double limit, std::size_t begin,
                             std::size_t end, std::vector<short_edge>& found) {
    for (std::size_t v = begin; v < end; ++v) {
        for (std::uint32_t const w : rings.neighbors(v)) {
            if (w < v) continue;
            double const square = squared_length(positions[v] - positions[w]);
            if (square < limit) found.push_back({square, {static_cast<std::uint32_t>(v), w}});
        }
    }
}

/// Which edges of a surface may be collapsed, and where their ends meet.
class collapse_rules {
public:
    /// Views of what outlives the rules; `rings` are right at the ends of every edge that is asked about.
    collapse_rules(std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles,
                   vertex_rings const& rings)
        : positions_(positions), triangles_(triangles), rings_(rings) {}

    /// Nothing where the surface would fold, be pinched or turn over. O(triangles at the ends).
    ///
    /// The rings of the vertices opposite the edge may be those before other edges of them were collapsed: edges whose
    /// ends are not neighbours leave a ring of at least three vertices for each, so none of them shrinks it below four.
    [[nodiscard]] std::optional<vec3> target(std::uint32_t u, std::uint32_t v) {
        auto const [few, more] = rings_.faces(u).size() <= rings_.faces(v).size() ? std::array{u, v} : std::array{v, u};
        // The link condition: the ends share no neighbours but the corners opposite the edge.
        common_.clear();
        auto const other = rings_.neighbors(more);
        for (std::uint32_t const w : rings_.neighbors(few)) {
            if (std::binary_search(other.begin(), other.end(), w)) common_.push_back(w);
        }
        std::size_t beside = 0;
        for (auto const& c : rings_.faces(few)) beside += has(triangles_[c.face], more) ? 1U : 0U;
        if (beside == 0 || beside > 2 || common_.size() != beside) return {};
        bool const border_u = rings_.is_border(u);
        bool const border_v = rings_.is_border(v);
        if (beside == 2 && border_u && border_v) return {};  // would pinch the surface
        if (beside == 2 && rings_.faces(u).size() + rings_.faces(v).size() <= 6) return {};  // a tetrahedron would fold
        for (std::uint32_t const w : common_) {
            if (rings_.neighbors(w).size() <= 3 && !rings_.is_border(w)) return {};
        }
        // A border keeps its line: the end that lies on it keeps its place. So does the hub of very many triangles.
        vec3 const p = positions_[u];
        vec3 const q = positions_[v];
        bool const hub = rings_.faces(more).size() > many;
        vec3 const meet = border_u != border_v ? (border_u ? p : q) : hub ? positions_[more] : vec3{0.5 * p + 0.5 * q};
        if (turns_over(u, v, meet) || turns_over(v, u, meet)) return {};
        return meet;
    }
private:
    static constexpr std::size_t many = 256;

    /// Whether a triangle at `moving`, but for those beside the edge, would face the other way.
    [[nodiscard]] bool turns_over(std::uint32_t moving, std::uint32_t other, vec3 const& target) const {
        if (positions_[moving] == target) return false;
        for (auto const& c : rings_.faces(moving)) {
            auto const& t = triangles_[c.face];
            if (has(t, other)) continue;
            vec3 const& a = positions_[t[(c.place + 1) % 3]];
            vec3 const& b = positions_[t[(c.place + 2) % 3]];
            vec3 const before = cross(a - positions_[moving], b - positions_[moving]);
            vec3 const after = cross(a - target, b - target);
            if (dot(before, after) < 0.25 * length(before) * length(after)) return true;
        }
        return false;
    }
    [[nodiscard]] static bool has(std::array<std::uint32_t, 3> const& t, std::uint32_t v) noexcept {
        return t[0] == v || t[1] == v || t[2] == v;
    }

    std::span<vec3 const> positions_;
    std::span<std::array<std::uint32_t, 3> const> triangles_;
    vertex_rings const& rings_;
    std::vector<std::uint32_t> common_{};
};

/// One pass: edges neither end of which another edge of the pass has changed.
class edge_collapser {
public:
    /// `known` are the rings of the surface as it is, or null.
    /// `fixed` is empty or has a flag for each vertex; edges at those that it names stay.
    edge_collapser(triangle_surface& s, double threshold, vertex_rings const* known, std::span<unsigned char const> fixed = {})
        : surface_(s), limit_(threshold * threshold), known_(known), fixed_(fixed) {}

    /// Number of collapsed edges; `survivor` leads every vertex to the one that it became. O(faces).
    std::size_t pass(std::vector<std::uint32_t>& survivor) {
        std::vector<short_edge> edges;
        if (known_ != nullptr) {
            find_short_edges(surface_.positions, *known_, limit_, 0, surface_.positions.size(), edges);
        } else if (any_short_side()) {
            rings_ = vertex_rings(surface_.positions.size(), surface_.triangles);
            find_short_edges(surface_.positions, rings_, limit_, 0, surface_.positions.size(), edges);
        }
        if (edges.empty()) return 0;
        sort(edges);
        vertex_rings const& rings = known_ != nullptr ? *known_ : rings_;
        known_ = nullptr;
        collapse_rules rules(surface_.positions, surface_.triangles, rings);
        touched_.assign(fixed_.begin(), fixed_.end());
        touched_.resize(surface_.positions.size(), 0);
        std::size_t done = 0;
        for (short_edge const& e : edges) {
            auto const [u, v] = e.ends;
            if (touched_[u] != 0 || touched_[v] != 0) continue;
            std::optional<vec3> const meet = rules.target(u, v);
            if (!meet) continue;
            collapse(rings, u, v, *meet);
            survivor[v] = u;
            ++done;
        }
        return done;
    }

private:
    /// O(faces).
    [[nodiscard]] bool any_short_side() const noexcept {
        auto const& p = surface_.positions;
        return std::any_of(surface_.triangles.begin(), surface_.triangles.end(), [&](auto const& t) {
            return squared_length(p[t[0]] - p[t[1]]) < limit_ || squared_length(p[t[1]] - p[t[2]]) < limit_ ||
                   squared_length(p[t[2]] - p[t[0]]) < limit_;
        });
    }
    /// Shortest first, ties by place.
    void sort(std::vector<short_edge>& edges) const {
        auto const& p = surface_.positions;
        std::sort(edges.begin(), edges.end(), [&](short_edge const& a, short_edge const& b) {
            if (a.square != b.square) return a.square < b.square;
            if (p[a.ends[0]] != p[b.ends[0]]) return lexicographically_less(p[a.ends[0]], p[b.ends[0]]);
            if (p[a.ends[1]] != p[b.ends[1]]) return lexicographically_less(p[a.ends[1]], p[b.ends[1]]);
            return a.ends < b.ends;
        });
    }
    void collapse(vertex_rings const& rings, std::uint32_t u, std::uint32_t v, vec3 const& meet) {
        surface_.positions[u] = meet;
        for (auto const& c : rings.faces(v)) {
            for (std::uint32_t& corner : surface_.triangles[c.face]) {
                if (corner == v) corner = u;
            }
        }
        for (auto const& ring : {rings.neighbors(u), rings.neighbors(v)}) {
            for (std::uint32_t const w : ring) touched_[w] = 1;
        }
        touched_[u] = touched_[v] = 1;
    }

    triangle_surface& surface_;
    double limit_;
    vertex_rings const* known_;
    std::span<unsigned char const> fixed_;
    vertex_rings rings_{};
    std::vector<unsigned char> touched_{};
};

struct collapse_short_edges_fn {
    /// Collapses edges shorter than `threshold` into their middle until none is left that may be, the shortest
    /// first; a closed manifold stays one, of the same genus. A triangle goes with its short side; a flat one whose
    /// sides are all long stays: nothing near it is small, it counts for no curvature, and to remove it would take a
    /// vertex of its neighbours'. O(faces) per pass, about log(edges to collapse) passes and at most 64.
    /// \throws invalid_input  `bad_parameter` for a threshold that is negative or not finite, and as
    ///         `triangle_surface::validate`.
    collapse_report operator()(triangle_surface& surface, double threshold) const {
        require_range("collapse_short_edges: threshold", threshold, 0, 1e100);
        surface.validate();
        return trusted(surface, threshold, nullptr);
    }

    /// Of a surface that is known to be valid, with its rings where they are known; `fixed` as `edge_collapser`.
    static collapse_report trusted(triangle_surface& surface, double threshold, vertex_rings const* known,
                                   std::span<unsigned char const> fixed = {}) {
        collapse_report report;
        std::vector<std::uint32_t> survivor(surface.positions.size());
        for (std::size_t v = 0; v < survivor.size(); ++v) survivor[v] = static_cast<std::uint32_t>(v);
        edge_collapser collapser(surface, threshold, known, fixed);
        for (int pass = 0; pass < most_passes; ++pass) {
            std::size_t const done = collapser.pass(survivor);
            if (done == 0) break;
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
    static constexpr int most_passes = 64;  ///< more are only needed where most short edges meet at one vertex

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
