/// \file
/// How often the surface of a solid wraps around each vertex of the diagram.
#ifndef TAFONI_DECOMPOSITION_DETAIL_DIAGRAM_WINDING_HPP
#define TAFONI_DECOMPOSITION_DETAIL_DIAGRAM_WINDING_HPP

#include <tafoni/decomposition/detail/surface_clip.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// A point where the surface crosses an edge of the diagram.
struct edge_crossing {
    std::uint64_t edge;     ///< 4 a + slot: the edge of vertex a < b along which the id in that slot of a's key changes
    double along;           ///< grows from a to b
    std::uint32_t number;   ///< of the vertex in the complex
    std::int32_t step;      ///< the winding number behind the point, going from a to b, minus that before it
};

/// Winding numbers of the diagram's vertices, and the crossings that separate them.
struct diagram_winding {
    std::vector<std::int32_t> of{};           ///< vertex -> winding number; 1 inside, 0 outside
    std::vector<std::uint8_t> crossed{};      ///< vertex -> bit s: the edge in slot s is crossed
    std::vector<edge_crossing> crossings{};   ///< by edge, in order along it

    [[nodiscard]] std::span<edge_crossing const> on_edge(std::uint64_t edge) const noexcept {
        auto const first = std::lower_bound(crossings.begin(), crossings.end(), edge,
                                            [](edge_crossing const& c, std::uint64_t e) { return c.edge < e; });
        auto last = first;
        while (last != crossings.end() && last->edge == edge) ++last;
        return {first, last};
    }
};

/// The slot of a's key whose id b does not have; a and b are the ends of an edge.
[[nodiscard]] inline std::uint32_t changing_slot(std::array<std::uint32_t, 4> const& a,
                                                 std::array<std::uint32_t, 4> const& b) noexcept {
    std::uint32_t y = 0;
    for (std::uint32_t x = 0; x < 4; ++x) {
        while (y < 4 && b[y] < a[x]) ++y;
        if (y == 4 || b[y] != a[x]) return x;
    }
    TAFONI_ASSERT(false, "two vertices of the diagram never have the same four sites");
    return 3;
}

[[nodiscard]] inline bool has_id(std::array<std::uint32_t, 4> const& key, std::uint32_t id) noexcept {
    return key[0] == id || key[1] == id || key[2] == id || key[3] == id;
}

/// Finds the crossings from the corners at which two bisectors meet in a piece. O(pieces).
///
/// At such a corner the piece runs in on the bisector with k and out on that with l. It turns left
/// there, so along n_k x n_l, the direction in which face (i, k) runs past l, the line leaves the solid.
template <class Executor>
[[nodiscard]] std::vector<edge_crossing> find_crossings(voronoi_diagram const& d, surface_pieces const& pieces,
                                                        vertex_numbers const& numbers, Executor const& threads) {
    auto blocks = collect_blocks<std::vector<edge_crossing>>(
        pieces.cell.size(), 4096, threads, [&](std::size_t begin, std::size_t end, std::vector<edge_crossing>& out) {
            for (std::size_t p = begin; p < end; ++p) {
                std::uint32_t const i = pieces.cell[p];
                std::uint32_t const first = pieces.corner_begin[p];
                std::uint32_t const last = pieces.corner_begin[p + 1];
                for (std::uint32_t c = first; c < last; ++c) {
                    if (pieces.corners[c] < numbers.triangle) continue;
                    std::uint32_t const in = pieces.edges[c == first ? last - 1 : c - 1];
                    std::uint32_t const l = d.neighbour[pieces.edges[c]];
                    if (d.neighbour[in] < i || l < i) continue;  // seen from the lowest of the three cells only
                    std::uint32_t at = d.corner_begin[in];
                    std::uint32_t const stop = d.corner_begin[in + 1];
                    std::uint32_t a = d.corners[stop - 1];
                    std::uint32_t b = d.corners[at];
                    while (at < stop && !(has_id(d.keys[a], l) && has_id(d.keys[b], l))) {
                        a = b;
                        if (++at < stop) b = d.corners[at];
                    }
                    TAFONI_ASSERT(at < stop, "the edge that a triangle crosses belongs to the diagram");
                    bool const forward = a < b;
                    if (!forward) std::swap(a, b);
                    vec3 const x = pieces.points[pieces.corners[c] - numbers.triangle];
                    vec3 const& pa = d.vertices[a];
                    vec3 const& pb = d.vertices[b];
                    double const along = dot(vec3{x[0] - pa[0], x[1] - pa[1], x[2] - pa[2]},
                                             vec3{pb[0] - pa[0], pb[1] - pa[1], pb[2] - pa[2]});
                    out.push_back({std::uint64_t{a} * 4 + changing_slot(d.keys[a], d.keys[b]), along,
                                   pieces.corners[c], forward ? -1 : 1});
                }
            }
        });
    return sorted_blocks(blocks, threads, [](edge_crossing const& x, edge_crossing const& y) {
        if (x.edge != y.edge) return x.edge < y.edge;
        if (x.along != y.along) return x.along < y.along;
        return x.number < y.number;
    });
}

