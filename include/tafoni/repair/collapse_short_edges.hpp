/// \file
/// Removes triangles that have grown too small to matter and would soon tangle.
#ifndef TAFONI_REPAIR_COLLAPSE_SHORT_EDGES_HPP
#define TAFONI_REPAIR_COLLAPSE_SHORT_EDGES_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/executor.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/geometry/triangle_surface.hpp>
#include <tafoni/geometry/vertex_rings.hpp>
#include <tafoni/repair/detail/edge_collapser.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tafoni {

/// What a pass over the edges did.
struct collapse_report {
    std::size_t collapsed = 0;                 ///< edges, each with the triangles beside it
    std::vector<vertex_index> new_vertex{};    ///< old vertex -> new one; of an edge both ends lead to one vertex
    std::vector<face_index> new_face{};        ///< old triangle -> new one, not valid where it is gone
};

namespace detail {

struct collapse_short_edges_fn {
    /// Collapses edges shorter than `threshold` into their middle until none is left that may be, the shortest
    /// first; a closed manifold stays one, of the same genus. A triangle goes with its short side; a flat one whose
    /// sides are all long stays: nothing near it is small, it counts for no curvature, and to remove it would take a
    /// vertex of its neighbours'. O(faces), and for each of about log(edges to collapse), at most 64, passes what lies around
    /// the short edges. All or nothing.
    /// \throws invalid_input  `bad_parameter` for a threshold that is negative or not finite, and as
    ///         `triangle_surface::validate`.
    collapse_report operator()(triangle_surface& surface, double threshold) const {
        require_range("collapse_short_edges: threshold", threshold, 0, 1e100);
        surface.validate();
        return trusted(surface, threshold, nullptr);
    }

    /// Of a surface that is known to be valid, with its rings where they are known; `fixed` is empty or has a flag for each
    /// vertex; edges at those that it names stay.
    static collapse_report trusted(triangle_surface& surface, double threshold, vertex_rings const* known,
                                   std::span<unsigned char const> fixed = {}) {
        std::size_t const n = surface.positions.size();
        double const limit = threshold * threshold;
        if (!any_short_side(surface, limit)) return unchanged(surface);
        vertex_rings const own = known == nullptr ? vertex_rings(n, surface.triangles) : vertex_rings{};
        vertex_rings const& before = known == nullptr ? own : *known;
        std::vector<short_edge> edges;
        find_short_edges(surface.positions, before, limit, 0, n, edges);
        triangle_surface work = surface;
        mended_rings rings;
        rings.start(before);
        edge_collapser collapser(work.positions, work.triangles, rings, fixed);
        std::size_t const collapsed = collapser.collapse(std::move(edges), limit);
        if (collapsed == 0) return unchanged(surface);
        collapsed_surface left;
        left.take(collapser, work.positions, work.triangles, before, inline_executor{});
        collapse_report report{.collapsed = collapsed, .new_vertex = {}, .new_face = {}};
        for (std::uint32_t const v : left.vertex) report.new_vertex.emplace_back(v);
        for (std::uint32_t const f : left.face) report.new_face.emplace_back(f);  // none stays none
        surface = std::move(left.surface);
        return report;
    }

private:
    [[nodiscard]] static collapse_report unchanged(triangle_surface const& s) {
        collapse_report report;
        for (std::size_t v = 0; v < s.positions.size(); ++v) report.new_vertex.emplace_back(v);
        for (std::size_t f = 0; f < s.triangles.size(); ++f) report.new_face.emplace_back(f);
        return report;
    }
    /// O(faces).
    [[nodiscard]] static bool any_short_side(triangle_surface const& s, double limit) noexcept {
        auto const& p = s.positions;
        return std::any_of(s.triangles.begin(), s.triangles.end(), [&](auto const& t) {
            return squared_length(p[t[0]] - p[t[1]]) < limit || squared_length(p[t[1]] - p[t[2]]) < limit ||
                   squared_length(p[t[2]] - p[t[0]]) < limit;
        });
    }
};

}  // namespace detail

/// `collapse_short_edges(surface, threshold)`; see `detail::collapse_short_edges_fn`.
inline constexpr detail::collapse_short_edges_fn collapse_short_edges{};

}  // namespace tafoni

#endif
