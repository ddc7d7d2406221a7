/// \file
/// Roughens the faces that were laid open, so that fresh breaks do not look like cut foam.
#ifndef TAFONI_DECOMPOSITION_DISPLACED_FACES_HPP
#define TAFONI_DECOMPOSITION_DISPLACED_FACES_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/decomposition/shard_surface.hpp>
#include <tafoni/field/concepts.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace tafoni {

/// Moves a point of space. Laws: pure, finite, small against the shards.
/// Model: `struct mine { vec3 operator()(vec3 const& p) const { return vec3{0, 0, 0.01 * wave(p)}; } };`
template <class D>
concept displacement_field = std::copy_constructible<D> && requires(D const& d, vec3 const& p) {
    { d(p) } -> std::same_as<vec3>;
};

/// A displacement of up to `amplitude` along each axis, from a scalar field with values in [0, 1]
/// that is read at three places per point.
template <scalar_field Field>
struct field_displacement {
    Field field{};
    double amplitude = 0.01;     ///< length unit
    vec3 offset{17, 31, 53};     ///< length unit: far enough that the three readings have nothing in common

    [[nodiscard]] vec3 operator()(vec3 const& p) const {
        double const x = field(p);
        double const y = field(vec3{p[0] + offset[0], p[1] + offset[1], p[2] + offset[2]});
        double const z = field(vec3{p[0] - offset[1], p[1] - offset[2], p[2] - offset[0]});
        return vec3{amplitude * (2 * x - 1), amplitude * (2 * y - 1), amplitude * (2 * z - 1)};
    }
};
template <class Field>
field_displacement(Field, double) -> field_displacement<Field>;
template <class Field>
field_displacement(Field, double, vec3) -> field_displacement<Field>;

struct displaced_faces_options {
    double edge_length = 0.1;  ///< length unit, > 0: fresh edges are halved until they are no longer
    int max_halvings = 6;      ///< 0 .. 12
};

namespace detail {

/// Halves the marked edges of a surface and the triangles at them.
class surface_refiner {
public:
    surface_refiner(shard_surface& s, double edge_length) : s_(s), longest_(edge_length * edge_length) {}

    /// One round; false when no edge was long enough. O(n log n).
    bool halve() {
        collect();
        std::vector<std::uint32_t> middle(s_.mesh.corners.size(), none);
        bool any = false;
        for (std::size_t k = 0; k < sides_.size();) {
            std::size_t const first = k;
            bool fresh = true;
            for (; k < sides_.size() && sides_[k].low == sides_[first].low && sides_[k].high == sides_[first].high; ++k) {
                fresh = fresh && s_.fresh[sides_[k].h / 3] != 0;
            }
            vec3 const p = s_.mesh.positions[sides_[first].low];
            vec3 const q = s_.mesh.positions[sides_[first].high];
            if (!fresh || squared_length(vec3{q[0] - p[0], q[1] - p[1], q[2] - p[2]}) <= longest_) continue;
            any = true;
            std::uint32_t const m =
                s_.mesh.add_vertex(vec3{0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.5 * (p[2] + q[2])}).value;
            s_.vertex.push_back(vertex_index{});
            for (std::size_t e = first; e < k; ++e) middle[sides_[e].h] = m;
        }
        if (any) split(middle);
        return any;
    }

private:
    static constexpr std::uint32_t none = vertex_index::none;
    struct side {
        std::uint32_t low;
        std::uint32_t high;
        std::uint32_t h;
    };

    void collect() {
        auto const& corners = s_.mesh.corners;
        require_indexable("displaced_faces", 4 * corners.size());
        sides_.resize(corners.size());
        for (std::uint32_t h = 0; h < corners.size(); ++h) {
            std::uint32_t const a = corners[h];
            std::uint32_t const b = corners[next_corner(h)];
            sides_[h] = {a < b ? a : b, a < b ? b : a, h};
        }
        std::sort(sides_.begin(), sides_.end(), [](side const& x, side const& y) {
            if (x.low != y.low) return x.low < y.low;
            return x.high != y.high ? x.high < y.high : x.h < y.h;
        });
    }

