/// \file
/// Policies of the water's way: where rain comes from, where it enters, where it runs.
#ifndef TAFONI_PERCOLATION_CONCEPTS_HPP
#define TAFONI_PERCOLATION_CONCEPTS_HPP

#include <tafoni/core/random.hpp>
#include <tafoni/graph/concepts.hpp>
#include <tafoni/rules/concepts.hpp>

namespace tafoni {

/// Draws the direction in which the rain of one path travels.
///
/// Laws: unit length; depends on the policy and the stream only.
/// Model: `struct mine { vec3 draw(stream&) const { return {0, 0, -1}; } };`
template <class R>
concept rain_policy = std::copy_constructible<R> && requires(R const& r, stream& random) {
    { r.draw(random) } -> std::same_as<vec3>;
};

/// Share of the rain on a skin link that enters there; entry is drawn with weight area x acceptance.
///
/// Laws: pure; in [0, 1] (so that entry can be drawn by rejection, whatever the number of links).
/// Model: `struct mine { double acceptance(link_view const& skin, vec3 const& rain) const { return 1; } };`
template <class P>
concept infiltration_policy = std::copy_constructible<P> && requires(P const& p, link_view const& l, vec3 const& d) {
    { p.acceptance(l, d) } -> std::same_as<double>;
};

/// Preference for the step from one link to a neighbour; the engine normalises over Neigh(here).
///
/// Laws: pure; >= 0 and finite; all zero ends the path.
/// Model: `struct mine { double weight(link_view const&, link_view const& there, water const&) const { return there.area; } };`
template <class P>
concept flow_policy =
    std::copy_constructible<P> && requires(P const& p, link_view const& here, link_view const& there, water const& w) {
        { p.weight(here, there, w) } -> std::same_as<double>;
    };

}  // namespace tafoni

#endif
