/// \file
/// Rock in motion, counted in whole units.
#ifndef TAFONI_WEATHERING_DETAIL_SEDIMENT_HPP
#define TAFONI_WEATHERING_DETAIL_SEDIMENT_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/geometry/vertex_rings.hpp>
#include <tafoni/weathering/hydraulic_erosion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// Volumes as multiples of one power of two, so that sums are exact in any order.
class volume_unit {
public:
    volume_unit() = default;
    /// 2^-50 of a volume that nothing in the scene exceeds.
    explicit volume_unit(double largest) noexcept {
        int exponent = 0;
        (void)std::frexp(largest > 0 ? largest : 1.0, &exponent);
        unit_ = std::ldexp(1.0, exponent - 50);
        inverse_ = 1 / unit_;
    }
    /// Nearest; what is beyond 2^60 units is cut there.
    [[nodiscard]] std::int64_t fixed(double volume) const noexcept {
        double const n = std::floor(volume * inverse_ + 0.5);
        return static_cast<std::int64_t>(std::clamp(n, -0x1p60, 0x1p60));
    }
    [[nodiscard]] double volume(std::int64_t units) const noexcept { return static_cast<double>(units) * unit_; }

private:
    double unit_ = 1;
    double inverse_ = 1;
};

/// Who holds what: particles by id, vertices what they owe (below 0) or are owed.
struct sediment_books {
    std::unordered_map<std::uint64_t, std::int64_t> load{};  ///< never walked in its own order but to sum
    std::vector<std::int64_t> due{};                         ///< per vertex
    std::int64_t eroded = 0;
    std::int64_t deposited = 0;
    std::int64_t left = 0;

    [[nodiscard]] std::int64_t carried() const noexcept {
        std::int64_t sum = 0;
        for (auto const& [id, v] : load) sum += v;
        for (std::int64_t const v : due) sum += v;
        return sum;
    }
    [[nodiscard]] bool balanced() const noexcept { return eroded == deposited + carried() + left; }

    /// What particles that are gone carried has left the scene. `alive(id)` tells.
    template <class Alive>
    void drop_gone(Alive const& alive) {
        for (auto i = load.begin(); i != load.end();) {
            if (alive(i->first)) {
                ++i;
            } else {
                left += i->second;
                i = load.erase(i);
            }
        }
    }
};

/// The triangles around a vertex, as far as its move is concerned.
struct vertex_room {
    vec3 sum{0, 0, 0};   ///< of the cross products of the sides at the vertex: six times the volume per length along a is a . sum
    double area = 0;     ///< |sum|
    double whole = 0;    ///< of the lengths of the products; area / whole is the mean cosine between faces and normal
    double lowest = 0;   ///< least altitude of a triangle over the side opposite the vertex, length unit

    static vertex_room at(std::size_t v, std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles,
                          vertex_rings const& rings) {
        vertex_room room;
        vec3 const& p = positions[v];
        double lowest = -1;
        for (auto const& c : rings.faces(v)) {
            auto const& t = triangles[c.face];
            vec3 const& q = positions[t[(c.place + 1) % 3]];
            vec3 const& r = positions[t[(c.place + 2) % 3]];
            vec3 const n = cross(vec3{q - p}, vec3{r - p});
            room.sum += n;
            double const nn = squared_length(n);
            room.whole += std::sqrt(nn);
            double const side = squared_length(r - q);
            double const height = side > 0 ? nn / side : 0.0;
            if (height < 0.0025 * side) continue;  // a sliver follows its neighbours
            if (lowest < 0 || height < lowest) lowest = height;
        }
        room.area = length(room.sum);
        room.lowest = lowest > 0 ? std::sqrt(lowest) : 0.0;
        return room;
    }
    /// How far the vertex may go in one iteration: no triangle at it turns by more than about 14 degrees.
    [[nodiscard]] double way(double most) const noexcept {
        return area > 0.2 * whole ? std::min(most, 0.25 * lowest) : 0.0;
    }
    /// The volume that goes with it, at most.
    [[nodiscard]] double volume(double most) const noexcept { return way(most) * area / 6; }
};

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
        out_share_.assign(vertices, 1.0F);
        in_share_.assign(vertices, 1.0F);
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
            (part > 0 ? out_ : in_)[corners[k]] += part > 0 ? part : -part;
        }
    }
    /// O(faces at the vertices that were asked).
    void close(std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles, vertex_rings const& rings,
               volume_unit const& unit, double most, sediment_books const& books) {
        for (std::size_t v = 0; v < out_.size(); ++v) {
            if (out_[v] == 0 && in_[v] == 0) continue;
            std::int64_t const cap = unit.fixed(vertex_room::at(v, positions, triangles, rings).volume(most));
            out_share_[v] = share(cap + std::min<std::int64_t>(books.due[v], 0), out_[v]);
            in_share_[v] = share(cap - std::max<std::int64_t>(books.due[v], 0), in_[v]);
        }
    }
    /// What of a corner's part is granted: of its sign, and no more.
    [[nodiscard]] std::int64_t grant(std::uint32_t vertex, std::int64_t part) const noexcept {
        float const share = (part > 0 ? out_share_ : in_share_)[vertex];
        if (share >= 1) return part;
        double const size = std::floor(static_cast<double>(part > 0 ? part : -part) * static_cast<double>(share));
        return part > 0 ? static_cast<std::int64_t>(size) : -static_cast<std::int64_t>(size);
    }

