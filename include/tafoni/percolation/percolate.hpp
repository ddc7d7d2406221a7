/// \file
/// One path of water through a frozen state of the links.
#ifndef TAFONI_PERCOLATION_PERCOLATE_HPP
#define TAFONI_PERCOLATION_PERCOLATE_HPP

#include <tafoni/percolation/concepts.hpp>
#include <tafoni/percolation/entry_tree.hpp>
#include <tafoni/percolation/link_table.hpp>
#include <tafoni/rules/concepts.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace tafoni {

/// Water in whole units of 2^-48, so that ledgers close exactly.
struct water_unit {
    static constexpr double per_water = 0x1p48;
    static constexpr double limit = 1024;  ///< most water in one path

    [[nodiscard]] static std::int64_t from(double water) noexcept {
        return static_cast<std::int64_t>(std::floor(water * per_water + 0.5));
    }
    [[nodiscard]] static double to(std::int64_t units) noexcept { return static_cast<double>(units) * 0x1p-48; }
};

/// One link that a path has run through.
struct path_visit {
    link_index link{};
    link_state state = link_state::gone;  ///< as the path found it
    std::int64_t absorbed = 0;            ///< water units
};

/// One path. Ledger: inflow = sum of absorbed + lost + drained, exactly.
struct path_trace {
    link_index entry{};          ///< not valid when no link accepted the rain
    std::uint32_t visits = 0;    ///< links traversed; they follow those of the path before
    std::int64_t inflow = 0;     ///< water units; 0 without entry
    std::int64_t lost = 0;       ///< soaked without wearing, or left at `longest_path`
    std::int64_t drained = 0;    ///< left the rock where no way led on
};

/// Who decides about a path: references to the caller's policies.
template <class Rain, class Infiltration, class Flow, class Absorption, class Soaking>
struct path_policies {
    Rain const& rain;
    Infiltration const& infiltration;
    Flow const& flow;
    Absorption const& absorption;
    Soaking const& soaking;
};

/// Numbers of a path.
struct path_options {
    std::uint64_t seed = 0;
    std::int64_t inflow = 0;                ///< water units at the entry, > 0
    link_scale scale{};
    std::uint32_t longest_path = 1u << 20;  ///< visits after which the rest is booked as lost
};

/// Memory of `percolate`; one per thread.
struct path_scratch {
    entry_tree::scratch entry{};
    std::vector<link_index> candidates{};
    std::vector<double> sums{};
};

namespace detail {

[[noreturn]] inline void bad_answer(char const* who, link_index l, double value,
                                    char const* allowed = ">= 0 and finite") {
    fail<invalid_input>(errc::out_of_range,
                        std::string(who) + ": a policy answered " + number_text(value) + " at link " +
                            std::to_string(l.value) + ", allowed " + allowed,
                        {.kind = entity::link, .index = l.value, .value = value, .limit = 0});
}

/// Throws unless 0 <= value < infinity.
inline void require_answer(char const* who, link_index l, double value) {
    if (!(value >= 0 && value <= std::numeric_limits<double>::max())) bad_answer(who, l, value);
}

/// Throws unless `value` is a chance or a share, in [0, 1] but for rounding.
inline double require_share(char const* who, link_index l, double value) {
    if (!(value >= -1e-6 && value <= 1 + 1e-6)) bad_answer(who, l, value, "[0, 1]");
    return value;
}

/// Throws unless the rain's direction has unit length within 1e-6.
inline void require_direction(vec3 const& d, std::uint64_t path) {
    double const squared = dot(d, d);
    if (squared >= 1 - 1e-6 && squared <= 1 + 1e-6) return;
    double const l = length(d);
    if (l >= 1 - 1e-6 && l <= 1 + 1e-6) return;
    fail<invalid_input>(errc::out_of_range,
                        "rain: a policy drew a direction of length " + number_text(l) + " for path " +
                            std::to_string(path) + ", allowed 1 (unit vector)",
                        {.kind = entity::parameter, .value = l, .limit = 1});
}

/// Draws one of Neigh(here) by flow weight; not valid when all weights are 0. O(Neigh).
template <class Network, class Flow>
[[nodiscard]] link_index next_link(link_table<Network> const& table, Flow const& flow, link_index here, water const& w,
                                   stream& random, path_scratch& memory) {
    auto& candidates = memory.candidates;
    auto& sums = memory.sums;
    candidates.clear();
    sums.clear();
    table.network().for_each_neighbor(here, [&](link_index l) {
        __builtin_prefetch(&table[l]);
        candidates.push_back(l);
    });
    link_view const from = table.view(here);
    double total = 0;
    for (link_index const l : candidates) {
        if (table[l].state != link_state::gone) {
            double const weight = flow.weight(from, table.view(l), w);
            if (!(weight >= 0)) bad_answer("flow", l, weight);
            total += weight;
        }
        sums.push_back(total);
    }
    if (!(total > 0)) return {};
    if (!(total <= std::numeric_limits<double>::max())) bad_answer("flow", here, total);
    double const u = random.uniform01() * total;
    std::size_t k = 0;
    while (k + 1 < sums.size() && !(u < sums[k])) ++k;
    while (k > 0 && !(sums[k] > sums[k - 1])) --k;  // u rounded up to the total: the last link with weight
    return candidates[k];
}

}  // namespace detail

