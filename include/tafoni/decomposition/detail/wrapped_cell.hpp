/// \file
/// One Voronoi cell, found vertex by vertex.
#ifndef TAFONI_DECOMPOSITION_DETAIL_WRAPPED_CELL_HPP
#define TAFONI_DECOMPOSITION_DETAIL_WRAPPED_CELL_HPP

#include <tafoni/decomposition/detail/near_planes.hpp>
#include <tafoni/decomposition/detail/plane_corner.hpp>
#include <tafoni/geometry/predicates.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

namespace tafoni::detail {

#if defined(__AVX__)
inline namespace avx {
#else
inline namespace baseline {
#endif

/// The convex cell of one site, grown over its edges from vertices that are known already, as gift
/// wrapping does [Chand and Kapur 1970]. A vertex is a triple of planes as in `voronoi_cell`.
///
/// Single precision guesses the plane at the far end of an edge. The guess is right when no plane
/// cuts the vertex off, and one that does so is a better guess: exact signs decide, the guess only
/// saves work. Fixed tables: the rare cell that does not fit is left to `voronoi_cell`.
class wrapped_cell {
    static constexpr std::size_t max_planes = 64;
    static constexpr std::size_t max_vertices = 2 * max_planes;
    static constexpr std::uint8_t none = 0xff;
    static constexpr std::size_t slots = 256;
    using id = std::uint8_t;

public:
    using triple = std::array<id, 3>;

    /// An empty cell, in units of 1 / `scale`; `reach`: how far the planes to come are complete;
    /// `margin`: how far, of lengths squared, single precision may be off.
    /// Planes of sites in [absent, site.rank) are not among those to come.
    void start(exact::site const& site, std::uint32_t absent, double scale, float reach, float margin) noexcept {
        for (std::uint32_t p = 0; p < planes_; ++p) {
            std::memset(holder_.data() + p * max_planes, none, max_planes);
            slot_[slot_of_[p]] = none;
        }
        site_ = site;
        absent_ = absent;
        scale_ = scale;
        limit2_ = 0.24F * reach * reach;
        margin_ = margin;
        planes_ = 0;
        count_ = 0;
        open_count_ = 0;
        overflow_ = false;
    }

    /// The place of a plane, new or old. `plane_at(id)` gives an `exact::plane`.
    template <class PlaneAt>
    [[nodiscard]] id plane(std::uint32_t global, PlaneAt const& plane_at) noexcept {
        std::size_t s = global * 0x9E3779B1U >> 24;
        for (;; s = (s + 1) % slots) {
            id const p = slot_[s];
            if (p == none) break;
            if (id_[p] == global) return p;
        }
        if (planes_ == max_planes) {
            overflow_ = true;
            return 0;
        }
        auto const p = static_cast<id>(planes_++);
        slot_[s] = p;
        slot_of_[p] = static_cast<std::uint8_t>(s);
        id_[p] = global;
        degree_[p] = 0;
        plane_[p] = plane_at(global);
        double_[p] = to_double_plane(site_.at, plane_[p]);
        double const f = plane_[p].axis >= 0 ? 1 : scale_;
        x_[p] = static_cast<float>(double_[p].x * f);
        y_[p] = static_cast<float>(double_[p].y * f);
        z_[p] = static_cast<float>(double_[p].z * f);
        return p;
    }

    /// Adds a vertex of the cell, its position in units of 1 / scale. False when the tables are full.
    [[nodiscard]] bool insert(triple const& t, std::array<float, 3> const& at) noexcept {
        if (overflow_ || count_ == max_vertices) return false;
        std::uint32_t const v = count_++;
        triple_[v] = t;
        third_[v] = static_cast<id>(t[0] ^ t[1] ^ t[2]);
        at_[v] = at;
        for (std::size_t k = 0; k < 3; ++k) {
            id const a = t[k];
            id const b = t[k == 2 ? 0 : k + 1];
            holder_[a * max_planes + b] = static_cast<std::uint8_t>(v);
            ++degree_[a];
            open_[open_count_] = {a, b};
            open_count_ += holder_[b * max_planes + a] == none ? 1U : 0U;
        }
        return true;
    }

    /// Finds all other vertices; calls found(v, estimate) for each. `planes` holds every plane within
    /// reach that meets a vertex not inserted. False when the tables are full or a vertex is out of reach.
    template <class PlaneAt, class Found>
    [[nodiscard]] bool complete(near_planes const& planes, PlaneAt const& plane_at, Found const& found) {
        if (count_ == 0) return false;
        while (open_count_ > 0) {
            auto const [a, b] = open_[--open_count_];
            if (holder_[b * max_planes + a] != none) continue;
            if (!cross(planes, plane_at, a, b, found)) return false;
        }
        return true;
    }

    [[nodiscard]] std::uint32_t vertex_count() const noexcept { return count_; }
    [[nodiscard]] std::uint32_t plane_count() const noexcept { return planes_; }
    [[nodiscard]] bool alive(std::uint32_t p) const noexcept { return degree_[p] != 0; }
    [[nodiscard]] std::uint32_t degree(std::uint32_t p) const noexcept { return degree_[p]; }
    [[nodiscard]] std::uint32_t id_of(std::uint32_t p) const noexcept { return id_[p]; }
    [[nodiscard]] triple const& vertex(std::uint32_t v) const noexcept { return triple_[v]; }
    [[nodiscard]] exact::site const& site() const noexcept { return site_; }

    void prepare_walks() const noexcept {}
    /// As `voronoi_cell::walk`.
    template <class Visit>
    void walk(std::uint32_t p, std::uint32_t first, Visit const& visit) const {
        triple const& t = triple_[first];
        std::uint32_t v = first;
        std::uint32_t before = t[0] == p ? t[2] : t[1] == p ? t[0] : t[1];
        do {
            visit(v);
            v = holder_[p * max_planes + before];
            before ^= p ^ third_[v];
        } while (v != first);
    }

private:
    // The vertex at the other end of the edge that holds a -> b.
    template <class PlaneAt, class Found>
    [[nodiscard]] bool cross(near_planes const& planes, PlaneAt const& plane_at, id a, id b, Found const& found) {
        std::array<float, 3> const& from = at_[holder_[a * max_planes + b]];
        std::array<float, 3> const along{y_[b] * z_[a] - z_[b] * y_[a], z_[b] * x_[a] - x_[b] * z_[a],
                                         x_[b] * y_[a] - y_[b] * x_[a]};
        float const size = (std::fabs(x_[a]) + std::fabs(y_[a]) + std::fabs(z_[a])) *
                           (std::fabs(x_[b]) + std::fabs(y_[b]) + std::fabs(z_[b]));
        float const r2 = from[0] * from[0] + from[1] * from[1] + from[2] * from[2];
        std::size_t k = planes.first_hit(from, along, margin_ * size, planes.within(1.2F * r2));
        bool all = k == near_planes::none;
        if (all) k = planes.first_hit(from, along, margin_ * size, planes.count());
        if (k == near_planes::none) return false;
        for (;;) {
            id const c = plane(planes.id(k), plane_at);
            if (overflow_) return false;
            vertex_estimate const e = corner(a, b, c);
            std::array<float, 3> const at{static_cast<float>(e.x * scale_), static_cast<float>(e.y * scale_),
                                          static_cast<float>(e.z * scale_)};
            float const radius2 = at[0] * at[0] + at[1] * at[1] + at[2] * at[2];
            if (!(radius2 < limit2_)) {
                if (all) return false;
                all = true;
                k = planes.first_hit(from, along, margin_ * size, planes.count());
                continue;
            }
            double const length = std::sqrt(e.x * e.x + e.y * e.y + e.z * e.z);
            float const margin = margin_ + static_cast<float>(e.error * scale_) * 8 * std::sqrt(limit2_);
            std::size_t const there = planes.within(radius2);
            // The three planes themselves are near it; usually no others are.
            std::size_t const expected = std::size_t{present(a)} + std::size_t{present(b)} + 1;
            std::size_t other = k;
            bool const cut = planes.count_near(at, margin, there) != expected && planes.any_near(at, margin, there, [&](std::size_t q) {
                std::uint32_t const global = planes.id(q);
                if (global == id_[a] || global == id_[b] || global == id_[c]) return false;
                exact::plane const p = plane_at(global);
                double_plane const d = to_double_plane(site_.at, p);
                double const n1 = std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z);
                double const s = d.x * e.x + d.y * e.y + d.z * e.z - d.h;
                double const unsure = e.error * n1 + 0x1p-49 * n1 * length;
                if (s < -unsure) return false;
                if (!(s > unsure) && exact::side4_unfiltered(site_, plane_[a], plane_[b], plane_[c], p) < 0) return false;
                other = q;
                return true;
            });
            if (cut) {
                k = other;
                continue;
            }
            if (!insert({b, a, c}, at)) return false;
            found(count_ - 1, e);
            return true;
        }
    }

    [[nodiscard]] bool present(id p) const noexcept { return id_[p] < absent_ || id_[p] > site_.rank; }

    // By the order of ids, so that the lowest site of a vertex always gets the same bits.
    [[nodiscard]] vertex_estimate corner(id a, id b, id c) const noexcept {
        if (id_[a] > id_[b]) std::swap(a, b);
        if (id_[b] > id_[c]) std::swap(b, c);
        if (id_[a] > id_[b]) std::swap(a, b);
        return solve(site_.at, plane_[a], plane_[b], plane_[c], double_[a], double_[b], double_[c]);
    }

    exact::site site_{};
    std::uint32_t absent_ = 0;
    double scale_ = 1;
    float limit2_ = 0;
    float margin_ = 0;
    std::uint32_t count_ = 0;
    std::uint32_t planes_ = 0;
    std::uint32_t open_count_ = 0;
    bool overflow_ = false;
    std::array<triple, max_vertices> triple_{};
    std::array<id, max_vertices> third_{};
    std::array<std::array<float, 3>, max_vertices> at_{};
    std::array<std::pair<id, id>, 3 * max_vertices + 3> open_{};
    std::array<std::uint32_t, max_planes> id_{};
    std::array<std::uint32_t, max_planes> degree_{};
    std::array<float, max_planes> x_{};
    std::array<float, max_planes> y_{};
    std::array<float, max_planes> z_{};
    std::array<exact::plane, max_planes> plane_{};
    std::array<double_plane, max_planes> double_{};
    std::array<std::uint8_t, max_planes> slot_of_{};
    std::array<std::uint8_t, slots> slot_ = filled<slots>();
    std::array<std::uint8_t, max_planes * max_planes> holder_ = filled<max_planes * max_planes>();

    template <std::size_t N>
    [[nodiscard]] static constexpr std::array<std::uint8_t, N> filled() noexcept {
        std::array<std::uint8_t, N> a{};
        a.fill(none);
        return a;
    }
};

}  // namespace baseline or avx
}  // namespace tafoni::detail

#endif
