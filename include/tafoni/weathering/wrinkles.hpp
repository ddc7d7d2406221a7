/// \file
/// Wrinkles, sagging and cracks along picked vertices: one pattern, worn by any mesh of the same topology.
#ifndef TAFONI_WEATHERING_WRINKLES_HPP
#define TAFONI_WEATHERING_WRINKLES_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/error.hpp>
#include <tafoni/core/executor.hpp>
#include <tafoni/curvature/vertex_normals.hpp>
#include <tafoni/geometry/refine_faces.hpp>
#include <tafoni/geometry/triangle_surface.hpp>
#include <tafoni/weathering/detail/wrinkle_reach.hpp>
#include <tafoni/weathering/wrinkle_path.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tafoni {

/// How far from the path the surface goes out.
enum class wrinkle_profile : std::uint8_t {
    fold,   ///< nothing on the path itself, swelling beside it [thesis, equation 12.3]
    groove  ///< most on the path [equation 12.1 alone]: with a negative strength a crack
};

/// A line of vertices that the surface folds along.
struct wrinkle {
    std::vector<vertex_index> controls{};  ///< ends, and where the line turns; at least 2, each next one another
    double radius = 0;                     ///< r of the affected region, length unit, > 0
    double strength = 1;                   ///< multiplies the factor; negative carves
    wrinkle_profile profile = wrinkle_profile::fold;
};

/// A vertex around which the surface swells (weight gain, sagging) or shrinks. [thesis, 12.4]
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

struct wrinkle_options {
    double divisor = 10;             ///< a of equation 12.4, > 0
    std::uint32_t subdivisions = 2;  ///< 0, 1 (radius r) or 2 (then r / 3 once more) [thesis, 12.6]
    wrinkle_formula formula = wrinkle_formula::scale_free;

    /// \throws invalid_input  `bad_parameter`.
    void validate() const {
        detail::require_range("wrinkle_options.divisor", divisor, 1e-6, 1e12);
        detail::require_range("wrinkle_options.subdivisions", subdivisions, 0, 2);
    }
};

/// Refined triangles and a factor per vertex: what is left of a base model when its wrinkles are picked.
///
/// Independent of threads; of the mesh only the topology is kept, so a pattern can be worn by every model
/// that was made from the base by moving its vertices [thesis, 12.6].
class wrinkle_pattern {
public:
    /// Wrinkles and enlargements on a base mesh; where several reach a vertex their factors add up.
    /// O(faces + region log region).
    /// \throws invalid_input  `index_out_of_range` for a vertex, `bad_parameter` for radii and strengths, and what
    ///         `find_wrinkle_path` throws.
    template <polygon_mesh M>
    wrinkle_pattern(M const& mesh, std::span<wrinkle const> wrinkles, std::span<enlargement const> enlargements = {},
                    wrinkle_options const& options = {})
        : options_((options.validate(), options)) {
        triangle_surface s = triangle_surface::copy_of(mesh);
        base_vertices_ = s.positions.size();
        check(wrinkles, enlargements);
        for (wrinkle const& w : wrinkles) paths_.push_back(find_wrinkle_path(s, w.controls));
        for (std::uint32_t k = 0; k < options_.subdivisions; ++k) {
            double const share = k == 0 ? 1.0 : 1.0 / 3;
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
            s.triangles = std::move(fine.triangles);
            midpoints_.insert(midpoints_.end(), fine.midpoints.begin(), fine.midpoints.end());
        }
        factors(s, wrinkles, enlargements);
        triangles_ = std::move(s.triangles);
    }

