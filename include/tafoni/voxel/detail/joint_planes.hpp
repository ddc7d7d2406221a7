/// \file
/// Which bonds a disc cuts.
#ifndef TAFONI_VOXEL_DETAIL_JOINT_PLANES_HPP
#define TAFONI_VOXEL_DETAIL_JOINT_PLANES_HPP

#include <tafoni/core/vector.hpp>
#include <tafoni/voxel/joints.hpp>

namespace tafoni::detail {

/// A disc with its normal of unit length and turned to the side that counts as above.
struct joint_plane {
    vec3 centre;
    vec3 normal;
    double squared_radius;

    static joint_plane of(joint_disc const& d) noexcept {
        vec3 n = normalized(d.normal);
        bool const down = n[2] != 0 ? n[2] < 0 : n[1] != 0 ? n[1] < 0 : n[0] < 0;
        if (down) n = vec3{-n[0], -n[1], -n[2]};
        return {d.centre, n, d.radius * d.radius};
    }
    /// Monotone along every axis, in doubles too: differences, products and sums round monotonically.
    [[nodiscard]] double height(vec3 const& p) const noexcept {
        return dot(normal, vec3{p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]});
    }
    [[nodiscard]] bool is_below(vec3 const& p) const noexcept { return height(p) < 0; }
    /// Whether the disc cuts between p and q, which differ in one coordinate. The same for (q, p).
    [[nodiscard]] bool cuts(vec3 const& p, vec3 const& q) const noexcept {
        double const hp = height(p);
        double const hq = height(q);
        if ((hp < 0) == (hq < 0)) return false;
        bool const swap = hp > hq;
        vec3 const& low = swap ? q : p;
        vec3 const& high = swap ? p : q;
        double const h = swap ? hq : hp;
        double const t = h / (h - (swap ? hp : hq));
        vec3 const at{low[0] + t * (high[0] - low[0]) - centre[0], low[1] + t * (high[1] - low[1]) - centre[1],
                      low[2] + t * (high[2] - low[2]) - centre[2]};
        return squared_length(at) <= squared_radius;
    }
};

}  // namespace tafoni::detail

#endif
