/// \file
/// Sites for columns with six sides, as basalt cools into.
#ifndef TAFONI_DECOMPOSITION_HEXAGONAL_SITES_HPP
#define TAFONI_DECOMPOSITION_HEXAGONAL_SITES_HPP

#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/sites.hpp>

#include <algorithm>

namespace tafoni {

/// A hexagonal lattice in planes across `axis` [Mateos et al., Figure 15]. Models `site_pattern`.
///
/// The paper puts one site per column into one plane; then walls stand exactly along the axis, and
/// water that needs a slope stops between columns of equal height: `vertical_jitter` tilts them.
/// Where the middle plane leaves the solid's box, a column's site slides along the axis into it.
struct hexagonal_sites {
    std::size_t count = 300;        ///< about how many columns cross the solid's box, >= 1
    double jitter = 0.2;            ///< largest move across the axis, in halves of the spacing, 0 .. 1
    double vertical_jitter = 0.2;   ///< largest move along the axis, in spacings, 0 .. 10
    vec3 axis{0, 0, 1};             ///< of the columns, unit length; tilt it for leaning columns
    std::size_t layers = 1;         ///< sites along a column, >= 1

    /// O(sites). \throws invalid_input  `no_sites`, `bad_parameter`.
    [[nodiscard]] std::vector<vec3> operator()(solid const& s, std::uint64_t seed) const {
        validate();
        auto const frame = detail::axis_frame::around(axis);
        vec3 const centre = s.bounds.centre();
        box3 const local = frame.local_box(s.bounds, centre);
        vec3 const extent = local.extent();
        // A cell of a hexagonal lattice with spacing a covers sqrt(3)/2 a^2; in a narrow box there is one row.
        double const n = static_cast<double>(count);
        double const spacing = std::max({std::sqrt(extent[0] * extent[1] / n / 0x1.bb67ae8584caap-1), extent[0] / n,
                                         extent[1] / n / 0x1.bb67ae8584caap-1});
        double const row = spacing * 0x1.bb67ae8584caap-1;
        bool const narrow = extent[0] < 0.5 * spacing;
        double const stagger = narrow ? 0.0 : 0.5;
        auto const columns = narrow ? 1 : static_cast<std::int64_t>(std::floor(extent[0] / spacing)) + 2;
        auto const rows = static_cast<std::int64_t>(std::floor(extent[1] / row)) + 1;
        double const first_row = -0.5 * row * static_cast<double>(rows - 1);
        double const first_column = -0.5 * spacing * (static_cast<double>(columns - 1) + stagger);
        double const reach_u = 0.5 * jitter * std::min(spacing, extent[0]);
        double const reach_v = 0.5 * jitter * std::min(spacing, extent[1]);
        std::vector<vec3> sites;
        std::uint64_t number = 0;
        for (std::int64_t r = 0; r < rows; ++r) {
            for (std::int64_t c = 0; c < columns; ++c) {
                for (std::size_t l = 0; l < layers; ++l) {
                    stream random(seed, stage::jitter, number++);
                    double const du = reach_u * random.uniform(-1, 1);
                    double const dv = reach_v * random.uniform(-1, 1);
                    double const dw = vertical_jitter * spacing * random.uniform(-1, 1);
                    vec3 const q{first_column + spacing * (static_cast<double>(c) + (r % 2 != 0 ? stagger : 0.0)) + du,
                                 first_row + row * static_cast<double>(r) + dv,
                                 local.lo[2] + extent[2] * ((static_cast<double>(l) + 0.5) / static_cast<double>(layers)) + dw};
                    place(s.bounds, frame, centre, q, sites);
                }
            }
        }
        if (sites.empty()) sites.push_back(centre);
        return sites;
    }

    void validate() const {
        detail::require_site_count("hexagonal_sites", count);
        detail::require_range("hexagonal_sites.jitter", jitter, 0, 1);
        detail::require_range("hexagonal_sites.vertical_jitter", vertical_jitter, 0, 10);
        detail::require_range("hexagonal_sites.axis length", length(axis), 1 - 1e-9, 1 + 1e-9);
        detail::require_range("hexagonal_sites.layers", static_cast<double>(layers), 1, 1e6);
    }

private:
    /// Adds the point if it lies in the box; with one layer, its nearest point along the axis that does.
    void place(box3 const& box, detail::axis_frame const& frame, vec3 const& centre, vec3 const& q,
               std::vector<vec3>& sites) const {
        vec3 const offset = frame.to_world(q);
        vec3 const p{centre[0] + offset[0], centre[1] + offset[1], centre[2] + offset[2]};
        if (box.contains(p)) {
            sites.push_back(p);
            return;
        }
        if (layers != 1) return;
        double from = -2 * box.diagonal();
        double to = -from;
        for (int a = 0; a < 3; ++a) {
            if (std::fabs(axis[a]) < 1e-12) {
                if (p[a] < box.lo[a] || p[a] > box.hi[a]) return;
                continue;
            }
            double const t0 = (box.lo[a] - p[a]) / axis[a];
            double const t1 = (box.hi[a] - p[a]) / axis[a];
            from = std::max(from, std::min(t0, t1));
            to = std::min(to, std::max(t0, t1));
        }
        if (!(from < to)) return;
        // A little inside, so that no two walls of the box meet there.
        double const margin = 0.05 * (to - from);
        double const t = from > 0 ? from + margin : to - margin;
        sites.push_back(detail::clamped(vec3{p[0] + t * axis[0], p[1] + t * axis[1], p[2] + t * axis[2]}, box));
    }
};

static_assert(site_pattern<hexagonal_sites>);

}  // namespace tafoni

#endif
