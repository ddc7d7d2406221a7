/// \file
/// Rock in motion, counted in whole units.
#ifndef TAFONI_WEATHERING_DETAIL_SEDIMENT_HPP
#define TAFONI_WEATHERING_DETAIL_SEDIMENT_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/geometry/vertex_rings.hpp>
#include <tafoni/weathering/detail/particle_loads.hpp>
#include <tafoni/weathering/detail/sound_moves.hpp>
#include <tafoni/weathering/hydraulic_erosion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// Volumes as multiples of one power of two, so that sums are exact in any order.
class volume_unit {
public:
    volume_unit() = default;
    /// 2^-46 of the largest volume that a vertex moves by in an iteration: a grain for the slowest rule, and room for
    /// 2^17 such moves of a vertex.
    explicit volume_unit(double largest) noexcept {
        int exponent = 0;
        (void)std::frexp(largest > 0 && std::isfinite(largest) ? largest : 1.0, &exponent);
        unit_ = std::ldexp(1.0, std::clamp(exponent - 46, -1000, 1000));
        inverse_ = 1 / unit_;
    }
    /// Nearest; what is beyond 2^56 units is cut there, so that sums of some do not overflow.
    [[nodiscard]] std::int64_t fixed(double volume) const noexcept {
        double const n = std::floor(volume * inverse_ + 0.5);
        return static_cast<std::int64_t>(std::clamp(n, -0x1p56, 0x1p56));
    }
    [[nodiscard]] double volume(volume_sum units) const noexcept { return static_cast<double>(units) * unit_; }

private:
    double unit_ = 1;
    double inverse_ = 1;
};

/// Who holds what: particles by id, vertices what they owe (below 0) or are owed.
struct sediment_books {
    particle_loads load{};
    std::vector<std::int64_t> due{};  ///< per vertex
    volume_sum eroded = 0;
    volume_sum deposited = 0;
    volume_sum left = 0;

    [[nodiscard]] volume_sum carried() const noexcept {
        volume_sum sum = load.sum();
        for (std::int64_t const v : due) sum += v;
        return sum;
    }
    [[nodiscard]] bool balanced() const noexcept { return eroded == deposited + carried() + left; }
    /// What left with particles before the surface gave it counts when it is given.
    [[nodiscard]] sediment_ledger in(volume_unit const& unit) const noexcept {
        volume_sum const now = carried();
        volume_sum const lent = std::clamp<volume_sum>(now, std::min<volume_sum>(-left, 0), 0);
        return {.eroded = unit.volume(eroded), .deposited = unit.volume(deposited), .carried = unit.volume(now - lent), .left = unit.volume(left + lent)};
    }
};

/// A particle gives back what a vertex owes that other walls hold, as far as it carries that much.
inline void give_back(moving_surface const& s, std::uint32_t v, std::int64_t& due, std::int64_t& load) noexcept {
    if (due >= 0 || load <= 0 || s.may_move(v)) return;
    std::int64_t const back = std::min(load, -due);
    due += back;
    load -= back;
}