/// For every vertex the vertex at the other end of the edge in each slot; none where three walls would meet. O(corners of the diagram).
template <class Executor>
[[nodiscard]] std::vector<std::array<std::uint32_t, 4>> edge_ends(voronoi_diagram const& d, Executor const& threads) {
    std::vector<std::array<std::uint32_t, 4>> ends(d.vertices.size(), {no_id, no_id, no_id, no_id});
    threads.for_blocks(d.sites.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::uint32_t i = static_cast<std::uint32_t>(begin); i < end; ++i) {
            for (std::uint32_t f = d.face_begin[i]; f < d.face_begin[i + 1]; ++f) {
                std::uint32_t const j = d.neighbour[f];
                if (j < i) continue;
                std::uint32_t a = d.corners[d.corner_begin[f + 1] - 1];
                for (std::uint32_t c = d.corner_begin[f]; c < d.corner_begin[f + 1]; ++c) {
                    std::uint32_t const b = d.corners[c];
                    std::uint32_t const slot_a = changing_slot(d.keys[a], d.keys[b]);
                    // The third id of the edge: six cells and faces see it, the lowest two enter it.
                    std::uint32_t k = 0;
                    for (std::uint32_t s = 0; s < 4; ++s) {
                        if (s != slot_a && d.keys[a][s] != i && d.keys[a][s] != j) k = d.keys[a][s];
                    }
                    if (k > j) {
                        ends[a][slot_a] = b;
                        ends[b][changing_slot(d.keys[b], d.keys[a])] = a;
                    }
                    a = b;
                }
            }
        }
    });
    return ends;
}

