/// \file
/// Sites that keep a distance which may change from place to place.
#ifndef TAFONI_DECOMPOSITION_POISSON_SITES_HPP
#define TAFONI_DECOMPOSITION_POISSON_SITES_HPP

#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/sites.hpp>
#include <tafoni/field/constant.hpp>
#include <tafoni/geometry/inside_columns.hpp>

#include <array>
#include <map>

namespace tafoni {

/// Poisson disc pattern in the solid: two sites p, q are at least min(radius(p), radius(q)) apart,
/// and hardly any place is left for another one [Bridson 2007; graded as in Mateos et al., Figure 4].
///
/// About 0.7 volume / radius^3 sites where the radius is constant. Models `site_pattern`.
template <scalar_field Radius = constant_field>
struct poisson_sites {
    Radius radius{};             ///< length unit; between 1e-4 and 1 diagonal of the solid's box where the solid is
    unsigned attempts = 30;      ///< places tried around each site, 1 .. 1000
    std::size_t most = 10'000'000;  ///< error beyond so many sites

    /// O(sites attempts log sites).
    /// \throws invalid_input  `bad_parameter` (also for a radius out of range), `size_overflow` beyond `most`.
    [[nodiscard]] std::vector<vec3> operator()(solid const& s, std::uint64_t seed) const {
        validate();
        inside_columns const rock(s);
        builder b{*this, s.bounds, s.bounds.diagonal(), {}, {}, {}};
        std::size_t opened = 0;
        // Starts all over the solid, so that every component gets its sites.
        for (std::uint64_t start = 0; start < 2000 || b.sites.empty(); ++start) {
            stream random(seed, stage::sites, start);
            vec3 p{0, 0, 0};
            for (int a = 0; a < 3; ++a) p[a] = random.uniform(s.bounds.lo[a], s.bounds.hi[a]);
            if (rock.contains(p)) b.offer(p);
            for (; opened < b.sites.size(); ++opened) {
                stream around(seed, stage::jitter, opened);
                vec3 const centre = b.sites[opened];
                double const r = b.radii[opened];
                for (unsigned k = 0; k < attempts; ++k) {
                    vec3 const d = around.unit_vector();
                    double const far_out = r * (1 + around.uniform01());
                    vec3 const q{centre[0] + far_out * d[0], centre[1] + far_out * d[1], centre[2] + far_out * d[2]};
                    if (s.bounds.contains(q) && rock.contains(q)) b.offer(q);
                }
            }
            if (start > 200'000'000) {
                detail::fail<invalid_input>(errc::out_of_range, "poisson_sites: the solid is too thin for its box",
                                            {.kind = entity::site});
            }
        }
        return std::move(b.sites);
    }

    void validate() const {
        detail::require_range("poisson_sites.attempts", attempts, 1, 1000);
        detail::require_site_count("poisson_sites", most);
        if constexpr (requires { radius.validate(); }) radius.validate();
    }

private:
    using cell_key = std::array<std::int32_t, 4>;  // level, x, y, z

    struct builder {
        poisson_sites const& pattern;
        box3 bounds;
        double size;
        std::vector<vec3> sites;
        std::vector<double> radii;
        std::map<cell_key, std::vector<std::uint32_t>> cells;
        std::array<bool, 16> level_used{};

        /// Level l holds the sites with radius in (2^-l-1, 2^-l] of `size`, in cells of edge 2^-l.
        [[nodiscard]] static std::size_t level_of(double relative) noexcept {
            std::size_t l = 0;
            for (double edge = 0.5; relative <= edge && l < 15; edge *= 0.5) ++l;
            return l;
        }
        [[nodiscard]] cell_key key_of(vec3 const& p, std::size_t level) const noexcept {
            double const per_length = static_cast<double>(1U << level) / size;
            cell_key k{static_cast<std::int32_t>(level), 0, 0, 0};
            for (int a = 0; a < 3; ++a) {
                k[static_cast<std::size_t>(a) + 1] = static_cast<std::int32_t>((p[a] - bounds.lo[a]) * per_length);
            }
            return k;
        }

        void offer(vec3 const& p) {
            double const r = pattern.radius(p);
            detail::require_range("poisson_sites.radius in box diagonals", r / size, 1e-4, 1);
            for (std::size_t l = 0; l < level_used.size(); ++l) {
                if (level_used[l] && conflicts(p, r, l)) return;
            }
            if (sites.size() >= pattern.most) {
                detail::fail<invalid_input>(errc::size_overflow,
                                            "poisson_sites: more than " + std::to_string(pattern.most) + " sites",
                                            {.kind = entity::site, .value = r});
            }
            std::size_t const l = level_of(r / size);
            level_used[l] = true;
            cells[key_of(p, l)].push_back(static_cast<std::uint32_t>(sites.size()));
            sites.push_back(p);
            radii.push_back(r);
        }

        /// A site of level l in conflict is at most its own radius away, that is within one cell.
        [[nodiscard]] bool conflicts(vec3 const& p, double r, std::size_t level) const {
            cell_key const home = key_of(p, level);
            for (std::int32_t dx = -1; dx <= 1; ++dx) {
                for (std::int32_t dy = -1; dy <= 1; ++dy) {
                    for (std::int32_t dz = -1; dz <= 1; ++dz) {
                        auto const cell = cells.find({home[0], home[1] + dx, home[2] + dy, home[3] + dz});
                        if (cell == cells.end()) continue;
                        for (std::uint32_t const i : cell->second) {
                            double const limit = std::min(r, radii[i]);
                            if (squared_length(vec3{p - sites[i]}) < limit * limit) return true;
                        }
                    }
                }
            }
            return false;
        }
    };
};

template <class Radius>
poisson_sites(Radius) -> poisson_sites<Radius>;

static_assert(site_pattern<poisson_sites<>>);

}  // namespace tafoni

#endif
