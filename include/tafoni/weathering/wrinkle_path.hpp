/// \file
/// The vertices between picked ones, along the plane that holds the ends and their mean normal.
#ifndef TAFONI_WEATHERING_WRINKLE_PATH_HPP
#define TAFONI_WEATHERING_WRINKLE_PATH_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/curvature/vertex_normals.hpp>
#include <tafoni/geometry/triangle_surface.hpp>
#include <tafoni/geometry/vertex_rings.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tafoni {

namespace detail {

struct find_wrinkle_path_fn {
    /// Neighbouring vertices from control to control, ends included.
    ///
    /// For each section a plane through both ends and the mean of their normals is laid; of the neighbours that
    /// lead on towards the end the one nearest to the plane is next [thesis, 12.2]. Where none leads on (a
    /// hole or a fold in between) the rest of the section is the shortest way along edges. Ties by place.
    /// O(faces) for the normals, then O(path), or O(vertices log vertices) per section without a direct way.
    /// \throws invalid_input  `bad_parameter` for fewer than two controls or equal neighbours in the list,
    ///         `index_out_of_range`; `bad_topology` with both vertices where no way along edges leads.
    template <polygon_mesh M>
    [[nodiscard]] std::vector<vertex_index> operator()(M const& mesh, std::span<vertex_index const> controls) const {
        return (*this)(triangle_surface::copy_of(mesh), controls);
    }
    [[nodiscard]] std::vector<vertex_index> operator()(triangle_surface const& s, std::span<vertex_index const> controls) const {
        if (controls.size() < 2) {
            fail<invalid_input>(errc::bad_parameter,
                                "wrinkle.controls: got " + std::to_string(controls.size()) + " vertices, need at least 2",
                                {.kind = entity::parameter, .value = static_cast<double>(controls.size()), .limit = 2});
        }
        for (std::size_t k = 0; k < controls.size(); ++k) {
            if (controls[k].value >= s.positions.size()) {
                fail<invalid_input>(errc::index_out_of_range,
                                    "wrinkle.controls[" + std::to_string(k) + "]: vertex " +
                                        std::to_string(controls[k].value) + " of " + std::to_string(s.positions.size()),
                                    {.kind = entity::vertex, .index = controls[k].value,
                                     .limit = static_cast<double>(s.positions.size())});
            }
            if (k > 0 && controls[k] == controls[k - 1]) {
                fail<invalid_input>(errc::bad_parameter,
                                    "wrinkle.controls[" + std::to_string(k) + "]: vertex " +
                                        std::to_string(controls[k].value) + " twice in a row",
                                    {.kind = entity::vertex, .index = controls[k].value});
            }
        }
        vertex_rings const rings(s.positions.size(), s.triangles);
        std::vector<vec3> normal(s.positions.size());
        vertex_normals(surface_view{.positions = s.positions, .triangles = s.triangles, .rings = &rings}, normal);
        std::vector<vertex_index> path{controls[0]};
        for (std::size_t k = 1; k < controls.size(); ++k) section(s, rings, normal, controls[k - 1].value, controls[k].value, path);
        return path;
    }

private:
    static void section(triangle_surface const& s, vertex_rings const& rings, std::span<vec3 const> normal,
                        std::uint32_t from, std::uint32_t to, std::vector<vertex_index>& path) {
        vec3 const along{s.positions[to] - s.positions[from]};
        vec3 const mean{normal[from] + normal[to]};
        vec3 const across = normalized(cross(along, mean));
        std::uint32_t at = from;
        while (at != to) {
            auto const around = rings.neighbors(at);
            if (std::binary_search(around.begin(), around.end(), to)) {
                path.push_back(vertex_index{to});
                return;
            }
            vec3 const left{s.positions[to] - s.positions[at]};
            double const far = squared_length(left);
            std::uint32_t next = vertex_index::none;
            double best = std::numeric_limits<double>::infinity();
            for (std::uint32_t const w : around) {
                vec3 const step{s.positions[w] - s.positions[at]};
                // Nearer to the end than before, so that the walk ends.
                if (!(squared_length(s.positions[to] - s.positions[w]) < far) || !(dot(step, left) > 0)) continue;
                double const off = std::fabs(dot(vec3{s.positions[w] - s.positions[from]}, across));
                bool const tie = off == best && lexicographically_less(s.positions[w], s.positions[next]);
                if (off < best || tie) {
                    best = off;
                    next = w;
                }
            }
            if (next == vertex_index::none) {
                shortest(s, rings, at, to, path);
                return;
            }
            path.push_back(vertex_index{next});
            at = next;
        }
    }

    /// Dijkstra along edges.
    static void shortest(triangle_surface const& s, vertex_rings const& rings, std::uint32_t from, std::uint32_t to,
                         std::vector<vertex_index>& path) {
        std::vector<double> way(s.positions.size(), std::numeric_limits<double>::infinity());
        std::vector<std::uint32_t> before(s.positions.size(), vertex_index::none);
        using entry = std::pair<double, std::uint32_t>;
        std::priority_queue<entry, std::vector<entry>, std::greater<>> queue;
        way[from] = 0;
        queue.push({0, from});
        while (!queue.empty()) {
            auto const [d, v] = queue.top();
            queue.pop();
            if (d > way[v]) continue;
            if (v == to) break;
            for (std::uint32_t const w : rings.neighbors(v)) {
                double const e = d + length(s.positions[w] - s.positions[v]);
                if (e < way[w]) {
                    way[w] = e;
                    before[w] = v;
                    queue.push({e, w});
                }
            }
        }
        if (before[to] == vertex_index::none) {
            fail<bad_topology>(errc::not_closed,
                               "wrinkle.controls: no edges lead from vertex " + std::to_string(from) + " to vertex " +
                                   std::to_string(to),
                               {.kind = entity::vertex, .index = to});
        }
        std::vector<vertex_index> back;
        for (std::uint32_t v = to; v != from; v = before[v]) back.push_back(vertex_index{v});
        path.insert(path.end(), back.rbegin(), back.rend());
    }
};

}  // namespace detail

/// `find_wrinkle_path(mesh, controls)`; see `detail::find_wrinkle_path_fn`.
inline constexpr detail::find_wrinkle_path_fn find_wrinkle_path{};

}  // namespace tafoni

#endif
