/// \file
/// Law checks for bubbles, for the choice among them, and for the rate over what they find.
#ifndef TAFONI_TESTING_BUBBLE_LAWS_HPP
#define TAFONI_TESTING_BUBBLE_LAWS_HPP

#include <tafoni/core/random.hpp>
#include <tafoni/voxel/bubble_choice.hpp>
#include <tafoni/voxel/rates.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tafoni::laws {

/// Bubble: a reach within 0 .. 48, nothing inside beyond it, at least one voxel inside, equal answers to equal
/// questions and from copies; it passes its own `validate`. O(reach^3).
template <bubble_shape S>
[[nodiscard]] std::vector<std::string> bubble_shape(S const& shape) {
    std::vector<std::string> broken;
    double const reach = shape.reach();
    if (!(reach >= 0 && reach <= bubble_stencil::widest)) {
        broken.push_back("the reach of a bubble is within 0 .. 48 voxels; got " + tafoni::detail::number_text(reach));
        return broken;
    }
    if constexpr (requires { shape.validate(); }) {
        try {
            shape.validate();
        } catch (invalid_input const& e) {
            broken.push_back(std::string("the bubble passes its own validate(); it says: ") + e.what());
        }
    }
    S const copy(shape);
    bool pure = shape.reach() == reach && copy.reach() == reach;
    bool within = true;
    std::size_t voxels = 0;
    int const r = static_cast<int>(reach) + 3;
    for (int z = -r; z <= r; ++z) {
        for (int y = -r; y <= r; ++y) {
            for (int x = -r; x <= r; ++x) {
                vec3 const offset{double(x), double(y), double(z)};
                bool const inside = shape.contains(offset);
                pure = pure && copy.contains(offset) == inside;
                if (!inside) continue;
                ++voxels;
                within = within && std::fabs(offset[0]) <= reach && std::fabs(offset[1]) <= reach &&
                         std::fabs(offset[2]) <= reach;
            }
        }
    }
    for (int z = r; z >= -r; --z) {  // again, from the other end
        for (int x = r; x >= -r; --x) {
            vec3 const offset{double(x), double((x + z) % (r + 1)), double(z)};
            pure = pure && shape.contains(offset) == copy.contains(offset);
        }
    }
    if (!pure) broken.push_back("a bubble is pure: equal questions get equal answers");
    if (!within) broken.push_back("nothing beyond the reach is inside of a bubble");
    if (voxels == 0) broken.push_back("a bubble holds at least one voxel");
    return broken;
}

/// Choice: at least one bubble; at every point an index of one; equal answers to equal questions and from copies;
/// it passes its own `validate`.
template <bubble_choice C>
[[nodiscard]] std::vector<std::string> bubble_choice(C const& choice) {
    std::vector<std::string> broken;
    if constexpr (requires { choice.validate(); }) {
        try {
            choice.validate();
        } catch (invalid_input const& e) {
            broken.push_back(std::string("the choice passes its own validate(); it says: ") + e.what());
            return broken;
        }
    }
    std::size_t const n = choice.stencils().size();
    if (n == 0 || n > 65536) {
        broken.push_back("a choice has 1 .. 65536 bubbles; got " + std::to_string(n));
        return broken;
    }
    C const copy(choice);
    bool pure = copy.stencils().size() == n;
    bool below = true;
    for (std::uint64_t k = 0; k < 4000; ++k) {
        stream random(19, stage::user, k);
        double const scale = std::ldexp(1.0, static_cast<int>(random.index_below(40)) - 10);
        double const x = random.uniform(-scale, scale);
        double const y = random.uniform(-scale, scale);
        double const z = random.uniform(-scale, scale);
        vec3 const p = k == 0 ? vec3{0, 0, 0} : vec3{x, y, z};
        std::size_t const chosen = choice.choose(p);
        below = below && chosen < n;
        pure = pure && choice.choose(p) == chosen && copy.choose(p) == chosen;
    }
    if (!pure) broken.push_back("a choice is pure: equal questions get equal answers");
    if (!below) broken.push_back("choose answers an index of one of the bubbles");
    return broken;
}

/// Rate: finite and >= 0 on [0, 1], equal answers to equal questions and from copies; it passes its own `validate`.
/// O(samples).
template <rate_function F>
[[nodiscard]] std::vector<std::string> rate(F const& f, int samples = 1024) {
    std::vector<std::string> broken;
    if constexpr (requires { f.validate(); }) {
        try {
            f.validate();
        } catch (invalid_input const& e) {
            broken.push_back(std::string("the rate passes its own validate(); it says: ") + e.what());
        }
    }
    F const copy(f);
    std::vector<double> first;
    bool finite = true;
    bool positive = true;
    for (int k = 0; k <= samples; ++k) {
        first.push_back(f(double(k) / samples));
        finite = finite && std::isfinite(first.back());
        positive = positive && !(first.back() < 0);
    }
    bool pure = true;
    for (int k = samples; k >= 0 && finite; --k) {  // again, from the other end
        double const c = double(k) / samples;
        double const r = first[static_cast<std::size_t>(k)];
        pure = pure && f(c) == r && copy(c) == r;
    }
    if (!finite) broken.push_back("a rate is finite for every share of air in [0, 1]");
    if (!positive) broken.push_back("a rate is not negative");
    if (!pure) broken.push_back("a rate is pure: equal questions get equal answers");
    return broken;
}

}  // namespace tafoni::laws

#endif
