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
#include <tafoni/geometry/detail/triangle_queries.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tafoni {

/// The faces of a mesh in the cells of a regular grid that they are within `reach` of [thesis, 8.1]. Views the
/// mesh, which must outlive it; `refit` after its vertices have moved. Models `fluid_boundary`.
///
/// A particle's question costs one cell. Cells are about as long as the larger of four times the reach and the mean
/// edge; there are at most about 8 million of 4 bytes, 16 more for one with faces, and 28 bytes for every face in one. Faces are also in cells
/// that they come to when vertices move by a quarter of the larger of reach and mean edge; until one moves farther
/// the cells stay. Answers depend on the mesh alone, never on when the cells were filled.
class mesh_boundary {
public:
    /// O(faces + cells). \throws invalid_input  `bad_parameter` for a reach that is not positive and finite,
    /// `size_overflow` beyond 32 bits. Positions must be finite and corners in range.
    mesh_boundary(std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles, double reach)
        : reach_(reach) {
        detail::require_range("mesh_boundary: reach", reach, std::numeric_limits<double>::min(), 1e100);
        detail::require_indexable("mesh_boundary: faces", triangles.size());
        positions_ = positions;
        triangles_ = triangles;
        fill();
    }

    /// Follows vertices that moved and faces that changed. O(vertices + faces); O(cells) more where the faces are
    /// others or a vertex has gone far.
    void refit(std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles) {
        positions_ = positions;
        triangles_ = triangles;
        if (positions.size() != last_.size() || !std::equal(triangles.begin(), triangles.end(), faces_then_.begin(), faces_then_.end())) {
            return fill();
        }
        moved_.resize(positions.size());
        double farthest = 0;
        for (std::size_t v = 0; v < positions.size(); ++v) {
            vec3 const& p = positions[v];
            vec3 const& q = last_[v];
            moved_[v] = p[0] == q[0] && p[1] == q[1] && p[2] == q[2] ? 0 : 1;
            if (moved_[v] == 0) continue;
            farthest = std::max(farthest, squared_length(p - base_[v]));
            last_[v] = p;
        }
        if (!(farthest <= slack_ * slack_)) return fill();
        for (std::size_t f = 0; f < triangles.size(); ++f) {
            auto const& t = triangles[f];
            if ((moved_[t[0]] | moved_[t[1]] | moved_[t[2]]) != 0) discs_[f] = disc_of(t);
        }
    }

    [[nodiscard]] double reach() const noexcept { return reach_; }
    [[nodiscard]] std::span<vec3 const> positions() const noexcept { return positions_; }
    [[nodiscard]] std::span<std::array<std::uint32_t, 3> const> triangles() const noexcept { return triangles_; }
    [[nodiscard]] std::size_t bytes() const noexcept {
        return (room_of_.capacity() + faces_.capacity()) * sizeof(std::uint32_t) + rooms_.capacity() * sizeof(room) +
               balls_.capacity() * sizeof(detail::ball_pack) + entries_.capacity() * sizeof(entry) + discs_.capacity() * sizeof(detail::face_disc) +
               (last_.capacity() + base_.capacity()) * sizeof(vec3) + faces_then_.capacity() * sizeof(std::array<std::uint32_t, 3>) +
               moved_.capacity();
    }

    /// Particles are asked about fastest block by block: the cells that faces are near, after 0 for all others. A particle
    /// of block 0 touches nothing.
    [[nodiscard]] std::size_t block_count() const noexcept { return std::max<std::size_t>(rooms_.size(), 1); }
    [[nodiscard]] std::size_t block_of(vec3 const& p) const noexcept { return room_at(place_of(p)); }

    /// As the concept asks; `radius` at most `reach()`. O(faces in a cell).
    template <class Visit>
    void for_each_contact(vec3 const& p, double radius, Visit const& visit) const {
        fine_place const at = place_of(p);
        std::uint32_t const number = room_at(at);
        if (number == 0) return;
        room const& r = rooms_[number];
        float const most = static_cast<float>(radius * inverse_) + blur_;
        auto const middle = [](float a, std::uint32_t i) { return a - (static_cast<float>(i >> 2) + 0.5F); };
        point const q = see(p);
        detail::ball_probe const probe(middle(q.x, at.x), middle(q.y, at.y), middle(q.z, at.z), most);
        detail::disc_sights sights;
        bool found = false;
        float nearest = std::numeric_limits<float>::max();  // square of the way to some point of a face
        for (std::uint32_t from = r.begin; from < r.end; from += packs) {
            gather(from, r.end, probe, sights);
            sights.look(discs_.data(), q.x, q.y, q.z, most, [&](std::uint32_t f) { found = visit_over(f, p, radius, visit) || found; });
            nearest = std::min(nearest, sights.nearest);
        }
        if (found || nearest == std::numeric_limits<float>::max()) return;
        visit_nearest(p, radius, r, probe, sights, std::min(most, std::sqrt(nearest) + blur_) * (1 + 1e-5F), visit);
    }

private:
    static constexpr double most_cells = 8e6;
    static constexpr double most_along = 65536;  ///< cells, so that float tells places in one apart
    static constexpr std::uint32_t packs = detail::disc_sights::most / detail::ball_pack::count;  ///< looked at in one go

