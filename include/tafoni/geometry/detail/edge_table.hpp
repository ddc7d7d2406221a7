/// \file
/// Which faces meet at which edge, for meshes of any quality.
#ifndef TAFONI_GEOMETRY_DETAIL_EDGE_TABLE_HPP
#define TAFONI_GEOMETRY_DETAIL_EDGE_TABLE_HPP

#include <tafoni/geometry/indexed_mesh.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// The sides of all faces, grouped by the two vertices that they join.
///
/// A side is numbered by the corner where it starts: side c of face f runs from corners[c] to the
/// next corner of f. Groups come by (lower vertex, higher vertex), sides in a group by number.
class edge_table {
public:
    struct side {
        std::uint32_t high;    ///< the higher of the two vertices
        std::uint32_t corner;  ///< where the side starts
    };

    explicit edge_table(indexed_mesh const& mesh) : mesh_(&mesh), face_of_(mesh.corners.size()) {
        std::size_t const vertices = mesh.vertex_count();
        begin_.assign(vertices + 1, 0);
        for (std::size_t f = 0; f < mesh.face_count(); ++f) {
            for (std::size_t c = mesh.offsets[f]; c < mesh.offsets[f + 1]; ++c) {
                face_of_[c] = static_cast<std::uint32_t>(f);
                ++begin_[lower(c) + 1];
            }
        }
        for (std::size_t v = 0; v < vertices; ++v) begin_[v + 1] += begin_[v];
        sides_.resize(mesh.corners.size());
        std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - (vertices == 0 ? 0 : 1));
        for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
            std::uint32_t const a = from(c);
            std::uint32_t const b = to(c);
            sides_[next[std::min(a, b)]++] = {std::max(a, b), static_cast<std::uint32_t>(c)};
        }
        for (std::size_t v = 0; v < vertices; ++v) {
            std::sort(sides_.begin() + begin_[v], sides_.begin() + begin_[v + 1], [](side x, side y) {
                return x.high != y.high ? x.high < y.high : x.corner < y.corner;
            });
        }
    }

    [[nodiscard]] std::uint32_t from(std::size_t corner) const noexcept { return mesh_->corners[corner]; }
    [[nodiscard]] std::uint32_t face_of(std::size_t corner) const noexcept { return face_of_[corner]; }
    [[nodiscard]] std::uint32_t next_corner(std::size_t corner) const noexcept {
        std::size_t const f = face_of_[corner];
        return static_cast<std::uint32_t>(corner + 1 == mesh_->offsets[f + 1] ? mesh_->offsets[f] : corner + 1);
    }
    [[nodiscard]] std::uint32_t to(std::size_t corner) const noexcept { return mesh_->corners[next_corner(corner)]; }
    /// True when the side runs from its lower to its higher vertex.
    [[nodiscard]] bool forward(side s) const noexcept { return from(s.corner) != s.high; }

    /// Calls f(lower vertex, sides of one edge) for every edge, in order. O(sides).
    template <class F>
    void for_each_edge(F const& f) const {
        for (std::size_t v = 0; v + 1 < begin_.size(); ++v) {
            std::size_t first = begin_[v];
            std::size_t const end = begin_[v + 1];
            while (first < end) {
                std::size_t last = first + 1;
                while (last < end && sides_[last].high == sides_[first].high) ++last;
                f(static_cast<std::uint32_t>(v), std::span<side const>(sides_.data() + first, last - first));
                first = last;
            }
        }
    }

private:
    [[nodiscard]] std::uint32_t lower(std::size_t corner) const noexcept {
        return std::min(from(corner), to(corner));
    }

    indexed_mesh const* mesh_;
    std::vector<std::uint32_t> face_of_;
    std::vector<std::uint32_t> begin_{};
    std::vector<side> sides_{};
};

/// Sets that grow together; the root of a set is its lowest member. Nearly O(1) each.
class disjoint_sets {
public:
    explicit disjoint_sets(std::size_t n) : parent_(n) {
        for (std::size_t i = 0; i < n; ++i) parent_[i] = static_cast<std::uint32_t>(i);
    }
    [[nodiscard]] std::uint32_t root(std::uint32_t i) noexcept {
        while (parent_[i] != i) {
            parent_[i] = parent_[parent_[i]];
            i = parent_[i];
        }
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) noexcept {
        a = root(a);
        b = root(b);
        if (a < b) parent_[b] = a;
        else parent_[a] = b;
    }

private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace tafoni::detail

#endif
