/// \file
/// Which faces around a cell belong together: the connected pieces of the cell in the solid.
#ifndef TAFONI_DECOMPOSITION_DETAIL_SHARD_SPLIT_HPP
#define TAFONI_DECOMPOSITION_DETAIL_SHARD_SPLIT_HPP

#include <tafoni/decomposition/detail/face_assembly.hpp>
#include <tafoni/decomposition/detail/loop_measure.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// The shards of every cell. Face f < interior count is an interior face, the rest are pieces of the skin.
struct shard_split {
    std::vector<std::size_t> face_begin{0};    ///< cell -> first entry of `faces`
    std::vector<std::uint32_t> faces{};        ///< around each cell, ascending
    std::vector<std::uint32_t> label{};        ///< per entry: which shard of the cell, from 0
    std::vector<std::uint32_t> shard_begin{};  ///< cell -> first shard
    std::vector<double> volumes{};             ///< per shard, lattice units
    std::vector<vec3> centroids{};             ///< per shard, lattice units
};

/// Splits one cell after the other; one object per thread.
class cell_splitter {
public:
    cell_splitter(polygon_set const& interior, vertex_places const& places) : interior_(interior), places_(places) {}

    /// Sets the labels of the faces around cell i, appends its shards, and returns how many there are.
    /// O(corners) for a cell that the surface does not touch, O(n log n) else.
    std::uint32_t operator()(std::uint32_t i, std::span<std::uint32_t const> faces, std::span<std::uint32_t> label,
                             std::vector<double>& volumes, std::vector<vec3>& centroids) {
        if (faces.empty()) return 0;
        cell_ = i;
        faces_ = faces;
        apex_ = lattice_frame::to_double(places_.diagram.sites[i]);
        bool const touched = faces.back() >= interior_.front.size();
        std::uint32_t count = 1;
        if (touched) {
            count = join_over_edges(label);
        } else {
            std::fill(label.begin(), label.end(), 0U);
        }
        sums_.assign(count, {});
        for (std::size_t x = 0; x < faces.size(); ++x) {
            for_loops(faces[x], [&](std::span<std::uint32_t const> loop, double sign) {
                sums_[label[x]].add(loop, places_, apex_, sign);
            });
        }
        if (count > 1) count = place_cavities(label, count);
        for (cone_sum const& s : sums_) {
            volumes.push_back(s.six_volumes / 6);
            double const scale = s.six_volumes != 0 ? 0.25 / s.six_volumes : 0;
            centroids.push_back(vec3{apex_[0] + s.moment[0] * scale, apex_[1] + s.moment[1] * scale,
                                     apex_[2] + s.moment[2] * scale});
        }
        return count;
    }

private:
    /// Calls f(loop, sign): the loops of a face, and 1 when they turn counter-clockwise seen from outside the cell.
    template <class F>
    void for_loops(std::uint32_t face, F const& f) const {
        std::size_t const interior = interior_.front.size();
        if (face >= interior) {
            surface_pieces const& p = places_.pieces;
            std::size_t const piece = face - interior;
            f(std::span{p.corners.data() + p.corner_begin[piece], p.corners.data() + p.corner_begin[piece + 1]}, 1.0);
            return;
        }
        double const sign = interior_.front[face] == cell_ ? 1.0 : -1.0;
        for (std::uint32_t l = interior_.face_begin[face]; l < interior_.face_begin[face + 1]; ++l) {
            f(std::span{interior_.corners.data() + interior_.loop_begin[l],
                        interior_.corners.data() + interior_.loop_begin[l + 1]},
              sign);
        }
    }