    void split(std::vector<std::uint32_t> const& middle) {
        shard_surface old;
        old.mesh.corners.swap(s_.mesh.corners);
        old.cell.swap(s_.cell);
        old.face.swap(s_.face);
        old.fresh.swap(s_.fresh);
        s_.mesh.offsets.assign(1, 0);
        for (std::size_t t = 0; t < old.cell.size(); ++t) {
            std::array<std::uint32_t, 3> const v{old.mesh.corners[3 * t], old.mesh.corners[3 * t + 1], old.mesh.corners[3 * t + 2]};
            std::array<std::uint32_t, 3> const m{middle[3 * t], middle[3 * t + 1], middle[3 * t + 2]};
            auto const add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
                s_.mesh.add_face({a, b, c});
                s_.cell.push_back(old.cell[t]);
                s_.face.push_back(old.face[t]);
                s_.fresh.push_back(old.fresh[t]);
            };
            std::size_t const count = std::size_t{m[0] != none} + std::size_t{m[1] != none} + std::size_t{m[2] != none};
            if (count == 0) {
                add(v[0], v[1], v[2]);
            } else if (count == 3) {
                add(v[0], m[0], m[2]);
                add(m[0], v[1], m[1]);
                add(m[2], m[1], v[2]);
                add(m[0], m[1], m[2]);
            } else {
                // Turned so that side 0 is halved, and with two halves side 1 as well.
                std::size_t r = 0;
                while (m[r] == none || (count == 2 && m[(r + 1) % 3] == none)) ++r;
                std::uint32_t const a = v[r];
                std::uint32_t const b = v[(r + 1) % 3];
                std::uint32_t const c = v[(r + 2) % 3];
                std::uint32_t const ab = m[r];
                if (count == 1) {
                    add(a, ab, c);
                    add(ab, b, c);
                } else {
                    std::uint32_t const bc = m[(r + 1) % 3];
                    add(ab, b, bc);
                    // The shorter diagonal; on a tie the one whose ends lie lower, so that both sides of a face agree.
                    if (shorter(a, bc, ab, c)) {
                        add(a, ab, bc);
                        add(a, bc, c);
                    } else {
                        add(a, ab, c);
                        add(ab, bc, c);
                    }
                }
            }
        }
    }

    [[nodiscard]] bool shorter(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) const {
        auto const& p = s_.mesh.positions;
        vec3 const x = p[a] - p[b];
        vec3 const y = p[c] - p[d];
        if (squared_length(x) != squared_length(y)) return squared_length(x) < squared_length(y);
        auto const lower = [](vec3 const& u, vec3 const& v) { return lexicographically_less(u, v) ? u : v; };
        return lexicographically_less(lower(p[a], p[b]), lower(p[c], p[d]));
    }

    shard_surface& s_;
    double longest_;
    std::vector<side> sides_{};
};

struct displaced_faces_fn {
    /// `surface` with its fresh faces cut finer and moved by `field`.
    ///
    /// A point is moved by the same amount whichever shard it is seen from, so the two sides of a break
    /// still fit together. The input's skin, its rim included, stays where it was. The surface stays a
    /// closed 2-manifold; whether it cuts itself is up to the amplitude. O(n log n) for n triangles of the result.
    /// \throws invalid_input  bad_parameter, size_overflow
    template <displacement_field Field>
    [[nodiscard]] shard_surface operator()(shard_surface surface, Field const& field,
                                           displaced_faces_options const& options = {}) const {
        require_range("displaced_faces_options.edge_length", options.edge_length, std::numeric_limits<double>::min(),
                      std::numeric_limits<double>::max());
        require_range("displaced_faces_options.max_halvings", options.max_halvings, 0, 12);
        surface_refiner refine(surface, options.edge_length);
        for (int k = 0; k < options.max_halvings && refine.halve(); ++k) {
        }
        std::vector<std::uint8_t> skin(surface.mesh.vertex_count(), 0);
        for (std::size_t c = 0; c < surface.mesh.corners.size(); ++c) {
            if (surface.fresh[c / 3] == 0) skin[surface.mesh.corners[c]] = 1;
        }
        for (std::size_t v = 0; v < skin.size(); ++v) {
            if (skin[v] != 0) continue;
            vec3& p = surface.mesh.positions[v];
            vec3 const d = field(p);
            p = vec3{p[0] + d[0], p[1] + d[1], p[2] + d[2]};
        }
        return surface;
    }
};

}  // namespace detail

/// Roughens fresh faces; see `detail::displaced_faces_fn`.
inline constexpr detail::displaced_faces_fn displaced_faces{};

}  // namespace tafoni

#endif
