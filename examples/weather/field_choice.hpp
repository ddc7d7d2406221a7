// Parameters of the processes on meshes that may differ from place to place.
#pragma once

#include <tafoni/field/any_field.hpp>

#include <cstdint>
#include <string>

namespace weather {

/// What a field is laid out over.
struct field_frame {
    tafoni::box3 bounds;
    tafoni::vec3 up{0, 0, 1};
    std::uint64_t seed = 0;
};

/// A number, a SPEC (constant, layers, ramp, noise, grid) or a file of altitudes as `read_durability` reads it.
/// Values lie in [least, most]. `option` is named in messages.
tafoni::any_field make_field(std::string const& option, std::string const& text, double least, double most, field_frame const& frame);

}  // namespace weather
