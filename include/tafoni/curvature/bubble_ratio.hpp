/// \file
/// Mean curvature from the share of a ball that the solid fills.
#ifndef TAFONI_CURVATURE_BUBBLE_RATIO_HPP
#define TAFONI_CURVATURE_BUBBLE_RATIO_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/error.hpp>
#include <tafoni/curvature/concepts.hpp>
#include <tafoni/curvature/detail/corner_sums.hpp>
#include <tafoni/curvature/vertex_normals.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni {

namespace detail {

inline constexpr double pi = 3.14159265358979323846;

/// The part of a ball around the origin that lies behind a patch of surface through it.
class ball_share {
public:
    ball_share(double radius, vec3 const& into_solid) noexcept : radius_(radius), pole_(into_solid) {}

    /// A triangle, counter-clockwise seen from outside, of which `inside[k]` tells the corners within the ball.
    void add(std::array<vec3, 3> const& t, std::array<bool, 3> const& inside) noexcept {
        std::array<vec3, 6> polygon;
        std::size_t n = 0;
        vec3 leaves{0, 0, 0};
        vec3 enters{0, 0, 0};
        int out = 0;
        int in = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            std::size_t const next = (k + 1) % 3;
            if (inside[k]) polygon[n++] = t[k];
            if (inside[k] == inside[next]) continue;
            vec3 const x = inside[k] ? on_sphere(t[k], t[next]) : on_sphere(t[next], t[k]);
            polygon[n++] = x;
            (inside[k] ? leaves : enters) = x;
            ++(inside[k] ? out : in);
        }
        for (std::size_t k = 1; k + 1 < n; ++k) cone_ += dot(polygon[0], cross(polygon[k], polygon[k + 1]));
        if (out == 1 && in == 1) turn(normalized(enters), normalized(leaves));
    }

    /// O(1). The cones to the patch, and the sector of the directions that leave the ball inside the solid.
    [[nodiscard]] double volume() const noexcept {
        double const half = elementary::acos(std::clamp(cos_, -1.0, 1.0));
        double const angle = sin_ < 0 ? 4 * pi - 2 * half : 2 * half;
        return cone_ / 6 + angle * radius_ * radius_ * radius_ / 3;
    }

private:
    /// Adds the signed area of the spherical triangle pole, u, v [Van Oosterom and Strackee 1983]. Half of it is the
    /// angle of (x, y); angles add up as complex numbers multiply, and the whole of it lies in [0, 4 pi).
    void turn(vec3 const& u, vec3 const& v) noexcept {
        double const y = dot(pole_, cross(u, v));
        double const x = 1 + dot(pole_, u) + dot(u, v) + dot(v, pole_);
        double const c = cos_ * x - sin_ * y;
        double const s = cos_ * y + sin_ * x;
        double const l = std::sqrt(c * c + s * s);
        if (!(l > 0)) return;
        cos_ = c / l;
        sin_ = s / l;
    }
    [[nodiscard]] vec3 on_sphere(vec3 const& p, vec3 const& q) const noexcept {
        vec3 const d{q - p};
        double const a = squared_length(d);
        double const b = dot(p, d);
        double const c = squared_length(p) - radius_ * radius_;  // <= 0
        double const root = std::sqrt(std::max(b * b - a * c, 0.0));
        double const t = b < 0 ? (root - b) / a : (b + root > 0 ? -c / (b + root) : 0.0);
        return vec3{p[0] + t * d[0], p[1] + t * d[1], p[2] + t * d[2]};
    }

    double radius_;
    vec3 pole_;
    double cone_ = 0;
    double cos_ = 1;  ///< of half the solid angle so far
    double sin_ = 0;
};

}  // namespace detail

/// H from the volume V of the solid within a ball around the vertex: V = (2 pi / 3) r^3 - (pi / 4) H r^4 + O(r^5)
/// [Hulin and Troyanov 2003; Pottmann et al. 2007, Principal curvatures from the integral invariant viewpoint],
/// the estimate that voxels use [Jones et al., section 4.3], exact for spheres and planes.
///
/// The ball sees the piece of surface that hangs together with the vertex inside it, so that a thin wall does
/// not count as a ridge. Averages over the ball: robust against noise, blunt on features below its radius. Triangles
/// with corners on a bent surface lie behind it, by H (a^2 + b^2 + c^2) / 24 in the mean for the sides a, b, c; what
/// that adds to the estimate is divided out, so that it is right where the surface is smooth.
/// Where an open mesh ends within the ball it shrinks; border vertices take the mean of their inner
/// neighbours. Models `curvature_estimator`.
struct bubble_ratio {
    double radius = 0;  ///< of the ball, length unit, >= 0; 0 means three mean edges