/// Who asks for what in an iteration, and what the surface can give.
///
/// Particles `ask` first; `close` compares what a vertex is asked for with what it may move by in an iteration, less
/// what it owes already; each request is then granted in that share. So water in a place that cannot follow takes no
/// more than that place gives, and no debt grows. All in whole units and in one order.
class sediment_exchange {
public:
    void open(std::size_t vertices) {
        out_.assign(vertices, 0);
        in_.assign(vertices, 0);
        out_share_.assign(vertices, 1.0);
        in_share_.assign(vertices, 1.0);
    }
    /// A corner's part of what is taken from a face: thirds that add up, the rest going to the first corners.
    [[nodiscard]] static std::int64_t third(std::int64_t taken, std::size_t corner) noexcept {
        std::int64_t const each = taken / 3;
        std::int64_t const rest = taken - 3 * each;
        if (static_cast<std::int64_t>(corner) >= (rest < 0 ? -rest : rest)) return each;
        return each + (rest < 0 ? -1 : 1);
    }
    void ask(std::array<std::uint32_t, 3> const& corners, std::int64_t taken) noexcept {
        for (std::size_t k = 0; k < 3; ++k) {
            std::int64_t const part = third(taken, k);
            std::int64_t& sum = (part > 0 ? out_ : in_)[corners[k]];
            sum = std::min(sum + (part > 0 ? part : -part), std::int64_t{1} << 61);
        }
    }
    /// O(faces at the vertices that were asked).
    void close(moving_surface const& surface, sound_moves const& moves, volume_unit const& unit, double most, sediment_books const& books) {
        for (std::size_t v = 0; v < out_.size(); ++v) {
            if (out_[v] == 0 && in_[v] == 0) continue;
            std::int64_t const cap = unit.fixed(moves.room(v, surface).volume(most));
            out_share_[v] = share(cap + std::min<std::int64_t>(books.due[v], 0), out_[v]);
            in_share_[v] = share(cap - std::max<std::int64_t>(books.due[v], 0), in_[v]);
        }
    }
    /// Whether particles asked the vertex for something, or offered it.
    [[nodiscard]] bool asked(std::size_t v) const noexcept { return out_[v] != 0 || in_[v] != 0; }
    /// What of a corner's part is granted: of its sign, and no more.
    [[nodiscard]] std::int64_t grant(std::uint32_t vertex, std::int64_t part) const noexcept {
        double const share = (part > 0 ? out_share_ : in_share_)[vertex];
        if (share >= 1) return part;
        double const size = std::floor(static_cast<double>(part > 0 ? part : -part) * share);
        return part > 0 ? static_cast<std::int64_t>(size) : -static_cast<std::int64_t>(size);
    }

private:
    [[nodiscard]] static double share(std::int64_t room, std::int64_t asked) noexcept {
        if (asked <= room) return 1;
        return room > 0 ? static_cast<double>(room) / static_cast<double>(asked) : 0.0;
    }

    std::vector<std::int64_t> out_{};  ///< asked of the vertex
    std::vector<std::int64_t> in_{};   ///< offered to it
    std::vector<double> out_share_{};
    std::vector<double> in_share_{};
};

/// Moves vertices by the volume that they owe or are owed [thesis, 8.3, signed].
class sediment_settlement {
public:
    /// One vertex after the other, by number, along the sum of the normals of its faces weighted by area, in which
    /// direction the volume changes fastest; no farther than `most` and its `vertex_room`. A move that is not sound is
    /// halved, twice at most, then left. Before vertices move half of what is due goes to the neighbours by area: a
    /// particle wears more than the face below it, and no vertex is dug out alone. Of what then stays due half goes to
    /// those neighbours that particles asked too, so that what is two edges from the water stays as it is; never to a
    /// vertex that other walls hold. Books what the surface really changed by; adds the way to `wear` and the volume to `sediment`.
    /// O(vertices + faces at those that owe).
    void operator()(moving_surface const& s, sound_moves& moves, sediment_exchange const& asked, volume_unit const& unit, double most, sediment_books& books,
                    std::span<double> wear, std::span<std::int64_t> sediment) {
        left_.clear();
        for (std::size_t v = 0; v < books.due.size(); ++v) {
            if (books.due[v] != 0 && asked.asked(v)) left_.push_back(static_cast<std::uint32_t>(v));
        }
        pass_on(s, moves, books, [&](std::uint32_t v) { return s.may_move(v); });
        left_.clear();
        for (std::size_t v = 0; v < books.due.size(); ++v) {
            if (books.due[v] == 0) continue;
            vertex_room const room = moves.room(v, s);
            double const way = room.way(most);
            if (way > 0) {
                double const wanted = unit.volume(books.due[v]) / (room.area / 6);
                double d = std::clamp(wanted, -way, way);
                for (int halved = 0; halved < 3; ++halved, d *= 0.5) {
                    vec3 const& p = s.positions[v];
                    double const share = d / room.area;
                    vec3 const to{p[0] + share * room.sum[0], p[1] + share * room.sum[1], p[2] + share * room.sum[2]};
                    vec3 const step{to - p};
                    std::int64_t booked = unit.fixed(dot(step, room.sum) / 6);
                    // All of it, but for what so small a step loses where coordinates are large.
                    if (d == wanted && std::abs(books.due[v] - booked) <= std::abs(books.due[v]) >> 10) booked = books.due[v];
                    if (booked == 0) break;
                    if (!moves.allows(v, to, room, s)) continue;
                    s.positions[v] = to;
                    moves.went(v, length(step), s);
                    wear[v] += length(step);
                    sediment[v] += booked;
                    books.due[v] -= booked;
                    (booked < 0 ? books.eroded : books.deposited) += booked < 0 ? -booked : booked;
                    break;
                }
            }
            if (books.due[v] != 0) left_.push_back(static_cast<std::uint32_t>(v));
        }
        pass_on(s, moves, books, [&](std::uint32_t v) { return asked.asked(v) && s.may_move(v); });
    }

private:
    /// Half of what `left_` owe or are owed to the other corners of their faces, by area.
    template <class To>
    void pass_on(moving_surface const& s, sound_moves const& moves, sediment_books& books, To const& to) {
        passed_.clear();
        for (std::uint32_t const v : left_) {
            double whole = 0;
            for (auto const& c : s.rings.faces(v)) whole += moves.twice_area(c.face);
            if (!(whole > 0)) continue;
            double const each = 0.25 * static_cast<double>(books.due[v]) / whole;
            std::int64_t gone = 0;
            for (auto const& c : s.rings.faces(v)) {
                auto const part = static_cast<std::int64_t>(each * moves.twice_area(c.face));
                if (part == 0) continue;
                for (std::uint32_t k = 1; k < 3; ++k) {
                    std::uint32_t const w = s.triangles[c.face][(c.place + k) % 3];
                    if (!to(w)) continue;
                    passed_.emplace_back(w, part);
                    gone += part;
                }
            }
            books.due[v] -= gone;
        }
        for (auto const& [w, part] : passed_) books.due[w] += part;
    }

