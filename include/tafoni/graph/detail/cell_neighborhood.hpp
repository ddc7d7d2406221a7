/// \file
/// Which links of one cell lie next to each other.
#ifndef TAFONI_GRAPH_DETAIL_CELL_NEIGHBORHOOD_HPP
#define TAFONI_GRAPH_DETAIL_CELL_NEIGHBORHOOD_HPP

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// Scratch for one cell after the other: nodes are the links of the cell, then its transparent faces.
///
/// Add the directed edges of every face with `edge`, then `close`, then read `neighbors_of`.
/// Cells of up to 64 nodes use one word per node, larger ones a sorted list of pairs.
class cell_neighborhood {
public:
    /// Starts a cell with `links` links and `transparent` faces that only pass neighbours on.
    void start(std::size_t links, std::size_t transparent, std::size_t directed_edges) {
        links_ = links;
        nodes_ = links + transparent;
        small_ = nodes_ <= 64;
        if (small_) {
            words_.assign(nodes_, 0);
        } else {
            pairs_.clear();
        }
        std::size_t const wanted = std::bit_ceil(2 * directed_edges + 2);
        if (table_.size() < wanted) {
            table_.assign(wanted, entry{});
            epoch_ = 0;
        }
        // A small cell after a large one must not walk a large table.
        mask_ = wanted - 1;
        if (++epoch_ == 0) {
            table_.assign(table_.size(), entry{});
            epoch_ = 1;
        }
        chain_.clear();
    }

    /// The edge between vertices u and v bounds a face of `node`; `is_long(u, v)` is asked once two nodes meet there.
    template <class IsLong>
    void edge(std::uint32_t u, std::uint32_t v, std::uint32_t node, IsLong const& is_long) {
        if (u > v) std::swap(u, v);
        std::uint64_t const key = std::uint64_t{u} << 32 | v;
        std::size_t at = static_cast<std::size_t>((key * 0x9E3779B97F4A7C15ULL) >> 32) & mask_;
        while (table_[at].epoch == epoch_ && table_[at].key != key) at = (at + 1) & mask_;
        entry& e = table_[at];
        if (e.epoch != epoch_) {
            e = {key, static_cast<std::uint32_t>(chain_.size()), epoch_};
            chain_.push_back({node, end});
            return;
        }
        bool measured = false;
        for (std::uint32_t i = e.head; i != end; i = chain_[i].second) {
            std::uint32_t const other = chain_[i].first;
            if (other == node) continue;
            if (!measured && !is_long(u, v)) return;
            measured = true;
            connect(node, other);
        }
        chain_.push_back({node, e.head});
        e.head = static_cast<std::uint32_t>(chain_.size()) - 1;
    }

    /// Passes neighbours on through transparent nodes.
    void close() {
        if (small_) close_words(); else close_pairs();
    }

    /// Visits the neighbours of a link of the cell, ascending. After `close`, in ascending order of `link`.
    template <class Visit>
    void neighbors_of(std::uint32_t link, Visit const& visit) {
        if (small_) {
            for (std::uint64_t w = words_[link] & link_mask() & ~(std::uint64_t{1} << link); w != 0; w &= w - 1) {
                visit(static_cast<std::uint32_t>(std::countr_zero(w)));
            }
            return;
        }
        auto it = std::lower_bound(pairs_.begin(), pairs_.end(), std::pair<std::uint32_t, std::uint32_t>{link, 0});
        for (; it != pairs_.end() && it->first == link; ++it) visit(it->second);
    }

private:
    using node_pair = std::pair<std::uint32_t, std::uint32_t>;
    struct entry {
        std::uint64_t key = 0;
        std::uint32_t head = 0;
        std::uint32_t epoch = 0;
    };
    static constexpr std::uint32_t end = ~std::uint32_t{0};

    [[nodiscard]] std::uint64_t link_mask() const noexcept {
        return links_ == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << links_) - 1;
    }

    void connect(std::uint32_t a, std::uint32_t b) {
        if (small_) {
            words_[a] |= std::uint64_t{1} << b;
            words_[b] |= std::uint64_t{1} << a;
        } else {
            pairs_.push_back({a, b});
            pairs_.push_back({b, a});
        }
    }

    void close_words() {
        std::uint64_t left = nodes_ == links_ ? 0 : ~link_mask();
        if (nodes_ < 64) left &= (std::uint64_t{1} << nodes_) - 1;
        while (left != 0) {
            std::uint64_t piece = left & (~left + 1);
            std::uint64_t reached = 0;
            for (std::uint64_t front = piece; front != 0;) {
                auto const t = static_cast<std::size_t>(std::countr_zero(front));
                front &= front - 1;
                reached |= words_[t];
                std::uint64_t const fresh = words_[t] & ~link_mask() & ~piece;
                piece |= fresh;
                front |= fresh;
            }
            left &= ~piece;
            reached &= link_mask();
            for (std::uint64_t w = reached; w != 0; w &= w - 1) {
                words_[static_cast<std::size_t>(std::countr_zero(w))] |= reached;
            }
        }
    }

    void close_pairs() {
        if (nodes_ > links_) {
            // Root of each transparent node's piece, by union-find over transparent-transparent pairs.
            std::vector<std::uint32_t> root(nodes_);
            for (std::size_t i = 0; i < nodes_; ++i) root[i] = static_cast<std::uint32_t>(i);
            auto const find = [&](std::uint32_t x) {
                while (root[x] != x) x = root[x] = root[root[x]];
                return x;
            };
            for (auto const& [a, b] : pairs_) {
                if (a >= links_ && b >= links_) root[find(a)] = find(b);
            }
            std::vector<node_pair> touch;  // (piece, link)
            for (auto const& [a, b] : pairs_) {
                if (a >= links_ && b < links_) touch.push_back({find(a), b});
            }
            std::erase_if(pairs_, [&](node_pair const& p) { return p.first >= links_ || p.second >= links_; });
            std::sort(touch.begin(), touch.end());
            touch.erase(std::unique(touch.begin(), touch.end()), touch.end());
            for (std::size_t i = 0; i < touch.size(); ++i) {
                for (std::size_t j = i + 1; j < touch.size() && touch[j].first == touch[i].first; ++j) {
                    connect(touch[i].second, touch[j].second);
                }
            }
        }
        std::sort(pairs_.begin(), pairs_.end());
        pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
    }

    std::size_t links_ = 0;
    std::size_t nodes_ = 0;
    bool small_ = true;
    std::vector<std::uint64_t> words_{};
    std::vector<node_pair> pairs_{};
    std::vector<entry> table_{};
    std::vector<node_pair> chain_{};  ///< (node, next) of the edges with equal ends
    std::size_t mask_ = 0;
    std::uint32_t epoch_ = 0;
};

}  // namespace tafoni::detail

#endif
