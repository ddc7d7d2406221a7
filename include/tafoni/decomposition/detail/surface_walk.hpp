/// \file
/// In which cell each vertex of a solid lies, and through which cells its edges run.
#ifndef TAFONI_DECOMPOSITION_DETAIL_SURFACE_WALK_HPP
#define TAFONI_DECOMPOSITION_DETAIL_SURFACE_WALK_HPP

#include <tafoni/decomposition/detail/bisector_row.hpp>
#include <tafoni/decomposition/detail/collect_blocks.hpp>
#include <tafoni/decomposition/detail/surface_signs.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tafoni::detail {

inline constexpr std::uint32_t no_id = 0xFFFFFFFFU;

/// The cells under the vertices and edges of a solid. An edge is named by the lower of its two half-edges.
struct surface_walk {
    /// Where an edge passes from one cell to the next.
    struct step {
        std::uint32_t from;
        std::uint32_t to;
    };

    std::vector<std::uint32_t> cell_of{};      ///< vertex -> cell; none for vertices without faces
    std::vector<std::uint32_t> step_begin{};   ///< half-edge -> first step; one past the last at the end
    std::vector<step> steps{};                 ///< by half-edge; of many steps sorted by their cells, else along it
    std::vector<vec3> points{};                ///< per step, lattice units

    /// So many steps are looked through one after the other.
    static constexpr std::size_t few = 16;

    /// Cells in ascending order: an edge passes between two of them once at most.
    [[nodiscard]] static std::pair<std::uint32_t, std::uint32_t> cells(step const& s) noexcept {
        return s.from < s.to ? std::pair{s.from, s.to} : std::pair{s.to, s.from};
    }

    /// The step of edge `h` between two cells, which must be there. O(log steps of the edge).
    [[nodiscard]] std::uint32_t step_between(std::size_t h, std::uint32_t a, std::uint32_t b) const noexcept {
        if (step_begin[h + 1] - step_begin[h] > few) {
            auto const at = std::lower_bound(steps.begin() + step_begin[h], steps.begin() + step_begin[h + 1], cells({a, b}),
                                             [](step const& s, auto const& key) { return cells(s) < key; });
            return static_cast<std::uint32_t>(at - steps.begin());
        }
        for (std::uint32_t s = step_begin[h]; s < step_begin[h + 1]; ++s) {
            if ((steps[s].from == a && steps[s].to == b) || (steps[s].from == b && steps[s].to == a)) return s;
        }
        TAFONI_ASSERT(false, "both triangles of an edge see the same cells along it");
        return no_id;
    }
};

/// Where segment a b meets the bisector of two sites; stays on the segment. Lattice units.
[[nodiscard]] inline vec3 point_on_edge(ivec3 const& si, ivec3 const& sk, ivec3 const& a, ivec3 const& b) noexcept {
    bisector_row const row(sk, si, a);
    vec3 const n = difference(sk, si);
    vec3 const d = difference(b, a);
    double const along = 2 * dot(n, d);
    double t = 0.5;
    if (std::fabs(along) > bisector_row::steep * (length(n) * length(d))) {
        t = (squared_length(n) - 2 * dot(n, difference(a, si))) / along;
    } else if (auto const exact = row.along(b, a); exact.sign() != 0) {
        t = to_double(row.offset()) / to_double(exact);
    }
    if (!(t > 0)) t = 0;
    if (t > 1) t = 1;
    vec3 const p = lattice_frame::to_double(a);
    return vec3{p[0] + t * d[0], p[1] + t * d[1], p[2] + t * d[2]};
}

/// Goes to the cell that holds point q, starting from cell c. O(cells on the way).
[[nodiscard]] inline std::uint32_t walk_to(surface_signs const& signs, std::uint32_t c, ivec3 const& q) {
    voronoi_diagram const& d = signs.diagram;
    std::uint32_t const n = static_cast<std::uint32_t>(d.sites.size());
    for (bool moved = true; moved;) {
        moved = false;
        for (std::uint32_t f = d.face_begin[c]; f < d.face_begin[c + 1]; ++f) {
            std::uint32_t const k = d.neighbour[f];
            if (k < n && signs.vertex_beyond(c, k, q)) {
                c = k;
                moved = true;
                break;
            }
        }
    }
    return c;
}

