/// \file
/// Draws a skin link in proportion to area x acceptance, whatever the number of skin links.
#ifndef TAFONI_PERCOLATION_ENTRY_TREE_HPP
#define TAFONI_PERCOLATION_ENTRY_TREE_HPP

#include <tafoni/core/index.hpp>
#include <tafoni/core/random.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace tafoni {

/// Sums of integer weights in a tree of fan-out 8: its state is the set of weights and nothing else,
/// so equal weights give equal draws whatever the history.
///
/// `draw` proposes a link by weight and accepts it with the caller's probability: exact in
/// distribution [von Neumann's rejection]. After `most_rejections` it draws from the exact sums over all
/// weighted links instead, so it cannot stall where hardly any link accepts. A tall column whose top is one
/// hundredth of its skin still needs those sums in one draw of a hundred only.
class entry_tree {
public:
    static constexpr int most_rejections = 512;

    /// Memory of the exact draw; one per thread. Reused while direction and tree stay the same.
    struct scratch {
        std::vector<double> sums{};
        std::vector<std::uint32_t> links{};
        std::uint64_t version = 0;
        double key[3] = {0, 0, 0};
    };

    entry_tree() = default;

    /// All weights 0. O(links).
    explicit entry_tree(std::size_t links) {
        std::size_t n = links;
        do {
            n = (n + 7) / 8;
            levels_.emplace_back(n * 8, 0);
        } while (n > 1);
    }

    /// Sum of the weights.
    [[nodiscard]] std::int64_t total() const noexcept { return total_; }
    [[nodiscard]] std::int64_t weight(link_index l) const noexcept { return levels_[0][l.value]; }

    /// Weight of link l, >= 0. O(log links).
    void set(link_index l, std::int64_t weight) noexcept {
        std::size_t i = l.value;
        std::int64_t const change = weight - levels_[0][i];
        if (change == 0) return;
        ++version_;
        for (auto& level : levels_) {
            level[i] += change;
            i /= 8;
        }
        total_ += change;
    }

    /// Forgets the exact draws that were kept; call it when the caller's acceptance changes.
    void invalidate() noexcept { ++version_; }

    /// Link with weight in proportion to weight(l) x accept(l); not valid when all products are 0.
    /// `key` identifies `accept` (the rain's direction). O(log links) expected, O(weighted links) after
    /// `most_rejections` rejections in a row.
    template <class Accept>
    [[nodiscard]] link_index draw(stream& random, double const (&key)[3], Accept const& accept, scratch& memory) const {
        if (total_ <= 0) return {};
        for (int k = 0; k < most_rejections; ++k) {
            link_index const l = at(static_cast<std::int64_t>(random.index_below(static_cast<std::uint64_t>(total_))));
            if (random.chance(accept(l))) return l;
        }
        if (memory.version != version_ || !std::equal(key, key + 3, memory.key)) {
            memory.version = 0;
            memory.sums.clear();
            memory.links.clear();
            double sum = 0;
            for_each_weighted(levels_.size() - 1, 0, [&](std::uint32_t l) {
                double const w = static_cast<double>(levels_[0][l]) * accept(link_index{l});
                if (!(w > 0)) return;
                sum += w;
                memory.sums.push_back(sum);
                memory.links.push_back(l);
            });
            std::copy(key, key + 3, memory.key);
            memory.version = version_;
        }
        if (memory.sums.empty()) return {};
        double const u = random.uniform01() * memory.sums.back();
        auto const it = std::upper_bound(memory.sums.begin(), memory.sums.end() - 1, u);
        return link_index{memory.links[static_cast<std::size_t>(it - memory.sums.begin())]};
    }

    /// Calls f(link) for every link with weight > 0, in ascending order. O(weighted links log links).
    template <class F>
    void for_each(F const& f) const {
        if (total_ > 0) for_each_weighted(levels_.size() - 1, 0, [&](std::uint32_t l) { f(link_index{l}); });
    }

private:
    /// The link at position r of the concatenated weights.
    [[nodiscard]] link_index at(std::int64_t r) const noexcept {
        std::size_t i = 0;
        for (std::size_t level = levels_.size(); level-- > 0;) {
            std::int64_t const* const w = levels_[level].data() + i * 8;
            std::size_t k = 0;
            while (r >= w[k]) r -= w[k++];
            i = i * 8 + k;
        }
        return link_index{i};
    }

    template <class F>
    void for_each_weighted(std::size_t level, std::size_t group, F const& f) const {
        for (std::size_t i = group * 8; i < group * 8 + 8; ++i) {
            if (levels_[level][i] <= 0) continue;
            if (level == 0) {
                f(static_cast<std::uint32_t>(i));
            } else {
                for_each_weighted(level - 1, i, f);
            }
        }
    }

    std::vector<std::vector<std::int64_t>> levels_{};  ///< [0] are the links, the last has one group of 8
    std::int64_t total_ = 0;
    std::uint64_t version_ = 1;
};

}  // namespace tafoni

#endif
