/// \file
/// Sites for blocks between three crossing joint sets of uneven spacing.
#ifndef TAFONI_DECOMPOSITION_JOINT_SITES_HPP
#define TAFONI_DECOMPOSITION_JOINT_SITES_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/sites.hpp>

namespace tafoni {

/// Bedding and two joint sets at right angles to it: a rectilinear grid whose spacings vary, with sites left out.
///
/// Cells of a rectilinear grid are boxes whatever the spacings are, so the shards are blocks with flat
/// faces; where a site is left out its neighbours grow into the gap, so some faces are oblique and
/// blocks of very different size lie side by side. Only sites in the solid's box are kept. Models `site_pattern`.
struct joint_sites {
    vec3 up{0, 0, 1};                ///< normal of the bedding, unit length
    vec3 spacing{1, 1, 1};           ///< mean distance along two horizontals and `up`, > 0, length unit
    double turn = 0;                 ///< turns the joint sets around `up`, degrees, -360 .. 360
    double variation = 0.5;          ///< a spacing is the mean times 1 - variation .. 1 + variation, 0 .. 0.95
    double left_out = 0.25;          ///< chance of a site to be left out, 0 .. 0.9
    double jitter = 0.1;             ///< largest move along each axis, in halves of the mean spacing, 0 .. 1

    /// O(sites). \throws invalid_input  `bad_parameter`, `size_overflow`.
    [[nodiscard]] std::vector<vec3> operator()(solid const& s, std::uint64_t seed) const {
        validate();
        auto frame = detail::axis_frame::around(up);
        double const angle = turn * 0.017453292519943295;
        vec3 const u = frame.u;
        for (int a = 0; a < 3; ++a) frame.u[a] = elementary::cos(angle) * u[a] + elementary::sin(angle) * frame.v[a];
        frame.v = cross(frame.w, frame.u);
        vec3 const centre = s.bounds.centre();
        box3 const local = frame.local_box(s.bounds, centre);
        vec3 const extent = local.extent();
        double count = 1;
        for (int a = 0; a < 3; ++a) count *= extent[a] / (spacing[a] * (1 - variation)) + 2;
        if (!(count < 4e9)) {
            detail::fail<invalid_input>(errc::size_overflow, "joint_sites: the spacing is too small for the solid",
                                        {.kind = entity::parameter, .value = count, .limit = 4e9});
        }
        std::vector<double> lines[3];
        for (int a = 0; a < 3; ++a) {
            stream random(seed, stage::sites, static_cast<std::uint64_t>(a));
            double at = local.lo[a] + spacing[a] * random.uniform01();
            while (at < local.hi[a]) {
                lines[a].push_back(at);
                at += spacing[a] * random.uniform(1 - variation, 1 + variation);
            }
        }
        std::vector<vec3> sites;
        std::uint64_t number = 0;
        for (double const z : lines[2]) {
            for (double const y : lines[1]) {
                for (double const x : lines[0]) {
                    stream random(seed, stage::jitter, number++);
                    if (random.chance(left_out)) continue;
                    vec3 q{x, y, z};
                    for (int a = 0; a < 3; ++a) q[a] += 0.5 * jitter * spacing[a] * random.uniform(-1, 1);
                    vec3 const offset = frame.to_world(q);
                    vec3 const p{centre[0] + offset[0], centre[1] + offset[1], centre[2] + offset[2]};
                    if (s.bounds.contains(p)) sites.push_back(p);
                }
            }
        }
        if (sites.empty()) sites.push_back(centre);
        return sites;
    }

    void validate() const {
        for (int a = 0; a < 3; ++a) detail::require_range("joint_sites.spacing", spacing[a], 1e-150, 1e150);
        detail::require_range("joint_sites.up length", length(up), 1 - 1e-9, 1 + 1e-9);
        detail::require_range("joint_sites.turn", turn, -360, 360);
        detail::require_range("joint_sites.variation", variation, 0, 0.95);
        detail::require_range("joint_sites.left_out", left_out, 0, 0.9);
        detail::require_range("joint_sites.jitter", jitter, 0, 1);
    }
};

static_assert(site_pattern<joint_sites>);

}  // namespace tafoni

#endif
