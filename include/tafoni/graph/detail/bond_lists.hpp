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

/// A CSR whose entries are removed by swapping with the last of their list. Bonds from a cell to itself are not kept.
class bond_lists {
public:
    bond_lists() = default;

    struct bond {
        std::uint32_t other;
        std::uint32_t link;
    };

    /// Keeps the interior links for which `keep(l, cells)` holds. O(cells + links).
    template <class Network, class Keep>
    bond_lists(Network const& n, Keep const& keep) {
        std::size_t const cells = n.cell_count();
        lists_.reserve(cells);
        for (std::size_t c = 0; c < cells; ++c) {
            auto const begin = static_cast<std::uint32_t>(bonds_.size());
            n.for_each_cell_link(cell_index{c}, [&](link_index l) {
                auto const ends = n.link_cells(l);
                if (!ends[1].valid() || ends[0] == ends[1] || !keep(l, ends)) return;
                bonds_.push_back({ends[0].value == c ? ends[1].value : ends[0].value, l.value});
            });
            require_indexable("connectivity: ends of bonds", bonds_.size());
            lists_.push_back({begin, static_cast<std::uint32_t>(bonds_.size()) - begin});
        }
        bonds_.shrink_to_fit();
    }

    [[nodiscard]] std::span<bond const> of(std::uint32_t c) const noexcept {
        return {bonds_.data() + lists_[c].begin, lists_[c].size};
    }
    [[nodiscard]] bool contains(std::uint32_t link, std::uint32_t c) const noexcept {
        for (bond const& b : of(c)) {
            if (b.link == link) return true;
        }
        return false;
    }
    /// True if the bond was there. O(bonds of the two cells).
    bool remove(std::uint32_t link, std::uint32_t a, std::uint32_t b) noexcept {
        return remove_end(link, a) && remove_end(link, b);
    }
    void clear(std::uint32_t c) noexcept { lists_[c].size = 0; }
    bool remove_end(std::uint32_t link, std::uint32_t c) noexcept {
        list& mine = lists_[c];
        for (std::uint32_t i = mine.begin; i < mine.begin + mine.size; ++i) {
            if (bonds_[i].link != link) continue;
            bonds_[i] = bonds_[mine.begin + --mine.size];
            return true;
        }
        return false;
    }

    /// Whether a and b are bonded, or both to a third cell; false as well where it is too long to look.
    [[nodiscard]] bool share_neighbor(std::uint32_t a, std::uint32_t b) const noexcept {
        auto const of_a = of(a);
        auto const of_b = of(b);
        if (of_a.size() * of_b.size() > 1024) return false;
        for (bond const& y : of_b) {
            if (y.other == a) return true;
            for (bond const& x : of_a) {
                if (x.other == y.other) return true;
            }
        }
        return false;
    }

    [[nodiscard]] std::size_t bytes() const noexcept {
        return lists_.capacity() * sizeof(list) + bonds_.capacity() * sizeof(bond);
    }

private:
    struct list {
        std::uint32_t begin;
        std::uint32_t size;
    };

    std::vector<list> lists_{};
    std::vector<bond> bonds_{};
};

}  // namespace tafoni::detail

#endif
