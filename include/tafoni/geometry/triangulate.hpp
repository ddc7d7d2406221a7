/// \file
/// Cuts a polygon in space into triangles, always in the same way.
#ifndef TAFONI_GEOMETRY_TRIANGULATE_HPP
#define TAFONI_GEOMETRY_TRIANGULATE_HPP

#include <tafoni/core/vector.hpp>
#include <tafoni/geometry/detail/exact_sign.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace tafoni {

namespace detail {

/// Ear clipping on the coordinate plane that the polygon covers best.
class ear_clipper {
public:
    void operator()(std::span<vec3 const> loop, std::vector<std::array<std::uint32_t, 3>>& out) {
        loop_ = loop;
        std::uint32_t const n = static_cast<std::uint32_t>(loop.size());
        if (n < 3) return;
        if (n == 3) {
            out.push_back({0, 1, 2});
            return;
        }
        choose_plane();
        if (n == 4 && turn(0, 1, 2) > 0 && turn(0, 2, 3) > 0) {
            out.push_back({0, 1, 2});
            out.push_back({0, 2, 3});
            return;
        }
        link();
        std::size_t left = n;
        while (left > 3) {
            std::uint32_t const tip = next_ear(left);
            out.push_back({previous_[tip], tip, following_[tip]});
            unlink(tip);
            --left;
        }
        std::uint32_t const a = start_;
        out.push_back({a, following_[a], following_[following_[a]]});
    }

private:
    struct ear {
        double squared_cut;  ///< of the diagonal that cuts the ear off
        std::uint32_t tip;
        std::uint32_t before;
        std::uint32_t after;
    };

    /// Newell's normal, summed from the lowest corner so that it does not depend on where the loop starts.
    void choose_plane() {
        std::size_t const n = loop_.size();
        start_ = 0;
        for (std::uint32_t i = 1; i < n; ++i) {
            if (lexicographically_less(loop_[i], loop_[start_])) start_ = i;
        }
        vec3 const origin = loop_[start_];
        vec3 normal{0, 0, 0};
        vec3 a{0, 0, 0};
        for (std::size_t k = 1; k < n; ++k) {
            vec3 const& p = loop_[(start_ + k) % n];
            vec3 const b{p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]};
            vec3 const c = cross(a, b);
            normal = vec3{normal[0] + c[0], normal[1] + c[1], normal[2] + c[2]};
            a = b;
        }
        int drop = 2;
        if (std::fabs(normal[1]) > std::fabs(normal[drop])) drop = 1;
        if (std::fabs(normal[0]) > std::fabs(normal[drop])) drop = 0;
        axis_u_ = (drop + 1) % 3;
        axis_v_ = (drop + 2) % 3;
        if (normal[drop] < 0) std::swap(axis_u_, axis_v_);
    }

    void link() {
        std::uint32_t const n = static_cast<std::uint32_t>(loop_.size());
        previous_.resize(n);
        following_.resize(n);
        alive_.assign(n, 1);
        for (std::uint32_t i = 0; i < n; ++i) {
            previous_[i] = i == 0 ? n - 1 : i - 1;
            following_[i] = i + 1 == n ? 0 : i + 1;
        }
        reflex_.clear();
        turns_left_.resize(n);
        for (std::uint32_t i = 0; i < n; ++i) {
            note_turn(i);
            if (turns_left_[i] == 0) reflex_.push_back(i);
        }
        heap_.clear();
        for (std::uint32_t i = 0; i < n; ++i) offer(i);
    }

    void unlink(std::uint32_t tip) {
        std::uint32_t const before = previous_[tip];
        std::uint32_t const after = following_[tip];
        following_[before] = after;
        previous_[after] = before;
        alive_[tip] = 0;
        if (start_ == tip) start_ = after;
        note_turn(before);
        note_turn(after);
        offer(before);
        offer(after);
    }

    /// A corner's turn changes with its neighbours only, so it is kept.
    void note_turn(std::uint32_t corner) noexcept {
        turns_left_[corner] = turn(previous_[corner], corner, following_[corner]) > 0 ? 1 : 0;
    }

    [[nodiscard]] int turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const noexcept {
        vec3 const& p = loop_[a];
        vec3 const& q = loop_[b];
        vec3 const& r = loop_[c];
        return turn_sign(p[axis_u_], p[axis_v_], q[axis_u_], q[axis_v_], r[axis_u_], r[axis_v_]);
    }

    [[nodiscard]] bool same_place(std::uint32_t a, std::uint32_t b) const noexcept {
        return loop_[a][axis_u_] == loop_[b][axis_u_] && loop_[a][axis_v_] == loop_[b][axis_v_];
    }

