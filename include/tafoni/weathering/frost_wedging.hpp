/// \file
/// Frost wedging: which policies make up the process, as one aggregate.
#ifndef TAFONI_WEATHERING_FROST_WEDGING_HPP
#define TAFONI_WEATHERING_FROST_WEDGING_HPP

#include <tafoni/percolation/rainfall.hpp>
#include <tafoni/percolation/seepage.hpp>
#include <tafoni/rules/roles.hpp>
#include <tafoni/rules/uptake.hpp>
#include <tafoni/rules/wear.hpp>

namespace tafoni {

namespace detail {
struct wear_role {
    template <class T>
    static constexpr bool fits = damage_rule<T> && breakage_rule<T> && detachment_rule<T>;
    template <class T>
    static constexpr bool resembles =
        damage_role::resembles<T> || breakage_role::resembles<T> || detachment_role::resembles<T>;
    template <class T>
    static void expect() {
        static_assert(fits<T>,
                      "`wear` takes all three rules: tafoni::wear{.harm = ..., .breakage = ..., .detachment = ...}");
    }
};
using frost_members = bundle_members<bundle_member<rain_role, rainfall<>>, bundle_member<flow_role, seepage<>>,
                                     bundle_member<absorption_role, uptake<>>, bundle_member<wear_role, wear<>>>;
}  // namespace detail

/// Weathering by freeze and thaw [Mateos et al., section 5]: rain enters fractures, runs down them, is
/// absorbed, and wears the bonds between shards until parts fall.
///
/// Every member takes a single policy or a bundle: `rain` a rain policy or `rainfall{rain, infiltration}`,
/// `flow` a flow policy or `seepage{flow, resistance}`, `absorb` an absorption rule or
/// `uptake{absorption, soaking}`, `wear` `tafoni::wear{harm, breakage, detachment}`. What a single policy
/// does not say is the paper's default. When members are left out, each part must model the role of one
/// member only; a part of several roles needs all members, or the types named: `frost_wedging<mine, mine>`. The defaults are the preset `paper`; run it with `frost_run`.
template <rain_policy Rain = rainfall<>, flow_policy Flow = seepage<>, absorption_rule Absorb = uptake<>,
          damage_rule Wear = tafoni::wear<>>
    requires breakage_rule<Wear> && detachment_rule<Wear>
struct frost_wedging {
    using members = detail::frost_members;  ///< for deduction

    [[no_unique_address]] Rain rain{};
    [[no_unique_address]] Flow flow{};
    [[no_unique_address]] Absorb absorb{};
    [[no_unique_address]] Wear wear{};

    template <class F>
    void for_each_policy(F const& f) const {
        f(rain);
        f(flow);
        f(absorb);
        f(wear);
    }

    /// \throws invalid_input  `bad_parameter` when a policy's own `validate()` says so.
    void validate() const { detail::validate_policies(*this); }
};

template <class... Parts>
    requires(!detail::bundle_of<detail::frost_members, Parts> && ...)
frost_wedging(Parts...) -> frost_wedging<detail::pick_part_t<detail::frost_members, 0, Parts...>,
                                         detail::pick_part_t<detail::frost_members, 1, Parts...>,
                                         detail::pick_part_t<detail::frost_members, 2, Parts...>,
                                         detail::pick_part_t<detail::frost_members, 3, Parts...>>;

}  // namespace tafoni

#endif