    /// O(vertices x triangles in a ball), about 7 us per vertex by default; quadratic where one ball holds most of a mesh.
    /// \throws invalid_input  `bad_parameter` for the radius or other rings, `attribute_length` for other than one number
    ///         per vertex.
    template <executor E>
    void operator()(surface_view const& s, std::span<double> mean, E const& executor) const {
        detail::require_one_per_vertex("bubble_ratio", s, mean.size());
        validate();
        double const r = radius > 0 ? radius : 3 * mean_edge(s);
        if (!(r > 0)) {
            std::fill(mean.begin(), mean.end(), 0.0);
            return;
        }
        std::vector<vec3> normal(s.positions.size());
        vertex_normals(s, normal, executor);
        executor.for_blocks(mean.size(), detail::vertex_grain, [&](std::size_t begin, std::size_t end) {
            patch found(s.positions.size(), s.triangles.size());
            for (std::size_t v = begin; v < end; ++v) mean[v] = at(s, normal[v], static_cast<std::uint32_t>(v), r, found);
        });
        detail::fill_border(s, mean, executor);
    }

    /// \throws invalid_input  if `radius` is negative or not finite.
    void validate() const { detail::require_range("bubble_ratio.radius", radius, 0, 1e100); }

private:
    /// The vertices inside the ball that hang together, and their triangles.
    struct patch {
        patch(std::size_t v, std::size_t f) : vertex_seen(v, 0), face_seen(f, 0) {}
        std::vector<std::uint32_t> vertex_seen;  ///< now: inside
        std::vector<std::uint32_t> face_seen;
        std::vector<std::uint32_t> vertices{};
        std::vector<std::uint32_t> faces{};
        std::uint32_t now = 0;

        /// Returns the squared distance of the nearest border vertex, or r2.
        double collect(surface_view const& s, std::uint32_t v, double r2) {
            vertices.assign(1, v);
            faces.clear();
            ++now;
            vertex_seen[v] = now;
            double border = r2;
            vec3 const p = s.positions[v];
            for (std::size_t k = 0; k < vertices.size(); ++k) {
                std::uint32_t const w = vertices[k];
                if (s.rings->is_border(w)) border = std::min(border, squared_length(s.positions[w] - p));
                for (auto const& c : s.rings->faces(w)) {
                    if (face_seen[c.face] == now) continue;
                    face_seen[c.face] = now;
                    faces.push_back(c.face);
                    for (std::uint32_t const u : s.triangles[c.face]) {
                        if (vertex_seen[u] == now || !(squared_length(s.positions[u] - p) < r2)) continue;
                        vertex_seen[u] = now;
                        vertices.push_back(u);
                    }
                }
            }
            return border;
        }
    };

    [[nodiscard]] static double at(surface_view const& s, vec3 const& n, std::uint32_t v, double r, patch& found) {
        if (s.rings->is_border(v) || !(squared_length(n) > 0)) return 0;
        double r2 = r * r;
        double const border = found.collect(s, v, r2);
        if (border < r2) {
            r2 = border;
            r = std::sqrt(r2);
            if (!(r > 0)) return 0;
            found.collect(s, v, r2);
        }
        vec3 const p = s.positions[v];
        detail::ball_share share(r, vec3{-n[0], -n[1], -n[2]});
        double area = 0;
        double sides = 0;  // sum of the squared sides, weighted by area
        for (std::uint32_t const f : found.faces) {
            std::array<vec3, 3> t;
            std::array<bool, 3> inside{};
            for (std::size_t k = 0; k < 3; ++k) {
                std::uint32_t const u = s.triangles[f][k];
                t[k] = vec3{s.positions[u] - p};
                inside[k] = found.vertex_seen[u] == found.now;
            }
            share.add(t, inside);
            vec3 const a{t[1] - t[0]};
            vec3 const b{t[2] - t[0]};
            vec3 const c{b - a};
            double const w = length(cross(a, b));
            area += w;
            sides += w * (squared_length(a) + squared_length(b) + squared_length(c));
        }
        double const behind = area > 0 ? sides / (6 * r2 * area) : 0.0;
        double const volume = std::clamp(share.volume(), 0.0, 4 * detail::pi / 3 * (r2 * r));
        return (8 / (3 * r) - 4 * volume / (detail::pi * r2 * r2)) / (1 + behind);
    }

    [[nodiscard]] static double mean_edge(surface_view const& s) noexcept {
        double sum = 0;
        std::size_t n = 0;
        for (std::size_t v = 0; v < s.positions.size(); ++v) {
            for (std::uint32_t const w : s.rings->neighbors(v)) {
                sum += length(s.positions[w] - s.positions[v]);
                ++n;
            }
        }
        return n > 0 ? sum / static_cast<double>(n) : 0.0;
    }
};

static_assert(curvature_estimator<bubble_ratio>);

}  // namespace tafoni

#endif
