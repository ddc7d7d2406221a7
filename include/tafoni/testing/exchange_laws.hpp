/// \file
/// Law checks for rules of what water takes from rock and lays down.
#ifndef TAFONI_TESTING_EXCHANGE_LAWS_HPP
#define TAFONI_TESTING_EXCHANGE_LAWS_HPP

#include <tafoni/weathering/hydraulic_erosion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace tafoni::laws {

/// Exchange rule: what the concept's comment asks for, for water that stands, flows, falls, is at the face, behind it and at
/// its reach. `reach`: of a particle, length unit. Returns the broken laws.
template <exchange_rule Rule>
[[nodiscard]] std::vector<std::string> exchange(Rule const& rule, double reach = 0.05) {
    std::vector<std::string> broken;
    auto const law = [&](bool holds, char const* what) {
        if (!holds && std::find(broken.begin(), broken.end(), what) == broken.end()) broken.push_back(what);
    };
    auto const same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
    Rule const copy(rule);
    for (vec3 const& normal : {vec3{0, 0, 1}, vec3{0.6, 0, 0.8}, vec3{0, -1, 0}}) {
        for (vec3 const& velocity : {vec3{0, 0, 0}, vec3{1, 0, 0}, vec3{-0.01, 0.02, 0}, vec3{0, 0, -30}, vec3{300, 200, 10}}) {
            for (double const distance : {-1.0, -0.5, 0.0, 1e-9, 0.1, 0.5, 1.0}) {
                wash_point const at{.position = {1, 2, 3}, .velocity = velocity, .normal = normal, .distance = distance * reach, .reach = reach};
                double const rate = rule.rate(at);
                law(std::isfinite(rate), "rates are finite");
                law(same(rule.rate(at), rate), "pure: equal questions get equal answers");
                law(same(copy.rate(at), rate), "a copy answers as the original");
            }
        }
    }
    return broken;
}

}  // namespace tafoni::laws

#endif
