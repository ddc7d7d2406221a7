/// \file
/// Which planes the border vertices of an open mesh stay in.
#ifndef TAFONI_WEATHERING_DETAIL_HELD_BORDERS_HPP
#define TAFONI_WEATHERING_DETAIL_HELD_BORDERS_HPP

#include <tafoni/core/vector.hpp>
#include <tafoni/geometry/vertex_rings.hpp>
#include <tafoni/weathering/detail/border_neighbors.hpp>
#include <tafoni/weathering/detail/border_planes.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// Coordinates as bits: 1 for x, 2 for y, 4 for z.
using axis_bits = unsigned char;

/// What a border vertex keeps: coordinates, to the bit, or its place across one or two planes, but for rounding.
struct border_hold {
    axis_bits axes = 0;
    unsigned char planes = 0;
    std::array<vec3, 2> across{vec3{0, 0, 0}, vec3{0, 0, 0}};  ///< unit normals
};

/// Without what leads out of the planes. O(1).
[[nodiscard]] inline vec3 without(vec3 way, border_hold const& kept) noexcept {
    for (int d = 0; d < 3; ++d) {
        if ((kept.axes >> d & 1U) != 0) way[d] = 0;
    }
    if (kept.planes == 1) {
        vec3 const& m = kept.across[0];
        double const out = dot(way, m);
        return vec3{way[0] - out * m[0], way[1] - out * m[1], way[2] - out * m[2]};
    }
    if (kept.planes == 2) {
        vec3 const along = normalized(cross(kept.across[0], kept.across[1]));
        double const in = dot(way, along);
        return vec3{in * along[0], in * along[1], in * along[2]};
    }
    return way;
}

/// What the vertices of a surface keep.
struct kept_ways {
    std::span<std::uint32_t const> slot{};  ///< by vertex, of `holds`; empty where the surface has no border
    std::span<border_hold const> holds{};

    /// Null where it keeps nothing.
    [[nodiscard]] border_hold const* of(std::size_t v) const noexcept {
        if (slot.empty() || slot[v] >= holds.size()) return nullptr;
        border_hold const& h = holds[slot[v]];
        return h.axes != 0 || h.planes != 0 ? &h : nullptr;
    }
};

