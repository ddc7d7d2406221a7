/// \file
/// Which part of a bundle plays which role: for deduction guides.
#ifndef TAFONI_RULES_ROLES_HPP
#define TAFONI_RULES_ROLES_HPP

#include <tafoni/core/vector.hpp>
#include <tafoni/graph/concepts.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <tuple>
#include <type_traits>

namespace tafoni::detail {

/// Stands in for every part of a bundle that was refused, so that nothing else is said than why.
struct refused_part {
    refused_part() = default;
    template <class T>
    refused_part(T const&);
    vec3 draw(auto const&...) const;
    double acceptance(auto const&...) const;
    double weight(auto const&...) const;
    double operator()(auto const&...) const;
    double absorbed(auto const&...) const;
    double soak_chance(auto const&...) const;
    double damage(auto const&...) const;
    double break_chance(auto const&...) const;
    falling decide(auto const&...) const;
    vec3 direction(auto const&...) const;
};

/// What stands in for a role's part: the role's own `refused` where `refused_part` would not fit.
template <class Role>
struct refused_as {
    using type = refused_part;
};
template <class Role>
    requires requires { typename Role::refused; }
struct refused_as<Role> {
    using type = typename Role::refused;
};

/// A member of a bundle: what it must model, and what it is when left out.
template <class Role, class Default>
struct bundle_member {
    using role = Role;
    using type = Default;
};

enum class casting { good, fits_none, fits_several };

/// The part that plays each member, or why there is none.
template <std::size_t Members>
struct cast_list {
    std::array<int, Members> part{};  ///< -1: left out
    casting outcome = casting::good;
    std::size_t wrong = 0;  ///< the part in question
    std::size_t member = 0; ///< where it was to go, as far as that can be told
};

/// The members of a bundle, in order.
template <class... Members>
struct bundle_members {
    static constexpr std::size_t size = sizeof...(Members);
    using list = std::tuple<Members...>;

    template <class Part>
    static constexpr std::array<bool, size> fits{Members::role::template fits<Part>...};
    template <class Part>
    static constexpr std::array<bool, size> resembles{Members::role::template resembles<Part>...};

    /// g++ 12 deduces from designated initialisers by position, so the parts are recognised by what they
    /// model when members are left out: in order, each for one member.
    template <class... Parts>
    static constexpr cast_list<size> cast() {
        cast_list<size> found;
        found.part.fill(-1);
        constexpr std::array<std::array<bool, size>, sizeof...(Parts)> model{fits<Parts>...};
        constexpr std::array<std::array<bool, size>, sizeof...(Parts)> look{resembles<Parts>...};
        std::size_t next = 0;
        for (std::size_t p = 0; p < sizeof...(Parts); ++p) {
            bool const whole = sizeof...(Parts) == size;
            std::size_t const end = whole ? p + 1 : size;
            std::size_t several = 0;
            std::size_t member = size;
            std::size_t likely = whole ? p : size;
            for (std::size_t k = whole ? p : next; k < end; ++k) {
                if (model[p][k] && several++ == 0) member = k;
                if (look[p][k] && likely == size) likely = k;
            }
            if (several != 1) {
                found.outcome = several == 0 ? casting::fits_none : casting::fits_several;
                found.wrong = p;
                found.member = likely;
                return found;
            }
            found.part[member] = static_cast<int>(p);
            next = member + 1;
        }
        return found;
    }
};

template <class Members, class... Parts>
struct cast_parts {
    static constexpr auto found = Members::template cast<Parts...>();
};

/// The same bundle, which is copied, not taken for a part.
template <class Members, class Part>
concept bundle_of = requires { requires std::same_as<typename Part::members, Members>; };

/// Says by a static_assert what is wrong with the parts, if anything is. Functions, since clang gives up a
/// class that holds a failed one, and reports that too.
template <class Members, class... Parts>
auto check_parts() {
    if constexpr ((bundle_of<Members, Parts> || ...)) {
        return std::false_type{};  // clang asks before it looks at the guide's own condition
    } else {
        constexpr auto found = cast_parts<Members, Parts...>::found;
        static_assert(found.outcome != casting::fits_several,
                      "this part models several roles of the bundle: give all members, or name the bundle's types");
        if constexpr (found.outcome == casting::fits_none) {
            static_assert(found.member < Members::size,
                          "this part models no role that is left in the bundle: "
                          "it takes or answers other types than the members' concepts ask for");
            if constexpr (found.member < Members::size) {
                using role = typename std::tuple_element_t<found.member, typename Members::list>::role;
                role::template expect<std::tuple_element_t<found.wrong, std::tuple<Parts...>>>();
            }
        }
        return std::bool_constant<found.outcome == casting::good>{};
    }
}

/// The type of member number `Member` of a bundle that is made from `Parts`.
template <class Members, std::size_t Member, class Checked, class... Parts>
struct pick_part {
    using type = typename refused_as<typename std::tuple_element_t<Member, typename Members::list>::role>::type;
};

template <class Members, std::size_t Member, class... Parts>
struct pick_part<Members, Member, std::true_type, Parts...> {
    static constexpr int part = cast_parts<Members, Parts...>::found.part[Member];
    static constexpr std::size_t given = part < 0 ? sizeof...(Parts) : static_cast<std::size_t>(part);
    using left_out = typename std::tuple_element_t<Member, typename Members::list>::type;
    using type = std::tuple_element_t<given, std::tuple<Parts..., left_out>>;
};

template <class Members, std::size_t Member, class... Parts>
using pick_part_t = typename pick_part<Members, Member, decltype(check_parts<Members, Parts...>()), Parts...>::type;

}  // namespace tafoni::detail

#endif
