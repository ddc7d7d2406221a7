/// \file
/// What a run has left standing, as a closed surface with numbers to colour it by.
#ifndef TAFONI_WEATHERING_WEATHERED_SURFACE_HPP
#define TAFONI_WEATHERING_WEATHERED_SURFACE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/decomposition/shard_surface.hpp>
#include <tafoni/graph/concepts.hpp>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tafoni {

/// The rock after a run. All arrays are per triangle, parallel to `surface.mesh`; which shard a triangle
/// bounds and whether frost laid it open stand in `surface.cell` and `surface.fresh`.
struct weathered_surface {
    shard_surface surface{};              ///< closed 2-manifold around all cells that are not air
    std::vector<double> life{};           ///< in [0, 1]; laid open: what the bond had left; the input's skin has no bond: `hold`
    std::vector<double> hold{};           ///< in [0, 1]; mean life of the shard's bonds by area: how firmly it sits; without bonds 1
    std::vector<std::uint8_t> exposed{};  ///< 1 = the outside reaches it; 0 = in a closed pocket, or a face without a link
};

namespace detail {

struct extract_weathered_surface_fn {
    /// The surface of what stands in `run`, a `frost_run` over `make_link_graph(complex)` or any run whose
    /// network knows the links of faces. Owns everything. O(faces + links + n log n) for n triangles.
    /// \throws invalid_input  attribute_length, bad_parameter  when the run's network was not made of `complex`
    template <cell_complex C, class Run>
        requires requires(Run const& run, face_index face, link_index link) {
            { run.network().link_of(face) } -> std::same_as<link_index>;
            { run.life(link) } -> std::same_as<double>;
            { run.state(link) } -> std::same_as<link_state>;
            { run.cells() } -> std::convertible_to<std::span<cell_state const>>;
        }
    [[nodiscard]] weathered_surface operator()(C const& complex, Run const& run) const {
        std::span<cell_state const> const cells = run.cells();
        std::vector<std::uint8_t> stands(cells.size());
        for (std::size_t c = 0; c < cells.size(); ++c) stands[c] = cells[c] != cell_state::air ? 1 : 0;
        weathered_surface out;
        out.surface = extract_surface(complex, std::span<std::uint8_t const>(stands));
        std::vector<double> const hold = hold_of_cells(run, stands);
        std::size_t const n = out.surface.mesh.face_count();
        out.life.resize(n);
        out.hold.resize(n);
        out.exposed.resize(n);
        for (std::size_t t = 0; t < n; ++t) {
            cell_index const cell = out.surface.cell[t];
            link_index const link = run.network().link_of(out.surface.face[t]);
            if (link.valid()) require_end(run.network(), link, cell, out.surface.face[t]);
            out.hold[t] = hold[cell.value];
            out.life[t] = link.valid() && out.surface.fresh[t] != 0 ? run.life(link) : out.hold[t];
            out.exposed[t] = link.valid() && run.state(link) == link_state::skin ? 1 : 0;
        }
        return out;
    }

private:
    template <class Run>
    static std::vector<double> hold_of_cells(Run const& run, std::vector<std::uint8_t> const& stands) {
        auto const& network = run.network();
        std::vector<double> hold(stands.size(), 0);
        for (std::size_t c = 0; c < stands.size(); ++c) {
            if (stands[c] == 0) continue;
            double area = 0;
            double sum = 0;
            network.for_each_cell_link(cell_index{c}, [&](link_index l) {
                if (!network.link_cells(l)[1].valid()) return;
                double const a = network.link_area(l);
                area += a;
                sum += a * run.life(l);
            });
            double const mean = area > 0 ? sum / area : 1;
            hold[c] = mean < 1 ? mean : 1;
        }
        return hold;
    }

    template <class Network>
    static void require_end(Network const& network, link_index link, cell_index cell, face_index face) {
        bool const known = link.value < network.link_count();
        if (known && (network.link_cells(link)[0] == cell || network.link_cells(link)[1] == cell)) return;
        fail<invalid_input>(errc::bad_parameter,
                            "extract_weathered_surface: the run's network was made of another complex: face " +
                                std::to_string(face.value) + " bounds cell " + std::to_string(cell.value) +
                                ", its link does not",
                            {.kind = entity::face, .index = face.value});
    }
};

}  // namespace detail

/// Extracts what stands; see `detail::extract_weathered_surface_fn`.
inline constexpr detail::extract_weathered_surface_fn extract_weathered_surface{};

}  // namespace tafoni

#endif
