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

    /// Forms the loops. O(n log n), also where many edges leave one vertex.
    void link() {
        std::sort(edges_.begin(), edges_.end());
        next_.resize(edges_.size());
        place_.assign(edges_.size(), nowhere);
        for (std::size_t e = 0; e < edges_.size(); ++e) next_[e] = e;
        corners_.clear();
        begin_.assign(1, 0);
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            if (e != 0 && edges_[e].from == edges_[e - 1].from) continue;
            while (has_edge(e)) follow(e);
        }
    }

    [[nodiscard]] std::size_t loop_count() const noexcept { return begin_.size() - 1; }
    [[nodiscard]] std::span<std::uint32_t const> loop(std::size_t l) const noexcept {
        return {corners_.data() + begin_[l], begin_[l + 1] - begin_[l]};
    }

private:
    static constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

    /// A vertex is named by the first edge that leaves it. Is one of its edges still unused?
    [[nodiscard]] bool has_edge(std::size_t v) const noexcept {
        return next_[v] < edges_.size() && edges_[next_[v]].from == edges_[v].from;
    }

    /// Walks from vertex v until the path has come back and all of it is in loops.
    void follow(std::size_t v) {
        path_.clear();
        for (;;) {
            // Where the path meets itself, the part in between is a loop of its own.
            if (place_[v] != nowhere) {
                std::size_t const at = place_[v];
                bool const loop = path_.size() - at > 2;
                for (std::size_t k = at; k < path_.size(); ++k) {
                    if (loop) corners_.push_back(edges_[path_[k]].from);
                    place_[path_[k]] = nowhere;
                }
                if (loop) begin_.push_back(corners_.size());
                path_.resize(at);
                if (path_.empty()) return;
            }
            TAFONI_ASSERT(has_edge(v), "every edge has a successor");
            if (!has_edge(v)) break;
            place_[v] = path_.size();
            path_.push_back(v);
            std::uint32_t const head = edges_[next_[v]++].to;
            v = static_cast<std::size_t>(std::lower_bound(edges_.begin(), edges_.end(), linked_edge{head, 0}) - edges_.begin());
            if (v == edges_.size() || edges_[v].from != head) break;
        }
        for (std::size_t k : path_) place_[k] = nowhere;
    }

    std::vector<linked_edge> edges_{};
    std::vector<std::size_t> next_{};   // vertex -> its first unused edge
    std::vector<std::size_t> place_{};  // vertex -> where the path passes it
    std::vector<std::size_t> path_{};   // vertices
    std::vector<std::uint32_t> corners_{};
    std::vector<std::size_t> begin_{0};
};

}  // namespace tafoni::detail

#endif
