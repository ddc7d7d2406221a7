/// \file
/// Collapsing edges: which may be, in what order, and what is left.
#ifndef TAFONI_REPAIR_DETAIL_EDGE_COLLAPSER_HPP
#define TAFONI_REPAIR_DETAIL_EDGE_COLLAPSER_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/geometry/detail/kept_runs.hpp>
#include <tafoni/geometry/detail/mended_rings.hpp>
#include <tafoni/geometry/triangle_surface.hpp>
#include <tafoni/geometry/vertex_rings.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace tafoni::detail {

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
template <class Rings>
class collapse_rules {
public:
    /// Views of what outlives the rules; `rings` are right at the ends of every edge that is asked about.
    collapse_rules(std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles,
                   Rings const& rings)
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
    Rings const& rings_;
    std::vector<std::uint32_t> common_{};
};

/// Collapses short edges in passes: the edges of one pass are those neither end of which another of them has changed.
class edge_collapser {
public:
    /// `positions` and `triangles` are changed: triangles that go name one vertex three times. `rings` are mended.
    /// `fixed` is empty or has a flag for each vertex; edges at those that it names stay.
    edge_collapser(std::span<vec3> positions, std::span<std::array<std::uint32_t, 3>> triangles, mended_rings& rings,
                   std::span<unsigned char const> fixed)
        : positions_(positions), triangles_(triangles), rings_(rings), touched_(fixed.begin(), fixed.end()) {
        touched_.resize(positions.size(), 0);
    }

    /// `edges` are all whose squared length is below `limit`. Returns how many were collapsed, in all passes.
    /// O(vertices + triangles around these edges) per pass.
    std::size_t collapse(std::vector<short_edge> edges, double limit) {
        std::size_t before = 0;
        for (int passes = 0; passes < most_passes && !edges.empty(); ++passes) {
            sort(edges);
            pass(edges);
            if (merged_.size() == before) break;
            rings_.mend(std::span(merged_).subspan(before), triangles_);
            find_again(edges, std::span<merged_vertex const>(merged_).subspan(before), limit);
            before = merged_.size();
        }
        return merged_.size();
    }

    /// In the order of the collapses, so that a kept one may be gone later.
    [[nodiscard]] std::span<merged_vertex const> merged() const noexcept { return merged_; }
    /// Triangles that went with their edges, each once.
    [[nodiscard]] std::span<std::uint32_t const> gone_faces() const noexcept { return gone_faces_; }

private:
    static constexpr int most_passes = 64;  ///< more are only needed where most short edges meet at one vertex

    void pass(std::span<short_edge const> edges) {
        collapse_rules rules(positions_, triangles_, rings_);
        reached_.clear();
        for (short_edge const& e : edges) {
            auto const [u, v] = e.ends;
            if (touched_[u] != 0 || touched_[v] != 0) continue;
            std::optional<vec3> const meet = rules.target(u, v);
            if (!meet) continue;
            positions_[u] = *meet;
            for (auto const& c : rings_.faces(v)) {
                auto& t = triangles_[c.face];
                t[c.place] = u;
                if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) continue;
                t = {u, u, u};
                gone_faces_.push_back(c.face);
            }
            for (auto const& ring : {rings_.neighbors(u), rings_.neighbors(v)}) {
                for (std::uint32_t const w : ring) touch(w);
            }
            merged_.push_back({.kept = u, .gone = v});
        }
        for (std::uint32_t const w : reached_) touched_[w] = 0;
    }
    void touch(std::uint32_t v) {
        if (touched_[v] != 0) return;
        touched_[v] = 1;
        reached_.push_back(v);
    }
    /// The short edges after a pass: those of before that are still there, and new ones at the vertices that moved.
    void find_again(std::vector<short_edge>& edges, std::span<merged_vertex const> merged, double limit) {
        std::vector<short_edge> found;
        auto const add = [&](std::uint32_t v, std::uint32_t w) {
            double const square = squared_length(positions_[v] - positions_[w]);
            if (square < limit) found.push_back({square, {std::min(v, w), std::max(v, w)}});
        };
        for (merged_vertex const& m : merged) {
            touched_[m.kept] |= 2;
            touched_[m.gone] |= 2;
            for (std::uint32_t const w : rings_.neighbors(m.kept)) add(m.kept, w);
        }
        for (short_edge const& e : edges) {
            if (((touched_[e.ends[0]] | touched_[e.ends[1]]) & 2) == 0) found.push_back(e);
        }
        for (merged_vertex const& m : merged) touched_[m.kept] = touched_[m.gone] = 0;
        edges.swap(found);
    }
    /// Shortest first, ties by place.
    void sort(std::vector<short_edge>& edges) const {
        auto const& p = positions_;
        std::sort(edges.begin(), edges.end(), [&](short_edge const& a, short_edge const& b) {
            if (a.square != b.square) return a.square < b.square;
            if (p[a.ends[0]] != p[b.ends[0]]) return lexicographically_less(p[a.ends[0]], p[b.ends[0]]);
            if (p[a.ends[1]] != p[b.ends[1]]) return lexicographically_less(p[a.ends[1]], p[b.ends[1]]);
            return a.ends < b.ends;
        });
    }

    std::span<vec3> positions_;
    std::span<std::array<std::uint32_t, 3>> triangles_;
    mended_rings& rings_;
    std::vector<unsigned char> touched_;
    std::vector<std::uint32_t> reached_{};
    std::vector<merged_vertex> merged_{};
    std::vector<std::uint32_t> gone_faces_{};
};