private:
    [[nodiscard]] static float share(std::int64_t room, std::int64_t asked) noexcept {
        if (asked <= room) return 1;
        return room > 0 ? static_cast<float>(static_cast<double>(room) / static_cast<double>(asked)) : 0.0F;
    }

    std::vector<std::int64_t> out_{};  ///< asked of the vertex
    std::vector<std::int64_t> in_{};   ///< offered to it
    std::vector<float> out_share_{};
    std::vector<float> in_share_{};
};

/// Moves vertices by the volume that they owe or are owed [thesis, 8.3, signed].
class sediment_settlement {
public:
    /// Looks at a surface whose triangles or vertices are others than before. O(vertices + faces).
    void adopt(std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles, vertex_rings const& rings) {
        across_.assign(triangles.size(), {none, none, none});
        faces_.resize(triangles.size());
        for (std::size_t f = 0; f < triangles.size(); ++f) {
            auto const& t = triangles[f];
            faces_[f] = face_state::of(positions[t[0]], positions[t[1]], positions[t[2]]);
            for (std::size_t k = 0; k < 3; ++k) {
                std::size_t found = 0;
                for (auto const& c : rings.faces(t[k])) {
                    if (c.face == f) continue;
                    auto const& other = triangles[c.face];
                    std::uint32_t const b = t[(k + 1) % 3];
                    if (other[0] != b && other[1] != b && other[2] != b) continue;
                    across_[f][k] = c.face;
                    ++found;
                }
                if (found != 1) across_[f][k] = none;
            }
        }
    }

    /// One vertex after the other, by number, along the sum of the normals of its faces weighted by area, in which
    /// direction the volume changes fastest; no farther than `most` and a quarter of the lowest triangle at it. A
    /// move is halved, twice at most, then left, where it would
    /// - bend two faces at an edge by more than a right angle,
    /// - make a pit or spike whose sides are steeper than 60 degrees, or
    /// - make a triangle lower than a tenth of its longest side,
    /// unless that was so and gets no worse.
    /// Before it moves, and of what then stays due, half goes to the neighbours by area: a particle wears more than
    /// the face below it, and no vertex is dug out alone. Books what the surface really changed by. Adds the way to `wear` and the volume to `sediment`. Returns the vertices that moved.
    /// O(vertices + faces at those that owe).
    std::size_t operator()(std::vector<vec3>& positions, std::span<std::array<std::uint32_t, 3> const> triangles,
                           vertex_rings const& rings, volume_unit const& unit, double most, sediment_books& books,
                           std::span<double> wear, std::span<std::int64_t> sediment) {
        left_.clear();
        for (std::size_t v = 0; v < positions.size(); ++v) {
            if (books.due[v] != 0) left_.push_back(static_cast<std::uint32_t>(v));
        }
        pass_on(triangles, rings, books);
        left_.clear();
        std::size_t moved = 0;
        for (std::size_t v = 0; v < positions.size(); ++v) {
            if (books.due[v] == 0) continue;
            vertex_room const room = vertex_room::at(v, positions, triangles, rings);
            double const way = room.way(most);
            if (way > 0) {
                double const wanted = unit.volume(books.due[v]) / (room.area / 6);
                double d = std::clamp(wanted, -way, way);
                for (int halved = 0; halved < 3; ++halved, d *= 0.5) {
                    vec3 const& p = positions[v];
                    double const s = d / room.area;
                    vec3 const to{p[0] + s * room.sum[0], p[1] + s * room.sum[1], p[2] + s * room.sum[2]};
                    vec3 const step{to - p};
                    std::int64_t booked = unit.fixed(dot(step, room.sum) / 6);
                    if (d == wanted) booked = books.due[v];  // the rest is rounding
                    if (booked == 0) break;
                    if (!sound(v, to, room, positions, triangles, rings)) continue;
                    positions[v] = to;
                    for (std::size_t k = 0; k < then_.size(); ++k) faces_[rings.faces(v)[k].face] = then_[k];
                    wear[v] += length(step);
                    sediment[v] += booked;
                    books.due[v] -= booked;
                    (booked < 0 ? books.eroded : books.deposited) += booked < 0 ? -booked : booked;
                    ++moved;
                    break;
                }
            }
            if (books.due[v] != 0) left_.push_back(static_cast<std::uint32_t>(v));
        }
        pass_on(triangles, rings, books);
        return moved;
    }

private:
    static constexpr std::uint32_t none = face_index::none;
    static constexpr double steepest = 0.7;  ///< cosine of 45 degrees
    static constexpr double bluntest = 0.3;
    static constexpr double flattest = 0.1;

