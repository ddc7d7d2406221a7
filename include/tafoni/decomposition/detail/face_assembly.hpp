/// \file
/// The faces between cells, cut back to what lies in the solid.
#ifndef TAFONI_DECOMPOSITION_DETAIL_FACE_ASSEMBLY_HPP
#define TAFONI_DECOMPOSITION_DETAIL_FACE_ASSEMBLY_HPP

#include <tafoni/decomposition/detail/diagram_winding.hpp>
#include <tafoni/decomposition/detail/loop_linker.hpp>
#include <tafoni/decomposition/detail/loop_measure.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// Positions by vertex number, lattice units.
struct vertex_places {
    voronoi_diagram const& diagram;
    std::vector<ivec3> const& points;
    surface_walk const& walk;
    surface_pieces const& pieces;
    vertex_numbers numbers;

    [[nodiscard]] vec3 operator()(std::uint32_t v) const noexcept {
        if (v < numbers.solid) return diagram.vertices[v];
        if (v < numbers.edge) return lattice_frame::to_double(points[v - numbers.solid]);
        if (v < numbers.triangle) return walk.points[v - numbers.edge];
        return pieces.points[v - numbers.triangle];
    }
};

/// Polygons with holes; front and back are cells of the diagram, front < back.
struct polygon_set {
    std::vector<std::uint32_t> front{};
    std::vector<std::uint32_t> back{};
    std::vector<std::uint32_t> face_begin{0};  ///< face -> first loop
    std::vector<std::size_t> loop_begin{0};    ///< loop -> first corner
    std::vector<std::uint32_t> corners{};      ///< vertex numbers, counter-clockwise seen from outside `front`

    void close_loop() { loop_begin.push_back(corners.size()); }
    void close_face(std::uint32_t i, std::uint32_t j) {
        front.push_back(i);
        back.push_back(j);
        face_begin.push_back(static_cast<std::uint32_t>(loop_begin.size() - 1));
    }
};

/// A directed edge that a triangle cuts into a face of the diagram.
struct face_cut {
    std::uint32_t face;
    linked_edge edge;
    friend bool operator<(face_cut const& x, face_cut const& y) noexcept {
        if (x.face != y.face) return x.face < y.face;
        if (x.edge.from != y.edge.from) return x.edge.from < y.edge.from;
        return x.edge.to < y.edge.to;
    }
};

/// All cuts, by face, each taken from the piece in the lower of the two cells. O(cuts log cuts).
template <class Executor>
[[nodiscard]] std::vector<face_cut> find_cuts(voronoi_diagram const& d, surface_pieces const& pieces, Executor const& threads) {
    auto blocks = collect_blocks<std::vector<face_cut>>(
        pieces.cell.size(), 4096, threads, [&](std::size_t begin, std::size_t end, std::vector<face_cut>& cuts) {
            for (std::size_t p = begin; p < end; ++p) {
                std::uint32_t const first = pieces.corner_begin[p];
                std::uint32_t const last = pieces.corner_begin[p + 1];
                for (std::uint32_t c = first; c < last; ++c) {
                    std::uint32_t const f = pieces.edges[c];
                    if ((f & surface_pieces::side_bit) != 0 || d.neighbour[f] < pieces.cell[p]) continue;
                    // The face closes the piece's cell: it runs past the piece in the other direction.
                    cuts.push_back({f, {pieces.corners[c + 1 == last ? first : c + 1], pieces.corners[c]}});
                }
            }
        });
    return sorted_blocks(blocks, threads, [](face_cut const& x, face_cut const& y) { return x < y; });
}

/// Assembles one face of the diagram after the other; one object per thread.
class face_assembler {
public:
    face_assembler(voronoi_diagram const& d, diagram_winding const& winding, vertex_places const& places)
        : diagram_(d), winding_(winding), places_(places) {}

    /// Appends the parts of face f, between cells i < j, that lie in the solid. Linear in the corners
    /// but for n log n where triangles cut the face.
    void operator()(std::uint32_t f, std::uint32_t i, std::uint32_t j, std::span<face_cut const> cuts,
                    polygon_set& out) {
        std::uint32_t const first = diagram_.corner_begin[f];
        std::uint32_t const last = diagram_.corner_begin[f + 1];
        if (cuts.empty()) {
            whole(first, last, i, j, out);
            return;
        }
        linker_.clear();
        std::uint32_t a = diagram_.corners[last - 1];
        for (std::uint32_t c = first; c < last; ++c) {
            std::uint32_t const b = diagram_.corners[c];
            add_side(a, b);
            a = b;
        }
        for (face_cut const& c : cuts) linker_.add(c.edge);
        linker_.link();
        emit(i, j, out);
    }

private:
    /// No triangle cuts the face: all of it lies in the solid as often as its corners do.
    void whole(std::uint32_t first, std::uint32_t last, std::uint32_t i, std::uint32_t j, polygon_set& out) const {
        std::int32_t const w = winding_.of[diagram_.corners[first]];
        for (std::int32_t copy = 0; copy < (w < 0 ? -w : w); ++copy) {
            if (w > 0) {
                out.corners.insert(out.corners.end(), diagram_.corners.begin() + first, diagram_.corners.begin() + last);
            } else {
                for (std::uint32_t c = last; c > first; --c) out.corners.push_back(diagram_.corners[c - 1]);
            }
            out.close_loop();
            out.close_face(i, j);
        }
    }

