/// \file
/// An iteration's end where edges have become too short.
#ifndef TAFONI_WEATHERING_DETAIL_EDGE_THINNING_HPP
#define TAFONI_WEATHERING_DETAIL_EDGE_THINNING_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/geometry/detail/mended_rings.hpp>
#include <tafoni/geometry/vertex_rings.hpp>
#include <tafoni/repair/detail/edge_collapser.hpp>
#include <tafoni/weathering/curvature_checkpoint.hpp>
#include <tafoni/weathering/detail/edge_lengths.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// Takes a surface and its rings to where its vertices go, without the edges that are too short there. Keeps its memory,
/// about that of the surface, from use to use.
class edge_thinning {
public:
    /// `next` is where the vertices go, `moved` how far, `edges` the lengths there. False, and nothing done, where no edge
    /// below `limit` may go; when anything throws only `next` is spoilt. O(vertices + faces), of which little where none goes.
    template <executor E>
    bool operator()(curvature_state& now, vertex_rings& rings, std::span<vec3> next, std::span<double const> moved,
                    edge_lengths const& edges, double limit, E const& threads) {
        std::vector<short_edge> found = edges_below(edges, limit, next, rings);
        if (!any_may_collapse(found, next, now.surface.triangles, rings, now.held)) return false;
        triangles_.resize(now.surface.triangles.size());
        threads.for_blocks(triangles_.size(), 8192, [&](std::size_t begin, std::size_t end) {
            std::copy(now.surface.triangles.begin() + static_cast<std::ptrdiff_t>(begin),
                      now.surface.triangles.begin() + static_cast<std::ptrdiff_t>(end),
                      triangles_.begin() + static_cast<std::ptrdiff_t>(begin));
        });
        mended_.start(rings);
        edge_collapser collapser(next, triangles_, mended_, now.held);
        std::size_t const collapsed = collapser.collapse(std::move(found), limit * limit);
        left_.take(collapser, next, triangles_, rings, threads);
        mended_.renumber(left_.vertex, left_.face, rings_, threads);
        follow(now, moved, threads);
        // Nothing below throws.
        std::swap(now.surface, left_.surface);
        std::swap(now.new_vertex, new_vertex_);
        std::swap(now.wear, wear_);
        std::swap(now.input_of, input_of_);
        if (!now.held.empty()) std::swap(now.held, held_);
        std::swap(rings, rings_);
        now.edges_collapsed += collapsed;
        ++now.iterations;
        return true;
    }

private:
    /// What belongs to the vertices, for those that are left.
    template <executor E>
    void follow(curvature_state const& now, std::span<double const> moved, E const& threads) {
        std::size_t const n = left_.surface.positions.size();
        wear_.resize(n);
        input_of_.resize(n);
        held_.resize(now.held.empty() ? 0 : n);
        new_vertex_.resize(now.new_vertex.size());
        for_kept_runs(moved.size(), left_.gone_vertices, threads, [&](std::size_t begin, std::size_t end, std::size_t to) {
            for (std::size_t v = begin; v < end; ++v, ++to) {
                wear_[to] = now.wear[v] + moved[v];
                input_of_[to] = moved[v] > 0 ? vertex_index{} : now.input_of[v];
                if (!now.held.empty()) held_[to] = now.held[v];
            }
        });
        for (std::uint32_t const v : left_.gone_vertices) {  // none of them is held, nor what it became
            std::uint32_t const to = left_.vertex[v];
            wear_[to] = std::max(wear_[to], now.wear[v] + moved[v]);
            input_of_[to] = vertex_index{};
        }
        threads.for_blocks(new_vertex_.size(), 8192, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) new_vertex_[v] = vertex_index{left_.vertex[now.new_vertex[v].value]};
        });
    }

    std::vector<std::array<std::uint32_t, 3>> triangles_{};
    mended_rings mended_{};
    collapsed_surface left_{};
    vertex_rings rings_{};
    std::vector<vertex_index> new_vertex_{};
    std::vector<double> wear_{};
    std::vector<vertex_index> input_of_{};
    std::vector<unsigned char> held_{};
};

}  // namespace tafoni::detail

#endif
