/// \file
/// Which part of a bundle plays which role: for deduction guides.
#ifndef TAFONI_RULES_ROLES_HPP
#define TAFONI_RULES_ROLES_HPP

namespace tafoni::detail {

/// The first of `Parts` that fits `Role`, else `Fallback`.
///
/// g++ 12 deduces from designated initialisers by position, so a guide must recognise its parts by
/// what they model when leading members are left out.
template <class Role, class Fallback, class... Parts>
struct pick_role {
    using type = Fallback;
};

template <class Role, class Fallback, class First, class... Rest>
    requires(Role::template fits<First>)
struct pick_role<Role, Fallback, First, Rest...> {
    using type = First;
};

template <class Role, class Fallback, class First, class... Rest>
    requires(!Role::template fits<First>)
struct pick_role<Role, Fallback, First, Rest...> : pick_role<Role, Fallback, Rest...> {};

template <class Role, class Fallback, class... Parts>
using pick_role_t = typename pick_role<Role, Fallback, Parts...>::type;

}  // namespace tafoni::detail

#endif
