#include "nrrd.hpp"

#include "input.hpp"

#include <tafoni/io/read_nrrd.hpp>

#include <utility>

namespace weather {

nrrd_volume read_nrrd(std::string const& path) {
    tafoni::sample_volume volume = tafoni::read_nrrd(load_bytes(path), path);
    return {.samples = std::move(volume.samples),
            .size = volume.frame.size,
            .origin = volume.frame.centre({0, 0, 0}),
            .spacing = volume.frame.spacing,
            .placed = volume.placed};
}

}  // namespace weather
