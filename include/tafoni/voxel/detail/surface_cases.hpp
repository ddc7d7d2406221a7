/// \file
/// How a surface runs through one cell of eight corners: derived from a rule when this header is compiled.
#ifndef TAFONI_VOXEL_DETAIL_SURFACE_CASES_HPP
#define TAFONI_VOXEL_DETAIL_SURFACE_CASES_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace tafoni::detail {

/// Corner c of a cell lies at (c & 1, c >> 1 & 1, c >> 2 & 1). Edge e runs along axis e / 4, and its place is
/// (e & 1) along the next axis, (e >> 1 & 1) along the one after that, cyclically.
constexpr int cell_edge_axis(int e) noexcept { return e / 4; }

/// The corner at the lower end of an edge.
constexpr int cell_edge_low(int e) noexcept {
    int const a = e / 4;
    return ((e & 1) << ((a + 1) % 3)) | ((e >> 1 & 1) << ((a + 2) % 3));
}

/// The edge between two neighbouring corners.
constexpr int cell_edge_between(int c, int d) noexcept {
    int const along = c ^ d;
    int const a = along == 1 ? 0 : along == 2 ? 1 : 2;
    return 4 * a + (c >> ((a + 1) % 3) & 1) + 2 * (c >> ((a + 2) % 3) & 1);
}

/// Bits of the two faces of the cell that an edge lies in: 2 axis + side.
constexpr int cell_edge_faces(int e) noexcept {
    int const a = e / 4;
    return (1 << (2 * ((a + 1) % 3) + (e & 1))) | (1 << (2 * ((a + 2) % 3) + (e >> 1 & 1)));
}

/// Triangles through a cell, by the cell's edges; counter-clockwise seen from the air, lowest edge first.
struct surface_case {
    static constexpr std::size_t most = 6;

    std::uint8_t count = 0;
    std::uint16_t crossed = 0;  ///< bits of the edges between a solid and an airy corner
    std::array<std::array<std::uint8_t, 3>, most> triangles{};
};

/// The loops in which a surface crosses the faces of one cell, by the cell's edges, lowest edge first.
struct surface_loops {
    std::uint8_t count = 0;
    std::array<std::uint8_t, 5> first{};   ///< loop l has the edges first[l] .. first[l + 1] - 1
    std::array<std::uint8_t, 12> edges{};  ///< counter-clockwise seen from the air
};

/// The rule [after Lorensen and Cline 1987]. On each face of the cell every run of solid corners is cut off
/// by one segment, so that solid corners that meet only across a face are separate and air is joined; both cells
/// at a face see the same corners and so the same segments. The segments close to loops, each of which
/// bounds one disc, cut so that no diagonal lies in a face of the cell: the neighbour could have it as
/// well, and an edge with four triangles would be no manifold. Among those cuts the one with the shortest diagonals
/// between midpoints; a loop is cut alike in whatever case it occurs.
class surface_case_rule {
public:
    /// Bit c of `solid` is corner c.
    // Plain arrays: while compiling, every call of std::array's members takes as long as the step that it is for.
    static constexpr surface_loops loops(unsigned solid) {
        surface_loops out;
        int next[12] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
        for (int axis = 0; axis < 3; ++axis) {
            for (int side = 0; side < 2; ++side) trace_face(solid, axis, side, next);
        }
        std::uint8_t at = 0;
        for (int start = 0; start < 12; ++start) {
            if (next[start] < 0) continue;
            for (int e = start; next[e] >= 0;) {
                out.edges[at++] = static_cast<std::uint8_t>(e);
                int const to = next[e];
                next[e] = -1;
                e = to;
            }
            out.first[++out.count] = at;
        }
        return out;
    }

    static constexpr surface_case make(unsigned solid) {
        surface_case out;
        surface_loops const found = loops(solid);
        for (std::size_t l = 0; l < found.count; ++l) {
            int loop[longest] = {};
            int n = 0;
            for (std::size_t k = found.first[l]; k < found.first[l + 1]; ++k) {
                loop[n] = found.edges[k];
                out.crossed = static_cast<std::uint16_t>(out.crossed | 1U << loop[n]);
                ++n;
            }
            cut(loop, n, out);
        }
        return out;
    }

private:
    static constexpr int never = 1 << 20;
    static constexpr int longest = 7;  // edges of a loop

