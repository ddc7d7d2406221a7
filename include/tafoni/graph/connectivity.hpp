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
/// visit more cells than there are in the component is labelled by one flood instead. Totals of a
/// component are kept in fixed point; those of the larger piece follow by subtraction.
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
    /// O(bonds of a cell).
    template <link_network Network>
    [[nodiscard]] bool is_bonded(Network const& n, link_index l) const noexcept {
        auto const ends = n.link_cells(l);
        return ends[1].valid() && bonds_.contains(l.value, ends[0].value);
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
        if (bonds_.share_neighbor(ends[0].value, ends[1].value)) return {};
        terminals_.assign({ends[0].value, ends[1].value});
        check();
        if (fragments_.size() < 2) return {};
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

    /// Breaks many bonds, then looks once: the fragments of every component that came apart, by group.
    /// The same fragments as one by one; where something falls in between, only core cells make the
    /// outcome the same. Good until the next change. O(cells of the touched components) at most.
    template <link_network Network>
    std::span<fragment const> break_links(Network const& n, std::span<link_index const> links) {
        terminals_.clear();
        for (link_index const l : links) {
            auto const ends = n.link_cells(l);
            if (!ends[1].valid() || ends[0] == ends[1]) continue;
            if (!bonds_.remove(l.value, ends[0].value, ends[1].value)) continue;
            terminals_.push_back(ends[0].value);
            terminals_.push_back(ends[1].value);
        }
        check();
        return fragments_;
    }

    /// Takes cells out with all their bonds, then looks once; fragments as by `break_links`.
    std::span<fragment const> remove_cells(std::span<cell_index const> cells) {
        terminals_.clear();
        for (cell_index const c : cells) take_out(c.value);
        std::erase_if(terminals_, [&](std::uint32_t c) { return (flags_[c] & removed) != 0; });
        check();
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
        bool blurred = false;  ///< may be several pieces, each with core cells
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

    std::uint32_t new_component() {
        if (!free_.empty()) {
            std::uint32_t const k = free_.back();
            free_.pop_back();
            return k;
        }
        components_.emplace_back();
        return static_cast<std::uint32_t>(components_.size()) - 1;
    }

    /// Gives the piece that a side has seen whole a component of its own, out of component k.
    void cut_off(std::uint32_t k, std::uint32_t side) {
        std::uint32_t const fresh = new_component();
        record piece{.seed = search_.cells(side).front()};
        std::uint32_t lowest = nothing;
        for (std::uint32_t const c : search_.cells(side)) {
            label_[c] = fresh;
            piece.volume += volume_[c];
            ++piece.cells;
            piece.core_cells += holds_core(c) ? 1U : 0U;
            lowest = std::min(lowest, c);
        }
        record& rest = components_[k];
        rest.volume -= piece.volume;
        rest.cells -= piece.cells;
        rest.core_cells -= piece.core_cells;
        components_[fresh] = piece;
        fragments_.push_back({{piece.volume, piece.core_cells, cell_index{lowest}}, fresh, group_});
    }

    void take_out(std::uint32_t c) {
        if ((flags_[c] & removed) != 0) return;
        flags_[c] |= removed;
        for (auto const& b : bonds_.of(c)) {
            bonds_.remove_end(b.link, b.other);
            terminals_.push_back(b.other);
        }
        bonds_.clear(c);
        record& k = components_[label_[c]];
        k.volume -= volume_[c];
        --k.cells;
        k.core_cells -= holds_core(c) ? 1U : 0U;
        if (k.cells == 0) {
            free_.push_back(label_[c]);
            k = {};
        }
    }

    /// Sorts out the components of `terminals_`: cells that lost a bond. Every piece that came off holds one.
    void check() {
        fragments_.clear();
        group_ = 0;
        auto const before = [&](std::uint32_t a, std::uint32_t b) {
            return std::pair{label_[a], a} < std::pair{label_[b], b};
        };
        if (terminals_.size() > 2) {
            std::sort(terminals_.begin(), terminals_.end(), before);
            terminals_.erase(std::unique(terminals_.begin(), terminals_.end()), terminals_.end());
        }
        for (std::size_t begin = 0; begin < terminals_.size();) {
            std::uint32_t const k = label_[terminals_[begin]];
            std::size_t end = begin + 1;
            while (end < terminals_.size() && label_[terminals_[end]] == k) ++end;
            check_component(k, {terminals_.data() + begin, end - begin});
            begin = end;
        }
    }

    void check_component(std::uint32_t k, std::span<std::uint32_t const> terminals) {
        std::size_t const first_fragment = fragments_.size();
        std::size_t budget = 2 * std::size_t{components_[k].cells};
        std::uint32_t rest = nothing;  // a terminal in what keeps the name k
        bool core_known = false;       // that its piece holds a core cell
        std::size_t i = 0;
        for (; i < terminals.size() && budget > 0; ++i) {
            std::uint32_t const t = terminals[i];
            if (label_[t] != k) continue;
            if (rest == nothing) {
                rest = t;
                core_known = false;
                continue;
            }
            if (bonds_.share_neighbor(rest, t)) continue;
            bool const may_stop = options_.when_both_hold_core == two_cores::stop;
            outcome const o = search_.run(bonds_, rest, t, may_stop, wanted());
            budget -= std::min(budget, search_.visited());
            if (o == outcome::met) continue;
            if (o == outcome::both_found) {
                components_[k].blurred = true;
                core_known = true;
                continue;
            }
            std::uint32_t const ended = o == outcome::first_ended ? 0 : 1;
            std::uint32_t const other = 1 - ended;
            bool const alive = !components_[k].blurred || search_.reaches(bonds_, other, wanted());
            cut_off(k, ended);
            core_known = alive && components_[k].blurred;
            if (ended == 0) rest = t;
            if (!alive) {
                cut_off(k, other);
                rest = nothing;
            }
        }
        if (i < terminals.size()) {
            for (std::uint32_t const t : terminals) cut_off_piece_of(t, k);
            rest = nothing;
        } else if (rest != nothing && components_[k].blurred && !core_known &&
                   !search_.reaches_from(bonds_, rest, wanted())) {
            cut_off(k, 0);
            rest = nothing;
        }
        finish_group(k, rest, first_fragment);
    }

    void cut_off_piece_of(std::uint32_t c, std::uint32_t k) {
        if (label_[c] != k) return;
        search_.flood(bonds_, c);
        cut_off(k, 0);
    }

    /// Books what keeps the name k, or forgets the group if nothing came apart.
    void finish_group(std::uint32_t k, std::uint32_t rest, std::size_t first_fragment) {
        record& kept = components_[k];
        if (kept.cells == 0) {
            kept = {};
            free_.push_back(k);
        } else {
            kept.seed = rest;
            if (fragments_.size() > first_fragment) fragments_.push_back({as_part(kept), k, group_});
        }
        if (fragments_.size() < first_fragment + 2) {
            fragments_.resize(first_fragment);
            return;
        }
        ++group_;
        if (fragments_.back().component != k) return;
        // The lowest cell of the larger piece is looked up only where a tie asks for it.
        bool tie = false;
        for (std::size_t f = first_fragment; f + 1 < fragments_.size(); ++f) {
            tie = tie || fragments_[f].totals.volume == fragments_.back().totals.volume;
        }
        if (!tie) return;
        gather(k);
        fragments_.back().totals.lowest_cell = cell_index{*std::min_element(search_.cells(0).begin(), search_.cells(0).end())};
    }

    /// Makes every piece of a component one of its own.
    void separate(std::uint32_t k) {
        gather(k);
        terminals_ = search_.cells(0);
        for (std::uint32_t const c : terminals_) cut_off_piece_of(c, k);
        components_[k] = {};
        free_.push_back(k);
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
    std::uint32_t group_ = 0;
    detail::two_sided_search search_{};
    std::vector<std::uint32_t> terminals_{};
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