    /// The parts of the side a b that lie in the solid, as often as they do, backwards when less than never.
    void add_side(std::uint32_t a, std::uint32_t b) {
        std::int32_t w = winding_.of[a];
        std::uint32_t const slot = changing_slot(diagram_.keys[a], diagram_.keys[b]);
        std::uint32_t from = a;
        if ((winding_.crossed[a] >> slot & 1) != 0) {
            bool const forward = a < b;
            std::uint64_t const edge =
                forward ? std::uint64_t{a} * 4 + slot
                        : std::uint64_t{b} * 4 + changing_slot(diagram_.keys[b], diagram_.keys[a]);
            auto const crossings = winding_.on_edge(edge);
            for (std::size_t k = 0; k < crossings.size(); ++k) {
                edge_crossing const& c = crossings[forward ? k : crossings.size() - 1 - k];
                linker_.add({from, c.number}, w);
                w += forward ? c.step : -c.step;
                from = c.number;
            }
        }
        TAFONI_ASSERT(w == winding_.of[b], "winding numbers agree along every edge");
        linker_.add({from, b}, w);
    }

    void emit(std::uint32_t i, std::uint32_t j, polygon_set& out) {
        vec3 const n = difference(diagram_.sites[j], diagram_.sites[i]);
        std::size_t const loops = linker_.loop_count();
        area_.resize(loops);
        outlines_.clear();
        for (std::size_t l = 0; l < loops; ++l) {
            area_[l] = dot(doubled_area(linker_.loop(l), places_), n);
            if (area_[l] >= 0) outlines_.push_back(l);
        }
        find_owners(n);
        // Loops by owner: an outline, then its holes, each in their order.
        first_hole_.assign(loops + 1, loops);
        next_hole_.resize(loops);
        for (std::size_t l = loops; l-- > 0;) {
            if (owner_[l] == loops) continue;
            next_hole_[l] = first_hole_[owner_[l]];
            first_hole_[owner_[l]] = l;
        }
        for (std::size_t l = 0; l < loops; ++l) {
            if (owner_[l] != loops) continue;
            append(linker_.loop(l), out);
            for (std::size_t h = first_hole_[l]; h != loops; h = next_hole_[h]) append(linker_.loop(h), out);
            out.close_face(i, j);
        }
    }

    /// A hole goes into the smallest outline around it. One without an outline belongs to a surface
    /// that cuts itself and stands alone, as a face of negative area. O(n log n) for one outline or no
    /// holes, else a sweep: every hole looks at the outlines that share its place along one axis.
    void find_owners(vec3 const& n) {
        std::size_t const loops = linker_.loop_count();
        owner_.assign(loops, loops);
        if (outlines_.empty() || outlines_.size() == loops) return;
        if (outlines_.size() == 1) {
            for (std::size_t l = 0; l < loops; ++l) owner_[l] = l == outlines_[0] ? loops : outlines_[0];
            return;
        }
        int drop = 2;
        if (std::fabs(n[1]) > std::fabs(n[drop])) drop = 1;
        if (std::fabs(n[0]) > std::fabs(n[drop])) drop = 0;
        int const u = (drop + 1) % 3;
        int const v = (drop + 2) % 3;
        range_.resize(loops);
        order_.clear();
        for (std::size_t l = 0; l < loops; ++l) {
            vec3 const p = places_(linker_.loop(l)[0]);
            range_[l] = {p[v], p[v], p[u], p[u]};
            order_.push_back(l);
            if (area_[l] < 0) continue;
            for (std::uint32_t number : linker_.loop(l)) {
                vec3 const q = places_(number);
                range_[l] = {std::min(range_[l][0], q[v]), std::max(range_[l][1], q[v]), std::min(range_[l][2], q[u]),
                             std::max(range_[l][3], q[u])};
            }
        }
        std::sort(order_.begin(), order_.end(), [this](std::size_t x, std::size_t y) {
            if (range_[x][0] != range_[y][0]) return range_[x][0] < range_[y][0];
            bool const hole = area_[x] < 0;
            return hole != (area_[y] < 0) ? !hole : x < y;
        });
        open_.clear();
        for (std::size_t l : order_) {
            if (area_[l] >= 0) {
                open_.push_back(l);
                continue;
            }
            std::size_t kept = 0;
            for (std::size_t o : open_) {
                if (range_[o][1] < range_[l][0]) continue;
                open_[kept++] = o;
                if (range_[l][2] < range_[o][2] || range_[l][2] > range_[o][3]) continue;
                std::size_t const best = owner_[l];
                if (best != loops && (area_[o] != area_[best] ? area_[o] > area_[best] : o > best)) continue;
                if (surrounds(linker_.loop(o), places_(linker_.loop(l)[0]), u, v)) owner_[l] = o;
            }
            open_.resize(kept);
        }
    }