    /// Segments of one face: from where its border, run counter-clockwise seen from outside, enters the solid to where it leaves.
    static constexpr void trace_face(unsigned solid, int axis, int side, int (&next)[12]) {
        int const u = 1 << ((axis + 1) % 3);
        int const v = 1 << ((axis + 2) % 3);
        int const base = side << axis;
        int const ring[4] = {base, base | (side == 1 ? u : v), base | u | v, base | (side == 1 ? v : u)};
        bool const filled[4] = {(solid >> ring[0] & 1U) != 0, (solid >> ring[1] & 1U) != 0, (solid >> ring[2] & 1U) != 0,
                                (solid >> ring[3] & 1U) != 0};
        for (int k = 0; k < 4; ++k) {
            if (filled[k] || !filled[(k + 1) & 3]) continue;
            int last = k + 1;
            while (filled[(last + 1) & 3]) ++last;
            next[cell_edge_between(ring[k], ring[(k + 1) & 3])] = cell_edge_between(ring[last & 3], ring[(last + 1) & 3]);
        }
    }

    static constexpr int diagonal(int e, int f) {
        if ((cell_edge_faces(e) & cell_edge_faces(f)) != 0) return never;
        int sum = 0;
        for (int d = 0; d < 3; ++d) {
            int const p = cell_edge_axis(e) == d ? 1 : 2 * (cell_edge_low(e) >> d & 1);
            int const q = cell_edge_axis(f) == d ? 1 : 2 * (cell_edge_low(f) >> d & 1);
            sum += (p - q) * (p - q);
        }
        return sum;
    }

    /// The cheapest cut of a loop into triangles, found from short stretches of the loop to long ones.
    static constexpr void cut(int const (&loop)[longest], int n, surface_case& out) {
        int cost[longest][longest] = {};
        int apex[longest][longest] = {};
        for (int span = 2; span < n; ++span) {
            for (int i = 0; i + span < n; ++i) {
                int const j = i + span;
                cost[i][j] = never * 4;
                for (int k = i + 1; k < j; ++k) {
                    int const c = cost[i][k] + cost[k][j];
                    if (c >= cost[i][j]) continue;
                    cost[i][j] = c;
                    apex[i][j] = k;
                }
                if (span + 1 < n) cost[i][j] += diagonal(loop[i], loop[j]);
            }
        }
        if (cost[0][n - 1] >= never) throw "a loop that cannot be cut without a diagonal in a face";
        int open[2 * longest][2] = {{0, n - 1}};
        for (int depth = 1; depth != 0;) {
            --depth;
            int const i = open[depth][0];
            int const j = open[depth][1];
            if (j - i < 2) continue;
            int const k = apex[i][j];
            auto const a = static_cast<std::uint8_t>(loop[i]);
            auto const b = static_cast<std::uint8_t>(loop[k]);
            auto const c = static_cast<std::uint8_t>(loop[j]);
            if (a < b && a < c) {
                out.triangles[out.count] = {a, b, c};
            } else if (b < c) {
                out.triangles[out.count] = {b, c, a};
            } else {
                out.triangles[out.count] = {c, a, b};
            }
            ++out.count;
            open[depth][0] = k;
            open[depth++][1] = j;
            open[depth][0] = i;
            open[depth++][1] = k;
        }
    }
};

/// One constant per case: a compiler counts its steps for each of them anew.
template <std::size_t Solid>
inline constexpr surface_case one_surface_case = surface_case_rule::make(static_cast<unsigned>(Solid));

template <std::size_t... Solid>
constexpr std::array<surface_case, 256> all_surface_cases(std::index_sequence<Solid...>) {
    return {one_surface_case<Solid>...};
}

/// By the bits of the solid corners.
inline constexpr std::array<surface_case, 256> surface_cases = all_surface_cases(std::make_index_sequence<256>{});

}  // namespace tafoni::detail

#endif
