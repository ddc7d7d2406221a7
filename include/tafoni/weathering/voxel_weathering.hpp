/// \file
/// Voxel weathering: which policies make up the process, as one aggregate.
#ifndef TAFONI_WEATHERING_VOXEL_WEATHERING_HPP
#define TAFONI_WEATHERING_VOXEL_WEATHERING_HPP

#include <tafoni/field/concepts.hpp>
#include <tafoni/field/constant.hpp>
#include <tafoni/rules/parameter_checks.hpp>
#include <tafoni/rules/roles.hpp>
#include <tafoni/voxel/bubble_choice.hpp>
#include <tafoni/voxel/rates.hpp>
#include <tafoni/voxel/single_bubble.hpp>
#include <tafoni/weathering/detail/durability_role.hpp>

#include <concepts>
#include <cstddef>
#include <span>

namespace tafoni {

namespace detail {
struct bubbles_role {
    struct refused {
        refused() = default;
        template <class T>
        refused(T const&);
        std::span<bubble_stencil const> stencils() const;
        std::size_t choose(vec3 const&) const;
    };
    template <class T>
    static constexpr bool fits = bubble_choice<T>;
    template <class T>
    static constexpr bool resembles = bubble_shape<T> || requires { &T::choose; };
    template <class T>
    static void expect() {
        static_assert(fits<T>,
                      "`bubbles` takes a bubble_choice: tafoni::single_bubble{tafoni::sphere_bubble{3}}, a mixture, a "
                      "profile, or your own");
    }
};
struct rate_role {
    template <class T>
    static constexpr bool fits = rate_function<T>;
    template <class T>
    static constexpr bool resembles = std::invocable<T const&, double> && !std::invocable<T const&, vec3>;
    template <class T>
    static void expect() {
        static_assert(fits<T>, "`rate` takes a rate_function: double operator()(double) const");
    }
};
using voxel_members = bundle_members<bundle_member<bubbles_role, single_bubble>, bundle_member<rate_role, cubic_rate>,
                                     bundle_member<durability_role, constant_field>>;
}  // namespace detail

/// Weathering by bubbles [Jones et al., section 4]: every voxel of the skin counts the air in a bubble
/// around it and loses (A f(share of air) + B f(share of rock)) / durability of its 100 per cent in a step.
///
/// Durability is asked once per voxel, at its centre in the user's space; its unit is steps per per cent at
/// a rate of 1; what is less than `least_durability` counts as that. Members that are left out are
/// the defaults; run it with `voxel_run`.
template <bubble_choice Bubbles = single_bubble, rate_function Rate = cubic_rate,
          scalar_field Durability = constant_field>
struct voxel_weathering {
    using members = detail::voxel_members;  ///< for deduction

    static constexpr double least_durability = 1e-3;

    [[no_unique_address]] Bubbles bubbles{};
    [[no_unique_address]] Rate rate{};
    [[no_unique_address]] Durability durability{};

    template <class F>
    void for_each_policy(F const& f) const {
        f(bubbles);
        f(rate);
        f(durability);
    }

    /// \throws invalid_input  `bad_parameter` when a policy's own `validate()` says so.
    void validate() const { detail::validate_policies(*this); }
};

template <class... Parts>
    requires(!detail::bundle_of<detail::voxel_members, Parts> && ...)
voxel_weathering(Parts...) -> voxel_weathering<detail::pick_part_t<detail::voxel_members, 0, Parts...>,
                                               detail::pick_part_t<detail::voxel_members, 1, Parts...>,
                                               detail::pick_part_t<detail::voxel_members, 2, Parts...>>;

}  // namespace tafoni

#endif
