/// \file
/// Rules of what water does to a link, and of what falls when a link is gone.
#ifndef TAFONI_RULES_CONCEPTS_HPP
#define TAFONI_RULES_CONCEPTS_HPP

#include <tafoni/core/random.hpp>
#include <tafoni/graph/concepts.hpp>

namespace tafoni {

/// The water in one path, dimensionless shares of a cycle's rain.
struct water {
    double now = 1;    ///< what is left here, in (0, initial]
    double initial = 1;  ///< w_in, > 0
    std::uint32_t step = 0;  ///< links traversed before this one
};

/// Means over the interior links at the start of the run; coefficients are scaled by them [section 5.2].
struct link_scale {
    double mean_area = 1;  ///< squared length unit, > 0
};

/// Water that a link drinks. Laws: pure; the answer is >= 0 and finite; the engine clamps it to `w.now`.
/// Model: `struct mine { double absorbed(link_view const&, water const&, link_scale const&) const { return 0.1; } };`
template <class R>
concept absorption_rule =
    std::copy_constructible<R> && requires(R const& r, link_view const& l, water const& w, link_scale const& s) {
        { r.absorbed(l, w, s) } -> std::same_as<double>;
    };

/// Chance that a link drinks all that is left. Laws: pure; in [0, 1]; 0 for w.now == w.initial in the paper's rule.
/// Optional member `double soaked_share(link_view const&) const` in [0, 1]: the part of it that wears the
/// link (1 when absent); the remainder is lost.
template <class R>
concept soaking_rule = std::copy_constructible<R> && requires(R const& r, link_view const& l, water const& w) {
    { r.soak_chance(l, w) } -> std::same_as<double>;
};

/// Life that absorbed water takes from a bonded link. Laws: pure; >= 0, finite, 0 for no water.
template <class R>
concept damage_rule = std::copy_constructible<R> && requires(R const& r, link_view const& l, double w, link_scale const& s) {
    { r.damage(l, w, s) } -> std::same_as<double>;
};

/// Chance that a weakened link breaks at once. Laws: pure; in [0, 1]; asked with the life after damage.
template <class R>
concept breakage_rule = std::copy_constructible<R> && requires(R const& r, link_view const& l) {
    { r.break_chance(l) } -> std::same_as<double>;
};

/// Decides over a split. Laws: pure; swapping the arguments swaps the answer.
/// A part with core cells never falls in the shipped rule; the engine does not enforce it.
template <class R>
concept detachment_rule = std::copy_constructible<R> && requires(R const& r, part const& a, part const& b) {
    { r.decide(a, b) } -> std::same_as<falling>;
};

}  // namespace tafoni

#endif