    /// Faces that share an edge belong to one closed surface. Labels count from 0 in order of the faces.
    std::uint32_t join_over_edges(std::span<std::uint32_t> label) {
        edges_.clear();
        parent_.resize(faces_.size());
        for (std::uint32_t x = 0; x < faces_.size(); ++x) {
            parent_[x] = x;
            for_loops(faces_[x], [&](std::span<std::uint32_t const> loop, double) {
                std::uint32_t a = loop.back();
                for (std::uint32_t b : loop) {
                    edges_.push_back({a < b ? a : b, a < b ? b : a, x});
                    a = b;
                }
            });
        }
        std::sort(edges_.begin(), edges_.end(), [](shared_edge const& p, shared_edge const& q) {
            if (p.low != q.low) return p.low < q.low;
            if (p.high != q.high) return p.high < q.high;
            return p.face < q.face;
        });
        for (std::size_t e = 1; e < edges_.size(); ++e) {
            if (edges_[e].low == edges_[e - 1].low && edges_[e].high == edges_[e - 1].high) {
                std::uint32_t const p = root(edges_[e - 1].face);
                std::uint32_t const q = root(edges_[e].face);
                parent_[p < q ? q : p] = p < q ? p : q;
            }
        }
        std::uint32_t count = 0;
        for (std::uint32_t x = 0; x < faces_.size(); ++x) {
            std::uint32_t const r = root(x);
            label[x] = r == x ? count++ : label[r];
        }
        return count;
    }

    [[nodiscard]] std::uint32_t root(std::uint32_t x) noexcept {
        while (parent_[x] != x) {
            parent_[x] = parent_[parent_[x]];
            x = parent_[x];
        }
        return x;
    }

    /// The box and one corner of every piece, and its faces one behind the other.
    void find_boxes(std::span<std::uint32_t const> label, std::uint32_t count) {
        boxes_.assign(count, box3{});
        corner_.resize(count);
        piece_begin_.assign(count + 1, 0);
        for (std::uint32_t l : label) ++piece_begin_[l + 1];
        for (std::uint32_t c = 0; c < count; ++c) piece_begin_[c + 1] += piece_begin_[c];
        piece_faces_.resize(faces_.size());
        std::vector<std::size_t> next(piece_begin_.begin(), piece_begin_.end() - 1);
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            piece_faces_[next[label[f]]++] = faces_[f];
            for_loops(faces_[f], [&](std::span<std::uint32_t const> loop, double) {
                for (std::uint32_t v : loop) boxes_[label[f]].include(places_(v));
                corner_[label[f]] = places_(loop[0]);
            });
        }
    }

    /// Does the surface of a piece wrap around x?
    [[nodiscard]] bool wraps(std::uint32_t piece, vec3 const& x) const {
        int winding = 0;
        for (std::size_t f = piece_begin_[piece]; f < piece_begin_[piece + 1]; ++f) {
            for_loops(piece_faces_[f], [&](std::span<std::uint32_t const> loop, double sign) {
                winding += sign > 0 ? winding_above(loop, places_, x) : -winding_above(loop, places_, x);
            });
        }
        return winding != 0;
    }

    /// A closed surface of negative volume bounds a cavity of the smallest piece around it. Without one
    /// (where the solid's surface cuts itself) it goes to the largest piece of the cell.
    std::uint32_t place_cavities(std::span<std::uint32_t> label, std::uint32_t count) {
        owner_.resize(count);
        std::uint32_t largest = 0;
        std::size_t solids = 0;
        std::size_t cavities = 0;
        for (std::uint32_t c = 0; c < count; ++c) {
            owner_[c] = c;
            if (sums_[c].six_volumes > sums_[largest].six_volumes) largest = c;
            ++(sums_[c].six_volumes < 0 ? cavities : solids);
        }
        if (cavities == 0 || !(sums_[largest].six_volumes > 0)) return count;
        if (solids > 1) find_boxes(label, count);
        for (std::uint32_t c = 0; c < count; ++c) {
            if (sums_[c].six_volumes >= 0) continue;
            std::uint32_t best = solids > 1 ? count : largest;
            for (std::uint32_t o = 0; o < count && solids > 1; ++o) {
                if (!(sums_[o].six_volumes > 0) || !boxes_[o].contains(corner_[c])) continue;
                if (best != count && sums_[o].six_volumes >= sums_[best].six_volumes) continue;
                if (wraps(o, corner_[c])) best = o;
            }
            owner_[c] = best == count ? largest : best;
        }
        std::uint32_t kept = 0;
        for (std::uint32_t c = 0; c < count; ++c) {
            if (owner_[c] != c) sums_[owner_[c]].add(sums_[c]);
        }
        renumbered_.resize(count);
        for (std::uint32_t c = 0; c < count; ++c) {
            if (owner_[c] != c) continue;
            sums_[kept] = sums_[c];
            renumbered_[c] = kept++;
        }
        sums_.resize(kept);
        for (std::uint32_t& l : label) l = renumbered_[owner_[l]];
        return kept;
    }

    struct shared_edge {
        std::uint32_t low;
        std::uint32_t high;
        std::uint32_t face;
    };

    polygon_set const& interior_;
    vertex_places const& places_;
    std::uint32_t cell_ = 0;
    std::span<std::uint32_t const> faces_{};
    vec3 apex_{0, 0, 0};
    std::vector<shared_edge> edges_{};
    std::vector<std::uint32_t> parent_{};
    std::vector<cone_sum> sums_{};
    std::vector<std::uint32_t> owner_{};
    std::vector<std::uint32_t> renumbered_{};
    std::vector<box3> boxes_{};
    std::vector<vec3> corner_{};
    std::vector<std::size_t> piece_begin_{};
    std::vector<std::uint32_t> piece_faces_{};
};

