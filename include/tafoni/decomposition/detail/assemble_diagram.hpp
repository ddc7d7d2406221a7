/// \file
/// Cells built block by block, put together into one diagram.
#ifndef TAFONI_DECOMPOSITION_DETAIL_ASSEMBLE_DIAGRAM_HPP
#define TAFONI_DECOMPOSITION_DETAIL_ASSEMBLE_DIAGRAM_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/run_context.hpp>
#include <tafoni/decomposition/detail/cell_builder.hpp>
#include <tafoni/decomposition/detail/site_tree.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
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

/// Writes the faces of a block. A vertex of an earlier block is found among those of its lowest site by
/// its key. O(corners).
template <class Diagram>
void write_faces(Diagram& d, cell_block const& block, block_offset at, std::vector<std::uint32_t> const& vertex_begin,
                 std::vector<std::uint32_t>& borrowed) {
    borrowed.resize(block.borrowed.size());
    for (std::size_t k = 0; k < borrowed.size(); ++k) {
        vertex_key const& key = block.borrowed[k];
        auto const* first = d.keys.data() + vertex_begin[key[0]];
        auto const* last = d.keys.data() + vertex_begin[key[0] + 1];
        if (last - first > 16) {
            first = std::lower_bound(first, last, key);
        } else {
            while (first != last && (((*first)[1] ^ key[1]) | ((*first)[2] ^ key[2]) | ((*first)[3] ^ key[3])) != 0) ++first;
        }
        TAFONI_ASSERT(first != last && *first == key, "cells agree on their vertices");
        borrowed[k] = static_cast<std::uint32_t>(first - d.keys.data());
    }
    auto const base = static_cast<std::uint32_t>(at.vertex);
    auto const global = [&](std::uint32_t place) {
        return place < cell_block::elsewhere ? base + place : borrowed[place - cell_block::elsewhere];
    };
    std::copy(block.neighbour.begin(), block.neighbour.end(), d.neighbour.begin() + static_cast<std::ptrdiff_t>(at.face));
    std::size_t small = 0;
    std::size_t large = 0;
    std::size_t face = 0;
    std::uint32_t const* vertex = block.vertex.data();
    std::size_t cell = at.cell;
    std::vector<std::uint32_t> loop(32);
    for (auto const& c : block.cells) {
        d.face_begin[cell++] = static_cast<std::uint32_t>(at.face + face);
        auto const write = [&](auto const* list) {
            for (std::uint32_t f = 0; f < c.faces; ++f, ++face) {
                d.corner_begin[at.face + face] = static_cast<std::uint32_t>(at.corner);
                std::uint32_t const degree = block.degree[face];
                std::uint32_t* to = d.corners.data() + at.corner;
                if (loop.size() < degree) loop.resize(2 * degree);
                std::uint32_t lowest = 0;
                for (std::uint32_t k = 0; k < degree; ++k) {
                    loop[k] = global(vertex[list[k]]);
                    if (loop[k] < loop[lowest]) lowest = k;
                }
                for (std::uint32_t k = lowest; k < degree; ++k) *to++ = loop[k];
                for (std::uint32_t k = 0; k < lowest; ++k) *to++ = loop[k];
                at.corner += degree;
                list += degree;
            }
        };
        if (c.vertices <= 255) {
            write(block.corner_small.data() + small);
            small += c.corners;
        } else {
            write(block.corner_large.data() + large);
            large += c.corners;
        }
        vertex += c.vertices;
    }
}

/// Room for the whole, judged by the part that is done.
template <class T>
void make_room(std::vector<T>& list, std::size_t size, double share_done) {
    if (size > list.capacity()) list.reserve(std::max(size, static_cast<std::size_t>(1.03 * static_cast<double>(size) / share_done)));
    list.resize(size);
}

