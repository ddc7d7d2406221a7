/// \file
/// One Voronoi cell in a box, cut plane by plane.
#ifndef TAFONI_DECOMPOSITION_DETAIL_VORONOI_CELL_HPP
#define TAFONI_DECOMPOSITION_DETAIL_VORONOI_CELL_HPP

#include <tafoni/decomposition/detail/cell_lanes.hpp>
#include <tafoni/decomposition/detail/plane_corner.hpp>
#include <tafoni/geometry/predicates.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace tafoni::detail {

#if defined(__AVX__)
inline namespace avx {
#else
inline namespace baseline {
#endif

/// The convex cell of one site, as its dual: a vertex is the triple of planes (a, b, c) that meet there,
/// with det(n_a, n_b, n_c) > 0, so the vertex across its edge a -> b holds b -> a [Ray et al. 2018].
///
/// All decisions are exact; the positions kept here only filter. `Planes` > 0 bounds the number of
/// planes alive and keeps everything in fixed tables; 0 is for the rare cell beyond that.
template <std::size_t Planes>
class voronoi_cell {
    static constexpr bool fixed = Planes != 0;
    static constexpr std::size_t max_vertices = 2 * Planes;  // simple polytopes have 2 F - 4
    using id = std::conditional_t<fixed, std::uint8_t, std::uint32_t>;
    template <class T, std::size_t N>
    using buffer = std::conditional_t<fixed, std::array<T, N>, std::vector<T>>;

public:
    using triple = std::array<id, 3>;

    /// The whole box. Planes 0 to 5 are -x, +x, -y, +y, -z, +z with ids wall_id + 0 .. 5.
    void start(exact::site const& site, lattice_box const& box, std::uint32_t wall_id) {
        site_ = site;
        planes_ = 0;
        free_.clear();
        grow(8, 6);
        for (std::uint32_t w = 0; w < 6; ++w) {
            auto const axis = static_cast<int>(w / 2);
            bool const upper = w % 2 != 0;
            auto const a = static_cast<std::size_t>(axis);
            plane_[w] = exact::wall{axis, upper, upper ? box.hi[a] : box.lo[a]};
            double_[w] = to_double_plane(site.at, plane_[w]);
            id_[w] = wall_id + w;
            degree_[w] = 4;
        }
        planes_ = 6;
        count_ = 8;
        for (std::uint32_t v = 0; v < 8; ++v) {
            auto const px = static_cast<id>(v & 1);
            auto const py = static_cast<id>(2 + (v >> 1 & 1));
            auto const pz = static_cast<id>(4 + (v >> 2 & 1));
            bool const even = ((v ^ v >> 1 ^ v >> 2) & 1) != 0;  // an odd number of upper walls: det > 0
            set(v, even ? triple{px, py, pz} : triple{px, pz, py});
            auto const offset = [&](std::size_t a) {
                return static_cast<double>((v >> a & 1 ? box.hi[a] : box.lo[a]) - site.at[a]);
            };
            put(v, {offset(0), offset(1), offset(2), 0});
            error_[v] = 0x1p-52 * (std::fabs(x_[v]) + std::fabs(y_[v]) + std::fabs(z_[v]));
        }
        pad();
        update_radius();
    }

    /// Takes away what is nearer to `other`. False when the fixed tables are full: start again with a larger cell.
    [[nodiscard]] bool cut(ivec3 const& at, std::uint32_t rank) {
        auto const nx = static_cast<double>(at[0] - site_.at[0]);
        auto const ny = static_cast<double>(at[1] - site_.at[1]);
        auto const nz = static_cast<double>(at[2] - site_.at[2]);
        double const h = 0.5 * (nx * nx + ny * ny + nz * nz);
        if (h > 2.000001 * radius2_) return true;
        double const n1 = std::fabs(nx) + std::fabs(ny) + std::fabs(nz);
        double const floor = 0x1p-49 * n1 * radius_;
        if (!maybe_cuts(nx, ny, nz, h, n1, floor)) return true;
        removed_count_ = 0;
        std::size_t unsure = 0;
        for (std::uint32_t v = 0; v < count_; ++v) {
            double const margin = error_[v] * n1 + floor;
            removed_[removed_count_] = v;
            removed_count_ += static_cast<std::size_t>(side_[v] > margin);
            unsure += static_cast<std::size_t>(std::fabs(side_[v]) <= margin);
        }
        exact::site const other{at, rank};
        if (unsure != 0) decide_exactly(other, n1, floor);
        if (removed_count_ == 0) return true;
        for (std::size_t k = 0; k < removed_count_; ++k) flag_[removed_[k]] = 1;
        return replace_removed(other, {nx, ny, nz, h, 2 * h}, n1);
    }

    /// Square of the distance of the farthest vertex from the site, not less than the true one.
    [[nodiscard]] double radius2() const noexcept { return 1.000001 * radius2_; }
    [[nodiscard]] std::uint32_t vertex_count() const noexcept { return count_; }
    [[nodiscard]] std::uint32_t plane_count() const noexcept { return planes_; }
    [[nodiscard]] bool alive(std::uint32_t p) const noexcept { return degree_[p] != 0; }
    [[nodiscard]] std::uint32_t degree(std::uint32_t p) const noexcept { return degree_[p]; }
    [[nodiscard]] std::uint32_t id_of(std::uint32_t p) const noexcept { return id_[p]; }
    [[nodiscard]] triple const& vertex(std::uint32_t v) const noexcept { return triple_[v]; }
    [[nodiscard]] exact::site const& site() const noexcept { return site_; }

    /// Could a site in the box (lattice units relative to this site) cut the cell? Never a wrong no. O(vertices).
    [[nodiscard]] bool reachable(std::array<double, 3> const& lo, std::array<double, 3> const& hi) const noexcept {
        lanes reached = lanes{} - 1;
        for (std::uint32_t v = 0; v < count_; v += cell_lanes) {
            lanes const spare = 1.000001 * load_lanes(r2_.data() + v) - gap2(lo[0], hi[0], load_lanes(x_.data() + v)) -
                                gap2(lo[1], hi[1], load_lanes(y_.data() + v)) - gap2(lo[2], hi[2], load_lanes(z_.data() + v));
            reached = spare > reached ? spare : reached;
        }
        for (std::size_t k = 0; k < cell_lanes; ++k) {
            if (reached[k] >= 0) return true;
        }
        return false;
    }

    /// Calls visit(v) for the vertices of plane p, counter-clockwise seen from outside. O(degree), or
    /// O(degree log vertices) without tables, after `prepare_walks`.
    template <class Visit>
    void walk(std::uint32_t p, std::uint32_t first, Visit const& visit) const {
        triple const& t = triple_[first];
        std::uint32_t v = first;
        std::uint32_t before = t[0] == p ? t[2] : t[1] == p ? t[0] : t[1];
        do {
            visit(v);
            v = holder(static_cast<id>(p), static_cast<id>(before));
            before ^= p ^ third_[v];  // the plane at v that is neither p nor the one just crossed
        } while (v != first);
    }

    void prepare_walks() {
        if constexpr (!fixed) {
            edges_.clear();
            for (std::uint32_t v = 0; v < count_; ++v) {
                for (std::size_t k = 0; k < 3; ++k) edges_.push_back({key(triple_[v][k], triple_[v][(k + 1) % 3]), v});
            }
            std::sort(edges_.begin(), edges_.end(), [](auto const& a, auto const& b) { return a.key < b.key; });
        }
    }

private:
    struct directed_edge {
        std::uint64_t key;
        std::uint32_t vertex;
    };
    struct open_edge {
        id a;
        id b;
        std::uint32_t removed;
        std::uint32_t kept;
    };

    static bool key_below(directed_edge const& l, std::uint64_t r) noexcept { return l.key < r; }
    static std::uint64_t key(std::uint64_t a, std::uint64_t b) noexcept { return a << 32 | b; }

    [[nodiscard]] std::uint32_t holder(id a, id b) const noexcept {
        if constexpr (fixed) {
            return holder_[a * Planes + b];
        } else {
            auto const k = key(a, b);
            auto const e = std::lower_bound(edges_.begin(), edges_.end(), k, key_below);
            return e->vertex;
        }
    }

    void grow(std::size_t vertices, std::size_t planes) {
        if constexpr (!fixed) {
            std::size_t const v = vertices + cell_lanes;
            if (x_.size() < v) {
                std::size_t const n = 2 * v;
                for (auto* b : {&x_, &y_, &z_, &error_, &r2_, &side_}) b->resize(n);
                triple_.resize(n);
                third_.resize(n);
                flag_.resize(n);
                removed_.resize(n);
            }
            if (plane_.size() < planes) {
                plane_.resize(2 * planes);
                double_.resize(2 * planes);
                id_.resize(2 * planes);
                degree_.resize(2 * planes);
            }
        }
    }

    void set(std::uint32_t v, triple const& t) noexcept {
        triple_[v] = t;
        third_[v] = static_cast<id>(t[0] ^ t[1] ^ t[2]);
        if constexpr (fixed) {
            auto const w = static_cast<std::uint8_t>(v);
            holder_[t[0] * Planes + t[1]] = w;
            holder_[t[1] * Planes + t[2]] = w;
            holder_[t[2] * Planes + t[0]] = w;
        }
    }

    void put(std::uint32_t v, vertex_estimate const& e) noexcept {
        x_[v] = e.x;
        y_[v] = e.y;
        z_[v] = e.z;
        error_[v] = e.error;
        r2_[v] = e.x * e.x + e.y * e.y + e.z * e.z;
    }

    void pad() noexcept {
        for (std::uint32_t v = count_; v % cell_lanes != 0; ++v) put(v, {});
    }

    void update_radius() noexcept {
        lanes most{};
        for (std::uint32_t v = 0; v < count_; v += cell_lanes) {
            lanes const value = load_lanes(r2_.data() + v);
            most = value > most ? value : most;
        }
        double r = most[0];
        for (std::size_t k = 1; k < cell_lanes; ++k) r = most[k] > r ? most[k] : r;
        radius2_ = r;
        radius_ = std::sqrt(r);
    }

    [[nodiscard]] bool maybe_cuts(double nx, double ny, double nz, double h, double n1, double floor) noexcept {
        auto const* x = x_.data();
        auto const* y = y_.data();
        auto const* z = z_.data();
        auto const* e = error_.data();
        auto* s = side_.data();
        lanes most = lanes{} - 1;
        for (std::uint32_t v = 0; v < count_; v += cell_lanes) {
            lanes const value = load_lanes(x + v) * nx + load_lanes(y + v) * ny + load_lanes(z + v) * nz - h;
            store_lanes(s + v, value);
            lanes const top = value + (load_lanes(e + v) * n1 + floor);
            most = top > most ? top : most;
        }
        bool any = false;
        for (std::size_t k = 0; k < cell_lanes; ++k) any = any || most[k] > 0;
        return any;
    }

    [[nodiscard]] bool beyond(std::uint32_t v, exact::site const& other) const noexcept {
        triple const& t = triple_[v];
        return exact::side4_unfiltered(site_, plane_[t[0]], plane_[t[1]], plane_[t[2]], other) > 0;
    }

    void decide_exactly(exact::site const& other, double n1, double floor) {
        removed_count_ = 0;
        for (std::uint32_t v = 0; v < count_; ++v) {
            double const margin = error_[v] * n1 + floor;
            if (side_[v] < -margin) continue;
            if (side_[v] > margin || beyond(v, other)) removed_[removed_count_++] = v;
        }
    }

    // The edges between removed and kept vertices, each with its removed end's direction a -> b.
    void find_open_edges() {
        open_count_ = 0;
        if constexpr (fixed) {
            for (std::size_t r = 0; r < removed_count_; ++r) {
                std::uint32_t const v = removed_[r];
                triple const t = triple_[v];
                for (std::size_t k = 0; k < 3; ++k) {
                    id const a = t[k];
                    id const b = t[k == 2 ? 0 : k + 1];
                    std::uint32_t const w = holder(b, a);
                    open_[open_count_] = {a, b, v, w};
                    open_count_ += 1U - flag_[w];
                }
            }
        } else {
            // Edges inside the removed part occur in both directions and cancel.
            edges_.clear();
            open_.resize(3 * removed_count_);
            fresh_.resize(3 * removed_count_);
            for (std::size_t r = 0; r < removed_count_; ++r) {
                std::uint32_t const v = removed_[r];
                for (std::size_t k = 0; k < 3; ++k) edges_.push_back({key(triple_[v][k], triple_[v][(k + 1) % 3]), v});
            }
            std::sort(edges_.begin(), edges_.end(), [](auto const& a, auto const& b) { return a.key < b.key; });
            for (auto const& e : edges_) {
                std::uint64_t const twin = key(e.key & 0xffffffffU, e.key >> 32);
                auto const t = std::lower_bound(edges_.begin(), edges_.end(), twin, key_below);
                if (t != edges_.end() && t->key == twin) continue;
                open_[open_count_++] = {static_cast<id>(e.key >> 32), static_cast<id>(e.key & 0xffffffffU), e.vertex, 0};
            }
        }
    }

    [[nodiscard]] bool replace_removed(exact::site const& other, double_plane const& plane, double n1) {
        TAFONI_ASSERT(removed_count_ < count_, "a cell holds its site");
        id p{};
        if (!free_.empty()) {
            p = free_.back();
            free_.pop_back();
        } else {
            if (fixed && planes_ == Planes) {
                for (std::size_t k = 0; k < removed_count_; ++k) flag_[removed_[k]] = 0;
                return false;
            }
            p = static_cast<id>(planes_++);
            grow(count_, planes_);
        }
        plane_[p] = other;
        double_[p] = plane;
        id_[p] = other.rank;
        find_open_edges();
        degree_[p] = static_cast<std::uint32_t>(open_count_);
        for (std::size_t k = 0; k < open_count_; ++k) fresh_[k] = crossing(open_[k], p, n1);
        for (std::size_t k = 0; k < open_count_; ++k) {
            ++degree_[open_[k].a];
            ++degree_[open_[k].b];
        }
        for (std::size_t k = 0; k < removed_count_; ++k) {
            flag_[removed_[k]] = 0;
            for (id q : triple_[removed_[k]]) {
                if (--degree_[q] == 0) free_.push_back(q);
            }
        }
        grow(count_ + open_count_, planes_);
        std::size_t used = 0;
        for (std::size_t k = 0; k < open_count_; ++k) {
            std::uint32_t const v = used < removed_count_ ? removed_[used++] : count_++;
            set(v, {open_[k].a, open_[k].b, p});
            put(v, fresh_[k]);
        }
        // Slots left over, from the last: move the last vertex in.
        while (removed_count_ > used) {
            std::uint32_t const hole = removed_[--removed_count_];
            --count_;
            if (hole == count_) continue;
            set(hole, triple_[count_]);
            put(hole, {x_[count_], y_[count_], z_[count_], error_[count_]});
        }
        pad();
        update_radius();
        return true;
    }

    // The point where an edge meets the new plane: between its ends when that is accurate enough.
    [[nodiscard]] vertex_estimate crossing(open_edge const& e, id p, double n1) const noexcept {
        if constexpr (fixed) {
            double const sv = side_[e.removed];
            double const sw = side_[e.kept];
            if (sv > 0 && sw < 0) {
                double const f = 1 / (sv - sw);
                double const t = -sw * f;
                double const dx = x_[e.removed] - x_[e.kept];
                double const dy = y_[e.removed] - y_[e.kept];
                double const dz = z_[e.removed] - z_[e.kept];
                vertex_estimate v;
                v.x = x_[e.kept] + t * dx;
                v.y = y_[e.kept] + t * dy;
                v.z = z_[e.kept] + t * dz;
                // Off the true edge by at most the ends' errors; along it by that over the sine of the angle.
                double const off = std::max(error_[e.removed], error_[e.kept]) + 0x1p-48 * radius_;
                v.error = off * (1 + n1 * (std::fabs(dx) + std::fabs(dy) + std::fabs(dz)) * f);
                if (v.error < 0x1p-28 * (std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z))) return v;
            }
        }
        return solve(site_.at, plane_[e.a], plane_[e.b], plane_[p], double_[e.a], double_[e.b], double_[p]);
    }

    exact::site site_{};
    std::uint32_t count_ = 0;
    std::uint32_t planes_ = 0;
    double radius2_ = 0;
    double radius_ = 0;
    alignas(32) buffer<double, max_vertices + 4> x_{};
    alignas(32) buffer<double, max_vertices + 4> y_{};
    alignas(32) buffer<double, max_vertices + 4> z_{};
    alignas(32) buffer<double, max_vertices + 4> error_{};
    alignas(32) buffer<double, max_vertices + 4> r2_{};
    alignas(32) buffer<double, max_vertices + 4> side_{};
    buffer<triple, max_vertices + 4> triple_{};
    buffer<id, max_vertices + 4> third_{};  ///< the planes of a vertex, xored
    buffer<std::uint8_t, max_vertices + 4> flag_{};
    buffer<exact::plane, Planes> plane_{};
    buffer<double_plane, Planes> double_{};
    buffer<std::uint32_t, Planes> id_{};
    buffer<std::uint32_t, Planes> degree_{};
    buffer<std::uint8_t, Planes * Planes> holder_{};
    std::vector<id> free_;
    buffer<std::uint32_t, max_vertices + 4> removed_{};
    std::size_t removed_count_ = 0;
    std::size_t open_count_ = 0;
    buffer<open_edge, max_vertices + 4> open_{};
    buffer<vertex_estimate, max_vertices + 4> fresh_{};
    std::vector<directed_edge> edges_;
};

}  // namespace baseline or avx
}  // namespace tafoni::detail

#endif
