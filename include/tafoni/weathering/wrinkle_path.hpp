/// \file
/// The vertices between picked ones, along the plane that holds the ends and their mean normal.
#ifndef TAFONI_WEATHERING_WRINKLE_PATH_HPP
#define TAFONI_WEATHERING_WRINKLE_PATH_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/curvature/vertex_normals.hpp>
#include <tafoni/geometry/triangle_surface.hpp>
#include <tafoni/geometry/vertex_rings.hpp>
#include <tafoni/weathering/detail/door_scale.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tafoni {

namespace detail {

/// A mesh as wrinkles see it: scaled by a power of two so that the longest side of its triangles' box lies in (1/2, 1],
/// which keeps every bit, with neighbours and normals.
struct wrinkle_ground {
    triangle_surface surface{};
    double unit = 1;  ///< length unit of the user: what a length of 1 is here
    vertex_rings rings{};
    std::vector<vec3> normal{};

    /// O(vertices + faces). \throws invalid_input  `out_of_range` for meshes longer than 2^300.
    explicit wrinkle_ground(triangle_surface s) : surface(std::move(s)), unit(unit_of(surface)) {
        for (vec3& p : surface.positions) p *= 1 / unit;
        rings = vertex_rings(surface.positions.size(), surface.triangles);
        normal.resize(surface.positions.size());
        vertex_normals(surface_view{.positions = surface.positions, .triangles = surface.triangles, .rings = &rings}, normal);
    }

    /// Of what triangles use; 1 for what has no extent.
    [[nodiscard]] static double unit_of(triangle_surface const& s) {
        box3 box;
        for (auto const& t : s.triangles) {
            for (std::uint32_t const c : t) box.include(s.positions[c]);
        }
        std::array const ends{box.lo, box.hi};
        return door_scale(s.triangles.empty() ? std::span<vec3 const>{} : std::span<vec3 const>{ends}).length_to_user(1);
    }
    /// \throws bad_topology  `unsupported` for a vertex without triangles; `who` begins the text.
    void require_used(std::string const& who, vertex_index v) const {
        if (!rings.faces(v.value).empty()) return;
        fail<bad_topology>(errc::unsupported, who + ": vertex " + std::to_string(v.value) + " belongs to no triangle",
                           {.kind = entity::vertex, .index = v.value});
    }
};

struct find_wrinkle_path_fn {
    /// Neighbouring vertices from control to control, ends included.
    ///
    /// For each section a plane through both ends and the mean of their normals is laid; of the neighbours that
    /// lead on towards the end the one nearest to the plane is next [thesis, 12.2]. Where none leads on (a
    /// hole or a fold in between) the rest of the section is the shortest way along edges. Where the normals lay no
    /// plane (they cancel, there are none, or they point along the section) it holds the axis that the section follows
    /// least. Ties by place.
    /// O(faces) for the normals, then O(path), or O(vertices log vertices) per section without a direct way.
    /// \throws invalid_input  `bad_parameter` for fewer than two controls or equal neighbours in the list,
    ///         `index_out_of_range`; `bad_topology`, which names the vertices, for a control without triangles and where
    ///         no way along edges leads.
    template <polygon_mesh M>
    [[nodiscard]] std::vector<vertex_index> operator()(M const& mesh, std::span<vertex_index const> controls) const {
        triangle_surface s = triangle_surface::copy_of(mesh);
        check(controls, s.positions.size());
        return (*this)(wrinkle_ground(std::move(s)), controls);
    }
    [[nodiscard]] std::vector<vertex_index> operator()(wrinkle_ground const& ground, std::span<vertex_index const> controls) const {
        check(controls, ground.surface.positions.size());
        for (std::size_t k = 0; k < controls.size(); ++k) ground.require_used("wrinkle.controls[" + std::to_string(k) + "]", controls[k]);
        std::vector<vertex_index> path{controls[0]};
        for (std::size_t k = 1; k < controls.size(); ++k) section(ground, controls[k - 1].value, controls[k].value, path);
        return path;
    }

private:
    static void check(std::span<vertex_index const> controls, std::size_t vertices) {
        if (controls.size() < 2) {
            fail<invalid_input>(errc::bad_parameter,
                                "wrinkle.controls: got " + std::to_string(controls.size()) + " vertices, need at least 2",
                                {.kind = entity::parameter, .value = static_cast<double>(controls.size()), .limit = 2});
        }
        for (std::size_t k = 0; k < controls.size(); ++k) {
            if (controls[k].value >= vertices) {
                fail<invalid_input>(errc::index_out_of_range,
                                    "wrinkle.controls[" + std::to_string(k) + "]: vertex " +
                                        std::to_string(controls[k].value) + " of " + std::to_string(vertices),
                                    {.kind = entity::vertex, .index = controls[k].value,
                                     .limit = static_cast<double>(vertices)});
            }
            if (k > 0 && controls[k] == controls[k - 1]) {
                fail<invalid_input>(errc::bad_parameter,
                                    "wrinkle.controls[" + std::to_string(k) + "]: vertex " +
                                        std::to_string(controls[k].value) + " twice in a row",
                                    {.kind = entity::vertex, .index = controls[k].value});
            }
        }
    }

