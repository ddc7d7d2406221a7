/// \file
/// Fills a grid of voxels with a model of a MagicaVoxel file.
#ifndef TAFONI_IO_FILL_FROM_VOX_HPP
#define TAFONI_IO_FILL_FROM_VOX_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/io/vox_file.hpp>
#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/voxel.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

namespace tafoni {

namespace detail {

struct fill_from_vox_fn {
    /// Voxel (i, j, k) of the model becomes state_of(colour) at (i, j, k) of the grid, all others air; colour 0 is
    /// air. Returns the voxels that the model names, those named twice counted twice. O(voxels of the grid).
    /// \throws invalid_input  `bad_count` when the grid has another size, `out_of_range` for a voxel outside it.
    template <editable_voxel_grid G, class StateOf>
        requires std::is_invocable_r_v<voxel_state, StateOf const&, std::uint8_t>
    std::size_t operator()(G& grid, vox_model const& model, StateOf const& state_of) const {
        using access = grid_access<G>;
        std::array<std::size_t, 3> const size = access::size(grid);
        for (std::size_t d = 0; d < 3; ++d) {
            if (size[d] == model.size[d]) continue;
            fail<invalid_input>(errc::bad_count,
                                std::string("fill_from_vox: the grid has ") + std::to_string(size[d]) + " voxels along " +
                                    "xyz"[d] + ", the model " + std::to_string(model.size[d]),
                                {.kind = entity::parameter,
                                 .value = static_cast<double>(size[d]),
                                 .limit = static_cast<double>(model.size[d])});
        }
        for (std::size_t v = 0; v < model.voxels.size(); ++v) {
            vox_voxel const& at = model.voxels[v];
            if (at.x < size[0] && at.y < size[1] && at.z < size[2]) continue;
            fail<invalid_input>(errc::out_of_range, "fill_from_vox: voxel " + std::to_string(v) + " lies outside the model",
                                {.kind = entity::voxel, .index = v});
        }
        for (std::size_t k = 0; k < size[2]; ++k) {
            for (std::size_t j = 0; j < size[1]; ++j) {
                for (std::size_t i = 0; i < size[0]; ++i) access::set(grid, i, j, k, voxel_state::air);
            }
        }
        for (vox_voxel const& at : model.voxels) {
            access::set(grid, at.x, at.y, at.z, at.colour == 0 ? voxel_state::air : state_of(at.colour));
        }
        return model.voxels.size();
    }

    /// Rock wherever the model has a colour.
    template <editable_voxel_grid G>
    std::size_t operator()(G& grid, vox_model const& model) const {
        return (*this)(grid, model, [](std::uint8_t) { return voxel_state::rock; });
    }
};

}  // namespace detail

/// `fill_from_vox(grid, model, state_of)`; see `detail::fill_from_vox_fn`.
inline constexpr detail::fill_from_vox_fn fill_from_vox{};

}  // namespace tafoni

#endif
