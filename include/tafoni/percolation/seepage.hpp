/// \file
/// How water runs in the rock: a flow and the field of resistance it meets, in one piece.
#ifndef TAFONI_PERCOLATION_SEEPAGE_HPP
#define TAFONI_PERCOLATION_SEEPAGE_HPP

#include <tafoni/field/concepts.hpp>
#include <tafoni/field/constant.hpp>
#include <tafoni/percolation/gravity_flow.hpp>
#include <tafoni/rules/roles.hpp>

namespace tafoni {

namespace detail {
struct flow_role {
    template <class T>
    static constexpr bool fits = flow_policy<T>;
    template <class T>
    static constexpr bool resembles = requires { &T::weight; };
    template <class T>
    static void expect() {
        static_assert(fits<T>, "`flow` takes a flow_policy: double weight(link_view, link_view, water) const");
    }
};
struct resistance_role {
    template <class T>
    static constexpr bool fits = scalar_field<T>;
    template <class T>
    static constexpr bool resembles = requires { &T::operator(); };
    template <class T>
    static void expect() {
        static_assert(fits<T>, "`resistance` takes a scalar_field: double operator()(vec3) const");
    }
};
using seepage_members =
    bundle_members<bundle_member<flow_role, gravity_flow>, bundle_member<resistance_role, constant_field>>;
}  // namespace detail

/// A flow policy together with a resistance field (rho in [0, 1], read once per link); models `flow_policy`.
///
/// The default of 0.5 is a decision: with 1 and full life, 1 - f_r = 0 and no water ever enters.
template <flow_policy Flow = gravity_flow, scalar_field Resistance = constant_field>
struct seepage {
    using members = detail::seepage_members;  ///< for deduction

    [[no_unique_address]] Flow flow{};
    [[no_unique_address]] Resistance resistance{};

    [[nodiscard]] double weight(link_view const& here, link_view const& there, water const& w) const {
        return flow.weight(here, there, w);
    }
    /// rho at a point, in [0, 1].
    [[nodiscard]] double resistance_at(vec3 const& p) const { return resistance(p); }

    template <class F>
    void for_each_policy(F const& f) const {
        f(flow);
        f(resistance);
    }
};

template <class... Parts>
    requires(!detail::bundle_of<detail::seepage_members, Parts> && ...)
seepage(Parts...) -> seepage<detail::pick_part_t<detail::seepage_members, 0, Parts...>,
                             detail::pick_part_t<detail::seepage_members, 1, Parts...>>;

static_assert(flow_policy<seepage<>>);

}  // namespace tafoni

#endif
