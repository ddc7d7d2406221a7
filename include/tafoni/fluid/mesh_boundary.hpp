/// \file
/// Triangles as the walls of a fluid, found through a grid.
#ifndef TAFONI_FLUID_MESH_BOUNDARY_HPP
#define TAFONI_FLUID_MESH_BOUNDARY_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/executor.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/fluid/concepts.hpp>
#include <tafoni/fluid/detail/face_balls.hpp>
#include <tafoni/fluid/detail/face_discs.hpp>
#include <tafoni/fluid/detail/face_rooms.hpp>
#include <tafoni/geometry/detail/triangle_queries.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace tafoni {

/// The faces of a mesh in the cells of a regular grid that they are within `reach` of [thesis, 8.1]. Views the
/// mesh, which must outlive it; `refit` after its vertices have moved. Models `fluid_boundary`.
///
/// A particle's question costs one cell. Cells are about as long as the larger of four times the reach and the mean
/// edge; there are at most about 8 million of 4 bytes, 36 more for one with faces, and 24 bytes for every face in one, beside
/// 64 for a face. Faces are also in cells that they come to when vertices move by a quarter of the larger of reach and mean
/// edge; until one moves farther the cells stay. Answers depend on the mesh alone, never on when the cells were filled.
class mesh_boundary {
public:
    /// O(vertices + faces + cells). \throws invalid_input  `bad_parameter` for a reach out of [1e-50, 1e50], `out_of_range` for a
    /// vertex of a coordinate beyond 1e50 or that is none: products of six lengths must be numbers; `size_overflow` beyond
    /// 32 bits. Corners must be in range.
    mesh_boundary(std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles, double reach)
        : reach_(reach) {
        detail::require_range("mesh_boundary: reach", reach, 1e-50, 1e50);
        detail::require_indexable("mesh_boundary: faces", triangles.size());
        for (std::size_t v = 0; v < positions.size(); ++v) {
            for (int d = 0; d < 3; ++d) {
                if (std::fabs(positions[v][d]) <= 1e50) continue;
                detail::fail<invalid_input>(errc::out_of_range,
                                            "mesh_boundary: vertex " + std::to_string(v) + " has a coordinate of " +
                                                detail::number_text(positions[v][d]) + ", beyond 1e50: choose a larger unit",
                                            {.kind = entity::vertex, .index = v, .value = positions[v][d], .limit = 1e50});
            }
        }
        positions_ = positions;
        triangles_ = triangles;
        fill();
    }

    /// Follows vertices that moved and faces that changed; coordinates must be in the constructor's range, which is not
    /// looked at again. O(vertices + faces); where the faces are others or a vertex has gone far also the cells in the
    /// boxes of the faces.
    void refit(std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles) {
        positions_ = positions;
        triangles_ = triangles;
        if (positions.size() != last_.size() || !std::equal(triangles.begin(), triangles.end(), faces_then_.begin(), faces_then_.end())) {
            return fill();
        }
        moved_.resize(positions.size());
        for (std::size_t v = 0; v < positions.size(); ++v) {
            vec3 const& p = positions[v];
            vec3 const& q = last_[v];
            moved_[v] = p[0] == q[0] && p[1] == q[1] && p[2] == q[2] ? 0 : 1;
            if (moved_[v] == 0) continue;
            farthest_ = std::max(farthest_, squared_length(p - base_[v]));
            last_[v] = p;
        }
        if (!(farthest_ <= rooms_.slack() * rooms_.slack())) return fill();
        rooms_.drift(std::sqrt(farthest_));
        for (std::size_t f = 0; f < triangles.size(); ++f) {
            auto const& t = triangles[f];
            if ((moved_[t[0]] | moved_[t[1]] | moved_[t[2]]) != 0) discs_[f] = disc_of(t);
        }
    }