/// Fills in the cells of `d.sites`. The blocks, and so all bits, depend on the sites alone.
///
/// A vertex belongs to the lowest of its sites, so a run of blocks can be written as soon as the
/// runs before it are: only one run is held besides the result.
template <class Diagram, class Executor>
void assemble_diagram(Diagram& d, Executor const& pool, run_context const& context) {
    // A run stays in the caches where few threads share it.
    std::size_t const blocks_per_run = 8 * std::max<std::size_t>(pool.thread_count(), 1);
    site_tree const tree(d.sites);
    lattice_box const box{d.box_lo, d.box_hi};
    std::size_t const leaves = tree.leaves.size();
    // The larger a block, the more its cells know of each other; the smaller, the better threads share it.
    std::size_t const leaves_per_block = std::clamp(leaves / 24, std::size_t{8}, std::size_t{128});
    std::size_t const block_count = (leaves + leaves_per_block - 1) / leaves_per_block;
    std::size_t const run_blocks = std::min(blocks_per_run, block_count);
    std::vector<cell_block> blocks(run_blocks);
    std::vector<std::unique_ptr<cell_builder>> builders(run_blocks);
    std::vector<block_offset> offset(run_blocks + 1);
    std::vector<std::uint32_t> vertex_begin(d.sites.size() + 1);
    d.face_begin.resize(d.sites.size() + 1);

    for (std::size_t done = 0; done < block_count; done += run_blocks) {
        context.tick("voronoi cells", static_cast<double>(done) / static_cast<double>(block_count));
        std::size_t const todo = std::min(run_blocks, block_count - done);
        pool.for_blocks(todo, 1, [&](std::size_t b, std::size_t e) {
            // Scratch memory outlives the run.
            if (!builders[b]) builders[b] = std::make_unique<cell_builder>(d.sites, tree, box);
            for (std::size_t k = b; k < e; ++k) {
                blocks[k].clear();
                std::size_t const first = (done + k) * leaves_per_block;
                std::size_t const stop = std::min(leaves, first + leaves_per_block);
                builders[b]->build(std::span(tree.leaves).subspan(first, stop - first), blocks[k]);
            }
        });

        for (std::size_t k = 0; k < todo; ++k) {
            block_offset o = offset[k];
            for (auto const& c : blocks[k].cells) {
                vertex_begin[o.cell++] = static_cast<std::uint32_t>(o.vertex);
                o.face += c.faces;
                o.corner += c.corners;
                o.vertex += c.own;
            }
            offset[k + 1] = o;
        }
        block_offset const total = offset[todo];
        if (total.corner >= std::numeric_limits<std::uint32_t>::max()) {
            fail<invalid_input>(errc::size_overflow, "make_voronoi_diagram: " + std::to_string(total.corner) +
                                                         " face corners exceed 32-bit indices");
        }
        vertex_begin[total.cell] = static_cast<std::uint32_t>(total.vertex);
        d.face_begin[total.cell] = static_cast<std::uint32_t>(total.face);
        double const share = static_cast<double>(total.cell) / static_cast<double>(d.sites.size());
        make_room(d.vertices, total.vertex, share);
        make_room(d.keys, total.vertex, share);
        make_room(d.neighbour, total.face, share);
        make_room(d.corner_begin, total.face + 1, share);
        make_room(d.corners, total.corner, share);
        d.corner_begin[total.face] = static_cast<std::uint32_t>(total.corner);
        pool.for_blocks(todo, 1, [&](std::size_t b, std::size_t e) {
            for (std::size_t k = b; k < e; ++k) {
                auto const to = static_cast<std::ptrdiff_t>(offset[k].vertex);
                std::copy(blocks[k].own_key.begin(), blocks[k].own_key.end(), d.keys.begin() + to);
                std::copy(blocks[k].own_position.begin(), blocks[k].own_position.end(), d.vertices.begin() + to);
            }
        });
        pool.for_blocks(todo, 1, [&](std::size_t b, std::size_t e) {
            std::vector<std::uint32_t> borrowed;
            for (std::size_t k = b; k < e; ++k) write_faces(d, blocks[k], offset[k], vertex_begin, borrowed);
        });
        offset[0] = total;
    }
}

}  // namespace tafoni::detail

#endif
