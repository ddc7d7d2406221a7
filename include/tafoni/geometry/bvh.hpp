/// \file
/// A tree of boxes over triangles: nearest points, rays, inside or outside, overlaps.
#ifndef TAFONI_GEOMETRY_BVH_HPP
#define TAFONI_GEOMETRY_BVH_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/geometry/detail/triangle_queries.hpp>
#include <tafoni/geometry/solid.hpp>
#include <tafoni/geometry/winding_number.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tafoni {

/// A balanced tree over triangles, which it copies. The same triangles give the same tree and answers everywhere.
///
/// Node i has the children 2 i and 2 i + 1; the 2^k leaves hold one to four triangles each. So depth is
/// at most log2(n), `refit` is one sweep, and no query recurses. About 150 bytes per triangle.
class bvh {
public:
    /// A triangle and the point on it that a query found.
    struct hit {
        std::uint32_t triangle = 0;
        vec3 point{0, 0, 0};
        double distance = 0;  ///< from the query point; for rays the multiple of the direction
    };

    bvh() = default;

    /// Splits at the median along the longest side of the box of the centres; ties by index.
    /// \throws invalid_input  size_overflow beyond 32-bit indices, index_out_of_range, non_finite_vertex. O(n log n).
    bvh(std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles) {
        std::size_t const n = triangles.size();
        detail::require_indexable("bvh", n);
        require_sound(positions, triangles);
        order_.resize(n);
        corners_.resize(n);
        if (n == 0) return;
        while (leaves_ * 4 < n) leaves_ *= 2;
        std::vector<vec3> centres(n);
        for (std::uint32_t t = 0; t < n; ++t) {
            order_[t] = t;
            box3 box;
            for (std::uint32_t const v : triangles[t]) box.include(positions[v]);
            centres[t] = box.centre();
        }
        for (std::size_t width = leaves_; width > 1; width /= 2) {
            for (std::size_t first = 0; first < leaves_; first += width) split(centres, first, width);
        }
        for (std::size_t leaf = 0; leaf < leaves_; ++leaf) std::sort(at(leaf), at(leaf + 1));
        nodes_.resize(2 * leaves_);
        place(positions, triangles);
    }

    explicit bvh(solid const& s) : bvh(s.positions, s.triangles) {}

    /// Follows moved vertices; the triangles must be those of the constructor.
    /// \throws invalid_input  attribute_length where their number differs, and as the constructor; the tree is then
    ///   as it was. O(n).
    void refit(std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles) {
        if (triangles.size() != order_.size()) {
            detail::fail<invalid_input>(errc::attribute_length,
                                        "bvh: refit got " + std::to_string(triangles.size()) + " triangles, the tree has " +
                                            std::to_string(order_.size()),
                                        {.kind = entity::face,
                                         .value = static_cast<double>(triangles.size()),
                                         .limit = static_cast<double>(order_.size())});
        }
        require_sound(positions, triangles);
        if (order_.empty()) return;
        place(positions, triangles);
    }

    [[nodiscard]] std::size_t size() const noexcept { return order_.size(); }

    /// The nearest point of the triangles, of the lowest triangle on a tie; none when there are no
    /// triangles, or none whose squared distance is finite. O(log n) where triangles are spread evenly.
    [[nodiscard]] std::optional<hit> nearest_point(vec3 const& p) const {
        if (order_.empty()) return std::nullopt;
        hit best;
        double limit = std::numeric_limits<double>::infinity();
        walk([&](box3 const& box) { return detail::squared_distance(box, p); },
             [&](double key) { return key <= limit; },
             [&](std::uint32_t triangle, auto const& c) {
                 vec3 const q = detail::nearest_on_triangle(c[0], c[1], c[2], p);
                 double const d = squared_length(vec3{q[0] - p[0], q[1] - p[1], q[2] - p[2]});
                 if (d < limit || (d == limit && triangle < best.triangle)) {
                     limit = d;
                     best = {triangle, q, 0};
                 }
             });
        if (!(limit < std::numeric_limits<double>::infinity())) return std::nullopt;
        best.distance = std::sqrt(limit);
        return best;
    }

    /// Where the ray origin + t direction, 0 <= t <= reach, first meets a triangle, on either side;
    /// does not slip between triangles that share an edge. O(log n) where triangles are spread evenly.
    [[nodiscard]] std::optional<hit> first_hit(vec3 const& origin, vec3 const& direction,
                                               double reach = std::numeric_limits<double>::infinity()) const {
        if (order_.empty() || !(squared_length(direction) > 0)) return std::nullopt;
        detail::sheared_ray const ray(origin, direction);
        std::optional<hit> best;
        double limit = reach;
        walk([&](box3 const& box) { return ray.entry(box); }, [&](double key) { return key <= limit; },
             [&](std::uint32_t triangle, auto const& c) {
                 double const t = ray.meet(c[0], c[1], c[2]);
                 if (!(t >= 0 && t <= limit)) return;
                 if (best && t == limit && best->triangle < triangle) return;
                 limit = t;
                 best = hit{triangle,
                            vec3{origin[0] + t * direction[0], origin[1] + t * direction[1],
                                 origin[2] + t * direction[2]},
                            t};
             });
        return best;
    }

