/// \file
/// Wrinkles, sagging and cracks along picked vertices: one pattern, worn by any mesh of the same topology.
#ifndef TAFONI_WEATHERING_WRINKLES_HPP
#define TAFONI_WEATHERING_WRINKLES_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/error.hpp>
#include <tafoni/core/executor.hpp>
#include <tafoni/curvature/vertex_normals.hpp>
#include <tafoni/geometry/refine_faces.hpp>
#include <tafoni/geometry/refined_origins.hpp>
#include <tafoni/geometry/triangle_surface.hpp>
#include <tafoni/geometry/vertex_rings.hpp>
#include <tafoni/weathering/detail/wrinkle_reach.hpp>
#include <tafoni/weathering/wrinkle_path.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tafoni {

/// How far from the path the surface goes out.
enum class wrinkle_profile : std::uint8_t {
    fold,   ///< nothing on the path itself, swelling beside it [thesis, equation 12.3]
    groove  ///< most on the path [equation 12.1 alone]: with a negative strength and a small radius a crack
};

/// A line of vertices that the surface folds along.
struct wrinkle {
    std::vector<vertex_index> controls{};  ///< ends, and where the line turns; at least 2, each next one another
    double radius = 0;                     ///< r of the affected region, length unit, > 0
    double strength = 1;                   ///< multiplies the factor, which on a groove is 0.12 r for a divisor of 10;
                                           ///< negative carves
    wrinkle_profile profile = wrinkle_profile::fold;
};

/// A vertex around which the surface swells (weight gain, sagging) or shrinks. [thesis, 12.4]
///
/// Folds cut into it, as they do into each other: on their lines nothing swells. Faces around it are not split.
struct enlargement {
    vertex_index centre{};
    double radius = 0;    ///< length unit, > 0
    double strength = 1;  ///< multiplies the factor; negative shrinks
};

/// Which form of equations 12.1 to 12.4 holds.
enum class wrinkle_formula : std::uint8_t {
    scale_free,  ///< sigma = r / 3 and lengths in units of r: the same wrinkle on a model of any size
    as_printed   ///< sigma = r^2 / 3 and lengths in the model's unit
};

/// What holds for all wrinkles of a pattern.
struct wrinkle_options {
    double divisor = 10;             ///< a of equation 12.4, > 0
    std::uint32_t subdivisions = 2;  ///< 0 to 6: within r of the path, then r / 3 [thesis, 12.6], r / 9, ...
    wrinkle_formula formula = wrinkle_formula::scale_free;

    /// \throws invalid_input  `bad_parameter`.
    void validate() const {
        detail::require_range("wrinkle_options.divisor", divisor, 1e-6, 1e12);
        detail::require_range("wrinkle_options.subdivisions", subdivisions, 0, 6);
    }
};

/// Refined triangles and a factor per vertex: what is left of a base model when its wrinkles are picked.
///
/// Independent of threads; of the mesh only the topology is kept, so a pattern can be worn by every model
/// that was made from the base by moving its vertices [thesis, 12.6].
class wrinkle_pattern {
public:
    /// Wrinkles and enlargements on a base mesh. What several wrinkles or enlargements give a vertex adds up, and is
    /// then scaled by sqrt(distance) from the nearest fold as in equation 12.3; grooves are added to that.
    /// O(faces + sum over the paths' edges of the vertices near them).
    /// \throws invalid_input  `index_out_of_range` for a vertex, `bad_parameter` for radii and strengths, `out_of_range`
    ///         for meshes longer than 2^300, and what `find_wrinkle_path` throws; `bad_topology` for an enlargement
    ///         of a vertex without triangles.
    template <polygon_mesh M>
    wrinkle_pattern(M const& mesh, std::span<wrinkle const> wrinkles, std::span<enlargement const> enlargements = {},
                    wrinkle_options const& options = {})
        : options_((options.validate(), options)) {
        triangle_surface base = triangle_surface::copy_of(mesh);
        base_vertices_ = base.positions.size();
        check(wrinkles, enlargements);
        detail::wrinkle_ground ground(std::move(base));
        for (wrinkle const& w : wrinkles) paths_.push_back(find_wrinkle_path(ground, w.controls));
        for (std::size_t k = 0; k < enlargements.size(); ++k) {
            ground.require_used("enlargements[" + std::to_string(k) + "].centre", enlargements[k].centre);
        }
        triangle_surface& s = ground.surface;
        origins_ = refined_origins(s.triangles.size());
        double share = 1 / ground.unit;
        for (std::uint32_t k = 0; k < options_.subdivisions; ++k, share /= 3) {
            refine(s, wrinkles, share);
        }
        triangles_ = s.triangles;
        rings_ = vertex_rings(s.positions.size(), triangles_);
        factors(s, ground.unit, wrinkles, enlargements);
    }

