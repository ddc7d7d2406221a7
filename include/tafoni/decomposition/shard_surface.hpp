/// \file
/// The closed surface of a set of cells, as triangles that know where they come from.
#ifndef TAFONI_DECOMPOSITION_SHARD_SURFACE_HPP
#define TAFONI_DECOMPOSITION_SHARD_SURFACE_HPP

#include <tafoni/decomposition/detail/face_triangles.hpp>
#include <tafoni/decomposition/detail/split_nonmanifold.hpp>
#include <tafoni/decomposition/shard_complex.hpp>
#include <tafoni/geometry/indexed_mesh.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tafoni {

/// A closed, outward oriented 2-manifold of triangles around cells. Arrays "per triangle" and "per
/// vertex" are parallel to `mesh`.
struct shard_surface {
    indexed_mesh mesh{};
    std::vector<cell_index> cell{};      ///< per triangle: the cell that it bounds
    std::vector<face_index> face{};      ///< per triangle: the face of the complex that it is cut from
    std::vector<std::uint8_t> fresh{};   ///< per triangle: 1 = laid open between two cells, 0 = skin of the input
    std::vector<vertex_index> vertex{};  ///< per vertex: that of the complex; not valid for vertices added on edges
};

namespace detail {

/// Where sheets touch along an edge whose two ends they share as well, each sheet gets a middle of its own.
inline void split_shared_edges(shard_surface& s, std::vector<std::uint32_t> const& opposite) {
    struct edge {
        std::uint32_t low;
        std::uint32_t high;
        std::uint32_t h;
    };
    std::vector<edge> edges;
    auto const corner = [&s](std::size_t h) { return s.mesh.corners[h]; };
    for (std::uint32_t h = 0; h < opposite.size(); ++h) {
        if (h >= opposite[h]) continue;
        std::uint32_t const a = corner(h);
        std::uint32_t const b = corner(next_corner(h));
        edges.push_back({a < b ? a : b, a < b ? b : a, h});
    }
    std::sort(edges.begin(), edges.end(), [](edge const& x, edge const& y) {
        if (x.low != y.low) return x.low < y.low;
        return x.high != y.high ? x.high < y.high : x.h < y.h;
    });
    std::vector<std::pair<std::uint32_t, std::uint32_t>> middles;  // half-edge, new vertex
    for (std::size_t e = 0; e < edges.size(); ++e) {
        auto const same = [&](std::size_t o) { return o < edges.size() && edges[o].low == edges[e].low && edges[o].high == edges[e].high; };
        if (!same(e + 1) && (e == 0 || !same(e - 1))) continue;
        vec3 const& p = s.mesh.positions[edges[e].low];
        vec3 const& q = s.mesh.positions[edges[e].high];
        vec3 const middle{0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.5 * (p[2] + q[2])};
        std::uint32_t const m = s.mesh.add_vertex(middle).value;
        s.vertex.push_back(vertex_index{});
        middles.push_back({edges[e].h, m});
        middles.push_back({opposite[edges[e].h], m});
    }
    std::sort(middles.begin(), middles.end());
    for (std::size_t k = 0; k < middles.size();) {
        std::uint32_t const t = middles[k].first / 3;
        std::vector<std::uint32_t> loop;
        std::size_t at = k;
        for (std::uint32_t c = 0; c < 3; ++c) {
            loop.push_back(corner(3 * t + c));
            if (at < middles.size() && middles[at].first == 3 * t + c) loop.push_back(middles[at++].second);
        }
        k = at;
        // A fan from a middle cuts off no corner twice, however many sides were split.
        std::size_t start = 0;
        while (loop[start] < s.vertex.size() && s.vertex[loop[start]].valid()) ++start;
        std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(start), loop.end());
        for (std::size_t c = 1; c + 1 < loop.size(); ++c) {
            std::array<std::uint32_t, 3> const tri{loop[0], loop[c], loop[c + 1]};
            if (c == 1) {
                std::copy(tri.begin(), tri.end(), s.mesh.corners.begin() + static_cast<std::ptrdiff_t>(3 * std::size_t{t}));
                continue;
            }
            s.mesh.add_face(tri);
            s.cell.push_back(cell_index{s.cell[t]});
            s.face.push_back(face_index{s.face[t]});
            s.fresh.push_back(std::uint8_t{s.fresh[t]});
        }
    }
}

