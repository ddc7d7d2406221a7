/// \file
/// Which coordinates the border vertices of an open mesh keep.
#ifndef TAFONI_WEATHERING_DETAIL_HELD_BORDERS_HPP
#define TAFONI_WEATHERING_DETAIL_HELD_BORDERS_HPP

#include <tafoni/core/vector.hpp>
#include <tafoni/geometry/vertex_rings.hpp>
#include <tafoni/weathering/detail/border_neighbors.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// Coordinates as bits: 1 for x, 2 for y, 4 for z.
using axis_bits = unsigned char;

/// Where every border edge at a vertex lies in a plane of constant x, y or z, as the sides of a terrain and the level rims
/// of a vessel do, the vertex stays in that plane; in two where two sides meet. Of two planes that all its edges lie in it
/// keeps the one that is more across the surface, and none that the surface itself lies in: flat ground sinks as a whole.
/// Borders of other kinds are free. What is kept stays equal to the bit, so this depends on the positions alone.
class held_borders {
public:
    /// Triangles are others from now on. O(vertices + faces).
    void adopt(vertex_rings const& rings, std::span<std::array<std::uint32_t, 3> const> triangles, std::size_t vertices) {
        vertices_.clear();
        begin_.assign(1, 0);
        beside_.clear();
        for (std::size_t v = 0; v < vertices; ++v) {
            if (!rings.is_border(v)) continue;
            vertices_.push_back(static_cast<std::uint32_t>(v));
            auto const along = neighbors_along_border(rings, triangles, v, scratch_);
            beside_.insert(beside_.end(), along.begin(), along.end());
            begin_.push_back(static_cast<std::uint32_t>(beside_.size()));
        }
        kept_.assign(vertices_.empty() ? 0 : vertices, 0);
    }
    /// Vertices are where they are now. O(border vertices and their faces).
    void look(std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles, vertex_rings const& rings) noexcept {
        for (std::size_t k = 0; k < vertices_.size(); ++k) {
            std::uint32_t const v = vertices_[k];
            axis_bits all = whole;
            axis_bits any = 0;
            bool level = begin_[k] < begin_[k + 1];
            for (std::uint32_t i = begin_[k]; i < begin_[k + 1]; ++i) {
                axis_bits const edge = shared(positions[beside_[i]], positions[v]);
                all = static_cast<axis_bits>(all & edge);
                any = static_cast<axis_bits>(any | edge);
                level = level && edge != 0;
            }
            kept_[v] = level ? chosen(all, any, normal_at(v, positions, triangles, rings)) : axis_bits{0};
        }
    }
    /// By vertex; empty where there is no border.
    [[nodiscard]] std::span<axis_bits const> kept() const noexcept { return kept_; }

private:
    static constexpr axis_bits whole = 7;

    [[nodiscard]] static axis_bits shared(vec3 const& p, vec3 const& q) noexcept {
        return static_cast<axis_bits>((p[0] == q[0] ? 1U : 0U) | (p[1] == q[1] ? 2U : 0U) | (p[2] == q[2] ? 4U : 0U));
    }
    /// `all`: coordinates that every border edge keeps, `any`: that one keeps.
    [[nodiscard]] static axis_bits chosen(axis_bits all, axis_bits any, vec3 const& n) noexcept {
        int most = 0;
        for (int d = 1; d < 3; ++d) {
            if (std::fabs(n[d]) > std::fabs(n[most])) most = d;
        }
        auto const up = static_cast<axis_bits>(1U << most);
        if (any == whole) return static_cast<axis_bits>(whole & ~up);  // a corner
        if (all == 0) return any;                                      // of two sides that are not level
        if ((all & (all - 1)) != 0) return static_cast<axis_bits>(all & ~up);
        return all == up && std::fabs(n[most]) > 0.95 * length(n) ? axis_bits{0} : all;
    }
    [[nodiscard]] static vec3 normal_at(std::uint32_t v, std::span<vec3 const> positions,
                                        std::span<std::array<std::uint32_t, 3> const> triangles, vertex_rings const& rings) noexcept {
        vec3 sum{0, 0, 0};
        for (auto const& c : rings.faces(v)) {
            auto const& t = triangles[c.face];
            sum += cross(vec3{positions[t[1]] - positions[t[0]]}, vec3{positions[t[2]] - positions[t[0]]});
        }
        return sum;
    }

    std::vector<std::uint32_t> vertices_{};
    std::vector<std::uint32_t> begin_{};
    std::vector<std::uint32_t> beside_{};  ///< neighbours along the border
    std::vector<std::uint32_t> scratch_{};
    std::vector<axis_bits> kept_{};
};

/// Without the coordinates that are kept. O(1).
[[nodiscard]] inline vec3 without(vec3 way, axis_bits kept) noexcept {
    for (int d = 0; d < 3; ++d) {
        if ((kept >> d & 1U) != 0) way[d] = 0;
    }
    return way;
}

}  // namespace tafoni::detail

#endif