    /// The surface of a mesh of the base's topology, refined, with the pattern worn `times` times; normals are taken
    /// anew each time. O(times x faces).
    /// \throws invalid_input  `attribute_length` for another number of vertices; as `triangle_surface::validate`.
    template <executor E = inline_executor>
    [[nodiscard]] triangle_surface wear(std::span<vec3 const> positions, std::uint32_t times = 1, E const& threads = {}) const {
        if (positions.size() != base_vertices_) {
            detail::fail<invalid_input>(errc::attribute_length,
                                        "wrinkle_pattern: got " + std::to_string(positions.size()) +
                                            " vertices, the base has " + std::to_string(base_vertices_),
                                        {.kind = entity::vertex, .value = static_cast<double>(positions.size()),
                                         .limit = static_cast<double>(base_vertices_)});
        }
        triangle_surface s{.positions = {positions.begin(), positions.end()}, .triangles = triangles_};
        add_midpoints(s.positions, midpoints_);
        s.validate();
        vertex_rings const rings(s.positions.size(), s.triangles);
        std::vector<vec3> normal(s.positions.size());
        for (std::uint32_t k = 0; k < times; ++k) {
            vertex_normals(surface_view{.positions = s.positions, .triangles = s.triangles, .rings = &rings}, normal, threads);
            for (std::size_t v = 0; v < normal.size(); ++v) {
                double const d = factor_[v];
                if (d == 0) continue;
                vec3& p = s.positions[v];
                p = vec3{p[0] + d * normal[v][0], p[1] + d * normal[v][1], p[2] + d * normal[v][2]};
            }
        }
        return s;
    }

    /// Displacement along the normal per refined vertex, length unit of the base: factor / a.
    [[nodiscard]] std::span<double const> displacement() const noexcept { return factor_; }
    [[nodiscard]] std::span<std::array<std::uint32_t, 3> const> triangles() const noexcept { return triangles_; }
    /// Ends of the edge that refined vertex `base_vertices() + k` lies in the middle of.
    [[nodiscard]] std::span<std::array<std::uint32_t, 2> const> midpoints() const noexcept { return midpoints_; }
    [[nodiscard]] std::size_t base_vertices() const noexcept { return base_vertices_; }
    /// Vertices along each wrinkle, in refined numbers.
    [[nodiscard]] std::span<std::vector<vertex_index> const> paths() const noexcept { return paths_; }

private:
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

    [[nodiscard]] double gaussian(double distance, double r) const noexcept {
        static constexpr double root_two_pi = 2.50662827463100050242;
        bool const printed = options_.formula == wrinkle_formula::as_printed;
        double const x = printed ? distance : distance / r;
        double const sigma = printed ? r * r / 3 : 1.0 / 3;
        return elementary::exp(-x * x / (2 * sigma * sigma)) / (sigma * root_two_pi);
    }

    void factors(triangle_surface const& s, std::span<wrinkle const> wrinkles, std::span<enlargement const> enlargements) {
        bool const printed = options_.formula == wrinkle_formula::as_printed;
        vertex_rings const rings(s.positions.size(), s.triangles);
        factor_.assign(s.positions.size(), 0.0);
        for (std::size_t k = 0; k < wrinkles.size(); ++k) {
            wrinkle const& w = wrinkles[k];
            for (auto const& at : detail::reach_of_path(s, rings, paths_[k], w.radius)) {
                double f = w.strength * gaussian(at.distance, w.radius);
                if (w.profile == wrinkle_profile::fold) f *= std::sqrt(printed ? at.distance : at.distance / w.radius);
                factor_[at.vertex] += f * (printed ? 1.0 : w.radius) / options_.divisor;
            }
        }
        for (enlargement const& e : enlargements) {
            std::vector<vertex_index> const centre{e.centre};
            for (auto const& at : detail::reach_of_path(s, rings, centre, e.radius)) {
                factor_[at.vertex] += e.strength * gaussian(at.distance, e.radius) * (printed ? 1.0 : e.radius) / options_.divisor;
            }
        }
    }

    wrinkle_options options_;
    std::size_t base_vertices_ = 0;
    std::vector<std::vector<vertex_index>> paths_{};
    std::vector<std::array<std::uint32_t, 3>> triangles_{};
    std::vector<std::array<std::uint32_t, 2>> midpoints_{};
    std::vector<double> factor_{};
};

}  // namespace tafoni

#endif
