/// \file
/// Law checks for policies and rules: what the compiler cannot see. No test framework needed.
#ifndef TAFONI_TESTING_POLICY_LAWS_HPP
#define TAFONI_TESTING_POLICY_LAWS_HPP

#include <tafoni/field/concepts.hpp>
#include <tafoni/percolation/concepts.hpp>
#include <tafoni/rules/concepts.hpp>
#include <tafoni/rules/parameter_checks.hpp>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

/// Each check asks a policy many questions and returns the laws it broke, in words; empty is good:
/// `for (auto const& broken : tafoni::laws::flow(my_flow{})) std::puts(broken.c_str());`
namespace tafoni::laws {

using broken_laws = std::vector<std::string>;

namespace detail {

/// A link as it may come up in a run.
[[nodiscard]] inline link_view any_link(stream& random) {
    link_view l;
    l.id = link_index{static_cast<std::uint32_t>(random.index_below(1000))};
    l.cells = {cell_index{static_cast<std::uint32_t>(random.index_below(1000))}, cell_index{}};
    double const x = random.uniform(-10, 10);
    double const y = random.uniform(-10, 10);
    double const z = random.uniform(-10, 10);
    l.centroid = vec3{x, y, z};
    l.normal = random.unit_vector();
    l.area = random.uniform(1e-6, 4);
    switch (random.index_below(4)) {
        case 0: l.state = link_state::skin; break;
        case 1: l.state = link_state::broken; break;
        case 2: l.state = link_state::pocket; break;
        default: l.state = link_state::bonded; break;
    }
    if (l.state != link_state::skin) l.cells[1] = cell_index{static_cast<std::uint32_t>(random.index_below(1000))};
    if (l.state == link_state::bonded) {
        l.life = random.chance(0.2) ? 1.0 : random.uniform(1e-9, 1);
        l.resistance = random.chance(0.2) ? 1.0 : random.uniform01();
    }
    return l;
}

[[nodiscard]] inline water any_water(stream& random) {
    double const initial = random.uniform(0.01, 3);
    double const share = random.chance(0.2) ? 1.0 : random.uniform(1e-9, 1);
    return {initial * share, initial, static_cast<std::uint32_t>(random.index_below(50))};
}

[[nodiscard]] inline bool same(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// Asks `ask(random)` 2000 times for a number in [lo, hi], twice each with the same random input.
template <class Ask>
[[nodiscard]] broken_laws in_range(char const* what, double lo, double hi, Ask const& ask) {
    bool range = true;
    bool pure = true;
    std::string got;
    for (std::uint64_t k = 0; k < 2000; ++k) {
        stream first(11, stage::user, k);
        stream again(11, stage::user, k);
        double const a = ask(first);
        double const b = ask(again);
        if (range && !(a >= lo && a <= hi)) {
            range = false;
            got = tafoni::detail::number_text(a);
        }
        if (!same(a, b)) pure = false;
    }
    broken_laws broken;
    if (!range) {
        broken.push_back(std::string(what) + " answers within [" + tafoni::detail::number_text(lo) + ", " +
                         (hi > 1e300 ? std::string("infinity)") : tafoni::detail::number_text(hi) + "]") + "; got " + got);
    }
    if (!pure) broken.push_back(std::string(what) + " is pure: equal questions get equal answers");
    return broken;
}

inline constexpr double finite = std::numeric_limits<double>::max();

/// `validate()` accepts the policy itself, when there is one.
template <class P>
void valid(P const& p, broken_laws& broken) {
    try {
        tafoni::detail::validate_policies(p);
    } catch (invalid_input const& e) {
        broken.push_back(std::string("the policy passes its own validate(); it says: ") + e.what());
    }
}

}  // namespace detail

/// Rain: unit directions; equal streams give equal directions.
template <rain_policy R>
[[nodiscard]] broken_laws rain(R const& r) {
    broken_laws broken;
    bool unit = true;
    bool pure = true;
    for (std::uint64_t k = 0; k < 2000; ++k) {
        stream first(7, stage::rain, k);
        stream again(7, stage::rain, k);
        vec3 const a = r.draw(first);
        vec3 const b = r.draw(again);
        if (!(std::fabs(length(a) - 1) <= 1e-6)) unit = false;
        for (int axis = 0; axis < 3; ++axis) pure = pure && detail::same(a[axis], b[axis]);
    }
    if (!unit) broken.push_back("rain has unit length");
    if (!pure) broken.push_back("rain depends on the policy and the stream only");
    detail::valid(r, broken);
    return broken;
}

/// Infiltration: pure, in [0, 1].
template <infiltration_policy P>
[[nodiscard]] broken_laws infiltration(P const& p) {
    auto broken = detail::in_range("infiltration", 0, 1, [&](stream& random) {
        link_view l = detail::any_link(random);
        l.state = link_state::skin;
        vec3 const d = random.unit_vector();
        return p.acceptance(l, d);
    });
    detail::valid(p, broken);
    return broken;
}

/// Flow: pure, >= 0 and finite, also between links at the same place.
template <flow_policy P>
[[nodiscard]] broken_laws flow(P const& p) {
    auto broken = detail::in_range("flow", 0, detail::finite, [&](stream& random) {
        link_view const here = detail::any_link(random);
        link_view there = detail::any_link(random);
        if (random.chance(0.05)) there.centroid = here.centroid;
        water const w = detail::any_water(random);
        return p.weight(here, there, w);
    });
    detail::valid(p, broken);
    return broken;
}

/// Absorption: pure, >= 0 and finite.
template <absorption_rule R>
[[nodiscard]] broken_laws absorption(R const& r) {
    auto broken = detail::in_range("absorption", 0, detail::finite, [&](stream& random) {
        link_view const l = detail::any_link(random);
        water const w = detail::any_water(random);
        return r.absorbed(l, w, link_scale{random.uniform(1e-3, 2)});
    });
    detail::valid(r, broken);
    return broken;
}

/// Soaking: pure, in [0, 1].
template <soaking_rule R>
[[nodiscard]] broken_laws soaking(R const& r) {
    auto broken = detail::in_range("soaking", 0, 1, [&](stream& random) {
        link_view const l = detail::any_link(random);
        water const w = detail::any_water(random);
        return r.soak_chance(l, w);
    });
    if constexpr (requires(link_view const& l) { r.soaked_share(l); }) {
        auto const share = detail::in_range("soaked_share", 0, 1, [&](stream& random) {
            return static_cast<double>(r.soaked_share(detail::any_link(random)));
        });
        broken.insert(broken.end(), share.begin(), share.end());
    }
    detail::valid(r, broken);
    return broken;
}

/// Damage: pure, >= 0 and finite, none without water.
template <damage_rule R>
[[nodiscard]] broken_laws damage(R const& r) {
    auto const bonded = [](stream& random) {
        link_view l = detail::any_link(random);
        l.state = link_state::bonded;
        l.life = random.uniform(1e-9, 1);
        return l;
    };
    auto broken = detail::in_range("damage", 0, detail::finite, [&](stream& random) {
        link_view const l = bonded(random);
        double const w = random.uniform(0, 2);
        return r.damage(l, w, link_scale{random.uniform(1e-3, 2)});
    });
    auto const none = detail::in_range("damage without water", 0, 0, [&](stream& random) {
        link_view const l = bonded(random);
        return r.damage(l, 0, link_scale{random.uniform(1e-3, 2)});
    });
    broken.insert(broken.end(), none.begin(), none.end());
    detail::valid(r, broken);
    return broken;
}

/// Breakage: pure, in [0, 1].
template <breakage_rule R>
[[nodiscard]] broken_laws breakage(R const& r) {
    auto broken = detail::in_range("breakage", 0, 1, [&](stream& random) {
        link_view l = detail::any_link(random);
        l.state = link_state::bonded;
        l.life = random.chance(0.1) ? 1.0 : random.uniform(1e-9, 1);
        return r.break_chance(l);
    });
    detail::valid(r, broken);
    return broken;
}

/// Detachment: pure; swapping the parts swaps the answer.
template <detachment_rule R>
[[nodiscard]] broken_laws detachment(R const& r) {
    broken_laws broken;
    bool pure = true;
    bool symmetric = true;
    for (std::uint64_t k = 0; k < 2000; ++k) {
        stream random(13, stage::user, k);
        part a;
        part b;
        a.volume = static_cast<std::int64_t>(random.index_below(8)) + 1;
        b.volume = static_cast<std::int64_t>(random.index_below(8)) + 1;
        a.core_cells = random.chance(0.6) ? 0 : 1 + random.index_below(3);
        b.core_cells = random.chance(0.6) ? 0 : 1 + random.index_below(3);
        bool const lower = random.chance(0.5);
        a.lowest_cell = cell_index{lower ? 3u : 9u};
        b.lowest_cell = cell_index{lower ? 9u : 3u};
        falling const forward = r.decide(a, b);
        falling const backward = r.decide(b, a);
        if (forward != r.decide(a, b)) pure = false;
        falling const mirrored = forward == falling::first    ? falling::second
                                 : forward == falling::second ? falling::first
                                                              : forward;
        if (backward != mirrored) symmetric = false;
    }
    if (!pure) broken.push_back("detachment is pure: equal parts get equal answers");
    if (!symmetric) broken.push_back("detachment: swapping the parts swaps the answer");
    detail::valid(r, broken);
    return broken;
}

/// Field: pure and finite; within [lo, hi] when a model states a range.
template <scalar_field F>
[[nodiscard]] broken_laws field(F const& f, double lo = -detail::finite, double hi = detail::finite) {
    auto broken = detail::in_range("field", lo, hi, [&](stream& random) {
        double const size = random.chance(0.5) ? 1 : 1000;
        double const x = random.uniform(-size, size);
        double const y = random.uniform(-size, size);
        double const z = random.uniform(-size, size);
        return f(vec3{x, y, z});
    });
    detail::valid(f, broken);
    return broken;
}

}  // namespace tafoni::laws

#endif
