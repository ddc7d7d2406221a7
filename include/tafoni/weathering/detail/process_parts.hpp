/// \file
/// The parts of a process that may be left out, and what stands in for them.
#ifndef TAFONI_WEATHERING_DETAIL_PROCESS_PARTS_HPP
#define TAFONI_WEATHERING_DETAIL_PROCESS_PARTS_HPP

#include <tafoni/percolation/facing_infiltration.hpp>
#include <tafoni/rules/depletion_soaking.hpp>
#include <tafoni/rules/wear.hpp>

namespace tafoni::detail {

/// The infiltration that comes with a rain, else the paper's.
template <class Rain>
[[nodiscard]] auto const& infiltration_of(Rain const& rain) noexcept {
    if constexpr (infiltration_policy<Rain>) {
        return rain;
    } else {
        static constexpr facing_infiltration facing{};
        return facing;
    }
}

/// The soaking that comes with an absorption, else the paper's.
template <class Absorb>
[[nodiscard]] auto const& soaking_of(Absorb const& absorb) noexcept {
    if constexpr (soaking_rule<Absorb>) {
        return absorb;
    } else {
        static constexpr depletion_soaking depletion{};
        return depletion;
    }
}

/// Whether the rule lets parts with core cells stand, so that searches may stop where both sides have one.
template <class Wear>
inline constexpr bool cores_stand = false;
template <class Damage, class Breakage>
inline constexpr bool cores_stand<wear<Damage, Breakage, smaller_part_falls>> = true;

}  // namespace tafoni::detail

#endif
