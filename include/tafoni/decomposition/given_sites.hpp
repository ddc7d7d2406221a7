/// \file
/// Sites that the user brings along.
#ifndef TAFONI_DECOMPOSITION_GIVEN_SITES_HPP
#define TAFONI_DECOMPOSITION_GIVEN_SITES_HPP

#include <tafoni/decomposition/sites.hpp>

namespace tafoni {

/// The user's points, as they are. Models `site_pattern`.
struct given_sites {
    std::vector<vec3> points{};

    /// O(points). \throws invalid_input  `no_sites`, `non_finite_site`.
    [[nodiscard]] std::vector<vec3> operator()(solid const&, std::uint64_t) const {
        validate();
        return points;
    }

    void validate() const {
        if (points.empty()) {
            detail::fail<invalid_input>(errc::no_sites, "given_sites.points: there are none", {.kind = entity::site});
        }
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (!is_finite(points[i])) {
                detail::fail<invalid_input>(errc::non_finite_site,
                                            "given_sites.points: site " + std::to_string(i) + " is not finite",
                                            {.kind = entity::site, .index = i});
            }
        }
    }
};

static_assert(site_pattern<given_sites>);

}  // namespace tafoni

#endif
