/// \file
/// Turns a grid of heights into a closed block of terrain with sides and base.
#ifndef TAFONI_GEOMETRY_TERRAIN_SOLID_HPP
#define TAFONI_GEOMETRY_TERRAIN_SOLID_HPP

#include <tafoni/geometry/detail/edge_faults.hpp>
#include <tafoni/geometry/detail/split_fans.hpp>
#include <tafoni/geometry/height_grid.hpp>
#include <tafoni/geometry/make_solid.hpp>

namespace tafoni {

/// How deep the block goes.
struct terrain_options {
    /// From the lowest height down to the base, in the unit of the grid, >= 0. 0 chooses the larger of a
    /// quarter of the height range and one cell.
    double depth = 0;
};

namespace detail {

/// A block of terrain before the final checks.
struct terrain_block {
    indexed_mesh mesh{};
    std::vector<std::uint8_t> artificial{};
    double base = 0;
};

inline void require_valid_grid(height_grid const& g) {
    char const* const who = "terrain_solid";
    __extension__ using wide = unsigned __int128;
    wide const nodes = wide{g.columns} * g.rows;
    if (nodes >= vertex_index::none / 8) {
        fail<invalid_input>(errc::size_overflow, std::string(who) + ": " + std::to_string(g.columns) + " x " +
                                                     std::to_string(g.rows) + " heights exceed 32-bit indices");
    }
    if (g.columns < 2 || g.rows < 2) {
        fail<invalid_input>(errc::empty_input, std::string(who) + ": a grid of " + std::to_string(g.columns) + " x " +
                                                   std::to_string(g.rows) + " heights has no area");
    }
    std::size_t const n = g.columns * g.rows;
    auto const require_length = [&](char const* name, std::size_t got) {
        if (got == n) return;
        fail<invalid_input>(errc::attribute_length,
                            std::string(who) + ": " + name + " has " + std::to_string(got) + " entries for " +
                                std::to_string(n) + " nodes",
                            {.kind = entity::attribute,
                             .value = static_cast<double>(got),
                             .limit = static_cast<double>(n)});
    };
    require_length("heights", g.heights.size());
    if (!g.missing.empty()) require_length("missing", g.missing.size());
    constexpr double largest = std::numeric_limits<double>::max();
    constexpr double smallest = std::numeric_limits<double>::min();
    require_range("height_grid.cell_size_x", g.cell_size_x, smallest, largest);
    require_range("height_grid.cell_size_y", g.cell_size_y, smallest, largest);
    require_range("height_grid.lower_left_x", g.lower_left_x, -largest, largest);
    require_range("height_grid.lower_left_y", g.lower_left_y, -largest, largest);
    for (std::size_t i = 0; i < n; ++i) {
        if ((!g.missing.empty() && g.missing[i] != 0) || std::isfinite(g.heights[i])) continue;
        fail<invalid_input>(errc::non_finite_vertex,
                            std::string(who) + ": the height in row " + std::to_string(i / g.columns) + ", column " +
                                std::to_string(i % g.columns) + " is " + number_text(g.heights[i]),
                            {.kind = entity::vertex, .index = i, .value = g.heights[i]});
    }
}

/// The top as triangles over the nodes, counter-clockwise seen from above. O(nodes).
[[nodiscard]] inline indexed_mesh terrain_top(height_grid const& g) {
    indexed_mesh top;
    for (std::size_t r = 0; r < g.rows; ++r) {
        for (std::size_t c = 0; c < g.columns; ++c) {
            top.positions.push_back(g.has_height(r, c) ? g.position(r, c) : vec3{0, 0, 0});
        }
    }
    auto const node = [&](std::size_t r, std::size_t c) { return static_cast<std::uint32_t>(r * g.columns + c); };
    for (std::size_t r = 0; r + 1 < g.rows; ++r) {
        for (std::size_t c = 0; c + 1 < g.columns; ++c) {
            std::array<std::uint32_t, 4> const q{node(r + 1, c), node(r + 1, c + 1), node(r, c + 1), node(r, c)};
            std::array<bool, 4> const has{g.has_height(r + 1, c), g.has_height(r + 1, c + 1), g.has_height(r, c + 1),
                                          g.has_height(r, c)};
            int const count = has[0] + has[1] + has[2] + has[3];
            if (count < 3) continue;
            double const rise = std::fabs(top.positions[q[0]][2] - top.positions[q[2]][2]);
            double const fall = std::fabs(top.positions[q[1]][2] - top.positions[q[3]][2]);
            bool const even = count == 4 ? rise <= fall : has[0] && has[2];
            if (even) {
                if (has[1]) top.add_face({q[0], q[1], q[2]});
                if (has[3]) top.add_face({q[0], q[2], q[3]});
            } else {
                if (has[0]) top.add_face({q[0], q[1], q[3]});
                if (has[2]) top.add_face({q[1], q[2], q[3]});
            }
        }
    }
    return top;
}

/// Top, base below every top triangle, and walls along the rim. O(nodes).
[[nodiscard]] inline terrain_block terrain_mesh(height_grid const& g, terrain_options const& options) {
    require_range("terrain_options.depth", options.depth, 0, std::numeric_limits<double>::max());
    require_valid_grid(g);
    indexed_mesh top = terrain_top(g);
    if (top.face_count() == 0) {
        fail<invalid_input>(errc::empty_input, "terrain_solid: no three neighbouring nodes have heights");
    }
    std::vector<std::uint32_t> across(top.corners.size(), std::numeric_limits<std::uint32_t>::max());
    std::vector<std::uint32_t> rim;
    {
        edge_table const edges(top);
        rim = find_edge_faults(edges, top.vertex_count(), across).open;
    }
    split_fans(top, across);

    terrain_block block;
    std::vector<std::uint32_t> top_name(top.vertex_count(), vertex_index::none);
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    for (std::uint32_t const v : top.corners) {
        lowest = std::min(lowest, top.positions[v][2]);
        highest = std::max(highest, top.positions[v][2]);
        top_name[v] = 0;
    }
    double const automatic = std::max(0.25 * (highest - lowest), std::max(g.cell_size_x, g.cell_size_y));
    block.base = lowest - (options.depth > 0 ? options.depth : automatic);
    for (std::size_t v = 0; v < top.vertex_count(); ++v) {
        if (top_name[v] == 0) top_name[v] = block.mesh.add_vertex(top.positions[v]).value;
    }
    std::uint32_t const below = static_cast<std::uint32_t>(block.mesh.vertex_count());
    for (std::uint32_t v = 0; v < below; ++v) {
        vec3 const p = block.mesh.positions[v];
        block.mesh.add_vertex(vec3{p[0], p[1], block.base});
    }
    auto const name = [&](std::size_t corner) { return top_name[top.corners[corner]]; };
    for (std::size_t c = 0; c < top.corners.size(); c += 3) block.mesh.add_face({name(c), name(c + 1), name(c + 2)});
    block.artificial.assign(block.mesh.face_count(), 0);
    for (std::size_t c = 0; c < top.corners.size(); c += 3) {
        block.mesh.add_face({below + name(c), below + name(c + 2), below + name(c + 1)});
    }
    for (std::uint32_t const c : rim) {
        std::uint32_t const a = name(c);
        std::uint32_t const b = name(c % 3 == 2 ? c - 2 : c + 1);
        block.mesh.add_face({b, a, below + a, below + b});
    }
    block.artificial.resize(block.mesh.face_count(), 1);
    return block;
}

struct terrain_solid_fn {
    /// The block of rock under a grid of heights.
    ///
    /// The top joins the centres of the cells. Four neighbours give two triangles, cut along the
    /// diagonal with the smaller difference of height (from south-west to north-east when equal);
    /// three of four give one; nodes without height leave holes, and the block may fall into several
    /// pieces. Pieces that touch in one node get a vertex each, so the surface is a 2-manifold. Sides
    /// and the flat base are marked artificial. Faces come in the order top (rows from the north),
    /// base, sides; each is one triangle but for the sides, which are quads.
    /// Its volume is the sum over the top triangles of mean height above the base times plan area.
    ///
    /// \throws invalid_input  empty_input, attribute_length, bad_parameter, non_finite_vertex (a height
    ///   that is not marked missing; the index counts row by row from the north), out_of_range, size_overflow. O(nodes).
    [[nodiscard]] solid operator()(height_grid const& grid, terrain_options const& options = {},
                                   run_context const& context = {}) const {
        terrain_block const block = terrain_mesh(grid, options);
        return make_solid(block.mesh, {.artificial = block.artificial}, context);
    }
};

}  // namespace detail

/// Makes a solid from a height grid; see `detail::terrain_solid_fn`.
inline constexpr detail::terrain_solid_fn terrain_solid{};

}  // namespace tafoni

#endif
