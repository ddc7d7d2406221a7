// --durability and --noise: how long a voxel lasts, in the user's space.
#pragma once

#include "voxel_rules.hpp"

namespace weather {

/// A field in steps per per cent of a voxel at a rate of 1; never below 1e-3. `text` is a SPEC (constant, profile,
/// layers, grid) or the name of a file that `read_durability` reads; `noise` is empty or a SPEC.
any_field make_durability(std::string const& text, std::string const& noise, height_range const& rock,
                          tafoni::box3 const& bounds, std::uint64_t seed);

}  // namespace weather
