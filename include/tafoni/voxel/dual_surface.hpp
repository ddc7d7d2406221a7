/// \file
/// Where a field takes a value, with edges and corners kept sharp.
#ifndef TAFONI_VOXEL_DUAL_SURFACE_HPP
#define TAFONI_VOXEL_DUAL_SURFACE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/field/concepts.hpp>
#include <tafoni/geometry/indexed_mesh.hpp>
#include <tafoni/voxel/detail/feature_point.hpp>
#include <tafoni/voxel/detail/isosurface_slabs.hpp>
#include <tafoni/voxel/grid_frame.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tafoni {

/// Where the vertex of a cell is placed.
enum class dual_placement : std::uint8_t {
    sharp,  ///< where the tangent planes of the cell's crossings meet best
    mean    ///< in the middle of the crossings: smooth, and the gradient is never asked
};

struct dual_surface_options {
    dual_placement placement = dual_placement::sharp;
};

namespace detail {

template <std::size_t Solid>
inline constexpr surface_loops one_surface_loops = surface_case_rule::loops(static_cast<unsigned>(Solid));

template <std::size_t... Solid>
constexpr std::array<surface_loops, 256> all_surface_loops(std::index_sequence<Solid...>) {
    return {one_surface_loops<Solid>...};
}

inline constexpr std::array<surface_loops, 256> surface_loop_cases = all_surface_loops(std::make_index_sequence<256>{});

/// The loops of a surface as polygons over the edges that it crosses.
struct loop_slab {
    struct crossing {
        std::array<std::uint32_t, 3> node;
        std::uint8_t axis;
    };
    std::vector<crossing> crossings{};
    std::vector<std::uint32_t> corners{};
    std::vector<std::size_t> offsets{0};
    std::vector<std::array<std::uint32_t, 3>> cells{};  ///< per loop

    static std::array<std::uint32_t, 3> narrow(std::array<std::size_t, 3> const& n) noexcept {
        return {static_cast<std::uint32_t>(n[0]), static_cast<std::uint32_t>(n[1]), static_cast<std::uint32_t>(n[2])};
    }
    void add_vertex(vec3 const&, std::size_t axis, std::array<std::size_t, 3> const& node) {
        crossings.push_back({narrow(node), static_cast<std::uint8_t>(axis)});
    }
    void add_cell(unsigned solid, std::array<std::uint32_t const*, 12> const& edge, std::array<std::size_t, 3> const& node) {
        surface_loops const& found = surface_loop_cases[solid];
        for (std::size_t l = 0; l < found.count; ++l) {
            for (std::size_t k = found.first[l]; k < found.first[l + 1]; ++k) {
                corners.push_back(edge[found.edges[k]][node[0]]);
            }
            offsets.push_back(corners.size());
            cells.push_back(narrow(node));
        }
    }
};

/// The dual of a closed surface of loops: a vertex per loop, a face per crossed edge.
class dual_of_loops {
public:
    explicit dual_of_loops(loop_slab const& loops) : loops_(loops), loop_of_(loops.corners.size()), around_(loops.crossings.size()) {
        for (auto& a : around_) a.fill(nobody);
        for (std::uint32_t l = 0; l + 1 < loops.offsets.size(); ++l) {
            for (std::size_t c = loops.offsets[l]; c < loops.offsets[l + 1]; ++c) {
                loop_of_[c] = l;
                auto& a = around_[loops.corners[c]];
                *std::find(a.begin(), a.end(), nobody) = static_cast<std::uint32_t>(c);
            }
        }
    }

    /// `vertices`: per loop; `points`: per crossing. Where two loops meet along two segments of a face, each gets a
    /// vertex in its middle, so that no edge has more than two triangles.
    indexed_mesh faces(std::vector<vec3> vertices, std::vector<vec3> const& points) {
        indexed_mesh out;
        out.positions = std::move(vertices);
        std::vector<std::uint32_t> middle(loop_of_.size(), nobody);  // per side, by its first corner
        for (std::uint32_t c = 0; c < loop_of_.size(); ++c) {
            std::uint32_t const other = across(c);
            if (middle[c] != nobody || !doubled(c, loop_of_[other])) continue;
            vec3 const& p = points[loops_.corners[c]];
            vec3 const& q = points[loops_.corners[next(c)]];
            middle[c] = middle[other] = out.add_vertex(vec3{0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.5 * (p[2] + q[2])}).value;
        }
        for (std::uint32_t v = 0; v < around_.size(); ++v) add_face(v, middle, out);
        return out;
    }

private:
    static constexpr std::uint32_t nobody = 0xFFFFFFFFU;

