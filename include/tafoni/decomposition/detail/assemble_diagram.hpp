/// \file
/// Cells built block by block, put together into one diagram.
#ifndef TAFONI_DECOMPOSITION_DETAIL_ASSEMBLE_DIAGRAM_HPP
#define TAFONI_DECOMPOSITION_DETAIL_ASSEMBLE_DIAGRAM_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/run_context.hpp>
#include <tafoni/decomposition/detail/cell_block.hpp>
#include <tafoni/decomposition/detail/site_tree.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace tafoni::detail {

/// Where the parts of a block go in the diagram.
struct block_offset {
    std::size_t cell = 0;
    std::size_t face = 0;
    std::size_t corner = 0;
    std::size_t vertex = 0;
};

/// Resolves the corners of a block's cells to vertices of the diagram and writes its faces. A vertex
/// is found among those of its lowest site by its key. O(corners).
template <class Diagram>
void write_faces(Diagram& d, cell_block const& block, block_offset at, std::vector<std::uint32_t> const& vertex_begin,
                 std::vector<std::uint32_t>& global) {
    std::size_t small = 0;
    std::size_t large = 0;
    std::size_t face = 0;
    auto cell = static_cast<std::uint32_t>(at.cell);
    auto const write = [&](cell_block::cell const& c, auto const* list) {
        std::uint32_t const* ids = block.neighbour.data() + face;
        auto const* triples = list + c.corners;
        global.resize(c.vertices);
        for (std::uint32_t v = 0; v < c.vertices; ++v) {
            std::uint32_t const i = ids[triples[3 * v]];
            std::uint32_t const j = ids[triples[3 * v + 1]];
            std::uint32_t const k = ids[triples[3 * v + 2]];
            vertex_key const key{std::min(cell, i), std::max(std::min(cell, j), i), std::max(std::min(cell, k), j),
                                 std::max(cell, k)};
            auto const* first = d.keys.data() + vertex_begin[key[0]];
            auto const* last = d.keys.data() + vertex_begin[key[0] + 1];
            if (last - first > 16) {
                first = std::lower_bound(first, last, key);
            } else {
                while (first != last && (((*first)[1] ^ key[1]) | ((*first)[2] ^ key[2]) | ((*first)[3] ^ key[3])) != 0) ++first;
            }
            TAFONI_ASSERT(first != last && *first == key, "cells agree on their vertices");
            global[v] = static_cast<std::uint32_t>(first - d.keys.data());
        }
        for (std::uint32_t f = 0; f < c.faces; ++f, ++face) {
            d.neighbour[at.face + face] = ids[f];
            d.corner_begin[at.face + face] = static_cast<std::uint32_t>(at.corner);
            std::uint32_t const degree = block.degree[face];
            std::uint32_t lowest = 0;
            for (std::uint32_t k = 1; k < degree; ++k) {
                if (global[list[k]] < global[list[lowest]]) lowest = k;
            }
            for (std::uint32_t k = 0; k < degree; ++k) {
                std::uint32_t const from = k + lowest < degree ? k + lowest : k + lowest - degree;
                d.corners[at.corner + k] = global[list[from]];
            }
            at.corner += degree;
            list += degree;
        }
        ++cell;
    };
    for (auto const& c : block.cells) {
        d.face_begin[cell] = static_cast<std::uint32_t>(at.face + face);
        if (c.vertices <= 255) {
            write(c, block.corner_small.data() + small);
            small += c.corners + 3 * std::size_t{c.vertices};
        } else {
            write(c, block.corner_large.data() + large);
            large += c.corners + 3 * std::size_t{c.vertices};
        }
    }
}

/// Fills in the cells of `d.sites`. The blocks, and so all bits, depend on the sites alone.
template <class Diagram, class Executor>
void assemble_diagram(Diagram& d, Executor const& pool, run_context const& context) {
    constexpr std::size_t leaves_per_block = 32;
    constexpr std::size_t blocks_per_tick = 128;
    site_tree const tree(d.sites);
    lattice_box const box{d.box_lo, d.box_hi};
    std::size_t const leaves = tree.leaves.size();
    std::size_t const block_count = (leaves + leaves_per_block - 1) / leaves_per_block;
    std::vector<cell_block> blocks(block_count);
    for (std::size_t done = 0; done < block_count; done += blocks_per_tick) {
        context.tick("voronoi cells", 0.8 * static_cast<double>(done) / static_cast<double>(block_count));
        std::size_t const todo = std::min(blocks_per_tick, block_count - done);
        pool.for_blocks(todo, 1, [&](std::size_t b, std::size_t e) {
            cell_builder builder(d.sites, tree, box);
            for (std::size_t k = done + b; k < done + e; ++k) {
                std::size_t const stop = std::min(leaves, (k + 1) * leaves_per_block);
                cell_builder::reserve(blocks[k], tree.nodes[tree.leaves[stop - 1]].end - tree.nodes[tree.leaves[k * leaves_per_block]].begin);
                for (std::size_t l = k * leaves_per_block; l < stop; ++l) builder.build_leaf(tree.leaves[l], blocks[k]);
            }
        });
    }

    std::vector<block_offset> offset(block_count + 1);
    std::vector<std::uint32_t> vertex_begin(d.sites.size() + 1);
    for (std::size_t k = 0; k < block_count; ++k) {
        cell_block const& b = blocks[k];
        block_offset o = offset[k];
        for (auto const& c : b.cells) {
            vertex_begin[o.cell++] = static_cast<std::uint32_t>(o.vertex);
            o.face += c.faces;
            o.corner += c.corners;
            o.vertex += c.own;
        }
        offset[k + 1] = o;
    }
    block_offset const total = offset.back();
    if (total.corner >= std::numeric_limits<std::uint32_t>::max()) {
        fail<invalid_input>(errc::size_overflow, "make_voronoi_diagram: " + std::to_string(total.corner) +
                                                     " face corners exceed 32-bit indices");
    }
    vertex_begin[total.cell] = static_cast<std::uint32_t>(total.vertex);

    context.tick("voronoi cells", 0.85);
    d.vertices.resize(total.vertex);
    d.keys.resize(total.vertex);
    pool.for_blocks(block_count, 16, [&](std::size_t b, std::size_t e) {
        for (std::size_t k = b; k < e; ++k) {
            auto const to = static_cast<std::ptrdiff_t>(offset[k].vertex);
            std::copy(blocks[k].own_key.begin(), blocks[k].own_key.end(), d.keys.begin() + to);
            std::copy(blocks[k].own_position.begin(), blocks[k].own_position.end(), d.vertices.begin() + to);
            blocks[k].own_key = {};
            blocks[k].own_position = {};
        }
    });
    d.face_begin.resize(total.cell + 1);
    d.neighbour.resize(total.face);
    d.corner_begin.resize(total.face + 1);
    d.corners.resize(total.corner);
    d.face_begin[total.cell] = static_cast<std::uint32_t>(total.face);
    d.corner_begin[total.face] = static_cast<std::uint32_t>(total.corner);
    context.tick("voronoi cells", 0.9);
    pool.for_blocks(block_count, 16, [&](std::size_t b, std::size_t e) {
        std::vector<std::uint32_t> global;
        for (std::size_t k = b; k < e; ++k) {
            write_faces(d, blocks[k], offset[k], vertex_begin, global);
            blocks[k] = {};
        }
    });
}

}  // namespace tafoni::detail

#endif
