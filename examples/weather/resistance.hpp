// --resistance SPEC: how hard the rock is where.
#pragma once

#include "spec.hpp"

#include <tafoni/geometry/solid.hpp>

#include <cstdint>
#include <functional>

namespace weather {

/// A field chosen at run time. It is read once per link, so the indirection costs nothing per path.
using any_field = std::function<double(tafoni::vec3 const&)>;

/// What `--resistance` says, in [0, 1] everywhere. Names: constant, layers, sine, ramp, pockets, noise, grid.
/// `up` is the direction against gravity. Lengths are in the unit of the model.
any_field make_resistance(std::string const& text, tafoni::solid const& body, tafoni::vec3 const& up,
                          std::uint64_t seed);

}  // namespace weather
