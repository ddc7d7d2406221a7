/// \file
/// What hangs together while bonds break: dynamic connectivity under deletion.
#ifndef TAFONI_GRAPH_CONNECTIVITY_HPP
#define TAFONI_GRAPH_CONNECTIVITY_HPP

#include <tafoni/core/sum.hpp>
#include <tafoni/graph/concepts.hpp>
#include <tafoni/graph/detail/bond_lists.hpp>
#include <tafoni/graph/detail/two_sided_search.hpp>
#include <tafoni/graph/split.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tafoni {

/// What to do where a search finds core cells on both sides of a broken bond.
enum class two_cores : std::uint8_t {
    stop,    ///< nothing can fall by the shipped rule: stop there; pieces that hold core cells are not told apart
    search,  ///< go on until it is known whether a piece has come off
};

struct connectivity_options {
    two_cores when_both_hold_core = two_cores::stop;
};

/// Components of the cells graph while its bonds break [Mateos et al., section 5.3].
///
/// A broken bond starts two searches, one from each end, in turns, until they meet, one of them has
/// seen its whole piece, or (`two_cores::stop`) both have found a core cell. So a break costs the
/// smaller piece at most, and a few dozen cells where the ends stay connected. A batch whose searches
/// have seen more than twice the model's cells is finished by one flood. Totals of a component are kept
/// in fixed point; those of the larger piece follow by subtraction.
///
/// A copy is a snapshot. The state follows from which bonds and cells are left: the second constructor
/// restores it. Component numbers are handles, good until the component comes apart or is removed.
class connectivity {
public:
    connectivity() = default;

    /// All cells solid, all interior links bonded. O(cells + links).
    template <link_network Network>
    explicit connectivity(Network const& n, connectivity_options options = {})
        : connectivity(n, {}, [](link_index) { return true; }, options) {}

    /// Cells by their states (all solid when empty), bonds where `bonded(l)` and both cells are not air.
    template <link_network Network, class IsBonded>
    connectivity(Network const& n, std::span<cell_state const> cells, IsBonded const& bonded,
                 connectivity_options options = {});

    [[nodiscard]] std::size_t cell_count() const noexcept { return flags_.size(); }
    [[nodiscard]] bool is_removed(cell_index c) const noexcept { return (flags_[c.value] & removed) != 0; }
    [[nodiscard]] bool is_core(cell_index c) const noexcept { return (flags_[c.value] & core) != 0; }
    /// O(1).
    template <link_network Network>
    [[nodiscard]] bool is_bonded(Network const& n, link_index l) const noexcept {
        if (!bonds_.contains(l.value)) return false;
        auto const ends = n.link_cells(l);
        return !is_removed(ends[0]) && !is_removed(ends[1]);
    }
    /// Only for cells that are not removed.
    [[nodiscard]] std::uint32_t component_of(cell_index c) const noexcept { return label_[c.value]; }
    /// With `two_cores::stop`, components that hold core cells may count several pieces as one.
    [[nodiscard]] part totals(std::uint32_t component) const noexcept { return as_part(components_[component]); }
    [[nodiscard]] std::size_t cells_in(std::uint32_t component) const noexcept { return components_[component].cells; }
    /// The whole network's volume, to turn `part::volume` back by `from_fixed`.
    [[nodiscard]] double volume_scale() const noexcept { return scale_; }
    [[nodiscard]] std::int64_t fixed_volume(cell_index c) const noexcept { return volume_[c.value]; }

    /// Breaks a bond; the parts if that parted a component. A link that is not bonded changes nothing.
    /// With `two_cores::stop` a split into two parts with core cells may go unreported.
    /// O(cells of the smaller part and their bonds).
    template <link_network Network>
    std::optional<split> break_link(Network const& n, link_index l) {
        auto const ends = n.link_cells(l);
        if (!ends[1].valid() || ends[0] == ends[1] || !bonds_.remove(l.value, ends[0].value, ends[1].value)) return {};
        begin();
        look(ends[0].value, ends[1].value);
        if (made_.empty()) return {};
        finish();
        std::uint32_t const a = label_[ends[0].value];
        std::uint32_t const b = label_[ends[1].value];
        if (a == b) return {};
        split s{.components = {a, b}};
        for (fragment const& f : fragments_) {
            if (f.component == a) s.first = f.totals;
            if (f.component == b) s.second = f.totals;
        }
        return s;
    }