    [[nodiscard]] std::uint32_t next(std::uint32_t c) const noexcept {
        std::uint32_t const l = loop_of_[c];
        return c + 1 < loops_.offsets[l + 1] ? c + 1 : static_cast<std::uint32_t>(loops_.offsets[l]);
    }
    [[nodiscard]] std::uint32_t previous(std::uint32_t c) const noexcept {
        std::uint32_t const l = loop_of_[c];
        return c > loops_.offsets[l] ? c - 1 : static_cast<std::uint32_t>(loops_.offsets[l + 1] - 1);
    }
    /// The corner at which the other loop's side over the same segment begins; its end is the corner at c's crossing.
    [[nodiscard]] std::uint32_t across(std::uint32_t c) const noexcept {
        std::uint32_t const to = loops_.corners[next(c)];
        for (std::uint32_t const a : around_[loops_.corners[c]]) {
            if (loop_of_[a] != loop_of_[c] && loops_.corners[previous(a)] == to) return previous(a);
        }
        return c;
    }
    [[nodiscard]] bool doubled(std::uint32_t c, std::uint32_t other) const noexcept {
        for (std::uint32_t k = next(c); k != c; k = next(k)) {
            if (loop_of_[across(k)] == other) return true;
        }
        return false;
    }

    void add_face(std::uint32_t v, std::vector<std::uint32_t> const& middle, indexed_mesh& out) const {
        std::array<std::uint32_t, 8> ring{};
        std::size_t n = 0;
        std::size_t start = 0;
        bool split = false;
        std::uint32_t c = around_[v][0];
        for (int k = 0; k < 4; ++k) {
            ring[n++] = loop_of_[c];
            if (middle[c] != nobody) {
                if (!split) start = n;
                split = true;
                ring[n++] = middle[c];
            }
            c = next(across(c));
        }
        if (!split) {  // the shorter diagonal
            auto const gap = [&](std::size_t a, std::size_t b) { return squared_length(out.positions[ring[a]] - out.positions[ring[b]]); };
            start = gap(1, 3) < gap(0, 2) ? 1 : 0;
        }
        // The ring runs clockwise, from the left of a segment to its right.
        for (std::size_t k = 1; k + 1 < n; ++k) out.add_face({ring[start], ring[(start + k + 1) % n], ring[(start + k) % n]});
    }

    loop_slab const& loops_;
    std::vector<std::uint32_t> loop_of_;
    std::vector<std::array<std::uint32_t, 4>> around_;
};

struct dual_surface_fn {
    /// Dual contouring [Ju et al. 2002] with a vertex per sheet in a cell [Schaefer et al. 2007]: inside is where
    /// `field` is >= `iso` at a node, the centre of a voxel of `nodes`; triangles are counter-clockwise seen
    /// from below `iso`. Closed, a lid lies in the plane of the outermost nodes; an oriented 2-manifold for every
    /// input. Edges and corners of the shape are kept where the field has a member `vec3 gradient(vec3 const&) const`;
    /// else gradients are differences over 1/1000 of a voxel. Vertices lie within one
    /// step of their cell, and never beyond the outermost nodes. O(nodes) calls of the
    /// field and about 20 more per crossed edge; memory: the surface and two planes.
    /// \throws invalid_input  as `grid_frame::validate`; `bad_parameter` for an `iso` beyond 1e300 and for the lowest
    ///         sample that is not finite, by its index and place; `size_overflow`.
    template <scalar_field F>
    [[nodiscard]] indexed_mesh operator()(F const& field, grid_frame const& nodes, double iso,
                                          dual_surface_options const& options = {}) const {
        nodes.validate();
        require_range("dual_surface: iso", iso, -1e300, 1e300);
        require_indexable("dual_surface: nodes of a plane", 8 * (nodes.size[0] + 2) * (nodes.size[1] + 2));
        node_lattice const at{.size = nodes.size, .origin = nodes.centre({0, 0, 0}), .spacing = nodes.spacing, .pad = 1,
                              .who = "dual_surface"};
        auto const plane = [&](std::size_t k, std::vector<double>& buffer) {
            buffer.clear();
            for (std::size_t j = 0; j < at.size[1]; ++j) {
                for (std::size_t i = 0; i < at.size[0]; ++i) buffer.push_back(field(node(at, {i + 1, j + 1, k + 1})));
            }
            return static_cast<double const*>(buffer.data());
        };
        loop_slab const loops = slab_walk<double, decltype(plane), loop_slab>(at, iso, plane).walk(0, at.layers());
        require_indexable("dual_surface", 2 * loops.corners.size());

        std::vector<vec3> points(loops.crossings.size());
        std::vector<vec3> normals(options.placement == dual_placement::sharp ? points.size() : 0);
        for (std::size_t v = 0; v < points.size(); ++v) place_crossing(field, at, iso, loops.crossings[v], points[v], v < normals.size() ? &normals[v] : nullptr);
        std::vector<vec3> vertices(loops.cells.size());
        vec3 const first = node(at, {0, 0, 0});
        vec3 const last = node(at, at.size);
        feature_point corner;
        for (std::size_t l = 0; l < vertices.size(); ++l) {
            corner.clear();
            for (std::size_t c = loops.offsets[l]; c < loops.offsets[l + 1]; ++c) {
                std::uint32_t const v = loops.corners[c];
                corner.add(points[v], normals.empty() ? vec3{0, 0, 0} : normals[v]);
            }
            std::array<std::size_t, 3> const low{loops.cells[l][0], loops.cells[l][1], loops.cells[l][2]};
            vertices[l] = corner.solve(node(at, low), node(at, {low[0] + 1, low[1] + 1, low[2] + 1}), at.spacing);
            for (Eigen::Index a = 0; a < 3; ++a) vertices[l][a] = std::fmin(std::fmax(vertices[l][a], first[a]), last[a]);
        }
        return dual_of_loops(loops).faces(std::move(vertices), points);
    }

private:
    /// Of a node, padding counted; padding lies in the plane of the outermost nodes.
    static vec3 node(node_lattice const& at, std::array<std::size_t, 3> const& n) noexcept {
        vec3 out;
        for (std::size_t d = 0; d < 3; ++d) {
            auto const a = static_cast<Eigen::Index>(d);
            std::size_t const k = n[d] == 0 ? 0 : n[d] > at.size[d] ? at.size[d] - 1 : n[d] - 1;
            out[a] = at.origin[a] + at.spacing[a] * static_cast<double>(k);
        }
        return out;
    }