/// A surface without what was collapsed, and what its vertices and triangles were. Keeps its memory from use to use.
struct collapsed_surface {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    triangle_surface surface{};
    std::vector<std::uint32_t> vertex{};        ///< old -> new; of one that is gone that of the vertex which it became
    std::vector<std::uint32_t> face{};          ///< old -> new, or none
    std::vector<std::uint32_t> gone_vertices{};  ///< old numbers, ascending
    std::vector<std::uint32_t> gone_faces{};     ///< old numbers, ascending: with those that named a vertex twice all along

    /// `positions` and `triangles` as `edges` left them. O(vertices + faces).
    template <executor E>
    void take(edge_collapser const& edges, std::span<vec3 const> positions,
              std::span<std::array<std::uint32_t, 3> const> triangles, vertex_rings const& before, E const& threads) {
        gone_vertices.clear();
        for (merged_vertex const& m : edges.merged()) gone_vertices.push_back(m.gone);
        std::sort(gone_vertices.begin(), gone_vertices.end());
        gone_faces.assign(edges.gone_faces().begin(), edges.gone_faces().end());
        if (before.corner_count() < 3 * triangles.size()) {
            gone_faces.clear();
            for (std::size_t f = 0; f < triangles.size(); ++f) {
                auto const& t = triangles[f];
                if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) gone_faces.push_back(static_cast<std::uint32_t>(f));
            }
        }
        std::sort(gone_faces.begin(), gone_faces.end());
        vertex.resize(positions.size());
        face.resize(triangles.size());
        surface.positions.resize(positions.size() - gone_vertices.size());
        surface.triangles.resize(triangles.size() - gone_faces.size());
        for_kept_runs(positions.size(), gone_vertices, threads, [&](std::size_t begin, std::size_t end, std::size_t to) {
            for (std::size_t v = begin; v < end; ++v, ++to) {
                vertex[v] = static_cast<std::uint32_t>(to);
                surface.positions[to] = positions[v];
            }
        });
        for (std::size_t k = edges.merged().size(); k-- > 0;) vertex[edges.merged()[k].gone] = vertex[edges.merged()[k].kept];
        for (std::uint32_t const f : gone_faces) face[f] = none;
        for_kept_runs(triangles.size(), gone_faces, threads, [&](std::size_t begin, std::size_t end, std::size_t to) {
            for (std::size_t f = begin; f < end; ++f, ++to) {
                auto const [i, j, k] = triangles[f];
                face[f] = static_cast<std::uint32_t>(to);
                surface.triangles[to] = {vertex[i], vertex[j], vertex[k]};
            }
        });
    }
};

}  // namespace tafoni::detail

#endif
