/// \file
/// Where curvature takes the vertices of a surface.
#ifndef TAFONI_WEATHERING_DETAIL_CURVATURE_DISPLACEMENT_HPP
#define TAFONI_WEATHERING_DETAIL_CURVATURE_DISPLACEMENT_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/error.hpp>
#include <tafoni/core/executor.hpp>
#include <tafoni/curvature/concepts.hpp>
#include <tafoni/curvature/displacement.hpp>
#include <tafoni/curvature/vertex_normals.hpp>
#include <tafoni/weathering/detail/border_neighbors.hpp>
#include <tafoni/weathering/detail/door_scale.hpp>
#include <tafoni/weathering/detail/held_vertices.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace tafoni::detail {

/// Equations 9.1 to 9.5 of Skorkovská's thesis; keeps its memory from use to use.
class curvature_displacement {
public:
    struct limits {
        double power = 1;
        double reach = 0;                        ///< of the vertex that goes farthest
        std::span<unsigned char const> held{};   ///< vertices that stay; may be empty
    };

    /// Finds `next` and `moved`; false where no vertex moves. O(vertices + faces).
    /// \throws invalid_input  `out_of_range` with the first vertex whose curvature or place is not finite.
    template <class Process, executor E>
    bool find(Process const& process, surface_view const& s, door_scale const& scale, limits const& l, E const& threads) {
        constexpr bool normals = !std::is_same_v<decltype(process.direction), laplacian_direction>;  // which looks at none
        std::size_t const n = s.positions.size();
        h_.resize(n);
        next_.resize(n);
        moved_.resize(n);
        any_.assign((n + vertex_grain - 1) / vertex_grain, 0);
        process.estimator(s, std::span<double>(h_), threads);
        double const largest = largest_curvature(h_, l.held);
        double const shrink = largest > 1 ? 1 / largest : 1.0;
        double const most = largest > 1 ? 1.0 : largest;
        if constexpr (normals) {
            normal_.resize(n);
            vertex_normals(s, normal_, threads);
        }
        threads.for_blocks(n, vertex_grain, [&](std::size_t begin, std::size_t end) {
            std::vector<std::uint32_t> along;
            bool any = false;
            for (std::size_t v = begin; v < end; ++v) {
                vec3 const p = s.positions[v];
                next_[v] = p;
                moved_[v] = 0;
                if (!(h_[v] > 0) || (!l.held.empty() && l.held[v] != 0)) continue;
                double const h = std::min(h_[v] * shrink, 1.0);
                std::span<std::uint32_t const> around = s.rings->neighbors(v);
                if (s.rings->is_border(v)) around = neighbors_along_border(*s.rings, s.triangles, v, along);
                wear_point at{.position = scale.point_to_user(p), .laplacian = vec3{0, 0, 0}, .normal = vec3{0, 0, 0},
                              .curvature = most > 0 ? h / most : 0.0};
                if constexpr (normals) at.normal = normal_[v];
                for (std::uint32_t const w : around) at.laplacian += s.positions[w] - p;
                double const share = scale.length_to_user(1 / static_cast<double>(around.size()));
                at.laplacian = vec3{at.laplacian[0] * share, at.laplacian[1] * share, at.laplacian[2] * share};
                double const hard = std::max(process.durability(at.position), Process::least_durability);
                double const d = std::min((l.power == 1 ? h : elementary::pow(h, l.power)) / hard, 1.0) * l.reach;
                vec3 const way = process.direction.direction(at);
                vec3 const step{d * way[0], d * way[1], d * way[2]};
                next_[v] = vec3{p[0] + step[0], p[1] + step[1], p[2] + step[2]};
                moved_[v] = length(step);
                any = any || moved_[v] > 0;
                if (!is_finite(next_[v])) {
                    fail<invalid_input>(errc::out_of_range, "curvature_run: the policies move vertex " + std::to_string(v) +
                                                                " to a place that is not finite",
                                        {.kind = entity::vertex, .index = v});
                }
            }
            any_[begin / vertex_grain] = any ? 1 : 0;
        });
        return std::find(any_.begin(), any_.end(), 1) != any_.end();
    }

    /// Where every vertex goes, in the door's frame.
    [[nodiscard]] std::vector<vec3>& next() noexcept { return next_; }
    /// How far.
    [[nodiscard]] std::span<double const> moved() const noexcept { return moved_; }

private:
    std::vector<double> h_{};
    std::vector<vec3> next_{};
    std::vector<double> moved_{};
    std::vector<vec3> normal_{};
    std::vector<unsigned char> any_{};  ///< of every block
};

}  // namespace tafoni::detail

#endif