/// Fills w.of from w.crossings and w.crossed. Each block of vertices is flooded on its own, relative to one vertex
/// of every part that hangs together in it; then one part after the other is set right across the edges
/// between blocks. O(vertices), the second step O(parts and pairs of parts that touch).
template <class Executor>
void flood(voronoi_diagram const& d, std::vector<std::array<std::uint32_t, 4>> const& ends, diagram_winding& w,
           Executor const& threads) {
    struct bridge {
        std::uint32_t from;  // vertices at first, then parts
        std::uint32_t to;
        std::int32_t step;
        bool operator<(bridge const& o) const noexcept { return from != o.from ? from < o.from : to < o.to; }
    };
    struct block {
        std::vector<bridge> bridges;
        std::uint32_t parts = 0;
    };
    constexpr std::size_t grain = 16384;
    std::size_t const vertices = d.vertices.size();
    auto const step_along = [&](std::uint32_t v, std::uint32_t s, std::uint32_t o) {
        std::int32_t step = 0;
        if ((w.crossed[v] >> s & 1) == 0) return step;
        bool const forward = v < o;
        std::uint64_t const edge = forward ? std::uint64_t{v} * 4 + s : std::uint64_t{o} * 4 + changing_slot(d.keys[o], d.keys[v]);
        for (edge_crossing const& c : w.on_edge(edge)) step += forward ? c.step : -c.step;
        return step;
    };
    w.of.assign(vertices, 0);
    std::vector<std::uint32_t> part_of(vertices, no_id);
    auto blocks = collect_blocks<block>(vertices, grain, threads, [&](std::size_t begin, std::size_t end, block& out) {
        std::vector<std::uint32_t> queue;
        for (std::uint32_t start = static_cast<std::uint32_t>(begin); start < end; ++start) {
            if (part_of[start] != no_id) continue;
            part_of[start] = out.parts;
            queue.push_back(start);
            while (!queue.empty()) {
                std::uint32_t const v = queue.back();
                queue.pop_back();
                for (std::uint32_t s = 0; s < 4; ++s) {
                    std::uint32_t const o = ends[v][s];
                    if (o == no_id || o < begin) continue;
                    if (o >= end) {
                        out.bridges.push_back({v, o, w.of[v] + step_along(v, s, o)});
                    } else if (part_of[o] == no_id) {
                        part_of[o] = out.parts;
                        w.of[o] = w.of[v] + step_along(v, s, o);
                        queue.push_back(o);
                    }
                }
            }
            ++out.parts;
        }
    });
    std::vector<std::uint32_t> first_part(blocks.size() + 1, 0);
    for (std::size_t b = 0; b < blocks.size(); ++b) first_part[b + 1] = first_part[b] + blocks[b].parts;
    // From here on a bridge leads from part to part, and one of each kind is enough.
    threads.for_blocks(blocks.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            auto& bridges = blocks[b].bridges;
            for (bridge& x : bridges) {
                x.step -= w.of[x.to];
                x = {first_part[b] + part_of[x.from], first_part[x.to / grain] + part_of[x.to], x.step};
            }
            std::sort(bridges.begin(), bridges.end());
            auto const same = [](bridge const& x, bridge const& y) { return x.from == y.from && x.to == y.to; };
            bridges.erase(std::unique(bridges.begin(), bridges.end(), same), bridges.end());
        }
    });
    std::vector<bridge> both;
    for (block& b : blocks) {
        for (bridge const& x : b.bridges) {
            both.push_back(x);
            both.push_back({x.to, x.from, -x.step});
        }
    }
    std::sort(both.begin(), both.end());
    std::vector<std::int32_t> offset(first_part.back(), 0);
    std::vector<std::uint8_t> known(first_part.back(), 0);
    std::vector<std::uint32_t> queue;
    std::uint32_t const sites = static_cast<std::uint32_t>(d.sites.size());
    for (std::uint32_t v = 0; v < vertices && queue.empty(); ++v) {
        if (d.keys[v][3] < sites) continue;
        queue.push_back(first_part[v / grain] + part_of[v]);
        known[queue[0]] = 1;
        offset[queue[0]] = -w.of[v];
    }
    while (!queue.empty()) {
        std::uint32_t const p = queue.back();
        queue.pop_back();
        auto x = std::lower_bound(both.begin(), both.end(), bridge{p, 0, 0});
        for (; x != both.end() && x->from == p; ++x) {
            if (known[x->to] != 0) continue;
            known[x->to] = 1;
            offset[x->to] = offset[p] + x->step;
            queue.push_back(x->to);
        }
    }
    threads.for_blocks(vertices, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) w.of[v] += offset[first_part[v / grain] + part_of[v]];
    });
}

/// Winding numbers of all vertices: 0 on the walls, changed by crossings. O(vertices + crossings log crossings).
template <class Executor>
[[nodiscard]] diagram_winding wind_diagram(voronoi_diagram const& d, surface_pieces const& pieces,
                                           vertex_numbers const& numbers, Executor const& threads) {
    diagram_winding w;
    w.crossings = find_crossings(d, pieces, numbers, threads);
    auto const ends = edge_ends(d, threads);
    std::uint32_t const vertices = static_cast<std::uint32_t>(d.vertices.size());
    w.crossed.assign(vertices, 0);
    for (edge_crossing const& c : w.crossings) {
        std::uint32_t const a = static_cast<std::uint32_t>(c.edge >> 2);
        std::uint32_t const slot = static_cast<std::uint32_t>(c.edge & 3);
        std::uint32_t const b = ends[a][slot];
        w.crossed[a] = static_cast<std::uint8_t>(w.crossed[a] | 1U << slot);
        w.crossed[b] = static_cast<std::uint8_t>(w.crossed[b] | 1U << changing_slot(d.keys[b], d.keys[a]));
    }
    flood(d, ends, w, threads);
    return w;
}

}  // namespace tafoni::detail

#endif
