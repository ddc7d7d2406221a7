/// \file
/// Cuts a face with holes into triangles.
#ifndef TAFONI_DECOMPOSITION_DETAIL_FACE_TRIANGLES_HPP
#define TAFONI_DECOMPOSITION_DETAIL_FACE_TRIANGLES_HPP

#include <tafoni/decomposition/concepts.hpp>
#include <tafoni/decomposition/detail/loop_measure.hpp>
#include <tafoni/geometry/triangulate.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tafoni::detail {

/// Bridges holes to the outline, then clips ears. One object serves many faces; the triangles of a
/// face depend on the face alone, so both of its sides are cut alike.
class face_triangulator {
public:
    /// Appends triangles of vertices, turning like the face's loops. Every edge of a loop is an edge
    /// of exactly one of them. O(n log n) without holes, O(n h) for the h bridges.
    template <class C>
    void operator()(C const& c, face_index f, std::vector<std::array<vertex_index, 3>>& out) {
        std::size_t const loops = c.loop_count(f);
        load(c, f, 0);
        if (loops == 1 && loop_.size() == 3) {
            out.push_back({loop_[0], loop_[1], loop_[2]});
            return;
        }
        if (loops > 1) {
            choose_plane(c, f);
            holes_.resize(loops - 1);
            for (std::size_t l = 1; l < loops; ++l) {
                auto const given = c.face_loop(f, l);
                auto& hole = holes_[l - 1];
                hole.clear();
                for (std::size_t k = 0; k < given.size(); ++k) hole.push_back(static_cast<vertex_index>(given[k]));
                std::size_t far = 0;
                for (std::size_t k = 1; k < hole.size(); ++k) {
                    if (u(c.position(hole[k])) > u(c.position(hole[far]))) far = k;
                }
                std::rotate(hole.begin(), hole.begin() + static_cast<std::ptrdiff_t>(far), hole.end());
            }
            std::sort(holes_.begin(), holes_.end(), [&](auto const& a, auto const& b) {
                double const x = u(c.position(a[0]));
                double const y = u(c.position(b[0]));
                return x != y ? x > y : a[0] < b[0];
            });
            for (auto const& hole : holes_) bridge(c, hole);
        }
        for (auto const& t : clip_triangles()) out.push_back({loop_[t[0]], loop_[t[1]], loop_[t[2]]});
    }

private:
    template <class C>
    void load(C const& c, face_index f, std::size_t l) {
        loop_.clear();
        places_.clear();
        auto const given = c.face_loop(f, l);
        for (std::size_t k = 0; k < given.size(); ++k) {
            loop_.push_back(static_cast<vertex_index>(given[k]));
            places_.push_back(c.position(loop_.back()));
        }
    }

    [[nodiscard]] std::vector<std::array<std::uint32_t, 3>> const& clip_triangles() {
        triangles_.clear();
        clipper_(places_, triangles_);
        return triangles_;
    }

    template <class C>
    void choose_plane(C const& c, face_index f) {
        vec3 const n = doubled_area(c.face_loop(f, 0), [&c](auto v) { return c.position(static_cast<vertex_index>(v)); });
        int drop = 2;
        if (std::fabs(n[1]) > std::fabs(n[drop])) drop = 1;
        if (std::fabs(n[0]) > std::fabs(n[drop])) drop = 0;
        axis_u_ = (drop + 1) % 3;
        axis_v_ = (drop + 2) % 3;
        if (n[drop] < 0) std::swap(axis_u_, axis_v_);
    }

    [[nodiscard]] double u(vec3 const& p) const noexcept { return p[axis_u_]; }
    [[nodiscard]] double v(vec3 const& p) const noexcept { return p[axis_v_]; }

    /// Joins a hole, whose first corner is its farthest along u, to the corner of the loop that it can
    /// see along u [Eberly, Triangulation by ear clipping, section 3].
    template <class C>
    void bridge(C const& c, std::vector<vertex_index> const& hole) {
        vec3 const m = c.position(hole[0]);
        std::size_t const n = loop_.size();
        std::size_t best = n;
        double nearest = 0;
        for (std::size_t k = 0; k < n; ++k) {
            vec3 const& a = places_[k];
            vec3 const& b = places_[k + 1 == n ? 0 : k + 1];
            // The ray from m along u leaves the outline through an edge that runs up in v.
            if (!(v(a) <= v(m) && v(b) > v(m))) continue;
            double const at = u(a) + (v(m) - v(a)) / (v(b) - v(a)) * (u(b) - u(a));
            if (at < u(m) || (best != n && at >= nearest)) continue;
            nearest = at;
            best = u(a) > u(b) || v(a) == v(m) ? k : (k + 1 == n ? 0 : k + 1);
        }
        if (best == n) best = 0;
        // Corners inside the triangle (m, point on the edge, corner) hide the corner: take the one
        // with the smallest angle to the ray.
        vec3 const corner = places_[best];
        std::size_t visible = best;
        double slope = 0;
        double reach = 0;
        bool found = false;
        double const lo = v(corner) < v(m) ? v(corner) : v(m);
        double const hi = v(corner) < v(m) ? v(m) : v(corner);
        for (std::size_t k = 0; k < n && hi > lo; ++k) {
            vec3 const& p = places_[k];
            if (v(p) < lo || v(p) > hi || u(p) < u(m) || k == best) continue;
            // Inside: between the line m-corner and the line (nearest, v(m))-corner.
            double const t = (v(p) - v(m)) / (v(corner) - v(m));
            double const left = u(m) + t * (u(corner) - u(m));
            double const right = nearest + t * (u(corner) - nearest);
            if (u(p) < left || u(p) > right || !(t >= 0 && t < 1)) continue;
            double const along = u(p) - u(m);
            double const tilt = along > 0 ? std::fabs(v(p) - v(m)) / along : std::numeric_limits<double>::infinity();
            if (!found || tilt < slope || (tilt == slope && along < reach)) {
                found = true;
                slope = tilt;
                reach = along;
                visible = k;
            }
        }
        std::vector<vertex_index> insert(hole);
        insert.push_back(hole[0]);
        insert.push_back(loop_[visible]);
        auto const at = static_cast<std::ptrdiff_t>(visible + 1);
        loop_.insert(loop_.begin() + at, insert.begin(), insert.end());
        std::vector<vec3> places;
        for (vertex_index h : insert) places.push_back(c.position(h));
        places_.insert(places_.begin() + at, places.begin(), places.end());
    }

    std::vector<vertex_index> loop_{};
    std::vector<vec3> places_{};
    std::vector<std::vector<vertex_index>> holes_{};
    std::vector<std::array<std::uint32_t, 3>> triangles_{};
    ear_clipper clipper_{};
    int axis_u_ = 0;
    int axis_v_ = 1;
};

}  // namespace tafoni::detail

#endif