/// Where the border of the input runs in a plane, as along the sides of a terrain and the level rims of a vessel, vertices
/// stay in it; in two where two sides meet. That is seen from the next 16 border vertices either way, by five that lie in a
/// plane to 1e-9, or three in a line: then it is the upright plane through the line, or the one square to that, whichever
/// is more across the surface. Where those do not tell, an edge of constant x, y or z does. Never a plane that the
/// surface itself lies in: flat ground sinks as a whole. Borders of other kinds are free. A plane of constant x, y or z is
/// kept to the bit. Vertices that split an edge of the border keep what both of its ends keep.
class held_borders {
public:
    held_borders() = default;
    /// Of the input; what its vertices keep never changes. O(vertices + faces).
    held_borders(std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles) : inputs_(positions.size()) {
        vertex_rings const rings(positions.size(), triangles);
        adopt(rings, triangles, positions.size());
        for (std::size_t k = 0; k < vertices_.size(); ++k) {
            vec3 const normal = normal_at(vertices_[k], positions, triangles, rings);
            if (begin_[k + 1] - begin_[k] == 2) holds_[k] = in_planes(k, positions, normal);
            if (holds_[k].axes == 0 && holds_[k].planes == 0) holds_[k].axes = by_axes(k, positions, normal);
        }
    }
    /// Edges of the input may have been split, by vertices that follow its own. O(vertices + faces), and for each border
    /// edge of the input the square of its parts.
    void adopt(vertex_rings const& rings, std::span<std::array<std::uint32_t, 3> const> triangles, std::size_t vertices) {
        std::vector<std::uint32_t> slot;
        vertices_.clear();
        begin_.assign(1, 0);
        beside_.clear();
        for (std::size_t v = 0; v < vertices; ++v) {
            if (!rings.is_border(v)) continue;
            if (slot.empty()) slot.assign(vertices, none);
            slot[v] = static_cast<std::uint32_t>(vertices_.size());
            vertices_.push_back(static_cast<std::uint32_t>(v));
            auto const along = neighbors_along_border(rings, triangles, v, scratch_);
            beside_.insert(beside_.end(), along.begin(), along.end());
            begin_.push_back(static_cast<std::uint32_t>(beside_.size()));
        }
        std::vector<border_hold> holds(vertices_.size());
        for (std::size_t k = 0; k < vertices_.size(); ++k) {
            std::uint32_t const v = vertices_[k];
            if (v < inputs_ && v < slot_.size() && slot_[v] != none) holds[k] = holds_[slot_[v]];
        }
        std::swap(slot_, slot);  // nothing below throws: what the input's vertices keep is never lost
        std::swap(holds_, holds);
        for (std::size_t k = 0; k < vertices_.size(); ++k) {
            if (vertices_[k] >= inputs_ && begin_[k + 1] - begin_[k] == 2) holds_[k] = common(holds_[end_of(k, 0)], holds_[end_of(k, 1)]);
        }
    }
    [[nodiscard]] kept_ways kept() const noexcept { return {.slot = slot_, .holds = holds_}; }

private:
    static constexpr axis_bits whole = 7;
    static constexpr std::size_t window = 17;
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    /// The next vertex of the input along the border, or where the border divides, as a number of `vertices_`.
    [[nodiscard]] std::size_t end_of(std::size_t k, std::uint32_t side) const noexcept {
        std::uint32_t before = vertices_[k];
        std::uint32_t at = beside_[begin_[k] + side];
        while (at >= inputs_ && at != vertices_[k]) {
            std::uint32_t const s = slot_[at];
            if (begin_[s + 1] - begin_[s] != 2) break;
            std::uint32_t const one = beside_[begin_[s]];
            std::uint32_t const next = one == before ? beside_[begin_[s] + 1] : one;
            before = at;
            at = next;
        }
        return slot_[at];
    }
    /// What both keep.
    [[nodiscard]] static border_hold common(border_hold const& a, border_hold const& b) noexcept {
        if (a.planes == 0 && b.planes == 0) return {.axes = static_cast<axis_bits>(a.axes & b.axes)};
        border_hold out;
        for (vec3 const& m : normals_of(a)) {
            for (vec3 const& n : normals_of(b)) {
                if (out.planes < 2 && squared_length(m) > 0 && squared_length(n) > 0 && length(cross(m, n)) <= 1e-6) out.across[out.planes++] = m;
            }
        }
        return out;
    }
    [[nodiscard]] static std::array<vec3, 3> normals_of(border_hold const& h) noexcept {
        std::array<vec3, 3> out{vec3{0, 0, 0}, vec3{0, 0, 0}, vec3{0, 0, 0}};
        for (std::size_t d = 0; d < 3; ++d) {
            if ((h.axes >> d & 1U) != 0) out[d][static_cast<int>(d)] = 1;
            if (d < h.planes) out[d] = h.across[d];
        }
        return out;
    }
    [[nodiscard]] border_hold in_planes(std::size_t k, std::span<vec3 const> positions, vec3 const& normal) const noexcept {
        vec3 const& p = positions[vertices_[k]];
        double const rounding = 0x1p-50 * std::max({std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])});
        std::array<border_run, 2> runs;
        std::array<vec3, 2> next;
        for (std::uint32_t side = 0; side < 2; ++side) {
            std::array<vec3, window> way{};
            std::size_t const found = walk(k, side, positions, way);
            runs[side] = run_along(std::span<vec3 const>(way.data(), found), normal, rounding);
            next[side] = way[1];
        }
        border_hold out;
        out.planes = static_cast<unsigned char>(planes_of(runs[0], runs[1], next[0], next[1], rounding, out.across));
        axis_bits exact = 0;
        for (std::size_t i = 0; i < out.planes; ++i) {
            int axes = 0;
            for (int d = 0; d < 3; ++d) {
                if (std::fabs(out.across[i][d]) != 1) continue;
                exact = static_cast<axis_bits>(exact | 1U << d);
                ++axes;
            }
            if (axes == 0) return out;
        }
        return {.axes = exact};
    }
    /// The border from the vertex on, less its place; how many points.
    std::size_t walk(std::size_t k, std::uint32_t side, std::span<vec3 const> positions, std::array<vec3, window>& way) const noexcept {
        std::uint32_t const start = vertices_[k];
        vec3 const& p = positions[start];
        std::uint32_t before = start;
        std::uint32_t at = beside_[begin_[k] + side];
        std::size_t found = 1;
        while (found < window && at != start) {
            way[found++] = vec3{positions[at] - p};
            std::uint32_t const s = slot_[at];
            if (s == none || begin_[s + 1] - begin_[s] != 2) break;
            std::uint32_t const one = beside_[begin_[s]];
            std::uint32_t const next = one == before ? beside_[begin_[s] + 1] : one;
            before = at;
            at = next;
        }
        return found;
    }

    [[nodiscard]] axis_bits by_axes(std::size_t k, std::span<vec3 const> positions, vec3 const& normal) const noexcept {
        axis_bits all = whole;
        axis_bits any = 0;
        bool level = begin_[k] < begin_[k + 1];
        for (std::uint32_t i = begin_[k]; i < begin_[k + 1]; ++i) {
            axis_bits const edge = shared(positions[beside_[i]], positions[vertices_[k]]);
            all = static_cast<axis_bits>(all & edge);
            any = static_cast<axis_bits>(any | edge);
            level = level && edge != 0;
        }
        return level ? chosen(all, any, normal) : axis_bits{0};
    }
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

    std::size_t inputs_ = 0;               ///< vertices of the input
    std::vector<std::uint32_t> vertices_{};
    std::vector<std::uint32_t> begin_{};
    std::vector<std::uint32_t> beside_{};  ///< neighbours along the border
    std::vector<std::uint32_t> scratch_{};
    std::vector<std::uint32_t> slot_{};    ///< of `vertices_`, by vertex
    std::vector<border_hold> holds_{};     ///< as `vertices_`
};

}  // namespace tafoni::detail

#endif
