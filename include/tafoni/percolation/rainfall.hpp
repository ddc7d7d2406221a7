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
};
struct infiltration_role {
    template <class T>
    static constexpr bool fits = infiltration_policy<T>;
};
}  // namespace detail

/// A rain policy together with an infiltration policy; models both.
template <rain_policy Rain = directional_rain, infiltration_policy Infiltration = facing_infiltration>
struct rainfall {
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
rainfall(Parts...) -> rainfall<detail::pick_role_t<detail::rain_role, directional_rain, Parts...>,
                               detail::pick_role_t<detail::infiltration_role, facing_infiltration, Parts...>>;

static_assert(rain_policy<rainfall<>> && infiltration_policy<rainfall<>>);

}  // namespace tafoni

#endif
