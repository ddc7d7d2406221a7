/// \file
/// Exposure by air: open is what air reaches from outside.
#ifndef TAFONI_GRAPH_AIR_FLOOD_HPP
#define TAFONI_GRAPH_AIR_FLOOD_HPP

#include <tafoni/graph/exposure.hpp>

#include <cstdint>

namespace tafoni {

/// A link is skin if air from outside touches its rock; closed air pockets count once they are reached.
///
/// Air passes between cells across any link whose cells are both air, and from outside through every
/// exterior link of an air cell; artificial skin lets none in. The states depend on the cells' states
/// only, not on their history. Models `exposure_policy`.
struct air_flood {
    struct state {
        std::vector<std::uint8_t> open{};        ///< per cell: 1 = air with a way out
        std::vector<std::uint32_t> queue{};      ///< scratch
        exposure_log log{};                      ///< scratch
    };

    /// O(cells + links).
    template <link_network Network>
    [[nodiscard]] state start(Network const& n, std::span<cell_state const> cells, std::span<link_state> links) const {
        detail::require_states(n, cells, links);
        state s;
        s.open.assign(n.cell_count(), 0);
        for (std::size_t l = 0; l < n.link_count(); ++l) {
            link_index const link{l};
            if (!n.has_link(link)) continue;
            set(n, cells, s, links, link);
        }
        std::vector<cell_index> air;
        for (std::size_t c = 0; c < cells.size(); ++c) {
            if (cells[c] == cell_state::air) air.push_back(cell_index{c});
        }
        exposure_change ignored;
        update(n, cells, air, s, links, ignored);
        return s;
    }

    /// O(links of the fallen cells and of the pockets that they open).
    template <link_network Network>
    void update(Network const& n, std::span<cell_state const> cells, std::span<cell_index const> fallen, state& s,
                std::span<link_state> links, exposure_change& change) const {
        for (cell_index const c : fallen) {
            if (s.open[c.value] == 0 && is_reached(n, s, c)) open(n, cells, s, c);
        }
        for (std::size_t head = 0; head < s.queue.size(); ++head) touch_all(n, cells, s, links, cell_index{s.queue[head]});
        s.queue.clear();
        for (cell_index const c : fallen) touch_all(n, cells, s, links, c);
        s.log.finish(links, change);
    }

private:
    template <class Network>
    static bool is_reached(Network const& n, state const& s, cell_index c) {
        bool reached = false;
        n.for_each_cell_link(c, [&](link_index l) {
            auto const ends = n.link_cells(l);
            if (!ends[1].valid()) {
                reached = true;
            } else if (s.open[ends[0].value] != 0 || s.open[ends[1].value] != 0) {
                reached = true;
            }
        });
        return reached;
    }

    /// Opens a cell and all air that hangs together with it.
    template <class Network>
    static void open(Network const& n, std::span<cell_state const> cells, state& s, cell_index first) {
        std::size_t head = s.queue.size();
        s.open[first.value] = 1;
        s.queue.push_back(first.value);
        for (; head < s.queue.size(); ++head) {
            cell_index const c{s.queue[head]};
            n.for_each_cell_link(c, [&](link_index l) {
                auto const ends = n.link_cells(l);
                cell_index const other = ends[0] == c ? ends[1] : ends[0];
                if (!other.valid() || s.open[other.value] != 0 || cells[other.value] != cell_state::air) return;
                s.open[other.value] = 1;
                s.queue.push_back(other.value);
            });
        }
    }

    template <class Network>
    static void touch_all(Network const& n, std::span<cell_state const> cells, state& s, std::span<link_state> links,
                          cell_index c) {
        n.for_each_cell_link(c, [&](link_index l) {
            s.log.touch(l, links[l.value]);
            set(n, cells, s, links, l);
        });
    }

    template <class Network>
    static void set(Network const& n, std::span<cell_state const> cells, state const& s, std::span<link_state> links,
                    link_index l) {
        auto const ends = n.link_cells(l);
        int const solid = solid_sides(n, cells, l);
        link_state& state_of = links[l.value];
        if (solid == 2) {
            if (state_of != link_state::broken) state_of = link_state::bonded;
        } else if (solid == 0) {
            state_of = link_state::gone;
        } else {
            bool const open = !ends[1].valid() || s.open[ends[0].value] != 0 || s.open[ends[1].value] != 0;
            state_of = open ? link_state::skin : link_state::pocket;
        }
    }
};

static_assert(exposure_policy<air_flood>);

}  // namespace tafoni

#endif
