/// \file
/// What a voxel run has left, as two closed surfaces with numbers to colour them by.
#ifndef TAFONI_WEATHERING_WEATHERED_VOXELS_HPP
#define TAFONI_WEATHERING_WEATHERED_VOXELS_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/voxel/voxel_surface.hpp>
#include <tafoni/weathering/voxel_run.hpp>

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace tafoni {

/// Numbers of the voxels that vertices stand for; all arrays parallel to the mesh's positions.
struct voxel_attributes {
    std::vector<double> curvature{};   ///< `voxel_run::curvature`, in [-1, 1]: > 0 on what protrudes
    std::vector<double> durability{};
    std::vector<double> decimation{};  ///< per cent that are left, <= 100
    /// What cavernous weathering will take, as the paper shows it beforehand: the negative part of the curvature
    /// times durability, >= 0 [Jones et al., section 6.2, Figure 16].
    std::vector<double> cavernous{};
};

/// The rock and the colluvium after some steps.
struct weathered_voxels {
    voxel_surface surface{};
    voxel_attributes rock{};
    voxel_attributes colluvium{};
};

namespace detail {

struct extract_weathered_voxels_fn {
    /// Owns everything; the same bits for every executor. O(surface of `extract_voxel_surface` + vertices log skin;
    /// vertices where rock and colluvium touch cost a bubble each).
    /// \throws invalid_input  as `extract_voxel_surface`
    template <class Process, executor Executor = inline_executor>
    [[nodiscard]] weathered_voxels operator()(voxel_run<Process> const& run, voxel_surface_options const& options = {},
                                              Executor const& threads = {}) const {
        weathered_voxels out;
        out.surface = extract_voxel_surface(run.grid(), options, threads);
        out.rock = attributes(run, out.surface.rock.vertex_voxel, threads);
        out.colluvium = attributes(run, out.surface.colluvium.vertex_voxel, threads);
        return out;
    }

private:
    template <class Process, class Executor>
    static voxel_attributes attributes(voxel_run<Process> const& run, std::span<voxel const> voxels,
                                       Executor const& threads) {
        voxel_attributes out;
        for (auto* values : {&out.curvature, &out.durability, &out.decimation, &out.cavernous}) values->resize(voxels.size());
        threads.for_blocks(voxels.size(), 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                skin_voxel const v = run.look(voxels[i]);
                double const curvature = run.curvature(v);
                out.curvature[i] = curvature;
                out.durability[i] = v.durability;
                out.decimation[i] = v.decimation;
                out.cavernous[i] = (curvature < 0 ? -curvature : 0) * v.durability;
            }
        });
        return out;
    }
};

}  // namespace detail

/// Extracts the surfaces of a `voxel_run` with their attributes; see `detail::extract_weathered_voxels_fn`.
inline constexpr detail::extract_weathered_voxels_fn extract_weathered_voxels{};

}  // namespace tafoni

#endif
