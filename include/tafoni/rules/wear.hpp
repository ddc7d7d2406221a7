/// \file
/// What absorbed water does to the rock: damage, breakage, and what falls.
#ifndef TAFONI_RULES_WEAR_HPP
#define TAFONI_RULES_WEAR_HPP

#include <tafoni/rules/low_life_breakage.hpp>
#include <tafoni/rules/roles.hpp>
#include <tafoni/rules/smaller_part_falls.hpp>
#include <tafoni/rules/surface_damage.hpp>

namespace tafoni {

namespace detail {
struct damage_role {
    template <class T>
    static constexpr bool fits = damage_rule<T>;
    template <class T>
    static constexpr bool resembles = requires { &T::damage; };
    template <class T>
    static void expect() {
        static_assert(fits<T>, "`harm` takes a damage_rule: double damage(link_view, double, link_scale) const");
    }
};
struct breakage_role {
    template <class T>
    static constexpr bool fits = breakage_rule<T>;
    template <class T>
    static constexpr bool resembles = requires { &T::break_chance; };
    template <class T>
    static void expect() {
        static_assert(fits<T>, "`breakage` takes a breakage_rule: double break_chance(link_view) const");
    }
};
struct detachment_role {
    template <class T>
    static constexpr bool fits = detachment_rule<T>;
    template <class T>
    static constexpr bool resembles = requires { &T::decide; };
    template <class T>
    static void expect() {
        static_assert(fits<T>, "`detachment` takes a detachment_rule: falling decide(part, part) const");
    }
};
using wear_members =
    bundle_members<bundle_member<damage_role, surface_damage>, bundle_member<breakage_role, low_life_breakage>,
                   bundle_member<detachment_role, smaller_part_falls>>;
}  // namespace detail

/// A damage rule, a breakage rule and a detachment rule in one piece; models all three.
template <damage_rule Damage = surface_damage, breakage_rule Breakage = low_life_breakage,
          detachment_rule Detachment = smaller_part_falls>
struct wear {
    using members = detail::wear_members;  ///< for deduction

    [[no_unique_address]] Damage harm{};
    [[no_unique_address]] Breakage breakage{};
    [[no_unique_address]] Detachment detachment{};

    [[nodiscard]] double damage(link_view const& l, double absorbed, link_scale const& scale) const {
        return harm.damage(l, absorbed, scale);
    }
    [[nodiscard]] double break_chance(link_view const& l) const { return breakage.break_chance(l); }
    [[nodiscard]] falling decide(part const& a, part const& b) const { return detachment.decide(a, b); }

    template <class F>
    void for_each_policy(F const& f) const {
        f(harm);
        f(breakage);
        f(detachment);
    }
};

template <class... Parts>
    requires(!detail::bundle_of<detail::wear_members, Parts> && ...)
wear(Parts...) -> wear<detail::pick_part_t<detail::wear_members, 0, Parts...>,
                       detail::pick_part_t<detail::wear_members, 1, Parts...>,
                       detail::pick_part_t<detail::wear_members, 2, Parts...>>;

static_assert(damage_rule<wear<>> && breakage_rule<wear<>> && detachment_rule<wear<>>);

}  // namespace tafoni

#endif