    /// The surface of a mesh of the base's topology, refined, with the pattern worn `times` times; normals are taken
    /// anew each time. O(times x faces).
    /// \throws invalid_input  `attribute_length` for another number of vertices, `non_finite_vertex`, `out_of_range` for
    ///         meshes longer than 2^300.
    template <executor E = inline_executor>
    [[nodiscard]] triangle_surface wear(std::span<vec3 const> positions, std::uint32_t times = 1, E const& threads = {}) const {
        require_vertices(positions.size(), base_vertices_, "the base");
        triangle_surface s{.positions = {positions.begin(), positions.end()}, .triangles = triangles_};
        add_midpoints(s.positions, origins_.midpoints);
        return wear_again(std::move(s), times, threads);
    }

    /// Wears it `times` times more on what `wear` gave: n times, then m times equal n + m. O(times x faces).
    /// \throws invalid_input  `attribute_length` for another number of vertices, `bad_parameter` for other triangles,
    ///         `non_finite_vertex`, `out_of_range` for meshes longer than 2^300.
    template <executor E = inline_executor>
    [[nodiscard]] triangle_surface wear_again(triangle_surface worn, std::uint32_t times = 1, E const& threads = {}) const {
        require_vertices(worn.positions.size(), factor_.size(), "the refined base");
        if (worn.triangles != triangles_) {
            detail::fail<invalid_input>(errc::bad_parameter, "wrinkle_pattern: the triangles are not those of the refined base",
                                        {.kind = entity::face});
        }
        worn.validate();
        double const inverse = 1 / detail::wrinkle_ground::unit_of(worn);
        std::vector<vec3> scaled(worn.positions.size());
        std::vector<vec3> normal(worn.positions.size());
        for (std::uint32_t k = 0; k < times; ++k) {
            for (std::size_t v = 0; v < scaled.size(); ++v) scaled[v] = vec3{worn.positions[v] * inverse};
            vertex_normals(surface_view{.positions = scaled, .triangles = triangles_, .rings = &rings_}, normal, threads);
            for (std::size_t v = 0; v < normal.size(); ++v) {
                double const d = factor_[v];
                if (d == 0) continue;
                vec3& p = worn.positions[v];
                p = vec3{p[0] + d * normal[v][0], p[1] + d * normal[v][1], p[2] + d * normal[v][2]};
            }
        }
        return worn;
    }

    /// Displacement along the normal per refined vertex, length unit of the base: factor / a.
    [[nodiscard]] std::span<double const> displacement() const noexcept { return factor_; }
    /// Those of the refined base, which every surface that wears the pattern gets.
    [[nodiscard]] std::span<std::array<std::uint32_t, 3> const> triangles() const noexcept { return triangles_; }
    /// Ends of the edge that refined vertex `base_vertices() + k` lies in the middle of.
    [[nodiscard]] std::span<std::array<std::uint32_t, 2> const> midpoints() const noexcept { return origins_.midpoints; }
    /// The same with the base's face of each triangle; `origins().carried(u)` gives numbers of the base's vertices to all.
    [[nodiscard]] refined_origins const& origins() const noexcept { return origins_; }
    [[nodiscard]] std::size_t base_vertices() const noexcept { return base_vertices_; }
    /// Vertices along each wrinkle, in refined numbers.
    [[nodiscard]] std::span<std::vector<vertex_index> const> paths() const noexcept { return paths_; }

private:
    static void require_vertices(std::size_t got, std::size_t needed, char const* whose) {
        if (got == needed) return;
        detail::fail<invalid_input>(errc::attribute_length,
                                    "wrinkle_pattern: got " + std::to_string(got) + " vertices, " + whose + " has " + std::to_string(needed),
                                    {.kind = entity::vertex, .value = static_cast<double>(got), .limit = static_cast<double>(needed)});
    }
    void check(std::span<wrinkle const> wrinkles, std::span<enlargement const> enlargements) const {
        for (wrinkle const& w : wrinkles) {
            detail::require_range("wrinkle.radius", w.radius, std::numeric_limits<double>::min(), 1e100);
            detail::require_range("wrinkle.strength", w.strength, -1e6, 1e6);
        }
        for (enlargement const& e : enlargements) {
            detail::require_range("enlargement.radius", e.radius, std::numeric_limits<double>::min(), 1e100);
            detail::require_range("enlargement.strength", e.strength, -1e6, 1e6);
            if (e.centre.value >= base_vertices_) {
                detail::fail<invalid_input>(errc::index_out_of_range,
                                            "enlargement.centre: vertex " + std::to_string(e.centre.value) + " of " +
                                                std::to_string(base_vertices_),
                                            {.kind = entity::vertex, .index = e.centre.value});
            }
        }
    }