    /// A place in quarters of a cell.
    struct fine_place {
        std::uint32_t x = 0;
        std::uint32_t y = 0;
        std::uint32_t z = 0;
        bool outside = true;
    };
    /// The faces of a cell.
    struct room {
        std::uint64_t near_to = 0;  ///< which of its 4 x 4 x 4 parts a face may be within reach of
        std::uint32_t begin = 0;    ///< in `balls_`
        std::uint32_t end = 0;
    };
    /// From the corner of the grid, in cells.
    struct point {
        float x, y, z;
    };
    [[nodiscard]] point see(vec3 const& p) const noexcept {
        return {static_cast<float>((p[0] - lo_[0]) * inverse_), static_cast<float>((p[1] - lo_[1]) * inverse_),
                static_cast<float>((p[2] - lo_[2]) * inverse_)};
    }
    [[nodiscard]] detail::face_disc disc_of(std::array<std::uint32_t, 3> const& t) const noexcept {
        vec3 const& a = positions_[t[0]];
        vec3 const& b = positions_[t[1]];
        vec3 const& c = positions_[t[2]];
        vec3 const m{(a[0] + b[0] + c[0]) / 3, (a[1] + b[1] + c[1]) / 3, (a[2] + b[2] + c[2]) / 3};
        vec3 const n = normalized(cross(vec3{b - a}, vec3{c - a}));
        double const r = std::sqrt(std::max({squared_length(a - m), squared_length(b - m), squared_length(c - m)}));
        point const at = see(m);
        float const wide = static_cast<float>(r * inverse_) + blur_;
        return {at.x, at.y, at.z, wide, static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2]), wide * wide};
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

    /// Faces of a room, from a place on, that a particle may touch; ascending.
    void gather(std::uint32_t from, std::uint32_t end, detail::ball_probe const& probe, detail::disc_sights& to) const noexcept {
        std::uint32_t* out = to.faces.data();
        for (std::uint32_t b = from; b < std::min(end, from + packs); ++b) {
            probe.add_met(balls_[b], faces_.data() + detail::ball_pack::count * b, out);
        }
        to.count = static_cast<std::size_t>(out - to.faces.data());
    }

    /// Over an edge or a corner, where no face has the foot. The nearest is no farther than `limit`, in cells; `sights`
    /// are those of the last faces of the room.
    template <class Visit>
    void visit_nearest(vec3 const& p, double radius, room const& r, detail::ball_probe const& probe, detail::disc_sights& sights,
                       float limit, Visit const& visit) const {
        double nearest = radius * radius;
        std::uint32_t best = face_index::none;
        vec3 way{0, 0, 0};
        auto const look_at = [&](std::uint32_t f) {
            auto const& t = triangles_[f];
            vec3 const foot = detail::nearest_on_triangle(positions_[t[0]], positions_[t[1]], positions_[t[2]], p);
            vec3 const away{p - foot};
            double const square = squared_length(away);
            if (!(square < nearest || (square == nearest && f < best && best != face_index::none))) return;
            nearest = square;
            best = f;
            way = away;
            limit = std::min(limit, (static_cast<float>(std::sqrt(square) * inverse_) + 2 * blur_) * (1 + 1e-5F));
        };
        bool const whole = r.end - r.begin <= packs;
        for (std::uint32_t from = r.begin; from < r.end; from += packs) {
            if (!whole) {
                point const q = see(p);
                gather(from, r.end, probe, sights);
                sights.look(discs_.data(), q.x, q.y, q.z, limit, [](std::uint32_t) {});
            }
            if (sights.count == 0) continue;
            float const bound = sights.bound_from_below();
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

    [[nodiscard]] std::size_t cells() const noexcept { return size_[0] * size_[1] * size_[2]; }

    void fill() {
        lay_out();
        last_.clear();  // what runs out of memory half way is filled again
        base_.assign(positions_.begin(), positions_.end());
        faces_then_.assign(triangles_.begin(), triangles_.end());
        discs_.resize(triangles_.size());
        room_of_.assign(cells(), 0);
        rooms_.assign(1, {});
        entries_.clear();
        float const further = static_cast<float>(slack_ * inverse_) + 2 * blur_;
        for (std::uint32_t f = 0; f < triangles_.size(); ++f) {
            discs_[f] = disc_of(triangles_[f]);
            float const radius = discs_[f].radius + further;
            for_each_cell(discs_[f], span_of(triangles_[f]), [&](std::size_t c, std::uint64_t parts, float x, float y, float z) {
                if (room_of_[c] == 0) {
                    room_of_[c] = static_cast<std::uint32_t>(rooms_.size());
                    rooms_.emplace_back();
                }
                room& r = rooms_[room_of_[c]];
                ++r.end;
                r.near_to |= parts;
                entries_.push_back({room_of_[c], f, detail::face_ball::around(x, y, z, radius)});
            });
        }
        constexpr std::uint32_t pack = detail::ball_pack::count;
        detail::require_indexable("mesh_boundary: faces in cells", entries_.size() + pack * rooms_.size());
        std::uint32_t total = 0;
        std::vector<std::uint32_t> at(rooms_.size());
        for (std::size_t k = 0; k < rooms_.size(); ++k) {
            room& r = rooms_[k];
            std::uint32_t const faces = r.end;
            r.begin = total;
            at[k] = total * pack;
            total += (faces + pack - 1) / pack;
            r.end = total;
        }
        faces_.assign(std::size_t{total} * pack, 0);
        balls_.assign(total, {});
        for (entry const& e : entries_) {
            std::uint32_t const to = at[e.room]++;
            faces_[to] = e.face;
            balls_[to / pack].put(to % pack, e.ball);
        }
        last_ = base_;
    }

    void lay_out() {
        box3 box;
        double edges = 0;
        for (auto const& t : triangles_) {
            for (std::size_t k = 0; k < 3; ++k) {
                box.include(positions_[t[k]]);
                edges += length(positions_[t[k]] - positions_[t[(k + 1) % 3]]);
            }
        }
        size_ = {0, 0, 0};
        if (triangles_.empty()) return;
        double const edge = edges / (3 * static_cast<double>(triangles_.size()));
        cell_ = std::max(4 * reach_, edge);
        slack_ = 0.25 * std::max(reach_, edge);
        double const rim = reach_ + slack_;
        vec3 const e = box.extent();
        lo_ = vec3{box.lo[0] - rim, box.lo[1] - rim, box.lo[2] - rim};
        auto const along = [&](int d) { return std::floor((e[d] + 2 * rim) / cell_) + 1; };
        while (along(0) * along(1) * along(2) > most_cells || std::max({along(0), along(1), along(2)}) > most_along) cell_ *= 1.25;
        inverse_ = 1 / cell_;
        for (int d = 0; d < 3; ++d) size_[static_cast<std::size_t>(d)] = static_cast<std::size_t>(along(d));
        // What rounding to float may move a point or a height by.
        blur_ = static_cast<float>(1e-6 * (std::max({e[0], e[1], e[2]}) + 2 * rim) * inverse_);
    }

    /// In quarters of a cell, in the grid.
    [[nodiscard]] std::uint32_t place(int d, double x) const noexcept {
        auto const n = static_cast<double>(4 * size_[static_cast<std::size_t>(d)] - 1);
        return static_cast<std::uint32_t>(std::clamp(4 * ((x - lo_[d]) * inverse_), 0.0, n));
    }
    [[nodiscard]] fine_place place_of(vec3 const& p) const noexcept {
        std::array<std::uint32_t, 3> c{};
        for (int d = 0; d < 3; ++d) {
            double const x = (p[d] - lo_[d]) * inverse_;
            auto const e = static_cast<std::size_t>(d);
            if (!(x >= 0 && x < static_cast<double>(size_[e]))) return {};
            c[e] = static_cast<std::uint32_t>(4 * x);
        }
        return {c[0], c[1], c[2], false};
    }

    /// The room that a place is in, or 0 where no face can be within reach.
    [[nodiscard]] std::uint32_t room_at(fine_place const& at) const noexcept {
        if (at.outside) return 0;
        std::uint32_t const r = room_of_[(at.x >> 2) + size_[0] * ((at.y >> 2) + size_[1] * std::size_t{at.z >> 2})];
        return (rooms_[r].near_to >> ((at.x & 3) + 4 * (at.y & 3) + 16 * (at.z & 3)) & 1U) != 0 ? r : 0;
    }

    struct entry {
        std::uint32_t room = 0;
        std::uint32_t face = 0;
        detail::face_ball ball{};
    };
    /// Quarters of cells around a face.
    struct cell_span {
        std::array<std::uint32_t, 3> low{};
        std::array<std::uint32_t, 3> high{};

        /// Which of the quarters of the cell number c are among them along an axis, as bits.
        [[nodiscard]] std::uint32_t bits(std::size_t axis, std::uint32_t c) const noexcept {
            std::uint32_t const from = low[axis] > 4 * c ? low[axis] - 4 * c : 0;
            std::uint32_t const to = std::min(high[axis] - 4 * c, 3U);
            return (2U << to) - (1U << from);
        }
    };
    [[nodiscard]] cell_span span_of(std::array<std::uint32_t, 3> const& t) const noexcept {
        cell_span s;
        vec3 const& a = positions_[t[0]];
        vec3 const& b = positions_[t[1]];
        vec3 const& c = positions_[t[2]];
        double const rim = reach_ + slack_;
        for (int d = 0; d < 3; ++d) {
            s.low[static_cast<std::size_t>(d)] = place(d, std::min({a[d], b[d], c[d]}) - rim);
            s.high[static_cast<std::size_t>(d)] = place(d, std::max({a[d], b[d], c[d]}) + rim);
        }
        return s;
    }
    /// Those of the cells around a face that its plane comes near: what is within reach of a face whose corners have
    /// moved by the slack is within the sum of both of the face as it was.
    template <class F>
    void for_each_cell(detail::face_disc const& d, cell_span const& s, F const& visit) const {
        // Bits of y and z moved to where a number of a part has them.
        constexpr std::array<std::uint64_t, 16> spread{0x0000, 0x0001, 0x0010, 0x0011, 0x0100, 0x0101, 0x0110, 0x0111,
                                                       0x1000, 0x1001, 0x1010, 0x1011, 0x1100, 0x1101, 0x1110, 0x1111};
        float const rim = static_cast<float>((reach_ + slack_) * inverse_) + 2 * blur_ +
                          0.5001F * (std::fabs(d.nx) + std::fabs(d.ny) + std::fabs(d.nz));
        for (std::uint32_t z = s.low[2] >> 2; z <= s.high[2] >> 2; ++z) {
            float const over_z = (static_cast<float>(z) + 0.5F - d.z) * d.nz - d.x * d.nx;
            std::uint32_t const z_bits = s.bits(2, z);
            std::uint64_t const planes = std::uint64_t{z_bits & 1U} | std::uint64_t{z_bits >> 1 & 1U} << 16 |
                                         std::uint64_t{z_bits >> 2 & 1U} << 32 | std::uint64_t{z_bits >> 3 & 1U} << 48;
            for (std::uint32_t y = s.low[1] >> 2; y <= s.high[1] >> 2; ++y) {
                std::size_t const row = size_[0] * (y + size_[1] * z);
                float const over_y = over_z + (static_cast<float>(y) + 0.5F - d.y) * d.ny;
                std::uint64_t const lines = planes * spread[s.bits(1, y)];
                for (std::uint32_t x = s.low[0] >> 2; x <= s.high[0] >> 2; ++x) {
                    float const over = over_y + (static_cast<float>(x) + 0.5F) * d.nx;
                    if (!(over <= rim && over >= -rim)) continue;
                    visit(row + x, lines * s.bits(0, x), d.x - (static_cast<float>(x) + 0.5F), d.y - (static_cast<float>(y) + 0.5F),
                          d.z - (static_cast<float>(z) + 0.5F));
                }
            }
        }
    }

    std::span<vec3 const> positions_{};
    std::span<std::array<std::uint32_t, 3> const> triangles_{};
    double reach_;
    double slack_ = 0;
    double cell_ = 1;
    double inverse_ = 1;
    float blur_ = 0;
    vec3 lo_{0, 0, 0};
    std::array<std::size_t, 3> size_{};
    std::vector<std::uint32_t> room_of_{};    ///< cell -> place in `rooms_`, of which the first is empty
    std::vector<room> rooms_{};
    std::vector<std::uint32_t> faces_{};      ///< by room, ascending in each
    std::vector<detail::ball_pack> balls_{};  ///< beside `faces_`: those that hold the face wherever the slack lets it go
    std::vector<entry> entries_{};            ///< by face, while cells are filled
    std::vector<detail::face_disc> discs_{};  ///< by face
    std::vector<vec3> base_{};            ///< positions that the cells were filled for
    std::vector<vec3> last_{};            ///< positions that the discs are of
    std::vector<std::array<std::uint32_t, 3>> faces_then_{};
    std::vector<unsigned char> moved_{};
};

static_assert(fluid_boundary<mesh_boundary>);

}  // namespace tafoni

#endif
