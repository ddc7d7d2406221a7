/// \file
/// Which air cells the outside reaches, kept up while cells fall.
#ifndef TAFONI_WEATHERING_DETAIL_AIR_FLOOD_HPP
#define TAFONI_WEATHERING_DETAIL_AIR_FLOOD_HPP

#include <tafoni/graph/concepts.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// Flood fill through air from outside. An air cell is open when it has skin or an open neighbour.
template <class Network>
class air_flood {
public:
    /// O(cells x links).
    void rebuild(Network const& network, std::span<cell_state const> cells) {
        open_.assign(cells.size(), 0);
        for (std::size_t c = 0; c < cells.size(); ++c) {
            if (cells[c] == cell_state::air) grow(network, cells, cell_index{c}, [](cell_index) {});
        }
    }

    [[nodiscard]] bool open(cell_index c) const noexcept { return open_[c.value] != 0; }

    /// `fallen` are air now; calls opened(c) for every air cell that the outside reaches since.
    /// O(newly open cells x links).
    template <class F>
    void fell(Network const& network, std::span<cell_state const> cells, std::span<cell_index const> fallen,
              F const& opened) {
        for (cell_index const c : fallen) grow(network, cells, c, opened);
    }

private:
    template <class F>
    void grow(Network const& network, std::span<cell_state const> cells, cell_index from, F const& opened) {
        if (open_[from.value] != 0) return;
        bool reached = false;
        network.for_each_cell_link(from, [&](link_index l) {
            auto const ends = network.link_cells(l);
            if (!ends[1].valid()) {
                reached = true;
            } else {
                cell_index const other = ends[0] == from ? ends[1] : ends[0];
                if (open_[other.value] != 0) reached = true;
            }
        });
        if (!reached) return;
        open_[from.value] = 1;
        queue_.assign(1, from);
        while (!queue_.empty()) {
            cell_index const at = queue_.back();
            queue_.pop_back();
            opened(at);
            network.for_each_cell_link(at, [&](link_index l) {
                auto const ends = network.link_cells(l);
                if (!ends[1].valid()) return;
                cell_index const other = ends[0] == at ? ends[1] : ends[0];
                if (cells[other.value] != cell_state::air || open_[other.value] != 0) return;
                open_[other.value] = 1;
                queue_.push_back(other);
            });
        }
    }

    std::vector<std::uint8_t> open_{};
    std::vector<cell_index> queue_{};
};

}  // namespace tafoni::detail

#endif
