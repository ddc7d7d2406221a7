/// \file
/// The concept of a site pattern: where shards grow from.
#ifndef TAFONI_DECOMPOSITION_SITES_HPP
#define TAFONI_DECOMPOSITION_SITES_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/geometry/solid.hpp>

#include <concepts>
#include <cstdint>
#include <vector>

namespace tafoni {

/// Places the sites of a solid's shards.
///
/// Laws: pure; the points depend on the arguments only, are finite, and stand in no particular order.
/// Shipped patterns keep to the solid's closed box; sites outside the solid are useful there (a
/// grid goes on beyond a slope), their shards are what their cells share with the solid.
/// Model: `struct mine { std::vector<vec3> operator()(solid const& s, std::uint64_t) const { return {s.bounds.centre()}; } };`
template <class P>
concept site_pattern = std::copy_constructible<P> && requires(P const& p, solid const& s, std::uint64_t seed) {
    { p(s, seed) } -> std::same_as<std::vector<vec3>>;
};

namespace detail {

/// Throws unless 1 <= count <= what 32-bit indices can hold.
inline void require_site_count(char const* who, std::size_t count) {
    if (count == 0) {
        fail<invalid_input>(errc::no_sites, std::string(who) + ".count: got 0, need at least one site",
                            {.kind = entity::parameter, .value = 0});
    }
    require_range((std::string(who) + ".count").c_str(), static_cast<double>(count), 1, 4e9);
}

/// The point moved into the box, axis by axis.
[[nodiscard]] inline vec3 clamped(vec3 const& p, box3 const& box) noexcept {
    vec3 r = p;
    for (int a = 0; a < 3; ++a) {
        if (r[a] < box.lo[a]) r[a] = box.lo[a];
        if (r[a] > box.hi[a]) r[a] = box.hi[a];
    }
    return r;
}

/// A right-handed frame around a unit vector: x, y, z for the axis z, turned as little as needed else.
struct axis_frame {
    vec3 u{1, 0, 0};
    vec3 v{0, 1, 0};
    vec3 w{0, 0, 1};

    [[nodiscard]] static axis_frame around(vec3 const& axis) noexcept {
        axis_frame f;
        f.w = axis;
        vec3 const start = std::fabs(axis[0]) < 0.9 ? vec3{1, 0, 0} : vec3{0, 1, 0};
        double const along = dot(start, axis);
        f.u = normalized(vec3{start[0] - along * axis[0], start[1] - along * axis[1], start[2] - along * axis[2]});
        f.v = cross(f.w, f.u);
        return f;
    }
    [[nodiscard]] vec3 to_local(vec3 const& p) const noexcept { return {dot(p, u), dot(p, v), dot(p, w)}; }
    [[nodiscard]] vec3 to_world(vec3 const& q) const noexcept {
        vec3 p{0, 0, 0};
        for (int a = 0; a < 3; ++a) p[a] = q[0] * u[a] + q[1] * v[a] + q[2] * w[a];
        return p;
    }
    /// The box of the box's corners in this frame, around `centre`.
    [[nodiscard]] box3 local_box(box3 const& b, vec3 const& centre) const noexcept {
        box3 r;
        for (int i = 0; i < 8; ++i) {
            vec3 const corner{(i & 1) != 0 ? b.hi[0] : b.lo[0], (i & 2) != 0 ? b.hi[1] : b.lo[1],
                              (i & 4) != 0 ? b.hi[2] : b.lo[2]};
            r.include(to_local(vec3{corner[0] - centre[0], corner[1] - centre[1], corner[2] - centre[2]}));
        }
        return r;
    }
};

}  // namespace detail
}  // namespace tafoni

#endif
