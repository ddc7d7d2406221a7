/// \file
/// Which cells are bonded to which, in lists that only shrink.
#ifndef TAFONI_GRAPH_DETAIL_BOND_LISTS_HPP
#define TAFONI_GRAPH_DETAIL_BOND_LISTS_HPP

#include <tafoni/core/index.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// A CSR whose entries are removed by swapping with the last of their list, and a bit per link.
///
/// A list is its length and then its entries, and entries do not name their link, so that most lists are
/// one cache line: of several bonds between two cells any entry may go, the bits say which are left.
/// Bonds from a cell to itself are not kept.
class bond_lists {
public:
    bond_lists() = default;

    /// Keeps the interior links for which `keep(l, cells)` holds. O(cells + links).
    template <class Network, class Keep>
    bond_lists(Network const& n, Keep const& keep) {
        std::size_t const cells = n.cell_count();
        begin_.reserve(cells);
        bonded_.assign((n.link_count() + 63) / 64, 0);
        for (std::size_t c = 0; c < cells; ++c) {
            std::size_t const begin = others_.size();
            others_.push_back(0);
            n.for_each_cell_link(cell_index{c}, [&](link_index l) {
                auto const ends = n.link_cells(l);
                if (!ends[1].valid() || ends[0] == ends[1] || !keep(l, ends)) return;
                others_.push_back(ends[0].value == c ? ends[1].value : ends[0].value);
                bonded_[l.value / 64] |= std::uint64_t{1} << (l.value % 64);
            });
            require_indexable("connectivity: ends of bonds", others_.size());
            others_[begin] = static_cast<std::uint32_t>(others_.size() - begin - 1);
            begin_.push_back(static_cast<std::uint32_t>(begin));
        }
        others_.shrink_to_fit();
    }

    /// The cells bonded to c, once for each bond.
    [[nodiscard]] std::span<std::uint32_t const> of(std::uint32_t c) const noexcept {
        std::uint32_t const* const list = others_.data() + begin_[c];
        return {list + 1, *list};
    }
    /// Whether nobody has removed the link; its cells may have been cleared since.
    [[nodiscard]] bool contains(std::uint32_t link) const noexcept {
        return (bonded_[link / 64] >> (link % 64) & 1) != 0;
    }
    /// Removes a bond between a and b; true if it was there. O(bonds of the two cells).
    bool remove(std::uint32_t link, std::uint32_t a, std::uint32_t b) noexcept {
        if (!contains(link)) return false;
        prefetch(b);
        bonded_[link / 64] &= ~(std::uint64_t{1} << (link % 64));
        return remove_any(a, b);
    }
    /// Removes any bond between a and b, whichever link it is.
    bool remove_any(std::uint32_t a, std::uint32_t b) noexcept { return remove_end(a, b) && remove_end(b, a); }
    void clear(std::uint32_t c) noexcept { others_[begin_[c]] = 0; }

    /// Whether a and b are bonded, or both to a third cell; false as well where it is too long to look.
    [[nodiscard]] bool share_neighbor(std::uint32_t a, std::uint32_t b) const noexcept {
        auto const of_a = of(a);
        auto const of_b = of(b);
        if (of_a.size() * of_b.size() > 1024) return false;
        for (std::uint32_t const y : of_b) {
            unsigned hit = y == a ? 1U : 0U;
            for (std::uint32_t const x : of_a) hit |= x == y ? 1U : 0U;
            if (hit != 0) return true;
        }
        return false;
    }

    [[nodiscard]] std::size_t bytes() const noexcept {
        return begin_.capacity() * 4 + others_.capacity() * 4 + bonded_.capacity() * 8;
    }

    /// Asks for the list of c, which will be read soon.
    void prefetch(std::uint32_t c) const noexcept { __builtin_prefetch(others_.data() + begin_[c]); }

private:

    /// Takes one entry `other` out of the list of c. Looks at eight at a time: a cell may have very many bonds.
    bool remove_end(std::uint32_t c, std::uint32_t other) noexcept {
        std::uint32_t& size = others_[begin_[c]];
        std::uint32_t* const p = &size + 1;
        std::uint32_t i = 0;
        for (; i + 8 <= size; i += 8) {
            unsigned hit = 0;
            for (std::uint32_t k = 0; k < 8; ++k) hit |= p[i + k] == other ? 1U : 0U;
            if (hit != 0) break;
        }
        for (; i < size; ++i) {
            if (p[i] != other) continue;
            p[i] = p[--size];
            return true;
        }
        return false;
    }

    std::vector<std::uint32_t> begin_{};   ///< per cell: where its list stands in others_
    std::vector<std::uint32_t> others_{};
    std::vector<std::uint64_t> bonded_{};  ///< per link: not removed
};

}  // namespace tafoni::detail

#endif
