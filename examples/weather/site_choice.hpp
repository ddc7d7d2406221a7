// --sites: where the shards grow from.
#pragma once

#include <tafoni/geometry/solid.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace weather {

/// What `--sites` says: random, surface, grid, hex, slabs, poisson, vertices (each may carry a SPEC's
/// keys), or a file of points. `count` is about how many shards are wanted.
std::vector<tafoni::vec3> choose_sites(std::string const& text, tafoni::solid const& body, std::size_t count,
                                       double jitter, tafoni::vec3 const& up, std::uint64_t seed);

}  // namespace weather
