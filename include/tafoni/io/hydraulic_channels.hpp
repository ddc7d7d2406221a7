/// \file
/// The numbers of a mesh under water as channels that the writers of PLY and VTP store.
#ifndef TAFONI_IO_HYDRAULIC_CHANNELS_HPP
#define TAFONI_IO_HYDRAULIC_CHANNELS_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/curvature/concepts.hpp>
#include <tafoni/curvature/estimate_curvature.hpp>
#include <tafoni/curvature/tensor_fit.hpp>
#include <tafoni/io/mesh_file.hpp>
#include <tafoni/weathering/hydraulic_run.hpp>

#include <utility>

namespace tafoni {

/// Vertex channels of `run.surface()`, all float32: curvature, in 1 / length unit, by `estimator`; wear, in length units, the
/// way that each vertex has moved; flow, the number of contacts with particles; sediment, the volume laid down less that
/// taken, in cubed length units: `write_ply("wet.ply", run.surface(), channels_of(run))`.
/// O(vertices + faces) beside the estimator's own cost; equal for every executor.
/// \throws  as `estimate_curvature`.
template <class Process, class Fluid, curvature_estimator Estimator = tensor_fit, executor Executor = inline_executor>
[[nodiscard]] mesh_attributes channels_of(hydraulic_run<Process, Fluid> const& run, Estimator const& estimator = {},
                                          Executor const& threads = {}) {
    mesh_attributes out;
    auto const add = [&out](char const* name, auto const& numbers) {
        mesh_channel channel{.name = name, .type = channel_type::float32};
        channel.values.reserve(numbers.size());
        for (auto const& x : numbers) channel.values.push_back(static_cast<double>(x));
        out.vertex_channels.push_back(std::move(channel));
    };
    add("curvature", estimate_curvature(run.surface(), estimator, threads));
    add("wear", run.wear());
    add("flow", run.flow());
    add("sediment", run.sediment());
    return out;
}

}  // namespace tafoni

#endif