    /// Across the plane of a section, unit length; zero where its ends lie in one place.
    static vec3 across_plane(vec3 const& along, vec3 const& mean) {
        vec3 const across = cross(along, mean);
        if (squared_length(across) > 1e-18 * squared_length(along)) return normalized(across);
        Eigen::Index least = 0;
        for (Eigen::Index a = 1; a < 3; ++a) {
            if (std::fabs(along[a]) < std::fabs(along[least])) least = a;
        }
        vec3 axis{0, 0, 0};
        axis[least] = 1;
        return normalized(cross(along, axis));
    }

    static void section(wrinkle_ground const& ground, std::uint32_t from, std::uint32_t to, std::vector<vertex_index>& path) {
        auto const& position = ground.surface.positions;
        vec3 const across = across_plane(vec3{position[to] - position[from]}, vec3{ground.normal[from] + ground.normal[to]});
        std::uint32_t at = from;
        while (at != to) {
            auto const around = ground.rings.neighbors(at);
            if (std::binary_search(around.begin(), around.end(), to)) {
                path.push_back(vertex_index{to});
                return;
            }
            vec3 const left{position[to] - position[at]};
            double const far = squared_length(left);
            std::uint32_t next = vertex_index::none;
            double best = std::numeric_limits<double>::infinity();
            for (std::uint32_t const w : around) {
                vec3 const step{position[w] - position[at]};
                // Nearer to the end than before, so that the walk ends.
                if (!(squared_length(position[to] - position[w]) < far) || !(dot(step, left) > 0)) continue;
                double const off = std::fabs(dot(vec3{position[w] - position[from]}, across));
                bool const tie = off == best && lexicographically_less(position[w], position[next]);
                if (off < best || tie) {
                    best = off;
                    next = w;
                }
            }
            if (next == vertex_index::none) {
                shortest(ground, from, at, to, path);
                return;
            }
            path.push_back(vertex_index{next});
            at = next;
        }
    }

    /// Dijkstra along edges from `at`, on a section that began at `from`.
    static void shortest(wrinkle_ground const& ground, std::uint32_t from, std::uint32_t at, std::uint32_t to,
                         std::vector<vertex_index>& path) {
        auto const& position = ground.surface.positions;
        std::vector<double> way(position.size(), std::numeric_limits<double>::infinity());
        std::vector<std::uint32_t> before(position.size(), vertex_index::none);
        using entry = std::pair<double, std::uint32_t>;
        std::priority_queue<entry, std::vector<entry>, std::greater<>> queue;
        way[at] = 0;
        queue.push({0, at});
        while (!queue.empty()) {
            auto const [d, v] = queue.top();
            queue.pop();
            if (d > way[v]) continue;
            if (v == to) break;
            for (std::uint32_t const w : ground.rings.neighbors(v)) {
                double const e = d + length(position[w] - position[v]);
                if (e < way[w]) {
                    way[w] = e;
                    before[w] = v;
                    queue.push({e, w});
                }
            }
        }
        if (before[to] == vertex_index::none) {
            fail<bad_topology>(errc::unsupported,
                               "wrinkle.controls: no edges lead from vertex " + std::to_string(from) + " to vertex " +
                                   std::to_string(to),
                               {.kind = entity::vertex, .index = to});
        }
        std::vector<vertex_index> back;
        for (std::uint32_t v = to; v != at; v = before[v]) back.push_back(vertex_index{v});
        path.insert(path.end(), back.rbegin(), back.rend());
    }
};

}  // namespace detail

/// `find_wrinkle_path(mesh, controls)`; see `detail::find_wrinkle_path_fn`.
inline constexpr detail::find_wrinkle_path_fn find_wrinkle_path{};

}  // namespace tafoni

#endif
