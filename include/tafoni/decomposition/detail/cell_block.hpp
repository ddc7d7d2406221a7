/// \file
/// The cells of a block of neighbouring sites, packed for assembly.
#ifndef TAFONI_DECOMPOSITION_DETAIL_CELL_BLOCK_HPP
#define TAFONI_DECOMPOSITION_DETAIL_CELL_BLOCK_HPP

#include <tafoni/core/vector.hpp>
#include <tafoni/decomposition/detail/plane_corner.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

using vertex_key = std::array<std::uint32_t, 4>;

/// What a block of cells hands to the assembly. Of each cell in turn: its neighbours, ascending; per
/// face a degree and its corners as indices of the cell's vertices; of these, where they are found.
struct cell_block {
    static constexpr std::uint32_t elsewhere = 0x80000000U;  ///< marks a place in `borrowed`

    struct cell {
        std::uint32_t faces = 0;
        std::uint32_t vertices = 0;
        std::uint32_t own = 0;
        std::uint32_t corners = 0;
    };
    std::vector<cell> cells;
    std::vector<std::uint32_t> neighbour;
    std::vector<std::uint32_t> degree;
    std::vector<std::uint8_t> corner_small;   ///< corners of cells with at most 255 vertices
    std::vector<std::uint32_t> corner_large;  ///< of all other cells
    std::vector<std::uint32_t> vertex;        ///< a place in `own_key`, or in `borrowed`
    std::vector<vertex_key> own_key;          ///< vertices whose lowest site is of this block, ascending
    std::vector<vec3> own_position;
    std::vector<vertex_key> borrowed;  ///< vertices whose lowest site is of an earlier block

    void clear() noexcept {
        cells.clear();
        neighbour.clear();
        degree.clear();
        corner_small.clear();
        corner_large.clear();
        vertex.clear();
        own_key.clear();
        own_position.clear();
        borrowed.clear();
    }
};

/// The sites and the box, as planes.
struct plane_source {
    std::span<ivec3 const> sites;
    lattice_box box;

    [[nodiscard]] exact::plane operator()(std::uint32_t id) const noexcept {
        auto const n = static_cast<std::uint32_t>(sites.size());
        if (id < n) return exact::site{sites[id], id};
        std::uint32_t const w = id - n;
        auto const a = static_cast<std::size_t>(w / 2);
        return exact::wall{static_cast<int>(w / 2), w % 2 != 0, w % 2 != 0 ? box.hi[a] : box.lo[a]};
    }


    /// The place of a vertex that `solve` has found for the lowest of its sites, its planes in order of
    /// id: a function of the key alone, on the walls and in the box to the last bit.
    [[nodiscard]] vec3 position(vertex_key const& key, vertex_estimate const& e) const noexcept {
        ivec3 const& base = sites[key[0]];
        std::array<double, 3> x{e.x, e.y, e.z};
        for (std::size_t a = 0; a < 3; ++a) {
            x[a] = std::clamp(static_cast<double>(base[a]) + x[a], static_cast<double>(box.lo[a]),
                              static_cast<double>(box.hi[a]));
        }
        for (std::size_t k = 3; k > 0 && key[k] >= sites.size(); --k) {
            std::uint32_t const w = key[k] - static_cast<std::uint32_t>(sites.size());
            x[w / 2] = static_cast<double>(w % 2 != 0 ? box.hi[w / 2] : box.lo[w / 2]);
        }
        return vec3{x[0], x[1], x[2]};
    }
};

/// Packs finished cells, with scratch memory of its own.
class cell_writer {
public:
    /// Appends a cell; `vertices`: where each of its vertices is found; `own`: how many of them are the cell's. O(corners).
    template <class Cell>
    void operator()(Cell& cell, std::span<std::uint32_t const> vertices, std::uint32_t own, cell_block& out) {
        cell.prepare_walks();
        order_.clear();
        for (std::uint32_t p = 0; p < cell.plane_count(); ++p) {
            if (cell.alive(p)) order_.push_back(std::uint64_t{cell.id_of(p)} << 32 | p);
        }
        sort_few(order_);
        cell_block::cell c{.faces = static_cast<std::uint32_t>(order_.size()),
                           .vertices = cell.vertex_count(),
                           .own = own,
                           .corners = 0};
        std::size_t const face = out.neighbour.size();
        out.neighbour.resize(face + c.faces);
        out.degree.resize(face + c.faces);
        std::uint32_t* const neighbour = out.neighbour.data() + face;
        std::uint32_t* const degree = out.degree.data() + face;
        for (std::uint32_t k = 0; k < c.faces; ++k) {
            neighbour[k] = static_cast<std::uint32_t>(order_[k] >> 32);
            degree[k] = cell.degree(static_cast<std::uint32_t>(order_[k]));
            c.corners += degree[k];
        }
        out.vertex.insert(out.vertex.end(), vertices.begin(), vertices.end());
        first_.resize(cell.plane_count());
        for (std::uint32_t v = 0; v < c.vertices; ++v) {
            for (auto const p : cell.vertex(v)) first_[p] = v;
        }
        auto const write = [&]<class T>(std::vector<T>& list) {
            std::size_t const old = list.size();
            list.resize(old + c.corners);
            T* corner = list.data() + old;
            for (auto const o : order_) {
                auto const p = static_cast<std::uint32_t>(o);
                cell.walk(p, first_[p], [&](std::uint32_t v) { *corner++ = static_cast<T>(v); });
            }
        };
        if (c.vertices <= 255) {
            write(out.corner_small);
        } else {
            write(out.corner_large);
        }
        out.cells.push_back(c);
    }

private:
    // Insertion for the usual handful.
    static void sort_few(std::vector<std::uint64_t>& list) {
        if (list.size() > 48) {
            std::sort(list.begin(), list.end());
            return;
        }
        for (std::size_t k = 1; k < list.size(); ++k) {
            std::uint64_t const v = list[k];
            std::size_t h = k;
            for (; h > 0 && list[h - 1] > v; --h) list[h] = list[h - 1];
            list[h] = v;
        }
    }

    std::vector<std::uint64_t> order_;
    std::vector<std::uint32_t> first_;
};

}  // namespace tafoni::detail

#endif
