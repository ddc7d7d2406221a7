/// \file
/// Where curvature takes the vertices that water is near.
#ifndef TAFONI_WEATHERING_DETAIL_WATER_DISPLACEMENT_HPP
#define TAFONI_WEATHERING_DETAIL_WATER_DISPLACEMENT_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/error.hpp>
#include <tafoni/core/executor.hpp>
#include <tafoni/curvature/concepts.hpp>
#include <tafoni/curvature/displacement.hpp>
#include <tafoni/curvature/vertex_normals.hpp>
#include <tafoni/weathering/detail/border_neighbors.hpp>
#include <tafoni/weathering/detail/held_borders.hpp>
#include <tafoni/weathering/detail/near_water.hpp>
#include <tafoni/weathering/detail/water_contacts.hpp>
#include <tafoni/weathering/detail/wet_side.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace tafoni::detail {

/// Equations 9.4 to 9.7 of Skorkovská's thesis, as `curvature_erosion` says; keeps its memory from use to use.
class water_displacement {
public:
    /// Puts into `next` where the vertices go that are within the influence of the water that touches, on its side of the
    /// wall; `mean_edge` and `most` in length units, `kept` what border vertices keep.
    /// O(vertices + faces + water).
    template <class Process, executor E>
    void find(Process const& process, surface_view const& surface, kept_ways const& kept, water_contacts const& water,
              double mean_edge, double most, std::vector<vec3>& next, E const& threads) {
        std::size_t const n = surface.positions.size();
        double const influence = process.influence > 0 ? process.influence : mean_edge;
        square_.resize(n);
        near_.find(water.points(), surface.positions, influence, square_, threads);
        side_.keep(*surface.rings, surface.positions, influence, square_, [&](auto const& visit) {
            water.for_each([&](water_contacts::contact const& c) {
                for (std::uint32_t const v : surface.triangles[c.face]) visit(v);
            });
        });
        mean_.resize(n);
        normal_.resize(n);
        surface_view at = surface;
        at.room = &room_;
        process.estimator(at, std::span<double>(mean_), threads);
        tafoni::vertex_normals(at, normal_, threads);
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        for (double const h : mean_) {
            low = std::min(low, h);
            high = std::max(high, h);
        }
        // What a ring cannot resolve is one curvature, halfway between ridge and hollow: the range of equation 9.4 has a
        // floor, or rounding would make ridges and hollows of a plane.
        double const least = least_turn / mean_edge;
        bool const bent = high - low >= least;
        double const width = 1 / (bent ? high - low : least);
        double const middle = 0.5 * low + 0.5 * high;
        // Over the larger of both, where the thesis blends fully at H_min and at H_max: a flat place among ridges has the
        // lowest curvature there is, and its Laplacian is rounding.
        double const largest = std::max({std::fabs(low), std::fabs(high), 0.5 * least});
        next.assign(surface.positions.begin(), surface.positions.end());
        threads.for_blocks(n, vertex_grain, [&](std::size_t begin, std::size_t end) {
            std::vector<std::uint32_t> along;
            for (std::size_t v = begin; v < end; ++v) {
                if (!(square_[v] <= influence * influence)) continue;
                double const share = bent ? (mean_[v] - low) * width : 0.5 + (mean_[v] - middle) * width;
                double const nearness = (influence - std::sqrt(square_[v])) / influence;
                vec3 const p = surface.positions[v];
                double const curvature = mean_[v] / largest;
                vec3 way = surface.rings->is_border(v)
                               ? direction(surface, detail::neighbors_along_border(*surface.rings, surface.triangles, v, along), v, curvature)
                               : direction(surface, surface.rings->neighbors(v), v, curvature);
                if (border_hold const* held = kept.of(v)) way = kept_in(way, normal_[v], *held);
                double const strength = process.power == 1 ? share : share > 0 ? elementary::pow(share, process.power) : 0.0;
                double const hard = std::max(process.durability(p), 1e-3);
                double const d = std::min(strength / hard, 1.0) * most * nearness;
                next[v] = vec3{p[0] + d * way[0], p[1] + d * way[1], p[2] + d * way[2]};
                if (is_finite(next[v])) continue;
                fail<invalid_input>(errc::out_of_range, "hydraulic_run: estimator or durability move vertex " + std::to_string(v) +
                                                            " to a place that is not finite",
                                    {.kind = entity::vertex, .index = v});
            }
        });
    }

private:
    static constexpr double least_turn = 0.01;  ///< of the normals, radians per mean edge

    /// Equation 9.7 with the erratum: inward normal and unit Laplacian, without what would lead outwards. `around`: at a
    /// border the neighbours along it, else all, so that a border does not creep inwards.
    [[nodiscard]] vec3 direction(surface_view const& surface, std::span<std::uint32_t const> around, std::size_t v, double curvature) const {
        vec3 const& p = surface.positions[v];
        vec3 laplacian{0, 0, 0};
        double square = 0;
        for (std::uint32_t const w : around) {
            vec3 const edge{surface.positions[w] - p};
            laplacian += edge;
            square += squared_length(edge);
        }
        if (!around.empty()) laplacian /= static_cast<double>(around.size());
        // At the middle of its neighbours, as on a straight border, but for rounding: straight in.
        if (squared_length(laplacian) <= 1e-18 * square) laplacian = vec3{-normal_[v][0], -normal_[v][1], -normal_[v][2]};
        vec3 way = blended_direction{}.direction({.position = p, .laplacian = laplacian, .normal = normal_[v], .curvature = curvature});
        double const out = tafoni::dot(way, normal_[v]);
        if (out > 0) {
            for (int a = 0; a < 3; ++a) way[a] -= out * normal_[v][a];
        }
        return way;
    }
    /// As deep into the surface as `way`, in the planes that are kept; not at all where the surface runs along the plane of
    /// the border.
    [[nodiscard]] static vec3 kept_in(vec3 const& way, vec3 const& normal, border_hold const& kept) noexcept {
        vec3 const within = without(normal, kept);
        vec3 const held = without(way, kept);
        double const free = squared_length(within);
        if (!(free > 0.0625)) return vec3{0, 0, 0};
        double const more = std::clamp((tafoni::dot(way, normal) - tafoni::dot(held, normal)) / free, -4.0, 4.0);
        return vec3{held[0] + more * within[0], held[1] + more * within[1], held[2] + more * within[2]};
    }

    near_water near_{};
    wet_side side_{};
    std::vector<double> square_{};
    std::vector<double> mean_{};
    std::vector<vec3> normal_{};
    estimator_room room_{};
};

}  // namespace tafoni::detail

#endif
