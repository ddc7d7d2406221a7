/// \file
/// Which cells hang together by bonds, kept up while bonds break.
#ifndef TAFONI_WEATHERING_DETAIL_BOND_PARTS_HPP
#define TAFONI_WEATHERING_DETAIL_BOND_PARTS_HPP

#include <tafoni/percolation/link_table.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// Components of the bonded cells with their totals. Breaking a bond searches from both ends in turn and
/// stops when the searches meet or the smaller side is complete: O(cells of the smaller side x links).
template <class Network>
class bond_parts {
public:
    static constexpr std::uint32_t none = 0xFFFFFFFFu;

    struct totals {
        std::int64_t volume = 0;
        std::uint64_t cells = 0;
        std::uint64_t cores = 0;
        cell_index seed{};    ///< a cell of the component
        cell_index lowest{};  ///< no cell of the component lies before it
        std::uint32_t origin = none;  ///< the component that it was cut from in this batch, or itself
        bool falls = false;
    };

    /// O(cells + links).
    void rebuild(link_table<Network> const& table, std::span<cell_state const> cells,
                 std::span<std::int64_t const> volumes) {
        component_.assign(cells.size(), none);
        mark_.assign(cells.size(), 0);
        epoch_ = 0;
        parts_.clear();
        for (std::size_t c = 0; c < cells.size(); ++c) {
            if (cells[c] == cell_state::air || component_[c] != none) continue;
            auto const id = static_cast<std::uint32_t>(parts_.size());
            parts_.push_back({});
            queue_[0].assign(1, cell_index{c});
            component_[c] = id;
            totals t;
            t.seed = t.lowest = cell_index{c};
            t.origin = id;
            for (std::size_t k = 0; k < queue_[0].size(); ++k) {
                cell_index const at = queue_[0][k];
                add(t, at, cells, volumes);
                for_each_bonded(table, at, [&](cell_index n) {
                    if (component_[n.value] != none) return;
                    component_[n.value] = id;
                    queue_[0].push_back(n);
                });
            }
            parts_[id] = t;
        }
    }

    [[nodiscard]] std::uint32_t component(cell_index c) const noexcept { return component_[c.value]; }
    [[nodiscard]] totals& operator[](std::uint32_t id) noexcept { return parts_[id]; }

    /// The bond between a and b is gone (the table says so already). True when that split a component:
    /// the smaller side has a new id, which is `made`.
    bool cut(link_table<Network> const& table, cell_index a, cell_index b, std::span<cell_state const> cells,
             std::span<std::int64_t const> volumes, std::uint32_t& made) {
        if (a == b || component_[a.value] != component_[b.value]) return false;
        if (epoch_ > 0xFFFFFFF0u) {
            std::fill(mark_.begin(), mark_.end(), 0u);
            epoch_ = 0;
        }
        std::uint32_t const mine[2] = {++epoch_, ++epoch_};
        queue_[0].assign(1, a);
        queue_[1].assign(1, b);
        mark_[a.value] = mine[0];
        mark_[b.value] = mine[1];
        std::size_t next[2] = {0, 0};
        for (int side = 0;; side = 1 - side) {
            if (next[side] == queue_[side].size()) return split(side, a, b, cells, volumes, made);
            cell_index const at = queue_[side][next[side]++];
            bool met = false;
            for_each_bonded(table, at, [&](cell_index n) {
                std::uint32_t& m = mark_[n.value];
                if (m == mine[1 - side]) met = true;
                if (m == mine[side] || met) return;
                m = mine[side];
                queue_[side].push_back(n);
            });
            if (met) return false;
        }
    }

    /// All cells of component `id`, ascending. O(cells of it x links).
    std::vector<cell_index> cells_of(link_table<Network> const& table, std::uint32_t id) {
        std::vector<cell_index> found{parts_[id].seed};
        std::uint32_t const mine = ++epoch_;
        mark_[found[0].value] = mine;
        for (std::size_t k = 0; k < found.size(); ++k) {
            for_each_bonded(table, found[k], [&](cell_index n) {
                if (mark_[n.value] == mine) return;
                mark_[n.value] = mine;
                found.push_back(n);
            });
        }
        std::sort(found.begin(), found.end());
        return found;
    }

    [[nodiscard]] std::uint32_t size() const noexcept { return static_cast<std::uint32_t>(parts_.size()); }

    /// The cells of component `id` are air now.
    void drop(std::uint32_t id, std::span<cell_index const> cells) noexcept {
        parts_[id] = {};
        for (cell_index const c : cells) component_[c.value] = none;
    }

    /// What the detachment rule sees of a component.
    [[nodiscard]] part view(std::uint32_t id) {
        totals& t = parts_[id];
        while (component_[t.lowest.value] != id) ++t.lowest.value;
        return {t.volume, static_cast<std::size_t>(t.cores), t.lowest};
    }

private:
    template <class F>
    static void for_each_bonded(link_table<Network> const& table, cell_index c, F const& f) {
        table.network().for_each_cell_link(c, [&](link_index l) {
            link_record const& r = table[l];
            if (r.state == link_state::bonded) f(r.cells[0] == c ? r.cells[1] : r.cells[0]);
        });
    }

    static void add(totals& t, cell_index c, std::span<cell_state const> cells, std::span<std::int64_t const> volumes) {
        t.volume += volumes[c.value];
        ++t.cells;
        t.cores += cells[c.value] == cell_state::core ? 1u : 0u;
        if (c < t.lowest) t.lowest = c;
    }

    bool split(int side, cell_index a, cell_index b, std::span<cell_state const> cells,
               std::span<std::int64_t const> volumes, std::uint32_t& made) {
        std::uint32_t const old = component_[a.value];
        made = static_cast<std::uint32_t>(parts_.size());
        totals t;
        t.seed = t.lowest = side == 0 ? a : b;
        t.origin = parts_[old].origin;
        for (cell_index const c : queue_[side]) add(t, c, cells, volumes);
        parts_.push_back(t);
        for (cell_index const c : queue_[side]) component_[c.value] = made;
        totals& rest = parts_[old];
        rest.volume -= t.volume;
        rest.cells -= t.cells;
        rest.cores -= t.cores;
        rest.seed = side == 0 ? b : a;
        return true;
    }

    std::vector<std::uint32_t> component_{};
    std::vector<std::uint32_t> mark_{};
    std::uint32_t epoch_ = 0;
    std::vector<totals> parts_{};
    std::vector<cell_index> queue_[2]{};
};

}  // namespace tafoni::detail

#endif
