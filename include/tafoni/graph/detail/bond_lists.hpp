/// \file
/// Which cells are bonded to which, in lists that only shrink.
#ifndef TAFONI_GRAPH_DETAIL_BOND_LISTS_HPP
#define TAFONI_GRAPH_DETAIL_BOND_LISTS_HPP

#include <tafoni/core/index.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// A CSR whose entries are removed by swapping with the last of their list. Bonds from a cell to itself are not kept.
class bond_lists {
public:
    bond_lists() = default;

    /// Keeps the interior links for which `keep(l, cells)` holds. O(cells + links).
    template <class Network, class Keep>
    bond_lists(Network const& n, Keep const& keep) {
        std::size_t const cells = n.cell_count();
        begin_.reserve(cells + 1);
        begin_.push_back(0);
        for (std::size_t c = 0; c < cells; ++c) {
            n.for_each_cell_link(cell_index{c}, [&](link_index l) {
                auto const ends = n.link_cells(l);
                if (!ends[1].valid() || ends[0] == ends[1] || !keep(l, ends)) return;
                others_.push_back(ends[0].value == c ? ends[1].value : ends[0].value);
                links_.push_back(l.value);
            });
            require_indexable("connectivity: ends of bonds", others_.size());
            begin_.push_back(static_cast<std::uint32_t>(others_.size()));
        }
        others_.shrink_to_fit();
        links_.shrink_to_fit();
        degree_.resize(cells);
        for (std::size_t c = 0; c < cells; ++c) degree_[c] = begin_[c + 1] - begin_[c];
    }

    [[nodiscard]] std::span<std::uint32_t const> others(std::uint32_t c) const noexcept {
        return {others_.data() + begin_[c], degree_[c]};
    }
    [[nodiscard]] std::span<std::uint32_t const> links(std::uint32_t c) const noexcept {
        return {links_.data() + begin_[c], degree_[c]};
    }
    [[nodiscard]] bool contains(std::uint32_t link, std::uint32_t c) const noexcept {
        for (std::uint32_t const l : links(c)) {
            if (l == link) return true;
        }
        return false;
    }
    /// True if the bond was there. O(bonds of the two cells).
    bool remove(std::uint32_t link, std::uint32_t a, std::uint32_t b) noexcept {
        return remove_end(link, a) && remove_end(link, b);
    }
    void clear(std::uint32_t c) noexcept { degree_[c] = 0; }
    bool remove_end(std::uint32_t link, std::uint32_t c) noexcept {
        std::uint32_t const first = begin_[c];
        for (std::uint32_t i = first; i < first + degree_[c]; ++i) {
            if (links_[i] != link) continue;
            std::uint32_t const last = first + --degree_[c];
            links_[i] = links_[last];
            others_[i] = others_[last];
            return true;
        }
        return false;
    }

    [[nodiscard]] std::size_t cell_count() const noexcept { return degree_.size(); }
    [[nodiscard]] std::size_t bytes() const noexcept {
        return 4 * (begin_.capacity() + degree_.capacity() + others_.capacity() + links_.capacity());
    }

private:
    std::vector<std::uint32_t> begin_{};
    std::vector<std::uint32_t> degree_{};
    std::vector<std::uint32_t> others_{};
    std::vector<std::uint32_t> links_{};
};

}  // namespace tafoni::detail

#endif
