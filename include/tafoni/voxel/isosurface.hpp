/// \file
/// Where a sampled field takes a value, as a closed surface.
#ifndef TAFONI_VOXEL_ISOSURFACE_HPP
#define TAFONI_VOXEL_ISOSURFACE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/executor.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/field/concepts.hpp>
#include <tafoni/field/grid_field.hpp>
#include <tafoni/geometry/indexed_mesh.hpp>
#include <tafoni/voxel/detail/isosurface_slabs.hpp>
#include <tafoni/voxel/grid_frame.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tafoni {

/// What happens where the inside reaches the outermost samples.
enum class isosurface_border : std::uint8_t {
    closed,  ///< a lid in the plane of the outermost samples
    open     ///< the surface ends there
};

struct isosurface_options {
    isosurface_border border = isosurface_border::closed;
};

namespace detail {

struct isosurface_fn {
    /// Marching cubes with linear interpolation: inside is where a sample is >= `iso`, and triangles are counter-clockwise seen
    /// from below `iso`. A closed, oriented 2-manifold for every input (with an open border: one with boundary
    /// on the sides only). Where a sample equals `iso`, and at the rim of a lid, edges may have no length; their ends
    /// are still two vertices. Empty where no sample, or with an open border every sample, is inside.
    /// The same bits for every executor and compiler. O(samples / 64 + surface); memory: the surface and two planes.
    /// \throws invalid_input  attribute_length, size_overflow, bad_parameter as `grid_field::validate`; the lowest
    ///         sample that is not finite, by its index and place; bad_parameter for an `iso` that is not finite.
    template <class Sample, executor E = inline_executor>
    [[nodiscard]] indexed_mesh operator()(grid_field<Sample> const& samples, double iso,
                                          isosurface_options const& options = {}, E const& exec = {}) const {
        check_shape(samples);
        node_lattice const at{.size = samples.size, .origin = samples.origin, .spacing = samples.spacing,
                              .pad = options.border == isosurface_border::closed ? std::size_t{1} : std::size_t{0}};
        std::size_t const plane_size = samples.size[0] * samples.size[1];
        return extract<Sample>(at, iso, exec, [&](std::size_t k, std::vector<Sample>&) {
            return samples.samples.data() + plane_size * k;
        });
    }

    /// The same for a field, asked once (with threads: up to twice) at the centre of every voxel of `nodes`. O(nodes) calls.
    template <scalar_field F, executor E = inline_executor>
    [[nodiscard]] indexed_mesh operator()(F const& field, grid_frame const& nodes, double iso,
                                          isosurface_options const& options = {}, E const& exec = {}) const {
        nodes.validate();
        node_lattice const at{.size = nodes.size, .origin = nodes.centre({0, 0, 0}), .spacing = nodes.spacing,
                              .pad = options.border == isosurface_border::closed ? std::size_t{1} : std::size_t{0}};
        return extract<double>(at, iso, exec, [&](std::size_t k, std::vector<double>& buffer) {
            buffer.resize(nodes.size[0] * nodes.size[1]);
            std::size_t n = 0;
            for (std::size_t j = 0; j < nodes.size[1]; ++j) {
                for (std::size_t i = 0; i < nodes.size[0]; ++i) {
                    buffer[n++] = field(nodes.centre({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j),
                                                      static_cast<std::int32_t>(k)}));
                }
            }
            return static_cast<double const*>(buffer.data());
        });
    }

private:
    /// All that `validate` asks for but the samples, which are read once only.
    template <class Sample>
    static void check_shape(grid_field<Sample> const& f) {
        grid_frame frame;
        std::string const got = std::to_string(f.size[0]) + " x " + std::to_string(f.size[1]) + " x " + std::to_string(f.size[2]);
        frame.size = f.size;
        frame.spacing = f.spacing;
        frame.origin = f.origin;
        frame.validate();
        if (f.samples.size() != frame.voxel_count()) {
            fail<invalid_input>(errc::attribute_length,
                                "isosurface: got " + std::to_string(f.samples.size()) + " samples for a grid of " + got,
                                {.kind = entity::parameter, .value = static_cast<double>(f.samples.size()),
                                 .limit = static_cast<double>(frame.voxel_count())});
        }
    }

    template <class Sample, class E, class Plane>
    static indexed_mesh extract(node_lattice const& at, double iso, E const& exec, Plane const& plane) {
        if (!std::isfinite(iso)) {
            fail<invalid_input>(errc::bad_parameter, "isosurface: iso is not finite", {.kind = entity::parameter, .value = iso});
        }
        require_indexable("isosurface: nodes of a plane", 8 * at.nodes(0) * at.nodes(1));
        indexed_mesh out;
        std::size_t const layers = at.layers();
        // Parts give what one walk through all layers gives: the numbers of vertices go on where the part before ends.
        std::size_t const parts = exec.thread_count() <= 1 ? 1 : 4 * exec.thread_count();
        std::size_t const grain = (layers + parts - 1) / parts;
        std::vector<surface_slab> slabs(grain == 0 ? 0 : (layers + grain - 1) / grain);
        exec.for_blocks(layers, grain, [&](std::size_t begin, std::size_t end) {
            slabs[begin / grain] = slab_walk<Sample, Plane>(at, iso, plane).walk(begin, end);
        });
        join(slabs, out);
        return out;
    }

    static void join(std::vector<surface_slab>& slabs, indexed_mesh& out) {
        std::size_t vertices = 0;
        std::size_t corners = 0;
        for (auto const& s : slabs) {
            vertices += s.positions.size();
            corners += s.corners.size();
        }
        require_indexable("isosurface", vertices);
        require_indexable("isosurface", corners);
        if (slabs.size() == 1) {
            out.positions = std::move(slabs[0].positions);
            out.corners = std::move(slabs[0].corners);
        } else {
            out.positions.reserve(vertices);
            out.corners.reserve(corners);
            for (auto& s : slabs) {
                auto const first = static_cast<std::uint32_t>(out.positions.size());
                out.positions.insert(out.positions.end(), s.positions.begin(), s.positions.end());
                for (std::uint32_t const c : s.corners) out.corners.push_back(first + c);
                s = {};
            }
        }
        out.offsets.resize(corners / 3 + 1);
        for (std::size_t t = 0; t < out.offsets.size(); ++t) out.offsets[t] = 3 * t;
    }
};

}  // namespace detail

/// Extracts a surface from samples or a field; see `detail::isosurface_fn`.
inline constexpr detail::isosurface_fn isosurface{};

}  // namespace tafoni

#endif
