/// \file
/// Which links lie open to the outside while cells turn into air: what an exposure policy is.
#ifndef TAFONI_GRAPH_EXPOSURE_HPP
#define TAFONI_GRAPH_EXPOSURE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/graph/concepts.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace tafoni {

/// Links that changed sides in one update; each list ascending, without repetition.
struct exposure_change {
    std::vector<link_index> opened{};  ///< now `skin`, not before: rain may enter here
    std::vector<link_index> closed{};  ///< no longer `skin`
};

namespace detail {

/// The least network: what algorithms over any `link_network` are compiled with.
struct network_archetype {
    std::size_t cell_count() const;
    double cell_volume(cell_index) const;
    std::size_t link_count() const;
    bool has_link(link_index) const;
    std::array<cell_index, 2> link_cells(link_index) const;
    double link_area(link_index) const;
    vec3 link_centroid(link_index) const;
    vec3 link_normal(link_index) const;
    template <class Visit>
    void for_each_cell_link(cell_index, Visit&&) const;
    template <class Visit>
    void for_each_neighbor(link_index, Visit&&) const;
};

/// Throws unless there is a state for every cell and every link slot.
template <class Network>
void require_states(Network const& n, std::span<cell_state const> cells, std::span<link_state const> links) {
    if (cells.size() == n.cell_count() && links.size() == n.link_count()) return;
    fail<invalid_input>(errc::attribute_length,
                        "exposure: got " + std::to_string(cells.size()) + " cell and " + std::to_string(links.size()) +
                            " link states for " + std::to_string(n.cell_count()) + " cells and " +
                            std::to_string(n.link_count()) + " link slots",
                        {.kind = entity::attribute, .value = static_cast<double>(cells.size())});
}

}  // namespace detail

/// How many sides of a link are rock: 0, 1 or 2. For those who write an exposure. O(1).
template <class Network>
[[nodiscard]] int solid_sides(Network const& n, std::span<cell_state const> cells, link_index l) {
    auto const ends = n.link_cells(l);
    int const first = cells[ends[0].value] != cell_state::air ? 1 : 0;
    return first + (ends[1].valid() && cells[ends[1].value] != cell_state::air ? 1 : 0);
}

/// Turns the states before and after an update into an `exposure_change`. For those who write an exposure.
///
/// In `update`, `touch` a link before (or instead of) changing it, as often as it comes up; `finish` compares
/// what the first touch saw with what is there now. O(touched log touched).
class exposure_log {
public:
    /// Link `l` may change; it is `before` now.
    void touch(link_index l, link_state before) { touched_.push_back({l, touched_.size(), before}); }

    /// Fills `change` for the links that were touched, and forgets them.
    void finish(std::span<link_state const> links, exposure_change& change) {
        change.opened.clear();
        change.closed.clear();
        std::sort(touched_.begin(), touched_.end(), [](entry const& a, entry const& b) {
            return a.link != b.link ? a.link < b.link : a.turn < b.turn;
        });
        for (std::size_t i = 0; i < touched_.size(); ++i) {
            if (i > 0 && touched_[i].link == touched_[i - 1].link) continue;
            bool const was = touched_[i].before == link_state::skin;
            bool const is = links[touched_[i].link.value] == link_state::skin;
            if (is && !was) change.opened.push_back(touched_[i].link);
            if (was && !is) change.closed.push_back(touched_[i].link);
        }
        touched_.clear();
    }

private:
    struct entry {
        link_index link;
        std::size_t turn;
        link_state before;
    };
    std::vector<entry> touched_{};
};

/// Keeps the states of links up to date while cells turn into air.
///
/// `start` and `update` are templates over the network: the concept asks with the least one there is.
/// The policy is constant; its memory is `E::state`, owned by the run and copyable (a snapshot).
/// `start(network, cells, links)` brings `links` into line with `cells` as if all air had been there from
/// the beginning, and returns the memory (to resume a run, restore its link states after `start`);
/// `update(network, cells, fallen, state, links, change)` does so after the cells `fallen` have become
/// air, which `cells` already says, and reports what changed.
/// Laws: a link with rock on both sides keeps its state, `bonded` or `broken`; with rock on one side it
/// is `skin` or `pocket`; with none `gone`. A skin link of the input is `skin` while its cell is rock.
/// Fallen cells are new air: given once each. The states after a row of updates depend on the cells'
/// history only where the policy says so, and never on the order within one update.
template <class E>
concept exposure_policy =
    std::copy_constructible<E> && std::copyable<typename E::state> &&
    requires(E const& e, detail::network_archetype const& n, std::span<cell_state const> cells,
             std::span<cell_index const> fallen, typename E::state& state, std::span<link_state> links,
             exposure_change& change) {
        { e.start(n, cells, links) } -> std::same_as<typename E::state>;
        { e.update(n, cells, fallen, state, links, change) } -> std::same_as<void>;
    };

}  // namespace tafoni

#endif
