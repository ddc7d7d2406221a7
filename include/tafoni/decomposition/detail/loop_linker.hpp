/// \file
/// Links directed edges into closed loops.
#ifndef TAFONI_DECOMPOSITION_DETAIL_LOOP_LINKER_HPP
#define TAFONI_DECOMPOSITION_DETAIL_LOOP_LINKER_HPP

#include <tafoni/core/error.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// A directed edge between two vertices.
struct linked_edge {
    std::uint32_t from;
    std::uint32_t to;
    friend bool operator<(linked_edge const& x, linked_edge const& y) noexcept {
        return x.from != y.from ? x.from < y.from : x.to < y.to;
    }
};

/// Scratch for one face at a time. As many edges must run into every vertex as out of it.
///
/// No loop passes a vertex twice; edges that run to and fro between two vertices vanish. The loops
/// depend on the set of edges only, not on the order in which they were added.
class loop_linker {
public:
    void clear() noexcept { edges_.clear(); }

    void add(linked_edge e) { edges_.push_back(e); }

    /// Adds e `times` times, reversed when negative.
    void add(linked_edge e, std::int32_t times) {
        for (; times > 0; --times) edges_.push_back(e);
        for (; times < 0; ++times) edges_.push_back({e.to, e.from});
    }

    /// Forms the loops. O(n log n).
    void link() {
        std::sort(edges_.begin(), edges_.end());
        used_.assign(edges_.size(), 0);
        corners_.clear();
        begin_.assign(1, 0);
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            if (used_[e] == 0) follow(e);
        }
    }

    [[nodiscard]] std::size_t loop_count() const noexcept { return begin_.size() - 1; }
    [[nodiscard]] std::span<std::uint32_t const> loop(std::size_t l) const noexcept {
        return {corners_.data() + begin_[l], begin_[l + 1] - begin_[l]};
    }

private:
    void follow(std::size_t e) {
        path_.clear();
        for (;;) {
            used_[e] = 1;
            path_.push_back(edges_[e].from);
            std::uint32_t const head = edges_[e].to;
            auto next = static_cast<std::size_t>(
                std::lower_bound(edges_.begin(), edges_.end(), linked_edge{head, 0}) - edges_.begin());
            // Where the path meets itself, the part in between is a loop of its own. That can happen
            // at its start, and where several edges leave a vertex.
            bool const several = next + 1 < edges_.size() && edges_[next + 1].from == head;
            std::size_t at = path_[0] == head ? 1 : 0;
            if (several) {
                at = path_.size();
                while (at > 0 && path_[at - 1] != head) --at;
            }
            if (at > 0) {
                if (path_.size() - (at - 1) > 2) {
                    corners_.insert(corners_.end(), path_.begin() + static_cast<std::ptrdiff_t>(at - 1), path_.end());
                    begin_.push_back(corners_.size());
                }
                path_.resize(at - 1);
                if (path_.empty()) return;
            }
            while (next < edges_.size() && edges_[next].from == head && used_[next] != 0) ++next;
            TAFONI_ASSERT(next < edges_.size() && edges_[next].from == head, "every edge has a successor");
            if (next >= edges_.size() || edges_[next].from != head) return;
            e = next;
        }
    }

    std::vector<linked_edge> edges_{};
    std::vector<std::uint8_t> used_{};
    std::vector<std::uint32_t> path_{};
    std::vector<std::uint32_t> corners_{};
    std::vector<std::size_t> begin_{0};
};

}  // namespace tafoni::detail

#endif
