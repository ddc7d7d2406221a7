/// \file
/// The cubes that a model is cut into.
#ifndef TAFONI_VOXEL_FRAME_FOR_HPP
#define TAFONI_VOXEL_FRAME_FOR_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/voxel/grid_frame.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace tafoni {

namespace detail {

struct frame_for_fn {
    /// Cubes over a box: its longest side takes `resolution` voxels, the others as many as cover them, with the
    /// box in the middle; `padding` more voxels on each side -x, +x, -y, +y, -z, +z.
    ///
    /// One voxel of padding keeps rock off the border, which closes its surface and lets air reach it from
    /// all sides; a statue that stands on the ground takes none at its base. \throws invalid_input
    /// `empty_input` for an empty or flat box, `bad_parameter`, `out_of_range` for a box that is not finite,
    /// `size_overflow` beyond 2^20 voxels along a side.
    [[nodiscard]] grid_frame operator()(box3 const& bounds, std::size_t resolution,
                                        std::array<std::size_t, 6> const& padding) const {
        if (bounds.empty()) fail<invalid_input>(errc::empty_input, "frame_for: the box is empty");
        require_range("frame_for: resolution", static_cast<double>(resolution), 1, static_cast<double>(grid_frame::longest));
        vec3 const extent = bounds.extent();
        double const longest = std::max({extent[0], extent[1], extent[2]});
        if (!(longest < 1e150) || !(std::fabs(bounds.lo[0]) < 1e150) || !(std::fabs(bounds.lo[1]) < 1e150) ||
            !(std::fabs(bounds.lo[2]) < 1e150)) {
            fail<invalid_input>(errc::out_of_range, "frame_for: the box reaches beyond 1e150",
                                {.kind = entity::parameter, .value = longest, .limit = 1e150});
        }
        double const edge = longest / static_cast<double>(resolution);
        if (!(edge >= std::numeric_limits<double>::min())) {
            fail<invalid_input>(errc::empty_input, "frame_for: the box has no extent",
                                {.kind = entity::parameter, .value = longest});
        }
        grid_frame frame{.spacing = {edge, edge, edge}};
        for (std::size_t d = 0; d < 3; ++d) {
            auto const a = static_cast<Eigen::Index>(d);
            // The rounding of a quotient must not add a layer to the longest side or to another one as long.
            double const covers = std::ceil(extent[a] / edge * (1 - 0x1p-40));
            double const voxels = std::clamp(covers, 1.0, static_cast<double>(resolution));
            std::array<std::size_t, 2> const pad{padding[2 * d], padding[2 * d + 1]};
            for (std::size_t const p : pad) {
                require_range("frame_for: padding", static_cast<double>(p), 0, static_cast<double>(grid_frame::longest));
            }
            frame.size[d] = static_cast<std::size_t>(voxels) + pad[0] + pad[1];
            frame.origin[a] = bounds.lo[a] - 0.5 * (voxels * edge - extent[a]) - static_cast<double>(pad[0]) * edge;
        }
        frame.validate();
        return frame;
    }

    /// The same padding on all sides.
    [[nodiscard]] grid_frame operator()(box3 const& bounds, std::size_t resolution, std::size_t padding = 1) const {
        return (*this)(bounds, resolution, {padding, padding, padding, padding, padding, padding});
    }
};

}  // namespace detail

/// `frame_for(bounds, resolution, padding)`; see `detail::frame_for_fn`.
inline constexpr detail::frame_for_fn frame_for{};

}  // namespace tafoni

#endif