    std::vector<std::uint32_t> left_{};
    std::vector<std::pair<std::uint32_t, std::int64_t>> passed_{};
};

/// From v to the mean of its neighbours, without what leads into the solid or out of it. O(neighbours).
[[nodiscard]] inline vec3 slide(std::size_t v, vertex_room const& room, moving_surface const& s) noexcept {
    vec3 mean{0, 0, 0};
    for (std::uint32_t const w : s.rings.neighbors(v)) mean += s.positions[w] - s.positions[v];
    mean /= static_cast<double>(s.rings.neighbors(v).size());
    double const across = dot(mean, room.sum) / (room.area * room.area);
    return vec3{mean[0] - across * room.sum[0], mean[1] - across * room.sum[1], mean[2] - across * room.sum[2]};
}

/// Moves vertices to `next` as far as that is sound: the whole way, half of it, a quarter, or none, and no farther than
/// their `vertex_room`. One that may not go at all, as the tip of a triangle that is flat already, slides along the
/// surface towards the middle of its neighbours, so that it may go on later. `next` is where they are then.
/// O(vertices + faces at those that move).
inline void follow(moving_surface const& s, std::span<vec3> next, sound_moves& moves, double most) {
    for (std::size_t v = 0; v < next.size(); ++v) {
        vec3 const p = s.positions[v];
        if (next[v] == p) continue;
        vertex_room const room = moves.room(v, s);
        double const way = room.way(most);
        auto const goes = [&](vec3 const& step) {
            double const far = length(step);
            double share = far > way ? way / far : 1.0;
            for (int halved = 0; far > 0 && share > 0 && halved < 3; ++halved, share *= 0.5) {
                vec3 const to{p[0] + share * step[0], p[1] + share * step[1], p[2] + share * step[2]};
                if (!moves.allows(v, to, room, s)) continue;
                s.positions[v] = next[v] = to;
                moves.went(v, share * far, s);
                return true;
            }
            return false;
        };
        vec3 const step{next[v] - p};
        next[v] = p;
        if (!goes(step) && way > 0 && !s.rings.is_border(v)) static_cast<void>(goes(slide(v, room, s)));
    }
}

}  // namespace tafoni::detail

#endif
