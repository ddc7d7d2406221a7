/// \file
/// Sites on a regular grid, shaken on request.
#ifndef TAFONI_DECOMPOSITION_GRID_SITES_HPP
#define TAFONI_DECOMPOSITION_GRID_SITES_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/sites.hpp>

#include <algorithm>

namespace tafoni {

/// The centres of equal, nearly cubic boxes that fill the solid's box, each moved within its box.
/// About `count` of them lie in the solid; those outside it are returned too. Models `site_pattern`.
struct grid_sites {
    std::size_t count = 1000;  ///< about how many in the solid, >= 1
    double jitter = 0.3;       ///< largest move along an axis, in halves of the box, 0 .. 1

    /// O(sites). \throws invalid_input  `no_sites`, `bad_parameter`, `size_overflow`.
    [[nodiscard]] std::vector<vec3> operator()(solid const& s, std::uint64_t seed) const {
        validate();
        vec3 const extent = s.bounds.extent();
        double const box_volume = extent[0] * extent[1] * extent[2];
        // Relative to the solid, so that no intermediate value leaves the range of doubles.
        double const edge = edge_of(extent, s.volume);
        std::size_t n[3];
        double total = 1;
        for (int a = 0; a < 3; ++a) {
            double const boxes = std::floor(extent[a] / edge + 0.5);
            total *= boxes > 1 ? boxes : 1;
            if (!(total < 4e9)) {
                detail::fail<invalid_input>(errc::size_overflow,
                                            "grid_sites: " + std::to_string(count) +
                                                " sites in the solid need too many in its box",
                                            {.kind = entity::site, .value = box_volume / s.volume});
            }
            n[a] = boxes > 1 ? static_cast<std::size_t>(boxes) : 1;
        }
        std::vector<vec3> sites;
        sites.reserve(n[0] * n[1] * n[2]);
        for (std::size_t k = 0; k < n[2]; ++k) {
            for (std::size_t j = 0; j < n[1]; ++j) {
                for (std::size_t i = 0; i < n[0]; ++i) {
                    stream random(seed, stage::jitter, sites.size());
                    std::size_t const at[3] = {i, j, k};
                    vec3 p{0, 0, 0};
                    for (int a = 0; a < 3; ++a) {
                        double const u = static_cast<double>(at[a]) + 0.5 + 0.5 * jitter * random.uniform(-1, 1);
                        p[a] = s.bounds.lo[a] + extent[a] * (u / static_cast<double>(n[a]));
                    }
                    sites.push_back(detail::clamped(p, s.bounds));
                }
            }
        }
        return sites;
    }

    void validate() const {
        detail::require_site_count("grid_sites", count);
        detail::require_range("grid_sites.jitter", jitter, 0, 1);
    }

private:
    /// Edge of a grid that has `count` boxes in the solid; where the box is thin, of one layer or one row.
    [[nodiscard]] double edge_of(vec3 const& extent, double volume) const {
        double e[3] = {extent[0], extent[1], extent[2]};
        std::sort(e, e + 3);
        double const n = static_cast<double>(count);
        double const cubic = elementary::pow(volume / n, 1.0 / 3);
        if (e[0] >= 0.5 * cubic) return cubic;
        double const square = std::sqrt(volume / e[0] / n);
        return e[1] >= 0.5 * square ? square : volume / e[0] / e[1] / n;
    }
};

static_assert(site_pattern<grid_sites>);

}  // namespace tafoni

#endif
