/// \file
/// Cuts every triangle of a solid along the cells that it crosses.
#ifndef TAFONI_DECOMPOSITION_DETAIL_SURFACE_CLIP_HPP
#define TAFONI_DECOMPOSITION_DETAIL_SURFACE_CLIP_HPP

#include <tafoni/decomposition/detail/key_table.hpp>
#include <tafoni/decomposition/detail/surface_walk.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tafoni::detail {

/// How the vertices of the complex are numbered while it is built: those of the diagram, those of
/// the solid, points on edges of the solid, points inside its triangles.
struct vertex_numbers {
    std::uint32_t solid = 0;      ///< first vertex of the solid
    std::uint32_t edge = 0;       ///< first point on an edge
    std::uint32_t triangle = 0;   ///< first point inside a triangle
    std::uint32_t end = 0;
};

/// The pieces into which cells cut triangles: convex polygons with the triangle's orientation.
///
/// An edge of a piece lies on the side of its triangle (`side_bit` | 0, 1 or 2) or on a face of the
/// diagram, named as a face of the piece's own cell.
struct surface_pieces {
    static constexpr std::uint32_t side_bit = 0x80000000U;

    std::vector<std::uint32_t> cell{};           ///< per piece
    std::vector<std::uint32_t> corner_begin{0};  ///< piece -> first corner
    std::vector<std::uint32_t> corners{};        ///< vertex numbers, counter-clockwise from outside
    std::vector<std::uint32_t> edges{};          ///< what the edge from this corner to the next lies on
    std::vector<vec3> points{};                  ///< inside triangles, lattice units
    std::vector<std::uint32_t> triangle_of{};    ///< per piece
};

/// Weights of u and v where both bisectors are met, in doubles, the larger pivot first.
[[nodiscard]] inline std::array<double, 2> rounded_weights(vec3 const& nk, vec3 const& nl, vec3 const& u, vec3 const& v,
                                                           vec3 const& base) noexcept {
    std::array<double, 3> r{2 * dot(nk, u), 2 * dot(nk, v), squared_length(nk) - 2 * dot(nk, base)};
    std::array<double, 3> s{2 * dot(nl, u), 2 * dot(nl, v), squared_length(nl) - 2 * dot(nl, base)};
    std::size_t x = 0;
    double best = std::fabs(r[0]);
    bool second = false;
    for (std::size_t c = 0; c < 2; ++c) {
        if (std::fabs(r[c]) > best) { best = std::fabs(r[c]); x = c; second = false; }
        if (std::fabs(s[c]) > best) { best = std::fabs(s[c]); x = c; second = true; }
    }
    if (second) std::swap(r, s);
    std::size_t const y = 1 - x;
    std::array<double, 2> w{1.0 / 3, 1.0 / 3};
    if (r[x] != 0) {
        double const factor = s[x] / r[x];
        double const pivot = s[y] - factor * r[y];
        w[y] = pivot != 0 ? (s[2] - factor * r[2]) / pivot : 1.0 / 3;
        w[x] = (r[2] - r[y] * w[y]) / r[x];
    }
    return w;
}

/// Where the triangle meets the bisectors (i, k) and (i, l); stays in the triangle. Lattice units.
[[nodiscard]] inline vec3 point_in_triangle(ivec3 const& si, ivec3 const& sk, ivec3 const& sl,
                                            std::array<ivec3, 3> const& q) noexcept {
    vec3 const u = difference(q[1], q[0]);
    vec3 const v = difference(q[2], q[0]);
    vec3 const nk = difference(sk, si);
    vec3 const nl = difference(sl, si);
    // Two equations for the position q0 + w0 u + w1 v.
    std::array<double, 2> w{1.0 / 3, 1.0 / 3};
    double const steepness = std::fabs(dot(cross(nk, nl), cross(u, v)));
    if (steepness > bisector_row::steep * (length(nk) * length(nl)) * (length(u) * length(v))) {
        w = rounded_weights(nk, nl, u, v, difference(q[0], si));
    } else {
        bisector_row const r(sk, si, q[0]);
        bisector_row const s(sl, si, q[0]);
        tafoni::wide_int<2> const ru = r.along(q[1], q[0]);
        tafoni::wide_int<2> const rv = r.along(q[2], q[0]);
        tafoni::wide_int<2> const su = s.along(q[1], q[0]);
        tafoni::wide_int<2> const sv = s.along(q[2], q[0]);
        if (auto const whole = ru * sv - rv * su; whole.sign() != 0) {
            w[0] = to_double(r.offset() * sv - rv * s.offset()) / to_double(whole);
            w[1] = to_double(ru * s.offset() - r.offset() * su) / to_double(whole);
        }
    }
    for (double& c : w) {
        if (!(c > 0)) c = 0;
        if (c > 1) c = 1;
    }
    if (double const sum = w[0] + w[1]; sum > 1) {
        w[0] /= sum;
        w[1] /= sum;
    }
    vec3 const p = lattice_frame::to_double(q[0]);
    return vec3{p[0] + w[0] * u[0] + w[1] * v[0], p[1] + w[0] * u[1] + w[1] * v[1],
                p[2] + w[0] * u[2] + w[1] * v[2]};
}

