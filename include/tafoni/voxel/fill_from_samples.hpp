/// \file
/// Fills a grid of voxels from samples, such as the densities of a scan.
#ifndef TAFONI_VOXEL_FILL_FROM_SAMPLES_HPP
#define TAFONI_VOXEL_FILL_FROM_SAMPLES_HPP

#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/detail/fill_bricks.hpp>
#include <tafoni/voxel/sample_volume.hpp>

#include <concepts>
#include <cstddef>
#include <string>

namespace tafoni {

namespace detail {

struct fill_from_samples_fn {
    /// Rock where is_rock(sample) is true, air elsewhere; one sample per voxel, in the user's axes, wherever the
    /// frames lie. Returns the voxels of rock. O(voxels).
    /// \throws invalid_input  as `sample_volume::validate`; `bad_count` when the grid has another size.
    template <editable_voxel_grid G, class IsRock>
        requires std::predicate<IsRock const&, float>
    std::size_t operator()(G& grid, sample_volume const& volume, IsRock const& is_rock) const {
        volume.validate();
        grid_frame const frame = frame_of(grid);
        frame.validate();
        for (std::size_t d = 0; d < 3; ++d) {
            if (frame.size[d] == volume.frame.size[d]) continue;
            fail<invalid_input>(errc::bad_count,
                                std::string("fill_from_samples: the grid has ") + std::to_string(frame.size[d]) +
                                    " voxels along " + "xyz"[d] + ", the volume " + std::to_string(volume.frame.size[d]),
                                {.kind = entity::parameter,
                                 .value = static_cast<double>(frame.size[d]),
                                 .limit = static_cast<double>(volume.frame.size[d])});
        }
        return fill_voxels(grid, [&](voxel v) -> bool {
            return is_rock(volume.at(static_cast<std::size_t>(v.x), static_cast<std::size_t>(v.y), static_cast<std::size_t>(v.z)));
        });
    }

    /// Rock from the sample `least` on; NaN is air.
    template <editable_voxel_grid G>
    std::size_t operator()(G& grid, sample_volume const& volume, float least) const {
        return (*this)(grid, volume, [least](float s) { return s >= least; });
    }
};

}  // namespace detail

/// `fill_from_samples(grid, volume, is_rock)` or `fill_from_samples(grid, volume, least)`.
inline constexpr detail::fill_from_samples_fn fill_from_samples{};

}  // namespace tafoni

#endif
