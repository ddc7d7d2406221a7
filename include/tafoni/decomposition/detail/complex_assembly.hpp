/// \file
/// Turns faces and shards in builder's numbers into the complex that the caller gets.
#ifndef TAFONI_DECOMPOSITION_DETAIL_COMPLEX_ASSEMBLY_HPP
#define TAFONI_DECOMPOSITION_DETAIL_COMPLEX_ASSEMBLY_HPP

#include <tafoni/decomposition/detail/shard_split.hpp>
#include <tafoni/decomposition/detail/smooth_patches.hpp>
#include <tafoni/decomposition/shard_complex.hpp>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// Fills cell_begin and cell_faces from the faces, ascending around each cell. O(faces).
inline void index_cell_faces(shard_complex& c) {
    c.cell_begin.assign(c.volumes.size() + 1, 0);
    auto const for_entries = [&c](auto const& f) {
        for (std::uint32_t k = 0; k < c.faces.size(); ++k) {
            f(c.faces[k].front.value, k);
            if (c.faces[k].back.valid()) f(c.faces[k].back.value, k);
        }
    };
    for_entries([&c](std::uint32_t cell, std::uint32_t) { ++c.cell_begin[cell + 1]; });
    for (std::size_t k = 0; k < c.volumes.size(); ++k) c.cell_begin[k + 1] += c.cell_begin[k];
    c.cell_faces.resize(c.cell_begin.back());
    std::vector<std::size_t> next(c.cell_begin.begin(), c.cell_begin.end() - 1);
    for_entries([&](std::uint32_t cell, std::uint32_t face) { c.cell_faces[next[cell]++] = face; });
}

/// Where parts of a site's cell went that were too small to stay.
struct moved_part {
    site_index site;
    cell_index shard;
};

/// Fills site_begin and shards_of_site from site_of and from what was moved. O(sites + cells).
/// `same_as[s]` is the site whose cell the duplicate s shares; empty when there are no duplicates.
inline void index_sites(shard_complex& c, std::vector<std::uint32_t> const& same_as, std::vector<moved_part> const& moved = {}) {
    std::vector<std::size_t> begin(c.sites.size() + 1, 0);
    for (site_index s : c.site_of) ++begin[s.value + 1];
    for (moved_part const& m : moved) ++begin[m.site.value + 1];
    for (std::size_t s = 0; s < c.sites.size(); ++s) begin[s + 1] += begin[s];
    std::vector<cell_index> shards(begin.back());
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (std::uint32_t k = 0; k < c.site_of.size(); ++k) shards[next[c.site_of[k].value]++] = cell_index{k};
    for (moved_part const& m : moved) shards[next[m.site.value]++] = m.shard;
    if (same_as.empty() && moved.empty()) {
        c.site_begin = std::move(begin);
        c.shards_of_site = std::move(shards);
        return;
    }
    c.site_begin.assign(1, 0);
    c.shards_of_site.clear();
    for (std::size_t s = 0; s < c.sites.size(); ++s) {
        std::uint32_t const o = same_as.empty() ? static_cast<std::uint32_t>(s) : same_as[s];
        auto const first = static_cast<std::ptrdiff_t>(c.shards_of_site.size());
        for (std::size_t k = begin[o]; k < begin[o + 1]; ++k) c.shards_of_site.push_back(shards[k]);
        if (!moved.empty()) {
            auto const less = [](cell_index a, cell_index b) { return a.value < b.value; };
            std::sort(c.shards_of_site.begin() + first, c.shards_of_site.end(), less);
            c.shards_of_site.erase(std::unique(c.shards_of_site.begin() + first, c.shards_of_site.end()), c.shards_of_site.end());
        }
        c.site_begin.push_back(c.shards_of_site.size());
    }
}

