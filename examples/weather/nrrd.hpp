// Volumes in NRRD files: raw samples behind a text header.
#pragma once

#include <tafoni/core/vector.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace weather {

struct nrrd_volume {
    std::vector<float> samples;          ///< x runs fastest
    std::array<std::size_t, 3> size{};
    tafoni::vec3 origin{0, 0, 0};
    tafoni::vec3 spacing{1, 1, 1};
    bool placed = false;                 ///< the file says where it lies
};

/// Reads a volume as `tafoni::read_nrrd` does; `origin` is the place of the first sample.
/// \throws tafoni::io_error
nrrd_volume read_nrrd(std::string const& path);

}  // namespace weather
