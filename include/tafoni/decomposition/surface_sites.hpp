/// \file
/// Sites at random on the skin of the rock.
#ifndef TAFONI_DECOMPOSITION_SURFACE_SITES_HPP
#define TAFONI_DECOMPOSITION_SURFACE_SITES_HPP

#include <tafoni/decomposition/sites.hpp>
#include <tafoni/geometry/sampling.hpp>

namespace tafoni {

/// Uniform by area on the surface, up to rounding, `count` of them. Models `site_pattern`.
struct surface_sites {
    std::size_t count = 1000;  ///< >= 1

    /// O(triangles + count log triangles). \throws invalid_input  `no_sites`.
    [[nodiscard]] std::vector<vec3> operator()(solid const& s, std::uint64_t seed) const {
        validate();
        surface_sampler const sample(s);
        std::vector<vec3> sites;
        sites.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            stream random(seed, stage::sites, i);
            sites.push_back(sample(random));
        }
        return sites;
    }

    void validate() const { detail::require_site_count("surface_sites", count); }
};

static_assert(site_pattern<surface_sites>);

}  // namespace tafoni

#endif