/// Renumbers vertices by what is used and moves everything into the caller's frame, where the origin of `frame`
/// is the lattice point (margin, margin, margin). `interior` is used up. O(n).
template <class Executor>
void assemble_complex(polygon_set& interior, shard_split& split, vertex_places const& places, solid const& body,
                      patch_map const& patches, double margin, Executor const& threads, shard_complex& out) {
    lattice_frame const& frame = places.diagram.frame;
    auto const to_user = [&](vec3 const& p) { return frame.to_user(vec3{p[0] - margin, p[1] - margin, p[2] - margin}); };
    surface_pieces const& pieces = places.pieces;
    std::size_t const inside = interior.front.size();
    std::size_t const skin = pieces.cell.size();
    out.interior_face_count = inside;
    out.faces.resize(inside + skin);
    out.cell_begin.assign(split.volumes.size() + 1, 0);
    threads.for_blocks(split.face_begin.size() - 1, 1024, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t> sorted;
        std::vector<std::size_t> next;
        for (std::size_t i = begin; i < end; ++i) {
            std::size_t const first = split.face_begin[i];
            std::size_t const last = split.face_begin[i + 1];
            std::uint32_t const shard = split.shard_begin[i];
            std::uint32_t const count = split.shard_begin[i + 1] - shard;
            for (std::size_t e = first; e < last; ++e) {
                std::uint32_t const f = split.faces[e];
                cell_index const owner{shard + split.label[e]};
                if (f >= inside || interior.front[f] == i) out.faces[f].front = owner;
                if (f < inside && interior.back[f] == i) out.faces[f].back = owner;
            }
            if (count == 1) out.cell_begin[shard + 1] = last;
            if (count < 2) continue;
            // The list around the cell becomes those of its shards, one after the other.
            next.assign(count + 1, first);
            for (std::size_t e = first; e < last; ++e) ++next[split.label[e] + 1];
            for (std::uint32_t k = 0; k < count; ++k) {
                next[k + 1] += next[k] - first;
                out.cell_begin[shard + k + 1] = next[k + 1];
            }
            sorted.resize(last - first);
            for (std::size_t e = first; e < last; ++e) sorted[next[split.label[e]]++ - first] = split.faces[e];
            std::copy(sorted.begin(), sorted.end(), split.faces.begin() + static_cast<std::ptrdiff_t>(first));
        }
    });
    out.cell_faces = std::move(split.faces);
    out.skin_sources = pieces.triangle_of;
    out.skin_patches.resize(skin);
    for (std::size_t p = 0; p < skin; ++p) out.skin_patches[p] = patches.of[body.polygon_of[pieces.triangle_of[p]]];

    std::vector<std::uint32_t> number(places.numbers.end, 0);
    auto const mark = [&](std::vector<std::uint32_t> const& corners) {
        threads.for_blocks(corners.size(), 1 << 15, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                std::atomic_ref<std::uint32_t>(number[corners[k]]).store(1, std::memory_order_relaxed);
            }
        });
    };
    mark(interior.corners);
    mark(pieces.corners);
    std::uint32_t used = 0;
    for (std::uint32_t& n : number) {
        if (n != 0) n = used++;
        else n = no_id;
    }
    out.vertices.resize(used);
    threads.for_blocks(number.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            if (number[n] == no_id) continue;
            bool const given = n >= places.numbers.solid && n < places.numbers.edge;
            out.vertices[number[n]] = given ? body.positions[n - places.numbers.solid]
                                            : to_user(places(static_cast<std::uint32_t>(n)));
        }
    });
    out.corners.resize(interior.corners.size() + pieces.corners.size());
    out.loop_begin = std::move(interior.loop_begin);
    out.face_begin = std::move(interior.face_begin);
    std::size_t const first = interior.corners.size();
    threads.for_blocks(out.corners.size(), 1 << 15, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            out.corners[k] = vertex_index{number[k < first ? interior.corners[k] : pieces.corners[k - first]]};
        }
    });
    out.loop_begin.reserve(out.loop_begin.size() + skin);
    out.face_begin.reserve(out.face_begin.size() + skin);
    for (std::size_t p = 0; p < skin; ++p) {
        out.loop_begin.push_back(first + pieces.corner_begin[p + 1]);
        out.face_begin.push_back(static_cast<std::uint32_t>(out.loop_begin.size() - 1));
    }

    std::size_t const shards = split.volumes.size();
    out.volumes = std::move(split.volumes);
    out.centroids = std::move(split.centroids);
    out.site_of.resize(shards);
    for (std::size_t i = 0; i + 1 < split.shard_begin.size(); ++i) {
        for (std::uint32_t k = split.shard_begin[i]; k < split.shard_begin[i + 1]; ++k) {
            out.site_of[k] = site_index{places.diagram.input_of[i]};
        }
    }
    for (double& v : out.volumes) v = frame.to_user_volume(v);
    for (vec3& c : out.centroids) c = to_user(c);
    out.polygon_of = body.polygon_of;
    out.patch_count = patches.count;
    out.size = body.bounds.diagonal();
    interior = polygon_set{};
}

}  // namespace tafoni::detail

#endif
