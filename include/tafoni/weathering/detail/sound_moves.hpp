/// \file
/// Which moves of a vertex leave a surface that water can go on running over.
#ifndef TAFONI_WEATHERING_DETAIL_SOUND_MOVES_HPP
#define TAFONI_WEATHERING_DETAIL_SOUND_MOVES_HPP

#include <tafoni/core/index.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/geometry/vertex_rings.hpp>
#include <tafoni/weathering/detail/held_borders.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tafoni::detail {

/// The triangles around a vertex, as far as its move is concerned.
struct vertex_room {
    vec3 sum{0, 0, 0};   ///< of normals by twice the area, where it may go: six times the volume per length along a is a . sum
    double area = 0;     ///< |sum|
    double sheer = 0;    ///< |sum| with what leads out of the planes that a border vertex keeps
    double whole = 0;    ///< twice the area around; sheer / whole is the mean cosine between faces and normal
    double lowest = 0;   ///< least altitude of a triangle over the side opposite the vertex, length unit
    double clear = std::numeric_limits<double>::infinity();  ///< way before other walls could be met, length unit

    /// How far the vertex may go in one iteration: no triangle at it turns by more than about 14 degrees.
    [[nodiscard]] double way(double most) const noexcept {
        return area > 0.2 * whole ? std::min({most, 0.25 * lowest, clear}) : 0.0;
    }
    /// The volume that goes with it, at most.
    [[nodiscard]] double volume(double most) const noexcept { return way(most) * area / 6; }
};

/// A surface whose vertices move.
struct moving_surface {
    std::span<vec3> positions;
    std::span<std::array<std::uint32_t, 3> const> triangles;
    vertex_rings const& rings;
    std::span<double> clear{};  ///< way that each vertex has left, below 0 none; empty: any
    kept_ways kept{};            ///< what border vertices keep

    /// Whether other walls leave the vertex a way.
    [[nodiscard]] bool may_move(std::size_t v) const noexcept { return clear.empty() || clear[v] > 0; }
};

/// Knows the triangles of a surface whose vertices move one after the other, and refuses what
/// - bends two faces at an edge by more than 72 degrees,
/// - makes a pit or spike whose sides are steeper than 45 degrees on the mean, or
/// - makes a triangle lower than a tenth of its longest side,
/// unless that was so and gets no worse. What it knows depends on the positions alone, not on the way there.
class sound_moves {
public:
    /// Looks at triangles and vertices that are others than before. O(vertices + faces).
    void adopt(moving_surface const& s) {
        std::span<vec3> const positions = s.positions;
        auto const triangles = s.triangles;
        vertex_rings const& rings = s.rings;
        across_.assign(triangles.size(), {none, none, none});
        faces_.resize(triangles.size());
        for (std::size_t f = 0; f < triangles.size(); ++f) {
            auto const& t = triangles[f];
            faces_[f] = face_state::of(positions[t[0]], positions[t[1]], positions[t[2]]);
            for (std::size_t k = 0; k < 3; ++k) {
                std::size_t found = 0;
                for (auto const& c : rings.faces(t[k])) {
                    if (c.face == f) continue;
                    auto const& other = triangles[c.face];
                    std::uint32_t const b = t[(k + 1) % 3];
                    if (other[0] != b && other[1] != b && other[2] != b) continue;
                    across_[f][k] = c.face;
                    ++found;
                }
                if (found != 1) across_[f][k] = none;
            }
        }
    }