    [[nodiscard]] bool is_ear(std::uint32_t tip) {
        std::uint32_t const a = previous_[tip];
        std::uint32_t const c = following_[tip];
        if (turns_left_[tip] == 0) return false;
        // Most corners are nowhere near: the box of the ear tells without an exact sign.
        auto const range = [&](int axis) {
            return std::minmax({loop_[a][axis], loop_[tip][axis], loop_[c][axis]});
        };
        auto const u = range(axis_u_);
        auto const v = range(axis_v_);
        // Only corners that turn right or not at all can be the first to reach into an ear.
        std::size_t kept = 0;
        bool blocked = false;
        for (std::size_t i = 0; i < reflex_.size(); ++i) {
            std::uint32_t const p = reflex_[i];
            if (!alive_[p] || turns_left_[p] != 0) continue;
            reflex_[kept++] = p;
            if (blocked || p == a || p == tip || p == c) continue;
            double const p_u = loop_[p][axis_u_];
            double const p_v = loop_[p][axis_v_];
            if (p_u < u.first || p_u > u.second || p_v < v.first || p_v > v.second) continue;
            if (same_place(p, a) || same_place(p, tip) || same_place(p, c)) continue;
            blocked = turn(a, tip, p) >= 0 && turn(tip, c, p) >= 0 && turn(c, a, p) >= 0;
        }
        reflex_.resize(kept);
        return !blocked;
    }

    void offer(std::uint32_t tip) {
        if (!is_ear(tip)) return;
        vec3 const& p = loop_[previous_[tip]];
        vec3 const& q = loop_[following_[tip]];
        heap_.push_back({squared_length(vec3{p[0] - q[0], p[1] - q[1], p[2] - q[2]}), tip, previous_[tip],
                         following_[tip]});
        std::push_heap(heap_.begin(), heap_.end(), [this](ear const& x, ear const& y) { return worse(x, y); });
    }

    /// The shortest cut goes first; ties go by place, so that renumbering the loop changes nothing.
    [[nodiscard]] bool worse(ear const& x, ear const& y) const noexcept {
        if (x.squared_cut != y.squared_cut) return x.squared_cut > y.squared_cut;
        vec3 const& p = loop_[x.tip];
        vec3 const& q = loop_[y.tip];
        if (lexicographically_less(q, p)) return true;
        if (lexicographically_less(p, q)) return false;
        return x.tip > y.tip;
    }

    [[nodiscard]] std::uint32_t next_ear(std::size_t left) {
        for (int round = 0; round < 2; ++round) {
            while (!heap_.empty()) {
                std::pop_heap(heap_.begin(), heap_.end(), [this](ear const& x, ear const& y) { return worse(x, y); });
                ear const e = heap_.back();
                heap_.pop_back();
                if (alive_[e.tip] && previous_[e.tip] == e.before && following_[e.tip] == e.after) return e.tip;
            }
            // A clipped corner may have been the only one in the way of another ear.
            std::uint32_t tip = start_;
            for (std::size_t i = 0; i < left; ++i, tip = following_[tip]) offer(tip);
        }
        // The projection cuts itself: take a corner that turns left, else any; the count stays n - 2.
        std::uint32_t tip = start_;
        for (std::size_t i = 0; i < left; ++i, tip = following_[tip]) {
            if (turns_left_[tip] != 0) return tip;
        }
        return start_;
    }

    std::span<vec3 const> loop_{};
    int axis_u_ = 0;
    int axis_v_ = 1;
    std::uint32_t start_ = 0;
    std::vector<std::uint32_t> previous_{};
    std::vector<std::uint32_t> following_{};
    std::vector<std::uint32_t> reflex_{};
    std::vector<std::uint8_t> alive_{};
    std::vector<std::uint8_t> turns_left_{};
    std::vector<ear> heap_{};
};

struct triangulate_fn {
    /// The n - 2 triangles of one closed loop of n >= 3 corners, as corner numbers, with the loop's turn.
    ///
    /// The polygon may be concave and need not be flat: it is seen along the axis in which its area
    /// vector is largest. A quad is cut from its first to its third corner where that works, as most
    /// programs do, so that volumes agree with theirs. All else is clipped ear by ear, the shortest cut
    /// first, and does not depend on where the loop starts. Where the seen outline cuts itself or has
    /// no area the count still holds, only the shape is arbitrary. Fewer than three corners give
    /// nothing. O(n (r + log n)) for r corners that do not turn left.
    [[nodiscard]] std::vector<std::array<std::uint32_t, 3>> operator()(std::span<vec3 const> loop) const {
        std::vector<std::array<std::uint32_t, 3>> out;
        ear_clipper clip;
        clip(loop, out);
        return out;
    }
};

}  // namespace detail

/// Triangulates a polygon; see `detail::triangulate_fn`.
inline constexpr detail::triangulate_fn triangulate{};

}  // namespace tafoni

#endif
