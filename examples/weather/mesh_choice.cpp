#include "mesh_choice.hpp"

namespace weather {

using namespace tafoni;

any_estimator parse_estimator(std::string const& name) {
    any_estimator out;
    if (name == "cotangent") out.which = any_estimator::kind::cotangent;
    if (name == "quadric") out.which = any_estimator::kind::quadric;
    if (name == "bubble") out.which = any_estimator::kind::bubble;
    return out;
}

vec3 parse_up(std::string const& name) {
    vec3 up{0, 0, 0};
    up[name.back() - 'x'] = name.front() == '-' ? -1.0 : 1.0;
    return up;
}

}  // namespace weather