    /// The farthest that contacts are looked for, length unit.
    [[nodiscard]] double reach() const noexcept { return reach_; }
    /// The mesh as it was viewed last.
    [[nodiscard]] std::span<vec3 const> positions() const noexcept { return positions_; }
    [[nodiscard]] std::span<std::array<std::uint32_t, 3> const> triangles() const noexcept { return triangles_; }
    /// Memory held. O(1).
    [[nodiscard]] std::size_t bytes() const noexcept {
        return rooms_.bytes() + discs_.capacity() * sizeof(detail::face_disc) + (last_.capacity() + base_.capacity()) * sizeof(vec3) +
               faces_then_.capacity() * sizeof(std::array<std::uint32_t, 3>) + moved_.capacity();
    }

    /// Particles are asked about fastest block by block: the cells that faces are near, after 0 for all others. A particle
    /// of block 0 touches nothing.
    [[nodiscard]] std::size_t block_count() const noexcept { return std::max<std::size_t>(rooms_.count(), 1); }
    [[nodiscard]] std::size_t block_of(vec3 const& p) const noexcept { return rooms_.room_at(rooms_.see(p)); }

    /// Brings the faces of a block that is asked about soon nearer to the processor. Changes nothing.
    void fetch(std::size_t block) const noexcept { rooms_.fetch(static_cast<std::uint32_t>(block)); }

    /// As the concept asks; `radius` at most `reach()`. O(faces in a cell).
    template <class Visit>
    void for_each_contact(vec3 const& p, double radius, Visit const& visit) const {
        place const at = rooms_.see(p);
        std::uint32_t const room = rooms_.room_at(at);
        if (room == 0) return;
        float const most = static_cast<float>(radius * rooms_.inverse()) + rooms_.blur();
        if (!visit_over_all(p, radius, at, room, most, visit)) visit_nearest(p, radius, at, room, most, visit);
    }

private:
    using place = detail::face_rooms::place;
    static constexpr std::uint32_t packs = detail::disc_sights::most / detail::ball_pack::count;  ///< looked at in one go

    [[nodiscard]] detail::face_disc disc_of(std::array<std::uint32_t, 3> const& t) const noexcept {
        vec3 const& a = positions_[t[0]];
        vec3 const& b = positions_[t[1]];
        vec3 const& c = positions_[t[2]];
        vec3 const m{(a[0] + b[0] + c[0]) / 3, (a[1] + b[1] + c[1]) / 3, (a[2] + b[2] + c[2]) / 3};
        auto const at = rooms_.see(m);
        return detail::face_disc::around({a, b, c, m}, {at.x, at.y, at.z}, rooms_.inverse(), rooms_.blur());
    }
    [[nodiscard]] static detail::ball_probe probe_at(place const& at, float radius) noexcept {
        auto const middle = [](float a, std::uint32_t i) { return a - (static_cast<float>(static_cast<std::int32_t>(i >> 2)) + 0.5F); };
        return {middle(at.x, at.i), middle(at.y, at.j), middle(at.z, at.k), radius};
    }

    /// Faces of a room, from a pack on, that a particle may touch; ascending.
    void gather(std::uint32_t from, std::uint32_t end, detail::ball_probe const& probe, detail::disc_sights& to) const noexcept {
        std::uint32_t* out = to.faces.data();
        for (std::uint32_t b = from; b < std::min(end, from + packs); ++b) probe.add_met(rooms_.balls(b), rooms_.faces(b), out);
        to.count = static_cast<std::size_t>(out - to.faces.data());
    }

    /// Whether there is a face that the particle stands over.
    template <class Visit>
    bool visit_over_all(vec3 const& p, double radius, place const& at, std::uint32_t room, float most, Visit const& visit) const {
        detail::ball_probe const probe = probe_at(at, rooms_.over(room, most));
        detail::disc_sights sights;
        bool found = false;
        std::uint32_t const end = rooms_.end_of(room);
        for (std::uint32_t from = rooms_[room].begin; from < end; from += packs) {
            gather(from, end, probe, sights);
            sights.look_over(discs_.data(), at.x, at.y, at.z, most, [&](std::uint32_t f) { found = visit_over(f, p, radius, visit) || found; });
        }
        return found;
    }