    /// Splits the triangles at vertices within `share` of a wrinkle's radius.
    void refine(triangle_surface& s, std::span<wrinkle const> wrinkles, double share) {
        vertex_rings const rings(s.positions.size(), s.triangles);
        std::vector<unsigned char> chosen(s.triangles.size(), 0);
        for (std::size_t w = 0; w < wrinkles.size(); ++w) {
            for (auto const& near_by : detail::reach_of_path(s, rings, paths_[w], share * wrinkles[w].radius)) {
                for (auto const& c : rings.faces(near_by.vertex)) chosen[c.face] = 1;
            }
        }
        refined_faces fine = refine_faces(s, chosen);
        for (auto& path : paths_) refine_path(path, fine.midpoints, s.positions.size());
        add_midpoints(s.positions, fine.midpoints);
        origins_.follow(fine);
        s.triangles = std::move(fine.triangles);
    }

    /// Edges of the path that were split get their middle.
    static void refine_path(std::vector<vertex_index>& path, std::span<std::array<std::uint32_t, 2> const> midpoints,
                            std::size_t first_new) {
        std::vector<vertex_index> fine;
        for (std::size_t k = 0; k < path.size(); ++k) {
            fine.push_back(path[k]);
            if (k + 1 == path.size()) break;
            std::array<std::uint32_t, 2> const e{std::min(path[k].value, path[k + 1].value),
                                                 std::max(path[k].value, path[k + 1].value)};
            auto const at = std::lower_bound(midpoints.begin(), midpoints.end(), e);
            if (at != midpoints.end() && *at == e) {
                fine.push_back(vertex_index{first_new + static_cast<std::size_t>(at - midpoints.begin())});
            }
        }
        path = std::move(fine);
    }

    /// Equation 12.1 times the length that it is in units of, over a. `t` is the distance over r.
    [[nodiscard]] double bell(double t, double r) const noexcept {
        static constexpr double root_two_pi = 2.50662827463100050242;
        bool const printed = options_.formula == wrinkle_formula::as_printed;
        double const x = printed ? t * r : t;
        double const sigma = printed ? r * r / 3 : 1.0 / 3;
        return elementary::exp(-x * x / (2 * sigma * sigma)) / (sigma * root_two_pi) * (printed ? 1.0 : r) / options_.divisor;
    }

    /// Equation 12.3 at every vertex. `s` is in units of `unit`.
    void factors(triangle_surface const& s, double unit, std::span<wrinkle const> wrinkles, std::span<enlargement const> enlargements) {
        bool const printed = options_.formula == wrinkle_formula::as_printed;
        std::size_t const n = s.positions.size();
        factor_.assign(n, 0.0);
        std::vector<double> carved(n, 0.0);
        std::vector<double> off(n, -1);  // from the nearest fold: in radii, or as printed in the user's unit
        std::vector<std::size_t> folds;
        for (std::size_t k = 0; k < wrinkles.size(); ++k) {
            wrinkle const& w = wrinkles[k];
            bool const fold = w.profile == wrinkle_profile::fold;
            if (fold) folds.push_back(k);
            double const r = w.radius / unit;
            for (auto const& at : detail::reach_of_path(s, rings_, paths_[k], r)) {
                double const t = at.distance / r;
                (fold ? factor_ : carved)[at.vertex] += w.strength * bell(t, w.radius);
                double const d = printed ? at.distance * unit : t;
                if (fold && (off[at.vertex] < 0 || d < off[at.vertex])) off[at.vertex] = d;
            }
        }
        for (enlargement const& e : enlargements) {
            std::vector<vertex_index> const centre{e.centre};
            double const r = e.radius / unit;
            for (auto const& at : detail::reach_of_path(s, rings_, centre, r)) {
                factor_[at.vertex] += e.strength * bell(at.distance / r, e.radius);
                if (!printed || off[at.vertex] >= 0) continue;
                for (std::size_t const k : folds) {
                    for (vertex_index const v : paths_[k]) {
                        double const d = unit * length(s.positions[at.vertex] - s.positions[v.value]);
                        if (off[at.vertex] < 0 || d < off[at.vertex]) off[at.vertex] = d;
                    }
                }
            }
        }
        for (std::size_t v = 0; v < n; ++v) {
            if (off[v] >= 0) factor_[v] *= std::sqrt(off[v]);
            factor_[v] += carved[v];
        }
    }

    wrinkle_options options_;
    std::size_t base_vertices_ = 0;
    std::vector<std::vector<vertex_index>> paths_{};
    std::vector<std::array<std::uint32_t, 3>> triangles_{};
    vertex_rings rings_{};
    refined_origins origins_{};
    std::vector<double> factor_{};
};

}  // namespace tafoni

#endif