    template <class F>
    static void place_crossing(F const& field, node_lattice const& at, double iso, loop_slab::crossing const& e, vec3& point, vec3* normal) {
        std::array<std::size_t, 3> const low{e.node[0], e.node[1], e.node[2]};
        std::array<std::size_t, 3> high = low;
        ++high[e.axis];
        auto const a = static_cast<Eigen::Index>(e.axis);
        vec3 const p = node(at, low);
        vec3 const q = node(at, high);
        if (low[e.axis] == 0 || high[e.axis] > at.size[e.axis]) {
            point = p;
            if (normal != nullptr) *normal = vec3{0, 0, 0};
            if (normal != nullptr) (*normal)[a] = low[e.axis] == 0 ? -1 : 1;
            return;
        }
        // Bisection with the secant's step where it helps: field values may jump.
        vec3 x = p;
        double lo = p[a];
        double hi = q[a];
        double f_lo = field(p) - iso;
        double f_hi = field(q) - iso;
        bool const rises = f_hi >= 0;
        for (int k = 0; k < 24 && hi - lo > 1e-12 * at.spacing[a]; ++k) {
            double const secant = lo - f_lo * ((hi - lo) / (f_hi - f_lo));
            x[a] = k % 3 != 2 && secant > lo && secant < hi ? secant : lo + 0.5 * (hi - lo);
            double const f = field(x) - iso;
            if (f == 0) {
                lo = hi = x[a];
                break;
            }
            bool const above = (f >= 0) == rises;
            (above ? hi : lo) = x[a];
            (above ? f_hi : f_lo) = f;
        }
        x[a] = std::fabs(f_lo) < std::fabs(f_hi) ? lo : hi;
        if (lo == hi) x[a] = lo;
        point = x;
        if (normal == nullptr) return;
        vec3 g;
        if constexpr (requires { { field.gradient(x) } -> std::convertible_to<vec3>; }) {
            g = field.gradient(x);
        } else {
            for (Eigen::Index d = 0; d < 3; ++d) {
                vec3 before = x;
                vec3 after = x;
                before[d] -= 5e-4 * at.spacing[d];
                after[d] += 5e-4 * at.spacing[d];
                g[d] = (field(after) - field(before)) / (after[d] - before[d]);
            }
        }
        *normal = is_finite(g) ? normalized(g) : vec3{0, 0, 0};
    }
};

}  // namespace detail

/// Extracts a surface with sharp features; see `detail::dual_surface_fn`.
inline constexpr detail::dual_surface_fn dual_surface{};

}  // namespace tafoni

#endif
