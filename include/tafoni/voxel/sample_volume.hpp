/// \file
/// A box of numbers, such as the densities of a scan.
#ifndef TAFONI_VOXEL_SAMPLE_VOLUME_HPP
#define TAFONI_VOXEL_SAMPLE_VOLUME_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/voxel/grid_frame.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace tafoni {

/// One number per voxel of a frame, at its centre.
struct sample_volume {
    grid_frame frame{};
    std::vector<float> samples{};  ///< x runs fastest, then y, then z
    bool placed = false;           ///< whether its source said where it lies, not only how large it is

    [[nodiscard]] float at(std::size_t i, std::size_t j, std::size_t k) const noexcept {
        return samples[i + frame.size[0] * (j + frame.size[1] * k)];
    }

    /// \throws invalid_input  as `grid_frame::validate`; `attribute_length` when samples are not one per voxel.
    void validate() const {
        frame.validate();
        if (samples.size() != frame.voxel_count()) {
            detail::fail<invalid_input>(errc::attribute_length,
                                        "sample_volume: got " + std::to_string(samples.size()) + " samples for " +
                                            std::to_string(frame.voxel_count()) + " voxels",
                                        {.kind = entity::attribute,
                                         .value = static_cast<double>(samples.size()),
                                         .limit = static_cast<double>(frame.voxel_count())});
        }
    }
};

}  // namespace tafoni

#endif
