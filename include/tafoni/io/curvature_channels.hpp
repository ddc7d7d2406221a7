/// \file
/// The numbers of a mesh that weathers by its curvature as channels that the writers of PLY and VTP store.
#ifndef TAFONI_IO_CURVATURE_CHANNELS_HPP
#define TAFONI_IO_CURVATURE_CHANNELS_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/io/mesh_file.hpp>
#include <tafoni/weathering/curvature_run.hpp>

namespace tafoni {

/// Vertex channels of `run.surface()`: curvature, in 1 / length unit, by the run's estimator, and wear, in length units,
/// the way that each vertex has moved; both float32: `write_ply("bust.ply", run.surface(), channels_of(run))`.
/// O(vertices + faces) beside the estimator's own cost; equal for every executor. \throws  what the estimator throws.
template <class Process, executor Executor = inline_executor>
[[nodiscard]] mesh_attributes channels_of(curvature_run<Process> const& run, Executor const& threads = {}) {
    mesh_attributes out;
    out.vertex_channels.push_back({.name = "curvature", .values = run.curvature(threads), .type = channel_type::float32});
    out.vertex_channels.push_back({.name = "wear", .values = run.wear(), .type = channel_type::float32});
    return out;
}

}  // namespace tafoni

#endif