    /// O(faces at v).
    [[nodiscard]] vertex_room room(std::size_t v, moving_surface const& s) const noexcept {
        vertex_room out;
        double lowest = -1;
        for (auto const& c : s.rings.faces(v)) {
            auto const& t = s.triangles[c.face];
            face_state const& f = faces_[c.face];
            out.sum += f.twice * f.normal;
            out.whole += f.twice;
            double const side = squared_length(s.positions[t[(c.place + 1) % 3]] - s.positions[t[(c.place + 2) % 3]]);
            double const height = side > 0 ? f.twice * f.twice / side : 0.0;
            if (height < 0.0025 * side) continue;  // a sliver follows its neighbours
            if (lowest < 0 || height < lowest) lowest = height;
        }
        out.area = out.sheer = length(out.sum);
        if (border_hold const* kept = s.kept.of(v)) {
            out.sum = without(out.sum, *kept);
            out.area = length(out.sum);
        }
        if (!s.clear.empty()) out.clear = std::max(s.clear[v], 0.0);
        out.lowest = lowest > 0 ? std::sqrt(lowest) : 0.0;
        return out;
    }
    /// Twice the area.
    [[nodiscard]] double twice_area(std::size_t face) const noexcept { return faces_[face].twice; }

    /// Whether v may go there; `room` is what it has. O(faces at v).
    [[nodiscard]] bool allows(std::size_t v, vec3 const& to, vertex_room const& room, moving_surface const& s) {
        auto const around = s.rings.faces(v);
        then_.resize(around.size());
        vec3 sum{0, 0, 0};
        double whole = 0;
        for (std::size_t k = 0; k < around.size(); ++k) {
            auto const& t = s.triangles[around[k].face];
            auto const at = [&](std::size_t i) -> vec3 const& { return t[i] == v ? to : s.positions[t[i]]; };
            face_state const& now = faces_[around[k].face];
            face_state const& then = then_[k] = face_state::of(at(0), at(1), at(2));
            if (then.shape < flattest && then.shape < now.shape * (1 - 1e-9)) return false;
            sum += then.twice * then.normal;
            whole += then.twice;
        }
        if (length(sum) < steepest * whole && length(sum) * room.whole < room.sheer * whole * (1 - 1e-9)) return false;
        for (std::size_t k = 0; k < around.size(); ++k) {
            std::uint32_t const f = around[k].face;
            for (std::uint32_t const g : across_[f]) {
                if (g == none) continue;
                face_state const* other = &faces_[g];
                for (std::size_t i = 0; i < around.size(); ++i) {
                    if (around[i].face == g) other = &then_[i];
                }
                double const after = dot(then_[k].normal, other->normal);
                if (after < sharpest && after < dot(faces_[f].normal, faces_[g].normal) - 1e-9) return false;
            }
        }
        return true;
    }
    /// v has gone where `allows` was last asked about, `way` far.
    void went(std::size_t v, double way, moving_surface const& s) noexcept {
        if (!s.clear.empty()) s.clear[v] = std::max(s.clear[v] - way, 0.0);
        auto const around = s.rings.faces(v);
        for (std::size_t k = 0; k < around.size(); ++k) faces_[around[k].face] = then_[k];
    }

private:
    static constexpr std::uint32_t none = face_index::none;
    static constexpr double steepest = 0.7;  ///< cosine of 45 degrees
    static constexpr double sharpest = 0.3;  ///< of 72
    static constexpr double flattest = 0.1;

    struct face_state {
        vec3 normal{0, 0, 0};
        double twice = 0;  ///< area
        double shape = 0;  ///< height over the longest side, of its length

        static face_state of(vec3 const& a, vec3 const& b, vec3 const& c) noexcept {
            vec3 const u{b - a};
            vec3 const v{c - a};
            vec3 const n = cross(u, v);
            double const l = length(n);
            if (!(l > 0)) return {};
            double const longest = std::max({squared_length(u), squared_length(v), squared_length(c - b)});
            return {.normal = vec3{n[0] / l, n[1] / l, n[2] / l}, .twice = l, .shape = l / longest};
        }
    };

    std::vector<std::array<std::uint32_t, 3>> across_{};  ///< the face over each side
    std::vector<face_state> faces_{};
    std::vector<face_state> then_{};
};

}  // namespace tafoni::detail

#endif