/// Appends the cells through which half-edge h runs, with the points between them.
inline void walk_edge(surface_signs const& signs, solid const& body, std::vector<std::uint32_t> const& cell_of,
                      std::size_t h, std::vector<surface_walk::step>& steps, std::vector<vec3>& points) {
    voronoi_diagram const& d = signs.diagram;
    std::uint32_t const n = static_cast<std::uint32_t>(d.sites.size());
    std::uint32_t const a = body.triangles[h / 3][h % 3];
    std::uint32_t const b = body.triangles[h / 3][(h % 3 + 1) % 3];
    ivec3 const& pa = signs.points[a];
    ivec3 const& pb = signs.points[b];
    std::uint32_t previous = no_id;
    std::size_t const first = steps.size();
    for (std::uint32_t c = cell_of[a]; c != cell_of[b];) {
        std::uint32_t next = no_id;
        for (std::uint32_t f = d.face_begin[c]; f < d.face_begin[c + 1]; ++f) {
            std::uint32_t const k = d.neighbour[f];
            if (k >= n || k == previous || !signs.vertex_beyond(c, k, pb)) continue;
            // The point on `next` lies beyond k: the edge meets k first.
            if (next == no_id || signs.edge_point_beyond(c, next, k, pa, pb)) next = k;
        }
        TAFONI_ASSERT(next != no_id, "an edge leaves every cell that does not hold its end");
        steps.push_back({c, next});
        previous = c;
        c = next;
    }
    if (steps.size() - first > surface_walk::few) {
        std::sort(steps.begin() + static_cast<std::ptrdiff_t>(first), steps.end(),
                  [](auto const& x, auto const& y) { return surface_walk::cells(x) < surface_walk::cells(y); });
    }
    for (std::size_t s = first; s < steps.size(); ++s) {
        auto const [low, high] = surface_walk::cells(steps[s]);
        points.push_back(point_on_edge(d.sites[low], d.sites[high], pa, pb));
    }
}

/// Locates all vertices and walks along all edges. O(vertices + edges + k log k) for k faces of cells met, exact.
template <class Executor>
[[nodiscard]] surface_walk walk_surface(surface_signs const& signs, solid const& body, Executor const& threads) {
    surface_walk walk;
    std::size_t const vertices = body.positions.size();
    std::size_t const half_edges = 3 * body.triangles.size();
    walk.cell_of.assign(vertices, no_id);
    for (auto const& t : body.triangles) {
        for (std::uint32_t v : t) walk.cell_of[v] = 0;
    }
    threads.for_blocks(vertices, 4096, [&](std::size_t begin, std::size_t end) {
        std::uint32_t c = 0;
        for (std::size_t v = begin; v < end; ++v) {
            if (walk.cell_of[v] == no_id) continue;
            c = walk_to(signs, c, signs.points[v]);
            walk.cell_of[v] = c;
        }
    });

    struct block {
        std::vector<surface_walk::step> steps;
        std::vector<vec3> points;
    };
    walk.step_begin.assign(half_edges + 1, 0);
    auto blocks = collect_blocks<block>(half_edges, 6144, threads, [&](std::size_t begin, std::size_t end, block& out) {
        for (std::size_t h = begin; h < end; ++h) {
            if (h < body.opposite[h]) walk_edge(signs, body, walk.cell_of, h, out.steps, out.points);
            walk.step_begin[h + 1] = static_cast<std::uint32_t>(out.steps.size());
        }
    });
    std::uint32_t offset = 0;
    std::size_t h = 0;
    for (block& b : blocks) {
        std::size_t const end = h + 6144 < half_edges ? h + 6144 : half_edges;
        for (; h < end; ++h) walk.step_begin[h + 1] += offset;
        require_indexable("voronoi_shards", walk.steps.size() + b.steps.size());
        append_and_free(walk.steps, b.steps);
        append_and_free(walk.points, b.points);
        offset = static_cast<std::uint32_t>(walk.steps.size());
    }
    return walk;
}

}  // namespace tafoni::detail

#endif