    /// Whether the foot of the normal meets the face.
    template <class Visit>
    bool visit_over(std::uint32_t f, vec3 const& p, double radius, Visit const& visit) const {
        auto const& t = triangles_[f];
        vec3 const& a = positions_[t[0]];
        vec3 const u{positions_[t[1]] - a};
        vec3 const v{positions_[t[2]] - a};
        vec3 const w{p - a};
        vec3 const n = cross(u, v);
        double const nn = dot(n, n);
        double const over = dot(w, n);
        if (!(nn > 0) || over * over > radius * radius * nn) return false;
        double const y = dot(cross(w, v), n);
        double const z = dot(cross(u, w), n);
        if (!(y >= 0 && z >= 0 && y + z <= nn)) return false;
        double const l = std::sqrt(nn);
        visit(boundary_contact{.face = f, .normal = vec3{n[0] / l, n[1] / l, n[2] / l}, .distance = over / l});
        return true;
    }

    /// Over an edge or a corner, where no face has the foot.
    template <class Visit>
    void visit_nearest(vec3 const& p, double radius, place const& at, std::uint32_t room, float most, Visit const& visit) const {
        detail::ball_probe const probe = probe_at(at, rooms_.any(most));
        detail::disc_sights sights;
        double nearest = radius * radius;
        std::uint32_t best = face_index::none;
        vec3 way{0, 0, 0};
        float limit = most * (1 + 1e-5F);  // what the nearest is no farther than
        auto const look_at = [&](std::uint32_t f) {
            auto const& t = triangles_[f];
            vec3 const foot = detail::nearest_on_triangle(positions_[t[0]], positions_[t[1]], positions_[t[2]], p);
            vec3 const away{p - foot};
            double const square = squared_length(away);
            if (!(square < nearest || (square == nearest && f < best && best != face_index::none))) return;
            nearest = square;
            best = f;
            way = away;
            limit = std::min(limit, (static_cast<float>(std::sqrt(square) * rooms_.inverse()) + 2 * rooms_.blur()) * (1 + 1e-5F));
        };
        std::uint32_t const end = rooms_.end_of(room);
        for (std::uint32_t from = rooms_[room].begin; from < end; from += packs) {
            gather(from, end, probe, sights);
            if (sights.count == 0) continue;
            float const bound = sights.bound_from_below(discs_.data(), at.x, at.y, at.z);
            if (!(bound <= limit * limit)) continue;
            std::size_t first = 0;
            while (sights.square[first] != bound) ++first;
            look_at(sights.faces[first]);
            for (std::size_t k = 0; k < sights.count; ++k) {
                if (k != first && sights.square[k] <= limit * limit) look_at(sights.faces[k]);
            }
        }
        double const l = std::sqrt(nearest);
        if (best == face_index::none || !(l > 0)) return;
        auto const& t = triangles_[best];
        vec3 const& a = positions_[t[0]];
        bool const behind = dot(p - a, cross(positions_[t[1]] - a, positions_[t[2]] - a)) < 0;
        double const s = behind ? -1 / l : 1 / l;
        visit(boundary_contact{.face = best, .normal = vec3{s * way[0], s * way[1], s * way[2]}, .distance = behind ? -l : l});
    }

    void fill() {
        last_.clear();  // what runs out of memory half way is filled again
        rooms_.lay_out(positions_, triangles_, reach_);
        base_.assign(positions_.begin(), positions_.end());
        faces_then_.assign(triangles_.begin(), triangles_.end());
        discs_.resize(triangles_.size());
        for (std::size_t f = 0; f < triangles_.size(); ++f) discs_[f] = disc_of(triangles_[f]);
        rooms_.fill(positions_, triangles_, discs_);
        farthest_ = 0;
        last_ = base_;
    }

    std::span<vec3 const> positions_{};
    std::span<std::array<std::uint32_t, 3> const> triangles_{};
    double reach_;
    double farthest_ = 0;                     ///< square of the way of a vertex since the cells were filled
    detail::face_rooms rooms_{};
    std::vector<detail::face_disc> discs_{};  ///< by face
    std::vector<vec3> base_{};                ///< positions that the cells were filled for
    std::vector<vec3> last_{};                ///< positions that the discs are of
    std::vector<std::array<std::uint32_t, 3>> faces_then_{};
    std::vector<unsigned char> moved_{};
};

static_assert(fluid_boundary<mesh_boundary>);

}  // namespace tafoni

#endif