    struct face_state {
        vec3 normal{0, 0, 0};
        double twice = 0;  ///< area
        double shape = 0;  ///< height over the longest side, of its length

        static face_state of(vec3 const& a, vec3 const& b, vec3 const& c) noexcept {
            vec3 const u{b - a};
            vec3 const v{c - a};
            vec3 const n = cross(u, v);
            double const l = length(n);
            double const longest = std::max({squared_length(u), squared_length(v), squared_length(c - b)});
            if (!(l > 0)) return {};
            return {.normal = vec3{n[0] / l, n[1] / l, n[2] / l}, .twice = l, .shape = l / longest};
        }
    };

    /// Whether v may go there; `then_` are its faces then.
    bool sound(std::size_t v, vec3 const& to, vertex_room const& room, std::span<vec3 const> positions,
               std::span<std::array<std::uint32_t, 3> const> triangles, vertex_rings const& rings) {
        auto const around = rings.faces(v);
        then_.resize(around.size());
        vec3 sum{0, 0, 0};
        double whole = 0;
        for (std::size_t k = 0; k < around.size(); ++k) {
            auto const& t = triangles[around[k].face];
            auto const at = [&](std::size_t i) -> vec3 const& { return t[i] == v ? to : positions[t[i]]; };
            face_state const& now = faces_[around[k].face];
            face_state const& then = then_[k] = face_state::of(at(0), at(1), at(2));
            if (then.shape < flattest && then.shape < now.shape * (1 - 1e-9)) return false;
            sum += then.twice * then.normal;
            whole += then.twice;
        }
        if (length(sum) < steepest * whole && length(sum) * room.whole < room.area * whole * (1 - 1e-9)) return false;
        for (std::size_t k = 0; k < around.size(); ++k) {
            std::uint32_t const f = around[k].face;
            for (std::uint32_t const g : across_[f]) {
                if (g == none) continue;
                face_state const* other = &faces_[g];
                for (std::size_t i = 0; i < around.size(); ++i) {
                    if (around[i].face == g) other = &then_[i];
                }
                double const after = dot(then_[k].normal, other->normal);
                if (after < bluntest && after < dot(faces_[f].normal, faces_[g].normal) - 1e-9) return false;
            }
        }
        return true;
    }

    /// Half of what `left_` owe or are owed to the other corners of their faces, by area.
    void pass_on(std::span<std::array<std::uint32_t, 3> const> triangles, vertex_rings const& rings, sediment_books& books) {
        passed_.clear();
        for (std::uint32_t const v : left_) {
            double whole = 0;
            for (auto const& c : rings.faces(v)) whole += faces_[c.face].twice;
            if (!(whole > 0)) continue;
            double const each = 0.25 * static_cast<double>(books.due[v]) / whole;
            std::int64_t gone = 0;
            for (auto const& c : rings.faces(v)) {
                auto const part = static_cast<std::int64_t>(each * faces_[c.face].twice);
                if (part == 0) continue;
                auto const& t = triangles[c.face];
                passed_.emplace_back(t[(c.place + 1) % 3], part);
                passed_.emplace_back(t[(c.place + 2) % 3], part);
                gone += 2 * part;
            }
            books.due[v] -= gone;
        }
        for (auto const& [w, part] : passed_) books.due[w] += part;
    }

    std::vector<std::array<std::uint32_t, 3>> across_{};  ///< the face over each side
    std::vector<face_state> faces_{};
    std::vector<face_state> then_{};
    std::vector<std::uint32_t> left_{};
    std::vector<std::pair<std::uint32_t, std::int64_t>> passed_{};
};

}  // namespace tafoni::detail

#endif
