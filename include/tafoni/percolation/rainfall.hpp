/// \file
/// Where water comes from: a rain and how it enters, in one piece.
#ifndef TAFONI_PERCOLATION_RAINFALL_HPP
#define TAFONI_PERCOLATION_RAINFALL_HPP

#include <tafoni/percolation/directional_rain.hpp>
#include <tafoni/percolation/facing_infiltration.hpp>
#include <tafoni/rules/roles.hpp>

namespace tafoni {

namespace detail {
struct rain_role {
    template <class T>
    static constexpr bool fits = rain_policy<T>;
    template <class T>
    static constexpr bool resembles = requires { &T::draw; };
    template <class T>
    static void expect() {
        static_assert(fits<T>, "`rain` takes a rain_policy: vec3 draw(stream&) const");
    }
};
struct infiltration_role {
    template <class T>
    static constexpr bool fits = infiltration_policy<T>;
    template <class T>
    static constexpr bool resembles = requires { &T::acceptance; };
    template <class T>
    static void expect() {
        static_assert(fits<T>, "`infiltration` takes an infiltration_policy: double acceptance(link_view, vec3) const");
    }
};
using rainfall_members = bundle_members<bundle_member<rain_role, directional_rain>,
                                        bundle_member<infiltration_role, facing_infiltration>>;
}  // namespace detail

/// A rain policy together with an infiltration policy; models both.
template <rain_policy Rain = directional_rain, infiltration_policy Infiltration = facing_infiltration>
struct rainfall {
    using members = detail::rainfall_members;  ///< for deduction

    [[no_unique_address]] Rain rain{};
    [[no_unique_address]] Infiltration infiltration{};

    [[nodiscard]] vec3 draw(stream& random) const { return rain.draw(random); }
    [[nodiscard]] double acceptance(link_view const& skin, vec3 const& direction) const {
        return infiltration.acceptance(skin, direction);
    }
    template <class F>
    void for_each_policy(F const& f) const {
        f(rain);
        f(infiltration);
    }
};

template <class... Parts>
    requires(!detail::bundle_of<detail::rainfall_members, Parts> && ...)
rainfall(Parts...) -> rainfall<detail::pick_part_t<detail::rainfall_members, 0, Parts...>,
                               detail::pick_part_t<detail::rainfall_members, 1, Parts...>>;

static_assert(rain_policy<rainfall<>> && infiltration_policy<rainfall<>>);

}  // namespace tafoni

#endif
