/// \file
/// Sites along a space-filling curve, and the tree of boxes over them.
#ifndef TAFONI_DECOMPOSITION_DETAIL_SITE_TREE_HPP
#define TAFONI_DECOMPOSITION_DETAIL_SITE_TREE_HPP

#include <tafoni/geometry/lattice.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// The axis that holds the highest bit, in Morton order (x before y before z), in which a and b differ.
[[nodiscard]] inline std::size_t morton_axis(ivec3 const& a, ivec3 const& b) noexcept {
    std::size_t axis = 0;
    auto best = static_cast<std::uint64_t>(a[0] ^ b[0]);
    for (std::size_t k = 1; k < 3; ++k) {
        auto const d = static_cast<std::uint64_t>(a[k] ^ b[k]);
        if (best < d && best < (best ^ d)) {
            axis = k;
            best = d;
        }
    }
    return axis;
}

/// Order along the Morton curve: a function of the coordinates alone.
[[nodiscard]] inline bool morton_less(ivec3 const& a, ivec3 const& b) noexcept {
    std::size_t const k = morton_axis(a, b);
    return a[k] < b[k];
}

/// The upper 21 bits of each coordinate, interleaved.
[[nodiscard]] inline std::uint64_t morton_prefix(ivec3 const& p) noexcept {
    auto const spread = [](std::int64_t v) {
        auto x = std::min(static_cast<std::uint64_t>(v) >> (lattice_frame::bits - 21), std::uint64_t{0x1fffff});
        x = (x | x << 32) & 0x001f00000000ffffULL;
        x = (x | x << 16) & 0x001f0000ff0000ffULL;
        x = (x | x << 8) & 0x100f00f00f00f00fULL;
        x = (x | x << 4) & 0x10c30c30c30c30c3ULL;
        return (x | x << 2) & 0x1249249249249249ULL;
    };
    return spread(p[0]) << 2 | spread(p[1]) << 1 | spread(p[2]);
}

/// Indices of the points in Morton order; equal points in order of index. O(n log n).
[[nodiscard]] inline std::vector<std::uint32_t> morton_order(std::span<ivec3 const> points) {
    struct entry {
        std::uint64_t key;
        std::uint32_t index;
    };
    std::vector<entry> entries(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
        entries[k] = {morton_prefix(points[k]), static_cast<std::uint32_t>(k)};
    }
    // 2^57 itself is the one coordinate that needs 58 bits: its prefix is clamped, hence the full compare.
    std::sort(entries.begin(), entries.end(), [&points](entry const& a, entry const& b) {
        if (a.key != b.key) return a.key < b.key;
        ivec3 const& p = points[a.index];
        ivec3 const& q = points[b.index];
        return p == q ? a.index < b.index : morton_less(p, q);
    });
    std::vector<std::uint32_t> order(points.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = entries[k].index;
    return order;
}

/// A binary tree over sites in Morton order, in preorder: the first child of node k is k + 1, the
/// next node outside the subtree of k is `skip`. Boxes are tight, so depth adapts to any density.
/// At most 2 n nodes; depth at most 174, whatever the sites.
struct site_tree {
    static constexpr std::uint32_t leaf_size = 8;

    struct node {
        ivec3 lo{};
        ivec3 hi{};
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
        std::uint32_t skip = 0;
        float spacing = 0;  ///< rough distance between the sites here, lattice units
    };

    std::vector<node> nodes;
    std::vector<std::uint32_t> leaves;  ///< nodes without children, by `begin`

    [[nodiscard]] bool is_leaf(std::size_t k) const noexcept { return nodes[k].skip == k + 1; }

    /// Expects distinct sites in Morton order, at least one. O(n log n), n = sites.size().
    explicit site_tree(std::span<ivec3 const> sites) {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> open{{0, static_cast<std::uint32_t>(sites.size())}};
        nodes.reserve(sites.size() / 2 + 1);
        while (!open.empty()) {
            auto const [begin, end] = open.back();
            open.pop_back();
            auto const here = static_cast<std::uint32_t>(nodes.size());
            nodes.push_back({.begin = begin, .end = end});
            if (end - begin <= leaf_size) {
                leaves.push_back(here);
                continue;
            }
            ivec3 const& first = sites[begin];
            std::size_t const axis = morton_axis(first, sites[end - 1]);
            auto const top = std::bit_floor(static_cast<std::uint64_t>(first[axis] ^ sites[end - 1][axis]));
            auto const bit = static_cast<std::int64_t>(top);
            auto const middle = std::partition_point(sites.begin() + begin, sites.begin() + end,
                                                     [&](ivec3 const& p) { return (p[axis] & bit) == 0; });
            auto const split = static_cast<std::uint32_t>(middle - sites.begin());
            open.emplace_back(split, end);
            open.emplace_back(begin, split);
        }
        for (std::size_t k = nodes.size(); k-- > 0;) finish(sites, k);
        for (std::size_t k = 0; k < nodes.size(); ++k) pass_spacing_down(k);
    }

private:
    void finish(std::span<ivec3 const> sites, std::size_t k) {
        node& v = nodes[k];
        if (v.end - v.begin <= leaf_size) {
            v.skip = static_cast<std::uint32_t>(k) + 1;
            v.lo = v.hi = sites[v.begin];
            for (std::uint32_t s = v.begin + 1; s < v.end; ++s) {
                for (std::size_t a = 0; a < 3; ++a) {
                    v.lo[a] = std::min(v.lo[a], sites[s][a]);
                    v.hi[a] = std::max(v.hi[a], sites[s][a]);
                }
            }
        } else {
            node const& l = nodes[k + 1];
            node const& r = nodes[l.skip];
            v.skip = r.skip;
            for (std::size_t a = 0; a < 3; ++a) {
                v.lo[a] = std::min(l.lo[a], r.lo[a]);
                v.hi[a] = std::max(l.hi[a], r.hi[a]);
            }
        }
    }

    // Spacing is only a guess of how far to look, so its bits need not be reproducible.
    void pass_spacing_down(std::size_t k) {
        node& v = nodes[k];
        std::uint32_t const count = v.end - v.begin;
        if (k == 0 || count >= 24) {
            double volume = 1;
            double longest = 0;
            for (std::size_t a = 0; a < 3; ++a) {
                auto const side = static_cast<double>(v.hi[a] - v.lo[a]);
                volume *= side;
                longest = std::max(longest, side);
            }
            v.spacing = static_cast<float>(std::max(std::cbrt(volume / count), longest / count));
        }
        if (is_leaf(k)) return;
        nodes[k + 1].spacing = v.spacing;
        nodes[nodes[k + 1].skip].spacing = v.spacing;
    }
};

}  // namespace tafoni::detail

#endif
