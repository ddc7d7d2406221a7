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

/// Weathering by freeze and thaw [Mateos et al., section 5]: rain enters fractures, runs down them, is
/// absorbed, and wears the bonds between shards until parts fall.
///
/// Every member takes a single policy or a bundle: `rain` a rain policy or `rainfall{rain, infiltration}`,
/// `flow` a flow policy or `seepage{flow, resistance}`, `absorb` an absorption rule or
/// `uptake{absorption, soaking}`, `wear` `tafoni::wear{harm, breakage, detachment}`. What a single policy
/// does not say is the paper's default. The defaults are the preset `paper`; run it with `frost_run`.
template <rain_policy Rain = rainfall<>, flow_policy Flow = seepage<>, absorption_rule Absorb = uptake<>,
          damage_rule Wear = tafoni::wear<>>
    requires breakage_rule<Wear> && detachment_rule<Wear>
struct frost_wedging {
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
frost_wedging(Parts...) -> frost_wedging<detail::pick_role_t<detail::rain_role, rainfall<>, Parts...>,
                                         detail::pick_role_t<detail::flow_role, seepage<>, Parts...>,
                                         detail::pick_role_t<detail::absorption_role, uptake<>, Parts...>,
                                         detail::pick_role_t<detail::damage_role, wear<>, Parts...>>;

}  // namespace tafoni

#endif