    /// Breaks many bonds; the fragments of every component that came apart, by group. The same pieces as
    /// one by one; where something falls in between, only core cells make the outcome the same.
    /// Good until the next change. O(sum of the smaller parts), at most O(cells and bonds of the model).
    template <link_network Network>
    std::span<fragment const> break_links(Network const& n, std::span<link_index const> links) {
        begin();
        for (link_index const l : links) {
            auto const ends = n.link_cells(l);
            if (!ends[1].valid() || ends[0] == ends[1]) continue;
            if (bonds_.remove(l.value, ends[0].value, ends[1].value)) look(ends[0].value, ends[1].value);
        }
        finish();
        return fragments_;
    }

    /// Takes cells out with all their bonds; fragments of what is left, as by `break_links`.
    std::span<fragment const> remove_cells(std::span<cell_index const> cells) {
        begin();
        for (cell_index const c : cells) take_out(c.value);
        finish();
        return fragments_;
    }
    std::span<fragment const> remove_cell(cell_index c) { return remove_cells({&c, 1}); }

    /// The cells of a component, ascending. Good until the next call. O(its cells log its cells).
    [[nodiscard]] std::span<cell_index const> cells_of(std::uint32_t component) {
        gather(component);
        cells_.clear();
        for (std::uint32_t const c : search_.cells(0)) cells_.push_back(cell_index{c});
        std::sort(cells_.begin(), cells_.end());
        return cells_;
    }

    /// Takes a whole component out: a part that falls. O(its cells).
    void remove_component(std::uint32_t component) {
        gather(component);
        for (std::uint32_t const c : search_.cells(0)) {
            flags_[c] |= removed;
            bonds_.clear(c);
        }
        components_[component] = {};
        free_.push_back(component);
    }

    /// Marks or unmarks a core cell. Heals nothing and drops nothing. O(1); unmarking may cost the component.
    void set_core(cell_index c, bool is_core_now) {
        if (is_core(c) == is_core_now) return;
        flags_[c.value] = static_cast<std::uint8_t>(flags_[c.value] ^ core);
        if (is_removed(c)) return;
        record& k = components_[label_[c.value]];
        k.core_cells = is_core_now ? k.core_cells + 1 : k.core_cells - 1;
        if (!is_core_now && k.blurred) separate(label_[c.value]);
    }

    /// Memory held, in bytes.
    [[nodiscard]] std::size_t bytes() const noexcept {
        return bonds_.bytes() + search_.bytes() + flags_.capacity() + 8 * volume_.capacity() + 4 * label_.capacity() +
               components_.capacity() * sizeof(record);
    }

private:
    static constexpr std::uint8_t core = 1;
    static constexpr std::uint8_t removed = 2;
    static constexpr std::uint32_t nothing = cell_index::none;
    struct record {
        std::int64_t volume = 0;
        std::uint32_t cells = 0;
        std::uint32_t core_cells = 0;
        std::uint32_t seed = nothing;
        std::uint32_t origin = nothing;  ///< what it was part of when the change began
        bool blurred = false;            ///< may be several pieces, each with core cells
    };
    using outcome = detail::two_sided_search::outcome;

    [[nodiscard]] static part as_part(record const& k) noexcept { return {k.volume, k.core_cells, cell_index{}}; }
    [[nodiscard]] bool holds_core(std::uint32_t c) const noexcept { return (flags_[c] & core) != 0; }
    [[nodiscard]] auto wanted() const noexcept { return [this](std::uint32_t c) { return holds_core(c); }; }

    /// Fills side 0 of the search with the cells of a component.
    void gather(std::uint32_t k) {
        if (!components_[k].blurred) {
            search_.flood(bonds_, components_[k].seed);
            return;
        }
        search_.cells(0).clear();
        for (std::size_t c = 0; c < label_.size(); ++c) {
            if (label_[c] == k && (flags_[c] & removed) == 0) search_.cells(0).push_back(static_cast<std::uint32_t>(c));
        }
    }

