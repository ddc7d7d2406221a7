/// \file
/// What a link drinks: its share of the passing water, and by chance all of it.
#ifndef TAFONI_RULES_UPTAKE_HPP
#define TAFONI_RULES_UPTAKE_HPP

#include <tafoni/rules/depletion_soaking.hpp>
#include <tafoni/rules/roles.hpp>
#include <tafoni/rules/surface_absorption.hpp>

namespace tafoni {

namespace detail {
struct absorption_role {
    template <class T>
    static constexpr bool fits = absorption_rule<T>;
    template <class T>
    static constexpr bool resembles = requires { &T::absorbed; };
    template <class T>
    static void expect() {
        static_assert(fits<T>, "`absorption` takes an absorption_rule: double absorbed(link_view, water, link_scale) const");
    }
};
struct soaking_role {
    template <class T>
    static constexpr bool fits = soaking_rule<T>;
    template <class T>
    static constexpr bool resembles = requires { &T::soak_chance; };
    template <class T>
    static void expect() {
        static_assert(fits<T>, "`soaking` takes a soaking_rule: double soak_chance(link_view, water) const");
    }
};
using uptake_members = bundle_members<bundle_member<absorption_role, surface_absorption>,
                                      bundle_member<soaking_role, depletion_soaking>>;
}  // namespace detail

/// An absorption rule together with a soaking rule; models both.
template <absorption_rule Absorption = surface_absorption, soaking_rule Soaking = depletion_soaking>
struct uptake {
    using members = detail::uptake_members;  ///< for deduction

    [[no_unique_address]] Absorption absorption{};
    [[no_unique_address]] Soaking soaking{};

    [[nodiscard]] double absorbed(link_view const& l, water const& w, link_scale const& scale) const {
        return absorption.absorbed(l, w, scale);
    }
    [[nodiscard]] double soak_chance(link_view const& l, water const& w) const { return soaking.soak_chance(l, w); }
    [[nodiscard]] double soaked_share(link_view const& l) const {
        if constexpr (requires { soaking.soaked_share(l); }) {
            return soaking.soaked_share(l);
        } else {
            return 1;
        }
    }
    template <class F>
    void for_each_policy(F const& f) const {
        f(absorption);
        f(soaking);
    }
};

template <class... Parts>
    requires(!detail::bundle_of<detail::uptake_members, Parts> && ...)
uptake(Parts...) -> uptake<detail::pick_part_t<detail::uptake_members, 0, Parts...>,
                           detail::pick_part_t<detail::uptake_members, 1, Parts...>>;

static_assert(absorption_rule<uptake<>> && soaking_rule<uptake<>>);

}  // namespace tafoni

#endif