/// Splits all cells. O(corners), with n log n in the cells that the surface touches.
template <class Executor>
[[nodiscard]] shard_split split_cells(polygon_set const& interior, vertex_places const& places, Executor const& threads) {
    std::size_t const cells = places.diagram.sites.size();
    std::size_t const inside = interior.front.size();
    surface_pieces const& pieces = places.pieces;
    require_indexable("voronoi_shards", inside + pieces.cell.size());
    shard_split s;
    s.face_begin.assign(cells + 1, 0);
    for (std::uint32_t c : interior.front) ++s.face_begin[c + 1];
    for (std::uint32_t c : interior.back) ++s.face_begin[c + 1];
    for (std::uint32_t c : pieces.cell) ++s.face_begin[c + 1];
    for (std::size_t c = 0; c < cells; ++c) s.face_begin[c + 1] += s.face_begin[c];
    s.faces.resize(s.face_begin[cells]);
    s.label.resize(s.face_begin[cells]);
    {
        std::vector<std::size_t> next(s.face_begin.begin(), s.face_begin.end() - 1);
        for (std::uint32_t f = 0; f < inside; ++f) {
            s.faces[next[interior.front[f]]++] = f;
            s.faces[next[interior.back[f]]++] = f;
        }
        for (std::size_t p = 0; p < pieces.cell.size(); ++p) {
            s.faces[next[pieces.cell[p]]++] = static_cast<std::uint32_t>(inside + p);
        }
    }
    struct block {
        std::vector<double> volumes;
        std::vector<vec3> centroids;
    };
    s.shard_begin.assign(cells + 1, 0);
    auto blocks = collect_blocks<block>(cells, 256, threads, [&](std::size_t begin, std::size_t end, block& out) {
        cell_splitter split(interior, places);
        for (std::size_t i = begin; i < end; ++i) {
            std::size_t const first = s.face_begin[i];
            std::size_t const size = s.face_begin[i + 1] - first;
            s.shard_begin[i + 1] = split(static_cast<std::uint32_t>(i), {s.faces.data() + first, size},
                                         {s.label.data() + first, size}, out.volumes, out.centroids);
        }
    });
    for (std::size_t i = 0; i < cells; ++i) s.shard_begin[i + 1] += s.shard_begin[i];
    for (block& b : blocks) {
        append_and_free(s.volumes, b.volumes);
        append_and_free(s.centroids, b.centroids);
    }
    return s;
}

}  // namespace tafoni::detail

#endif
