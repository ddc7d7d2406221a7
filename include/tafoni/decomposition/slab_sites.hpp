/// \file
/// Sites for tilted slabs of given thickness.
#ifndef TAFONI_DECOMPOSITION_SLAB_SITES_HPP
#define TAFONI_DECOMPOSITION_SLAB_SITES_HPP

#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/sites.hpp>

namespace tafoni {

/// Rectilinear grids in parallel planes whose distances follow `spacings` [Mateos et al., Figure 16].
///
/// The first plane lies half a spacing above the lowest corner of the solid's box, seen along `up`;
/// when the spacings are used up they start again. Only sites in the box are kept. Models `site_pattern`.
struct slab_sites {
    std::vector<double> spacings{};  ///< from plane to plane, > 0, length unit, at least one
    double across = 1;               ///< spacing within a plane, > 0, length unit
    vec3 up{0, 0, 1};                ///< normal of the slabs, unit length
    double jitter = 0;               ///< largest move, in halves of the spacings, 0 .. 1

    /// O(sites). \throws invalid_input  `no_sites`, `bad_parameter`, `size_overflow`.
    [[nodiscard]] std::vector<vec3> operator()(solid const& s, std::uint64_t seed) const {
        validate();
        auto const frame = detail::axis_frame::around(up);
        vec3 const centre = s.bounds.centre();
        box3 const local = frame.local_box(s.bounds, centre);
        vec3 const extent = local.extent();
        double const columns = std::floor(extent[0] / across) + 1;
        double const rows = std::floor(extent[1] / across) + 1;
        double thinnest = spacings.front();
        for (double const d : spacings) thinnest = std::min(thinnest, d);
        if (!(columns * rows * (extent[2] / thinnest + 1) < 4e9)) {
            detail::fail<invalid_input>(errc::size_overflow, "slab_sites: the spacings are too small for the solid",
                                        {.kind = entity::parameter, .value = across});
        }
        std::vector<vec3> sites;
        std::uint64_t number = 0;
        double w = local.lo[2] + 0.5 * spacings.front();
        for (std::size_t layer = 0; w < local.hi[2]; ++layer) {
            double const spacing = spacings[layer % spacings.size()];
            for (double r = 0; r < rows; ++r) {
                for (double c = 0; c < columns; ++c) {
                    stream random(seed, stage::jitter, number++);
                    double const du = 0.5 * jitter * across * random.uniform(-1, 1);
                    double const dv = 0.5 * jitter * across * random.uniform(-1, 1);
                    double const dw = 0.5 * jitter * thinnest * random.uniform(-1, 1);
                    vec3 const q{across * (c - 0.5 * (columns - 1)) + du, across * (r - 0.5 * (rows - 1)) + dv, w + dw};
                    vec3 const offset = frame.to_world(q);
                    vec3 const p{centre[0] + offset[0], centre[1] + offset[1], centre[2] + offset[2]};
                    if (s.bounds.contains(p)) sites.push_back(p);
                }
            }
            w += spacing;
        }
        if (sites.empty()) sites.push_back(centre);
        return sites;
    }

    void validate() const {
        if (spacings.empty()) {
            detail::fail<invalid_input>(errc::bad_parameter, "slab_sites.spacings: need at least one",
                                        {.kind = entity::parameter, .value = 0, .limit = 1});
        }
        for (double const d : spacings) detail::require_range("slab_sites.spacings", d, 1e-150, 1e150);
        detail::require_range("slab_sites.across", across, 1e-150, 1e150);
        detail::require_range("slab_sites.up length", length(up), 1 - 1e-9, 1 + 1e-9);
        detail::require_range("slab_sites.jitter", jitter, 0, 1);
    }
};

static_assert(site_pattern<slab_sites>);

}  // namespace tafoni

#endif
