/// \file
/// The numbers of a wrinkled mesh as channels that the writers of PLY and VTP store.
#ifndef TAFONI_IO_WRINKLE_CHANNELS_HPP
#define TAFONI_IO_WRINKLE_CHANNELS_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/executor.hpp>
#include <tafoni/curvature/concepts.hpp>
#include <tafoni/curvature/estimate_curvature.hpp>
#include <tafoni/curvature/tensor_fit.hpp>
#include <tafoni/io/mesh_file.hpp>
#include <tafoni/weathering/wrinkles.hpp>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tafoni {

/// Vertex channels of `worn`, which `pattern.wear` or `wear_again` gave, all float32: curvature, in 1 / length unit, by
/// `estimator`; wear, in length units, the distance from `flat`, the same surface before: `pattern.wear(positions, 0)`;
/// factor, in length units, the way along the normal that the pattern asks for each time:
/// `write_ply("cracked.ply", cracked, channels_of(pattern, flat, cracked))`.
/// O(vertices + faces) beside the estimator's own cost; equal for every executor.
/// \throws invalid_input  `attribute_length` where a surface has another number of vertices than the refined pattern, and
///         as `estimate_curvature`.
template <curvature_estimator Estimator = tensor_fit, executor Executor = inline_executor>
[[nodiscard]] mesh_attributes channels_of(wrinkle_pattern const& pattern, triangle_surface const& flat, triangle_surface const& worn,
                                          Estimator const& estimator = {}, Executor const& threads = {}) {
    std::vector<double> factor(pattern.displacement().begin(), pattern.displacement().end());
    for (triangle_surface const* s : {&flat, &worn}) {
        if (s->positions.size() == factor.size()) continue;
        detail::fail<invalid_input>(errc::attribute_length,
                                    "channels_of: got a surface of " + std::to_string(s->positions.size()) + " vertices, the refined pattern has " +
                                        std::to_string(factor.size()),
                                    {.kind = entity::vertex, .value = static_cast<double>(s->positions.size()),
                                     .limit = static_cast<double>(factor.size())});
    }
    std::vector<double> wear(factor.size());
    for (std::size_t v = 0; v < wear.size(); ++v) wear[v] = length(vec3{worn.positions[v] - flat.positions[v]});
    mesh_attributes out;
    auto const add = [&out](char const* name, std::vector<double> numbers) {
        out.vertex_channels.push_back({.name = name, .values = std::move(numbers), .type = channel_type::float32});
    };
    add("curvature", estimate_curvature(worn, estimator, threads));
    add("wear", std::move(wear));
    add("factor", std::move(factor));
    return out;
}

}  // namespace tafoni

#endif