    void begin() {
        fragments_.clear();
        made_.clear();
        loose_.clear();
        visited_ = 0;
        // Breaks one by one look near the broken bond. Where that fails, one flood is cheaper.
        flood_instead_ = false;
    }

    /// After the bond between a and b is gone: gives what came off a component of its own.
    void look(std::uint32_t a, std::uint32_t b) {
        if (flood_instead_) {
            loose_.push_back(a);
            loose_.push_back(b);
            return;
        }
        if (bonds_.share_neighbor(a, b)) return;
        std::uint32_t const k = label_[a];
        outcome const o = search_.run(bonds_, a, b, options_.when_both_hold_core == two_cores::stop, wanted());
        visited_ += search_.visited();
        flood_instead_ = visited_ > 4096 + 2 * cell_count();
        if (o == outcome::met) return;
        if (o == outcome::both_found) {
            components_[k].blurred = true;
            return;
        }
        std::uint32_t const ended = o == outcome::first_ended ? 0 : 1;
        bool const kept = !components_[k].blurred || search_.reaches(bonds_, 1 - ended, wanted());
        cut_off(k, ended);
        components_[k].seed = ended == 0 ? b : a;
        if (!kept) cut_off(k, 1 - ended);
    }

    /// Gives the piece that a side of the search has seen whole a component of its own, out of component k.
    void cut_off(std::uint32_t k, std::uint32_t side) {
        if (free_.empty()) {
            free_.push_back(static_cast<std::uint32_t>(components_.size()));
            components_.emplace_back();
        }
        std::uint32_t const fresh = free_.back();
        free_.pop_back();
        record& rest = components_[k];
        if (rest.origin == nothing) {
            rest.origin = k;
            made_.push_back(k);
        }
        record piece{.seed = search_.cells(side).front(), .origin = rest.origin};
        for (std::uint32_t const c : search_.cells(side)) {
            label_[c] = fresh;
            piece.volume += volume_[c];
            ++piece.cells;
            piece.core_cells += holds_core(c) ? 1U : 0U;
        }
        rest.volume -= piece.volume;
        rest.cells -= piece.cells;
        rest.core_cells -= piece.core_cells;
        components_[fresh] = piece;
        made_.push_back(fresh);
    }

    void take_out(std::uint32_t c) {
        if ((flags_[c] & removed) != 0) return;
        while (!bonds_.of(c).empty()) {
            std::uint32_t const other = bonds_.of(c).back();
            bonds_.remove_any(c, other);
            look(c, other);
        }
        flags_[c] |= removed;
        std::uint32_t const k = label_[c];
        components_[k].volume -= volume_[c];
        --components_[k].cells;
        components_[k].core_cells -= holds_core(c) ? 1U : 0U;
        if (components_[k].origin == nothing && components_[k].cells == 0) {
            components_[k].origin = k;
            made_.push_back(k);
        }
    }

    /// Floods what was put off, lists the fragments, and frees the components that have no cells left.
    void finish() {
        for (std::uint32_t const c : loose_) {
            if ((flags_[c] & removed) == 0) put_off_.push_back({label_[c], c});
        }
        for (auto const& [k, c] : put_off_) {
            if (label_[c] != k) continue;
            search_.flood(bonds_, c);
            cut_off(k, 0);
        }
        put_off_.clear();
        if (made_.empty()) return;
        order_.clear();
        for (std::uint32_t const k : made_) {
            order_.push_back({components_[k].origin, static_cast<std::uint32_t>(order_.size()), k});
        }
        std::sort(order_.begin(), order_.end());
        for (std::size_t i = 0; i < made_.size(); ++i) made_[i] = order_[i][2];
        std::uint32_t group = 0;
        for (std::size_t i = 0; i < made_.size();) {
            std::uint32_t const origin = components_[made_[i]].origin;
            std::size_t const first = fragments_.size();
            for (; i < made_.size() && components_[made_[i]].origin == origin; ++i) {
                record const& k = components_[made_[i]];
                if (k.cells > 0) fragments_.push_back({{k.volume, k.core_cells, cell_index{}}, made_[i], group});
            }
            if (fragments_.size() < first + 2) {
                fragments_.resize(first);
            } else {
                break_ties(std::span{fragments_}.subspan(first));
                ++group;
            }
        }
        for (std::uint32_t const k : made_) {
            components_[k].origin = nothing;
            if (components_[k].cells > 0) continue;
            components_[k] = {};
            free_.push_back(k);
        }
    }

