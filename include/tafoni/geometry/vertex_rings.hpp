/// \file
/// Around every vertex: its triangles and its neighbours, as flat arrays.
#ifndef TAFONI_GEOMETRY_VERTEX_RINGS_HPP
#define TAFONI_GEOMETRY_VERTEX_RINGS_HPP

#include <tafoni/core/index.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni {

namespace detail {
class mended_rings;
}

/// One-ring adjacency of a triangle mesh, which may be open, non-manifold or degenerate.
///
/// Lists are in ascending order, so that sums over them have one order. A triangle that names a vertex
/// twice is left out. About 60 bytes per vertex of a closed mesh.
class vertex_rings {
public:
    vertex_rings() = default;

    /// O(vertices + faces); every corner must be below `vertices`.
    vertex_rings(std::size_t vertices, std::span<std::array<std::uint32_t, 3> const> triangles) {
        face_begin_.assign(vertices + 1, 0);
        auto const proper = [](std::array<std::uint32_t, 3> const& t) {
            return t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
        };
        for (auto const& t : triangles) {
            if (!proper(t)) continue;
            for (std::uint32_t const v : t) ++face_begin_[v + 1];
        }
        for (std::size_t v = 0; v < vertices; ++v) face_begin_[v + 1] += face_begin_[v];
        corners_.resize(face_begin_[vertices]);
        std::vector<std::uint32_t> at(face_begin_.begin(), face_begin_.end() - 1);
        for (std::size_t f = 0; f < triangles.size(); ++f) {
            auto const& t = triangles[f];
            if (!proper(t)) continue;
            for (std::uint32_t k = 0; k < 3; ++k) corners_[at[t[k]]++] = {static_cast<std::uint32_t>(f), k};
        }
        neighbor_begin_.assign(vertices + 1, 0);
        neighbors_.reserve(corners_.size() + vertices / 8);
        border_.assign(vertices, 0);
        std::vector<std::uint32_t> ring;
        for (std::size_t v = 0; v < vertices; ++v) {
            if (add_neighbors(faces(v), triangles, neighbors_, ring)) border_[v] = 1;
            neighbor_begin_[v + 1] = static_cast<std::uint32_t>(neighbors_.size());
        }
    }

    /// The place of a vertex in one of its triangles.
    struct corner {
        std::uint32_t face = 0;
        std::uint32_t place = 0;  ///< 0, 1 or 2

        bool operator==(corner const&) const = default;
    };
    /// Whether all lists are equal.
    bool operator==(vertex_rings const&) const = default;

    [[nodiscard]] std::size_t vertex_count() const noexcept { return border_.size(); }
    /// Three for every triangle that names no vertex twice.
    [[nodiscard]] std::size_t corner_count() const noexcept { return corners_.size(); }
    /// Triangles at a vertex, ascending.
    [[nodiscard]] std::span<corner const> faces(std::size_t v) const noexcept {
        return {corners_.data() + face_begin_[v], corners_.data() + face_begin_[v + 1]};
    }
    /// Vertices that share an edge with it, ascending, each once.
    [[nodiscard]] std::span<std::uint32_t const> neighbors(std::size_t v) const noexcept {
        return {neighbors_.data() + neighbor_begin_[v], neighbors_.data() + neighbor_begin_[v + 1]};
    }
    /// Whether an edge at the vertex has one triangle only.
    [[nodiscard]] bool is_border(std::size_t v) const noexcept { return border_[v] != 0; }

private:
    friend class detail::mended_rings;

    using triangle_span = std::span<std::array<std::uint32_t, 3> const>;
    static constexpr std::size_t most_in_fan = 16;

    /// Appends the neighbours of the vertex with the triangles `around` it; whether it lies on the border. O(k log k).
    static bool add_neighbors(std::span<corner const> around, triangle_span triangles, std::vector<std::uint32_t>& neighbors,
                              std::vector<std::uint32_t>& scratch) {
        return !add_closed_fan(around, triangles, neighbors) && add_any(around, triangles, neighbors, scratch);
    }
    /// Where each neighbour leads one triangle in and one out, as at nearly all vertices; false elsewhere.
    static bool add_closed_fan(std::span<corner const> around, triangle_span triangles, std::vector<std::uint32_t>& neighbors) {
        std::size_t const n = around.size();
        if (n > most_in_fan) return false;
        std::array<std::uint32_t, most_in_fan> out;
        std::array<std::uint32_t, most_in_fan> in;
        for (std::size_t k = 0; k < n; ++k) {
            auto const& t = triangles[around[k].face];
            std::uint32_t const place = around[k].place;
            out[k] = t[place == 2 ? 0 : place + 1];
            in[k] = t[place == 0 ? 2 : place - 1];
        }
        // Ranks by counting: no branch depends on the numbers, which are as good as random. Equal ones share a rank, so
        // that the ranks no longer add up.
        std::array<std::uint32_t, most_in_fan> sorted;
        std::array<std::uint32_t, most_in_fan> other;
        std::size_t ranks = 0;
        std::size_t other_ranks = 0;
        for (std::size_t k = 0; k < n; ++k) {
            std::size_t rank = 0;
            std::size_t other_rank = 0;
            for (std::size_t j = 0; j < n; ++j) {
                rank += out[j] < out[k] ? 1U : 0U;
                other_rank += in[j] < in[k] ? 1U : 0U;
            }
            sorted[rank] = out[k];
            other[other_rank] = in[k];
            ranks += rank;
            other_ranks += other_rank;
        }
        std::size_t const all = n * (n - 1) / 2;
        if (ranks != all || other_ranks != all) return false;
        if (!std::equal(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(n), other.begin())) return false;
        neighbors.insert(neighbors.end(), sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(n));
        return true;
    }
    static bool add_any(std::span<corner const> around, triangle_span triangles, std::vector<std::uint32_t>& neighbors,
                        std::vector<std::uint32_t>& ring) {
        ring.clear();
        for (corner const& c : around) {
            ring.push_back(triangles[c.face][(c.place + 1) % 3]);
            ring.push_back(triangles[c.face][(c.place + 2) % 3]);
        }
        std::sort(ring.begin(), ring.end());
        bool border = false;
        for (std::size_t k = 0; k < ring.size();) {
            std::size_t e = k + 1;
            while (e < ring.size() && ring[e] == ring[k]) ++e;
            if (e - k == 1) border = true;
            neighbors.push_back(ring[k]);
            k = e;
        }
        return border;
    }

    std::vector<std::uint32_t> face_begin_{};
    std::vector<corner> corners_{};
    std::vector<std::uint32_t> neighbor_begin_{};
    std::vector<std::uint32_t> neighbors_{};
    std::vector<unsigned char> border_{};
};

}  // namespace tafoni

#endif