    static void append(std::span<std::uint32_t const> loop, polygon_set& out) {
        out.corners.insert(out.corners.end(), loop.begin(), loop.end());
        out.close_loop();
    }

    /// Crossing number in the plane of the axes u and v.
    [[nodiscard]] bool surrounds(std::span<std::uint32_t const> loop, vec3 const& x, int u, int v) const {
        bool inside = false;
        vec3 a = places_(loop[loop.size() - 1]);
        for (std::uint32_t number : loop) {
            vec3 const b = places_(number);
            if ((a[v] > x[v]) != (b[v] > x[v])) {
                double const at = a[u] + (x[v] - a[v]) / (b[v] - a[v]) * (b[u] - a[u]);
                if (at > x[u]) inside = !inside;
            }
            a = b;
        }
        return inside;
    }

    voronoi_diagram const& diagram_;
    diagram_winding const& winding_;
    vertex_places const& places_;
    loop_linker linker_{};
    std::vector<double> area_{};
    std::vector<std::size_t> outlines_{};
    std::vector<std::size_t> owner_{};
    std::vector<std::size_t> first_hole_{};
    std::vector<std::size_t> next_hole_{};
    std::vector<std::array<double, 4>> range_{};  // of an outline or of a hole's first corner: along v, along u
    std::vector<std::size_t> order_{};
    std::vector<std::size_t> open_{};
};

/// All faces between cells, by the lower cell. O(corners of the diagram + cuts log cuts).
template <class Executor>
[[nodiscard]] polygon_set assemble_faces(voronoi_diagram const& d, diagram_winding const& winding,
                                         vertex_places const& places, Executor const& threads) {
    auto const cuts = find_cuts(d, places.pieces, threads);
    std::uint32_t const sites = static_cast<std::uint32_t>(d.sites.size());
    auto blocks = collect_blocks<polygon_set>(sites, 512, threads, [&](std::size_t begin, std::size_t end, polygon_set& out) {
        face_assembler assemble(d, winding, places);
        auto cut = std::lower_bound(cuts.begin(), cuts.end(), d.face_begin[begin],
                                    [](face_cut const& c, std::uint32_t f) { return c.face < f; });
        for (std::uint32_t i = static_cast<std::uint32_t>(begin); i < end; ++i) {
            for (std::uint32_t f = d.face_begin[i]; f < d.face_begin[i + 1]; ++f) {
                std::uint32_t const j = d.neighbour[f];
                auto const first = cut;
                while (cut != cuts.end() && cut->face == f) ++cut;
                if (j > i && j < sites) assemble(f, i, j, {first, cut}, out);
            }
        }
    });
    polygon_set all;
    std::vector<std::uint32_t> first_loop(blocks.size(), 0);
    std::vector<std::size_t> first_corner(blocks.size(), 0);
    std::size_t loops = 0;
    std::size_t corners = 0;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        first_loop[b] = static_cast<std::uint32_t>(loops);
        first_corner[b] = corners;
        loops += blocks[b].loop_begin.size() - 1;
        corners += blocks[b].corners.size();
        blocks[b].face_begin.erase(blocks[b].face_begin.begin());
        blocks[b].loop_begin.erase(blocks[b].loop_begin.begin());
    }
    require_indexable("voronoi_shards", loops + places.pieces.cell.size());
    auto const as_is = [](std::uint32_t x, std::size_t) { return x; };
    gather_blocks(blocks, [](polygon_set& b) -> auto& { return b.front; }, all.front, threads, as_is);
    gather_blocks(blocks, [](polygon_set& b) -> auto& { return b.back; }, all.back, threads, as_is);
    gather_blocks(blocks, [](polygon_set& b) -> auto& { return b.corners; }, all.corners, threads, as_is);
    gather_blocks(blocks, [](polygon_set& b) -> auto& { return b.face_begin; }, all.face_begin, threads,
                  [&](std::uint32_t l, std::size_t b) { return l + first_loop[b]; });
    gather_blocks(blocks, [](polygon_set& b) -> auto& { return b.loop_begin; }, all.loop_begin, threads,
                  [&](std::size_t c, std::size_t b) { return c + first_corner[b]; });
    return all;
}

}  // namespace tafoni::detail

#endif