    /// The lowest cell is looked up only where volumes tie.
    void break_ties(std::span<fragment> group) {
        std::vector<std::int64_t> volumes;
        for (fragment const& f : group) volumes.push_back(f.totals.volume);
        std::sort(volumes.begin(), volumes.end());
        for (fragment& f : group) {
            auto const [lo, hi] = std::equal_range(volumes.begin(), volumes.end(), f.totals.volume);
            if (hi - lo < 2) continue;
            gather(f.component);
            f.totals.lowest_cell = cell_index{*std::min_element(search_.cells(0).begin(), search_.cells(0).end())};
        }
    }

    /// Makes every piece of a component one of its own.
    void separate(std::uint32_t k) {
        gather(k);
        begin();
        loose_ = search_.cells(0);
        finish();
        fragments_.clear();
    }

    connectivity_options options_{};
    detail::bond_lists bonds_{};
    double scale_ = 0;
    std::vector<std::uint8_t> flags_{};
    std::vector<std::int64_t> volume_{};   ///< per cell, fixed point
    std::vector<std::uint32_t> label_{};   ///< per cell: its component
    std::vector<record> components_{};
    std::vector<std::uint32_t> free_{};
    detail::two_sided_search search_{};
    std::size_t visited_ = 0;             ///< cells that the searches of this change have seen
    bool flood_instead_ = false;
    std::vector<std::uint32_t> made_{};   ///< components of this change: those that came apart and their pieces
    std::vector<std::array<std::uint32_t, 3>> order_{};  ///< made_ by origin, then by turn
    std::vector<std::uint32_t> loose_{};  ///< cells that lost a bond after searching was given up
    std::vector<std::pair<std::uint32_t, std::uint32_t>> put_off_{};
    std::vector<fragment> fragments_{};
    std::vector<cell_index> cells_{};
};

template <link_network Network, class IsBonded>
connectivity::connectivity(Network const& n, std::span<cell_state const> cells, IsBonded const& bonded,
                           connectivity_options options)
    : options_(options) {
    std::size_t const count = n.cell_count();
    if (!cells.empty() && cells.size() != count) {
        detail::fail<invalid_input>(errc::attribute_length, "connectivity: got " + std::to_string(cells.size()) +
                                                                " cell states for " + std::to_string(count) + " cells");
    }
    scale_ = pairwise_sum(0, count, [&](std::size_t c) { return n.cell_volume(cell_index{c}); });
    flags_.assign(count, 0);
    volume_.resize(count);
    for (std::size_t c = 0; c < count; ++c) {
        volume_[c] = scale_ > 0 ? to_fixed(n.cell_volume(cell_index{c}), scale_) : 0;
        if (cells.empty()) continue;
        flags_[c] = cells[c] == cell_state::air ? removed : cells[c] == cell_state::core ? core : std::uint8_t{0};
    }
    bonds_ = detail::bond_lists(n, [&](link_index l, std::array<cell_index, 2> const& ends) {
        return !is_removed(ends[0]) && !is_removed(ends[1]) && bonded(l);
    });
    label_.assign(count, nothing);
    search_ = detail::two_sided_search(count);
    for (std::size_t c = 0; c < count; ++c) {
        if (label_[c] != nothing || (flags_[c] & removed) != 0) continue;
        search_.flood(bonds_, static_cast<std::uint32_t>(c));
        record k{.seed = static_cast<std::uint32_t>(c)};
        for (std::uint32_t const m : search_.cells(0)) {
            label_[m] = static_cast<std::uint32_t>(components_.size());
            k.volume += volume_[m];
            ++k.cells;
            k.core_cells += holds_core(m) ? 1U : 0U;
        }
        components_.push_back(k);
    }
}

}  // namespace tafoni

#endif