/// Walks path number `path` over the frozen `table` and appends its visits. Nothing else changes.
///
/// The rain picks an entry among the weighted links of `skin`; the entry absorbs nothing. Then, link by
/// link: a neighbour is drawn by flow weight; it soaks all that is left by chance, or absorbs its share;
/// the path ends without water or without a way on [Mateos et al., sections 5.1 and 5.2]. Links laid bare
/// and broken ones are ways, links with air on both sides are not. Draws come from
/// stream(seed, stage, path): one stream per stage, so no policy shifts another's draws.
/// Cost O(visits x Neigh).
/// \throws invalid_input  `out_of_range` when a weight or an absorption is negative or not finite, or an
///                        acceptance, a chance or a share is outside [0, 1]; it names the link. Also when the
///                        rain's direction is not of unit length within 1e-6.
struct percolate_fn {
    template <class Network, class Policies>
    path_trace operator()(link_table<Network> const& table, entry_tree const& skin, Policies const& policies,
                          path_options const& options, std::uint64_t path, std::vector<path_visit>& visits,
                          path_scratch& memory) const {
        path_trace trace;
        stream rain(options.seed, stage::rain, path);
        vec3 const direction = policies.rain.draw(rain);
        detail::require_direction(direction, path);
        stream entry(options.seed, stage::entry, path);
        double const key[3] = {direction[0], direction[1], direction[2]};
        trace.entry = skin.draw(
            entry, key,
            [&](link_index l) {
                return detail::require_share("infiltration", l, policies.infiltration.acceptance(table.view(l), direction));
            },
            memory.entry);
        if (!trace.entry.valid()) return trace;

        stream flow(options.seed, stage::flow, path);
        stream soak(options.seed, stage::absorption, path);
        trace.inflow = options.inflow;
        std::int64_t left = options.inflow;
        water w{.now = water_unit::to(left), .initial = water_unit::to(left), .step = 0};
        link_index here = trace.entry;
        while (left > 0) {
            if (trace.visits == options.longest_path) {
                trace.lost += left;
                return trace;
            }
            here = detail::next_link(table, policies.flow, here, w, flow, memory);
            if (!here.valid()) {
                trace.drained = left;
                return trace;
            }
            link_view const l = table.view(here);
            double const chance = detail::require_share("soaking", here, policies.soaking.soak_chance(l, w));
            std::int64_t absorbed = 0;
            if (chance > 0 && soak.chance(chance)) {
                absorbed = left;
                if constexpr (requires { policies.soaking.soaked_share(l); }) {
                    double const share = detail::require_share("soaking", here, policies.soaking.soaked_share(l));
                    if (share < 1) absorbed = share > 0 ? water_unit::from(w.now * share) : 0;
                }
                trace.lost += left - absorbed;
                left = 0;
            } else {
                double const drunk = policies.absorption.absorbed(l, w, options.scale);
                if (!(drunk >= 0)) detail::bad_answer("absorption", here, drunk);
                absorbed = drunk >= w.now ? left : water_unit::from(drunk);
                if (absorbed > left) absorbed = left;
                left -= absorbed;
            }
            visits.push_back({here, l.state, absorbed});
            ++trace.visits;
            w.now = water_unit::to(left);
            ++w.step;
        }
        return trace;
    }
};

inline constexpr percolate_fn percolate{};

}  // namespace tafoni

#endif