    /// As `tafoni::winding_number`, for closed surfaces. O(log n + triangles above p).
    [[nodiscard]] int winding_number(vec3 const& p) const {
        int sum = 0;
        visit(
            [&](box3 const& b) {
                return b.lo[0] <= p[0] && p[0] <= b.hi[0] && b.lo[1] <= p[1] && p[1] <= b.hi[1] && p[2] <= b.hi[2];
            },
            [&](std::uint32_t, auto const& c) { sum += detail::upward_crossing(c[0], c[1], c[2], p); });
        return sum;
    }

    /// Calls f(triangle) for every triangle whose box touches `box`, in an order that is always the same.
    template <class F>
    void for_each_in(box3 const& box, F const& f) const {
        visit([&](box3 const& b) { return detail::overlap(b, box); },
              [&](std::uint32_t triangle, auto const& c) {
                  box3 own;
                  for (vec3 const& p : c) own.include(p);
                  if (detail::overlap(own, box)) f(triangle);
              });
    }

private:
    static void require_sound(std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles) {
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            for (std::uint32_t const v : triangles[t]) {
                if (v >= positions.size()) {
                    detail::fail<invalid_input>(errc::index_out_of_range,
                                                "bvh: triangle " + std::to_string(t) + " names vertex " + std::to_string(v) +
                                                    ", there are " + std::to_string(positions.size()),
                                                {.kind = entity::face,
                                                 .index = t,
                                                 .value = static_cast<double>(v),
                                                 .limit = static_cast<double>(positions.size()) - 1});
                }
                if (!is_finite(positions[v])) {
                    detail::fail<invalid_input>(errc::non_finite_vertex,
                                                "bvh: vertex " + std::to_string(v) + " is not finite",
                                                {.kind = entity::vertex, .index = v});
                }
            }
        }
    }

    /// Copies the corners and boxes them from the leaves up.
    void place(std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles) {
        for (std::size_t i = 0; i < order_.size(); ++i) {
            auto const& t = triangles[order_[i]];
            corners_[i] = {positions[t[0]], positions[t[1]], positions[t[2]]};
        }
        for (std::size_t leaf = 0; leaf < leaves_; ++leaf) {
            box3 box;
            for (std::size_t i = begin(leaf); i < begin(leaf + 1); ++i) {
                for (vec3 const& p : corners_[i]) box.include(p);
            }
            nodes_[leaves_ + leaf] = box;
        }
        for (std::size_t node = leaves_; --node > 0;) {
            nodes_[node] = nodes_[2 * node];
            nodes_[node].include(nodes_[2 * node + 1].lo);
            nodes_[node].include(nodes_[2 * node + 1].hi);
        }
    }

    /// Triangles of leaf l are [begin(l), begin(l + 1)) in `order_`.
    [[nodiscard]] std::size_t begin(std::size_t leaf) const noexcept { return leaf * order_.size() / leaves_; }
    [[nodiscard]] std::vector<std::uint32_t>::iterator at(std::size_t leaf) noexcept {
        return order_.begin() + static_cast<std::ptrdiff_t>(begin(leaf));
    }

    void split(std::vector<vec3> const& centres, std::size_t first, std::size_t width) {
        box3 box;
        for (auto i = at(first); i != at(first + width); ++i) box.include(centres[*i]);
        vec3 const extent = box.extent();
        int axis = 0;
        for (int a = 1; a < 3; ++a) {
            if (extent[a] > extent[axis]) axis = a;
        }
        std::nth_element(at(first), at(first + width / 2), at(first + width), [&](std::uint32_t x, std::uint32_t y) {
            double const a = centres[x][axis];
            double const b = centres[y][axis];
            return a != b ? a < b : x < y;
        });
    }

    /// Nearer children first; `key` of a box is a lower bound or NaN, `wanted` may grow stricter on the way.
    template <class Key, class Wanted, class Leaf>
    void walk(Key const& key, Wanted const& wanted, Leaf const& leaf) const {
        struct entry {
            std::size_t node;
            double key;
        };
        std::array<entry, 64> stack;
        std::size_t top = 0;
        stack[top++] = {1, key(nodes_[1])};
        while (top > 0) {
            entry const e = stack[--top];
            if (!wanted(e.key)) continue;
            if (e.node >= leaves_) {
                for_leaf(e.node, leaf);
                continue;
            }
            entry left{2 * e.node, key(nodes_[2 * e.node])};
            entry right{2 * e.node + 1, key(nodes_[2 * e.node + 1])};
            if (right.key < left.key) std::swap(left, right);
            stack[top++] = right;
            stack[top++] = left;
        }
    }

    template <class Enter, class Leaf>
    void visit(Enter const& enter, Leaf const& leaf) const {
        if (order_.empty()) return;
        std::array<std::size_t, 64> stack;
        std::size_t top = 0;
        stack[top++] = 1;
        while (top > 0) {
            std::size_t const node = stack[--top];
            if (!enter(nodes_[node])) continue;
            if (node >= leaves_) {
                for_leaf(node, leaf);
                continue;
            }
            stack[top++] = 2 * node + 1;
            stack[top++] = 2 * node;
        }
    }

    template <class Leaf>
    void for_leaf(std::size_t node, Leaf const& leaf) const {
        std::size_t const l = node - leaves_;
        for (std::size_t i = begin(l); i < begin(l + 1); ++i) leaf(order_[i], corners_[i]);
    }

    std::size_t leaves_ = 1;
    std::vector<std::uint32_t> order_{};               ///< triangles by leaf
    std::vector<std::array<vec3, 3>> corners_{};       ///< in the same order
    std::vector<box3> nodes_{};                        ///< from 1
};

}  // namespace tafoni

#endif
