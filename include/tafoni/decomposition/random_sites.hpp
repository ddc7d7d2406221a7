/// \file
/// Sites at random in the rock.
#ifndef TAFONI_DECOMPOSITION_RANDOM_SITES_HPP
#define TAFONI_DECOMPOSITION_RANDOM_SITES_HPP

#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/sites.hpp>
#include <tafoni/geometry/inside_columns.hpp>

namespace tafoni {

/// Uniform in the solid, `count` of them, by rejection from its box. Models `site_pattern`.
struct random_sites {
    std::size_t count = 1000;  ///< >= 1

    /// O(count box / volume) tests.
    /// \throws invalid_input  `no_sites`; `out_of_range` where the solid fills less than about 1e-7 of its box.
    [[nodiscard]] std::vector<vec3> operator()(solid const& s, std::uint64_t seed) const {
        validate();
        inside_columns const rock(s);
        std::vector<vec3> sites;
        sites.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            stream random(seed, stage::sites, i);
            sites.push_back(draw(s.bounds, rock, random));
        }
        return sites;
    }

    void validate() const { detail::require_site_count("random_sites", count); }

private:
    [[nodiscard]] static vec3 draw(box3 const& box, inside_columns const& rock, stream& random) {
        for (int tries = 0; tries < 200'000'000; ++tries) {
            vec3 p{0, 0, 0};
            for (int a = 0; a < 3; ++a) p[a] = random.uniform(box.lo[a], box.hi[a]);
            if (rock.contains(p)) return p;
        }
        detail::fail<invalid_input>(errc::out_of_range, "random_sites: the solid is too thin for its box",
                                    {.kind = entity::site});
    }
};

static_assert(site_pattern<random_sites>);

}  // namespace tafoni

#endif
