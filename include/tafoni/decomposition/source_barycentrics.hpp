/// \file
/// Where the corners of a cut surface lie in the triangles that they come from.
#ifndef TAFONI_DECOMPOSITION_SOURCE_BARYCENTRICS_HPP
#define TAFONI_DECOMPOSITION_SOURCE_BARYCENTRICS_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/decomposition/shard_surface.hpp>
#include <tafoni/geometry/solid.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tafoni {

namespace detail {

struct source_barycentrics_fn {
    /// Per corner of the surface's triangles: the shares, at least 0 with sum 1, of the three vertices of
    /// `body.triangles[c.face_source(face)]` at that corner; zeros on fresh triangles, which have no source.
    ///
    /// With them texture coordinates, colours and normals of the input are carried over. A corner at a vertex of
    /// the source has exactly its share 1. In a source without area the shares are those along its longest side. O(corners).
    /// \throws invalid_input  attribute_length where `body` is not the solid that `c` was cut from
    [[nodiscard]] std::vector<std::array<double, 3>> operator()(shard_surface const& s, shard_complex const& c, solid const& body) const {
        if (body.triangles.size() != c.polygon_of.size()) {
            fail<invalid_input>(errc::attribute_length, "source_barycentrics: the solid has " + std::to_string(body.triangles.size()) +
                                                            " triangles, the shards were cut from " + std::to_string(c.polygon_of.size()));
        }
        std::vector<std::array<double, 3>> shares(s.mesh.corners.size(), {0, 0, 0});
        for (std::size_t k = 0; k < shares.size(); ++k) {
            std::uint32_t const t = c.face_source(s.face[k / 3]);
            if (t == shard_complex::none) continue;
            auto const& v = body.triangles[t];
            shares[k] = shares_of(s.mesh.positions[s.mesh.corners[k]], {body.positions[v[0]], body.positions[v[1]], body.positions[v[2]]});
        }
        return shares;
    }

private:
    [[nodiscard]] static std::array<double, 3> shares_of(vec3 const& p, std::array<vec3, 3> const& q) noexcept {
        for (std::size_t k = 0; k < 3; ++k) {
            if (p == q[k]) return {k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
        }
        vec3 const u{q[1][0] - q[0][0], q[1][1] - q[0][1], q[1][2] - q[0][2]};
        vec3 const v{q[2][0] - q[0][0], q[2][1] - q[0][1], q[2][2] - q[0][2]};
        vec3 const n = normalized(cross(u, v));
        std::array<double, 3> w{};
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            vec3 const& a = q[(k + 1) % 3];
            vec3 const& b = q[(k + 2) % 3];
            double const area = dot(n, cross(vec3{a[0] - p[0], a[1] - p[1], a[2] - p[2]}, vec3{b[0] - p[0], b[1] - p[1], b[2] - p[2]}));
            w[k] = area > 0 ? area : 0;
            sum += w[k];
        }
        if (sum > 0) return {w[0] / sum, w[1] / sum, w[2] / sum};
        std::size_t longest = 0;
        double most = -1;
        for (std::size_t k = 0; k < 3; ++k) {
            double const l = squared_length(vec3{q[(k + 1) % 3] - q[k]});
            if (l > most) most = l, longest = k;
        }
        w = {0, 0, 0};
        vec3 const& a = q[longest];
        vec3 const& b = q[(longest + 1) % 3];
        double x = most > 0 ? dot(vec3{p[0] - a[0], p[1] - a[1], p[2] - a[2]}, vec3{b[0] - a[0], b[1] - a[1], b[2] - a[2]}) / most : 0;
        x = x > 0 ? (x < 1 ? x : 1) : 0;
        w[longest] = 1 - x;
        w[(longest + 1) % 3] = x;
        return w;
    }
};

}  // namespace detail

/// Places in the source triangles; see `detail::source_barycentrics_fn`.
inline constexpr detail::source_barycentrics_fn source_barycentrics{};

}  // namespace tafoni

#endif
