/// \file
/// Two searches in turns, from the two ends of a broken bond.
#ifndef TAFONI_GRAPH_DETAIL_TWO_SIDED_SEARCH_HPP
#define TAFONI_GRAPH_DETAIL_TWO_SIDED_SEARCH_HPP

#include <tafoni/graph/detail/bond_lists.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// Breadth-first searches that mark cells by epoch and side, so that nothing is cleared between them.
class two_sided_search {
public:
    enum class outcome : std::uint8_t { met, both_found, first_ended, second_ended };

    two_sided_search() = default;
    explicit two_sided_search(std::size_t cells) : mark_(cells, 0) {}

    /// From a and b until they meet, one ends, or, when `may_stop`, both have seen a cell that is `wanted`.
    template <class Wanted>
    [[nodiscard]] outcome run(bond_lists const& bonds, std::uint32_t a, std::uint32_t b, bool may_stop,
                              Wanted const& wanted) {
        next_epoch();
        start(0, a, wanted);
        start(1, b, wanted);
        for (;;) {
            for (std::uint32_t side = 0; side < 2; ++side) {
                if (may_stop && found_[0] && found_[1]) return outcome::both_found;
                if (head_[side] == queue_[side].size()) return side == 0 ? outcome::first_ended : outcome::second_ended;
                if (expand(bonds, side, wanted)) return outcome::met;
            }
        }
    }

    /// Goes on with one side after the other has ended, until it has seen a wanted cell (true) or ends.
    template <class Wanted>
    bool reaches(bond_lists const& bonds, std::uint32_t side, Wanted const& wanted) {
        while (!found_[side] && head_[side] < queue_[side].size()) expand(bonds, side, wanted);
        return found_[side];
    }

    /// From one cell on side 0, until it has seen a wanted cell (true) or ends.
    template <class Wanted>
    bool reaches_from(bond_lists const& bonds, std::uint32_t c, Wanted const& wanted) {
        next_epoch();
        start(0, c, wanted);
        return reaches(bonds, 0, wanted);
    }

    /// All that hangs together with a cell, on side 0.
    void flood(bond_lists const& bonds, std::uint32_t c) {
        reaches_from(bonds, c, [](std::uint32_t) { return false; });
    }

    /// What a side has seen, in the order of the search.
    [[nodiscard]] std::vector<std::uint32_t>& cells(std::uint32_t side) noexcept { return queue_[side]; }
    [[nodiscard]] std::size_t visited() const noexcept { return queue_[0].size() + queue_[1].size(); }
    [[nodiscard]] std::size_t bytes() const noexcept { return 4 * mark_.capacity(); }

private:
    static constexpr std::size_t turn = 64;  ///< neighbours in one turn, so that a huge cell costs the other side no wait

    void next_epoch() {
        if (epoch_ >= 0xFFFFFFF0U) {
            std::fill(mark_.begin(), mark_.end(), 0U);
            epoch_ = 0;
        }
        epoch_ += 2;
    }

    template <class Wanted>
    void start(std::uint32_t side, std::uint32_t c, Wanted const& wanted) {
        queue_[side].assign(1, c);
        head_[side] = 0;
        seen_[side] = 0;
        mark_[c] = epoch_ + side;
        found_[side] = wanted(c);
    }

    /// Looks at some neighbours of the next cell of a side, all unless it has very many; true if one
    /// belongs to the other side.
    template <class Wanted>
    bool expand(bond_lists const& bonds, std::uint32_t side, Wanted const& wanted) {
        std::uint32_t const mine = epoch_ + side;
        std::uint32_t const theirs = epoch_ + 1 - side;
        auto const all = bonds.of(queue_[side][head_[side]]);
        std::size_t const end = std::min(all.size(), seen_[side] + turn);
        std::uint32_t* const marks = mark_.data();
        for (std::size_t i = seen_[side]; i < end; ++i) {
            std::uint32_t const other = all[i];
            if (marks[other] == mine) continue;
            if (marks[other] == theirs) return true;
            marks[other] = mine;
            bonds.prefetch(other);
            queue_[side].push_back(other);
            found_[side] = found_[side] || wanted(other);
        }
        seen_[side] = end;
        if (end == all.size()) {
            seen_[side] = 0;
            ++head_[side];
        }
        return false;
    }

    std::vector<std::uint32_t> mark_{};  ///< per cell: the search and side that saw it last
    std::uint32_t epoch_ = 0;
    std::array<std::vector<std::uint32_t>, 2> queue_{};
    std::array<std::size_t, 2> head_{};
    std::array<std::size_t, 2> seen_{};  ///< neighbours of the cell at the head that were looked at
    std::array<bool, 2> found_{};
};

}  // namespace tafoni::detail

#endif
