// Choices that all processes on meshes offer, as values of run time.
#pragma once

#include <tafoni/curvature/bubble_ratio.hpp>
#include <tafoni/curvature/cotangent.hpp>
#include <tafoni/curvature/displacement.hpp>
#include <tafoni/curvature/quadric_fit.hpp>
#include <tafoni/curvature/tensor_fit.hpp>

#include <array>
#include <span>
#include <string>
#include <vector>

namespace weather {

/// One of the shipped estimators; asked once per iteration, so the choice costs nothing.
struct any_estimator {
    enum class kind { tensor, cotangent, quadric, bubble };

    kind which = kind::tensor;
    double radius = 0;  ///< of the bubble, length unit; 0: three mean edges

    template <tafoni::executor E>
    void operator()(tafoni::surface_view const& s, std::span<double> mean, E const& threads) const {
        switch (which) {
            case kind::tensor: return tafoni::tensor_fit{}(s, mean, threads);
            case kind::cotangent: return tafoni::cotangent{}(s, mean, threads);
            case kind::quadric: return tafoni::quadric_fit{}(s, mean, threads);
            case kind::bubble: return tafoni::bubble_ratio{.radius = radius}(s, mean, threads);
        }
    }
    /// For checkpoints.
    [[nodiscard]] std::array<double, 2> parameters() const { return {static_cast<double>(static_cast<int>(which)), radius}; }
};
static_assert(tafoni::curvature_estimator<any_estimator>);

/// `tensor`, `cotangent`, `quadric` or `bubble`.
any_estimator parse_estimator(std::string const& name);

/// Points on the sides of a terrain move within them only, so that it keeps its outline.
template <class Direction>
struct within_sides {
    Direction base{};
    tafoni::box3 box{};      ///< of the terrain
    double tolerance = 0;    ///< length unit

    [[nodiscard]] tafoni::vec3 direction(tafoni::wear_point const& at) const noexcept {
        tafoni::vec3 way = base.direction(at);
        for (int a = 0; a < 2; ++a) {
            if (at.position[a] - box.lo[a] <= tolerance || box.hi[a] - at.position[a] <= tolerance) way[a] = 0;
        }
        return way;
    }
    [[nodiscard]] std::vector<double> parameters() const { return {1}; }
};

/// The axis that points up as a unit vector; `x`, `y`, `z`, `-x`, `-y` or `-z`.
tafoni::vec3 parse_up(std::string const& name);

}  // namespace weather