/// Cuts one triangle after the other; one object per thread.
///
/// A piece is kept in dual form, as the cyclic list of what its edges lie on; its corners follow:
/// two sides of the triangle meet in a vertex of the solid, a side and a bisector in a point of the
/// edge, two bisectors in a point of the triangle [Sutherland, Hodgman 1974, with exact signs].
class triangle_clipper {
public:
    triangle_clipper(surface_signs const& signs, solid const& body, surface_walk const& walk,
                     vertex_numbers const& numbers)
        : signs_(signs), diagram_(signs.diagram), body_(body), walk_(walk), numbers_(numbers),
          sites_(static_cast<std::uint32_t>(signs.diagram.sites.size())) {}

    /// Appends the pieces of triangle t. Points inside triangles are numbered from
    /// `numbers.triangle + out.points.size()` on. O(cells x faces of a cell).
    void operator()(std::size_t t, surface_pieces& out) {
        auto const& corners = body_.triangles[t];
        std::uint32_t const first = walk_.cell_of[corners[0]];
        if (first == walk_.cell_of[corners[1]] && first == walk_.cell_of[corners[2]]) {
            // A cell is convex, and signs are exact: the triangle can not leave it.
            for (std::uint32_t k = 0; k < 3; ++k) {
                out.corners.push_back(numbers_.solid + corners[k]);
                out.edges.push_back(surface_pieces::side_bit | k);
            }
            finish_piece(t, first, out);
            return;
        }
        triangle_ = t;
        for (std::size_t k = 0; k < 3; ++k) q_[k] = signs_.points[corners[k]];
        seen_.clear();
        points_.clear();
        queue_.assign(1, first);
        (void)seen_.find_or_insert({first, no_id, no_id}, 0);
        for (std::size_t at = 0; at < queue_.size(); ++at) {
            cell_ = queue_[at];
            clip();
            emit(out);
        }
    }

private:
    /// Sets `edges_` to the dual form of the piece in `cell_`.
    void clip() {
        constexpr std::uint32_t side = surface_pieces::side_bit;
        edges_.assign({side, side | 1U, side | 2U});
        for (std::uint32_t f = diagram_.face_begin[cell_]; f < diagram_.face_begin[cell_ + 1]; ++f) {
            std::uint32_t const k = diagram_.neighbour[f];
            if (k >= sites_) continue;
            for (std::size_t c = 0; c < 3; ++c) vertex_beyond_[c] = signs_.vertex_beyond(cell_, k, q_[c]);
            if (!vertex_beyond_[0] && !vertex_beyond_[1] && !vertex_beyond_[2]) continue;
            cut(f, k);
        }
    }

    void cut(std::uint32_t f, std::uint32_t k) {
        std::size_t const n = edges_.size();
        beyond_.resize(n);
        bool any = false;
        for (std::size_t r = 0; r < n; ++r) {
            beyond_[r] = corner_beyond(edges_[r == 0 ? n - 1 : r - 1], edges_[r], k) ? 1 : 0;
            any = any || beyond_[r] != 0;
        }
        if (!any) return;
        kept_.clear();
        for (std::size_t r = 0; r < n; ++r) {
            bool const start = beyond_[r] == 0;
            bool const end = beyond_[r + 1 == n ? 0 : r + 1] == 0;
            if (start || end) kept_.push_back(edges_[r]);
            if (start && !end) kept_.push_back(f);
        }
        edges_.swap(kept_);
        TAFONI_ASSERT(!edges_.empty(), "cells are entered through an edge that they share");
    }

    [[nodiscard]] bool corner_beyond(std::uint32_t before, std::uint32_t after, std::uint32_t k) const {
        bool const side_before = (before & surface_pieces::side_bit) != 0;
        bool const side_after = (after & surface_pieces::side_bit) != 0;
        if (side_before && side_after) return vertex_beyond_[after & 3U];
        if (!side_before && !side_after) {
            return signs_.triangle_point_beyond(cell_, diagram_.neighbour[before], diagram_.neighbour[after], k,
                                                q_);
        }
        std::uint32_t const s = (side_before ? before : after) & 3U;
        std::uint32_t const other = diagram_.neighbour[side_before ? after : before];
        return signs_.edge_point_beyond(cell_, other, k, q_[s], q_[s == 2 ? 0 : s + 1]);
    }