struct extract_surface_fn {
    /// The surface of the cells whose entry in `inside` is not 0: every face with such a cell on one
    /// side only, cut into triangles, outward oriented. Sheets that touch are separated. Both sides of
    /// a face are cut alike. Any cell complex. O(faces + n log n) for n triangles.
    /// \throws invalid_input  attribute_length unless there is one entry per cell; size_overflow
    template <cell_complex C>
    [[nodiscard]] shard_surface operator()(C const& c, std::span<std::uint8_t const> inside) const {
        if (inside.size() != c.cell_count()) {
            fail<invalid_input>(errc::attribute_length, "extract_surface: " + std::to_string(inside.size()) +
                                                            " entries for " + std::to_string(c.cell_count()) + " cells");
        }
        builder b;
        for (std::uint32_t f = 0; f < c.face_count(); ++f) b.add(c, face_index{f}, inside);
        return b.finish(c);
    }

    /// The surface of a few shards, each named once. O(shards of the complex / 64 + n log n).
    /// \throws invalid_input  index_out_of_range
    [[nodiscard]] shard_surface operator()(shard_complex const& c, std::span<cell_index const> cells) const {
        std::vector<std::uint8_t> inside(c.cell_count(), 0);
        for (cell_index k : cells) {
            if (k.value >= inside.size()) {
                fail<invalid_input>(errc::index_out_of_range,
                                    "extract_surface: cell " + std::to_string(k.value) + " of " + std::to_string(inside.size()),
                                    {.kind = entity::cell, .index = k.value});
            }
            inside[k.value] = 1;
        }
        builder b;
        for (cell_index k : cells) {
            for (std::uint32_t f : c.faces_of(k)) b.add(c, face_index{f}, inside);
        }
        return b.finish(c);
    }

private:
    struct builder {
        template <class C>
        void add(C const& c, face_index f, std::span<std::uint8_t const> inside) {
            auto const [front, back] = c.face_cells(f);
            bool const in_front = front.valid() && inside[front.value] != 0;
            bool const in_back = back.valid() && inside[back.value] != 0;
            if (in_front == in_back) return;
            cut.clear();
            triangulate_face(c, f, cut);
            for (auto const& v : cut) {
                // A bridge to a hole that touches the outline leaves triangles with one corner twice: nothing.
                if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
                triangles.push_back({v[0].value, in_front ? v[1].value : v[2].value, in_front ? v[2].value : v[1].value});
                out.cell.push_back(in_front ? front : back);
                out.face.push_back(f);
                out.fresh.push_back(back.valid() ? 1 : 0);
            }
        }

        template <class C>
        shard_surface finish(C const& c) {
            require_indexable("extract_surface", 3 * triangles.size());
            auto const places = [&c](std::uint32_t v) { return c.position(vertex_index{v}); };
            bool crowded = false;
            auto opposite = pair_half_edges(triangles, places, crowded);
            if (crowded && drop_opposites()) opposite = pair_half_edges(triangles, places, crowded);
            std::uint32_t const vertices = weld_corners(opposite, out.mesh.corners);
            out.mesh.positions.resize(vertices);
            out.vertex.resize(vertices);
            out.mesh.offsets.resize(triangles.size() + 1);
            for (std::size_t t = 0; t < triangles.size(); ++t) out.mesh.offsets[t + 1] = 3 * (t + 1);
            for (std::size_t k = 0; k < out.mesh.corners.size(); ++k) {
                out.vertex[out.mesh.corners[k]] = vertex_index{triangles[k / 3][k % 3]};
            }
            for (std::size_t v = 0; v < vertices; ++v) out.mesh.positions[v] = c.position(out.vertex[v]);
            split_shared_edges(out, opposite);
            return std::move(out);
        }

        /// Takes out triangles that lie back to back; false when there are none.
        bool drop_opposites() {
            auto const stays = without_opposites(triangles);
            std::size_t kept = 0;
            for (std::size_t t = 0; t < stays.size(); ++t) {
                if (stays[t] == 0) continue;
                triangles[kept] = triangles[t];
                out.cell[kept] = out.cell[t];
                out.face[kept] = out.face[t];
                out.fresh[kept++] = out.fresh[t];
            }
            if (kept == stays.size()) return false;
            triangles.resize(kept);
            out.cell.resize(kept);
            out.face.resize(kept);
            out.fresh.resize(kept);
            return true;
        }

        face_triangulator triangulate_face{};
        std::vector<std::array<vertex_index, 3>> cut{};
        std::vector<std::array<std::uint32_t, 3>> triangles{};
        shard_surface out{};
    };
};

}  // namespace detail

/// Extracts a closed surface; see `detail::extract_surface_fn`.
inline constexpr detail::extract_surface_fn extract_surface{};

}  // namespace tafoni

#endif
