/// \file
/// Exposure by the paper's search on the links graph.
#ifndef TAFONI_GRAPH_SURFACE_WALK_HPP
#define TAFONI_GRAPH_SURFACE_WALK_HPP

#include <tafoni/graph/exposure.hpp>

#include <cstdint>

namespace tafoni {

/// Exterior links that lose their last rock are dropped; from those that remain, a breadth-first search
/// in the links graph over links between rock and air finds the new ones [Mateos et al., section 5.3].
///
/// Depends on history: where all exterior links fall at once, nothing is left to start from, and what
/// the air has laid open stays `pocket`. A search after each update from all remaining exterior links
/// finds the same; this one starts from what is new. Models `exposure_policy`.
struct surface_walk {
    struct state {
        std::vector<link_index> queue{};     ///< scratch
        std::vector<link_index> fresh{};     ///< scratch
        exposure_log log{};                  ///< scratch
    };

    /// The input's skin on rock is exterior; then as by `update`. O(links + neighbours).
    template <link_network Network>
    [[nodiscard]] state start(Network const& n, std::span<cell_state const> cells, std::span<link_state> links) const {
        detail::require_states(n, cells, links);
        state s;
        for (std::size_t l = 0; l < n.link_count(); ++l) {
            link_index const link{l};
            if (!n.has_link(link)) continue;
            if (links[l] == link_state::skin) links[l] = link_state::pocket;  // left over from another run
            set(n, cells, s, links, link);
        }
        spread(n, s, links);
        s.log = {};
        return s;
    }

    /// O(links of the fallen cells and links laid open, with their neighbours).
    template <link_network Network>
    void update(Network const& n, std::span<cell_state const> cells, std::span<cell_index const> fallen, state& s,
                std::span<link_state> links, exposure_change& change) const {
        for (cell_index const c : fallen) {
            n.for_each_cell_link(c, [&](link_index l) {
                s.log.touch(l, links[l.value]);
                set(n, cells, s, links, l);
            });
        }
        spread(n, s, links);
        s.log.finish(links, change);
    }

private:
    /// Sets a link by its cells alone; links between rock and air are a pocket until the search finds them.
    template <class Network>
    static void set(Network const& n, std::span<cell_state const> cells, state& s, std::span<link_state> links,
                    link_index l) {
        int const solid = solid_sides(n, cells, l);
        link_state& state_of = links[l.value];
        if (solid == 0) {
            state_of = link_state::gone;
        } else if (!n.link_cells(l)[1].valid()) {
            state_of = link_state::skin;
        } else if (solid == 2) {
            if (state_of != link_state::broken) state_of = link_state::bonded;
        } else if (state_of != link_state::skin) {
            state_of = link_state::pocket;
            s.fresh.push_back(l);
        }
    }

    /// Carries exposure from exterior links to the fresh links beside them, and on from there.
    template <class Network>
    static void spread(Network const& n, state& s, std::span<link_state> links) {
        for (link_index const l : s.fresh) {
            if (links[l.value] != link_state::pocket) continue;
            bool beside_skin = false;
            n.for_each_neighbor(l, [&](link_index m) { beside_skin = beside_skin || links[m.value] == link_state::skin; });
            if (beside_skin) open(n, s, links, l);
        }
        s.fresh.clear();
    }

    template <class Network>
    static void open(Network const& n, state& s, std::span<link_state> links, link_index first) {
        s.queue.assign(1, first);
        s.log.touch(first, link_state::pocket);
        links[first.value] = link_state::skin;
        for (std::size_t head = 0; head < s.queue.size(); ++head) {
            n.for_each_neighbor(s.queue[head], [&](link_index m) {
                if (links[m.value] != link_state::pocket) return;
                s.log.touch(m, link_state::pocket);
                links[m.value] = link_state::skin;
                s.queue.push_back(m);
            });
        }
    }
};

static_assert(exposure_policy<surface_walk>);

}  // namespace tafoni

#endif