    void emit(surface_pieces& out) {
        std::size_t const n = edges_.size();
        for (std::size_t r = 0; r < n; ++r) {
            std::uint32_t const before = edges_[r == 0 ? n - 1 : r - 1];
            std::uint32_t const after = edges_[r];
            out.corners.push_back(corner(before, after, out));
            out.edges.push_back(after);
            if ((after & surface_pieces::side_bit) != 0) continue;
            std::uint32_t const k = diagram_.neighbour[after];
            if (!seen_.find_or_insert({k, no_id, no_id}, 0).second) queue_.push_back(k);
        }
        finish_piece(triangle_, cell_, out);
    }

    [[nodiscard]] std::uint32_t corner(std::uint32_t before, std::uint32_t after, surface_pieces& out) {
        bool const side_before = (before & surface_pieces::side_bit) != 0;
        bool const side_after = (after & surface_pieces::side_bit) != 0;
        if (side_before && side_after) return numbers_.solid + body_.triangles[triangle_][after & 3U];
        if (side_before || side_after) {
            std::size_t const h = 3 * triangle_ + ((side_before ? before : after) & 3U);
            std::size_t const o = body_.opposite[h];
            return numbers_.edge +
                   walk_.step_between(h < o ? h : o, cell_, diagram_.neighbour[side_before ? after : before]);
        }
        key_table::key id{cell_, diagram_.neighbour[before], diagram_.neighbour[after]};
        std::sort(id.begin(), id.end());
        auto const [point, known] =
            points_.find_or_insert(id, numbers_.triangle + static_cast<std::uint32_t>(out.points.size()));
        if (!known) {
            out.points.push_back(
                point_in_triangle(diagram_.sites[id[0]], diagram_.sites[id[1]], diagram_.sites[id[2]], q_));
        }
        return point;
    }

    static void finish_piece(std::size_t t, std::uint32_t cell, surface_pieces& out) {
        out.cell.push_back(cell);
        out.corner_begin.push_back(static_cast<std::uint32_t>(out.corners.size()));
        out.triangle_of.push_back(static_cast<std::uint32_t>(t));
    }

    surface_signs const& signs_;
    voronoi_diagram const& diagram_;
    solid const& body_;
    surface_walk const& walk_;
    vertex_numbers numbers_;
    std::uint32_t sites_;

    std::size_t triangle_ = 0;
    std::uint32_t cell_ = 0;
    std::array<ivec3, 3> q_{};
    std::array<bool, 3> vertex_beyond_{};
    std::vector<std::uint32_t> edges_{};
    std::vector<std::uint32_t> kept_{};
    std::vector<std::uint8_t> beyond_{};
    std::vector<std::uint32_t> queue_{};
    key_table seen_{};
    key_table points_{};
};

/// Cuts all triangles. O(pieces x faces of a cell). `numbers.end` is set.
template <class Executor>
[[nodiscard]] surface_pieces clip_surface(surface_signs const& signs, solid const& body, surface_walk const& walk,
                                          vertex_numbers& numbers, Executor const& threads) {
    // Few triangles are large ones: each may cross many cells.
    std::size_t const grain = std::clamp<std::size_t>(body.triangles.size() / 256, 1, 1024);
    auto blocks = collect_blocks<surface_pieces>(
        body.triangles.size(), grain, threads, [&](std::size_t begin, std::size_t end, surface_pieces& out) {
            triangle_clipper clip(signs, body, walk, numbers);
            for (std::size_t t = begin; t < end; ++t) clip(t, out);
        });
    surface_pieces all;
    std::size_t pieces = 0;
    std::size_t corners = 0;
    std::size_t points = 0;
    for (surface_pieces const& b : blocks) {
        pieces += b.cell.size();
        corners += b.corners.size();
        points += b.points.size();
    }
    require_indexable("voronoi_shards", 2 * corners);  // one bit is taken by side_bit
    require_indexable("voronoi_shards", numbers.triangle + points);
    all.cell.reserve(pieces);
    all.triangle_of.reserve(pieces);
    all.corner_begin.reserve(pieces + 1);
    all.corners.reserve(corners);
    all.edges.reserve(corners);
    all.points.reserve(points);
    for (surface_pieces& b : blocks) {
        std::uint32_t const first_point = static_cast<std::uint32_t>(all.points.size());
        std::uint32_t const first_corner = static_cast<std::uint32_t>(all.corners.size());
        for (std::uint32_t& c : b.corners) {
            if (c >= numbers.triangle) c += first_point;
        }
        for (std::size_t p = 1; p < b.corner_begin.size(); ++p) {
            all.corner_begin.push_back(first_corner + b.corner_begin[p]);
        }
        append_and_free(all.corners, b.corners);
        append_and_free(all.edges, b.edges);
        append_and_free(all.cell, b.cell);
        append_and_free(all.triangle_of, b.triangle_of);
        append_and_free(all.points, b.points);
    }
    numbers.end = numbers.triangle + static_cast<std::uint32_t>(all.points.size());
    return all;
}

}  // namespace tafoni::detail

#endif
