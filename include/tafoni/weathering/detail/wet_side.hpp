/// \file
/// Which of the vertices near water lie on the side of the wall that the water is on.
#ifndef TAFONI_WEATHERING_DETAIL_WET_SIDE_HPP
#define TAFONI_WEATHERING_DETAIL_WET_SIDE_HPP

#include <tafoni/core/vector.hpp>
#include <tafoni/geometry/vertex_rings.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// Leaves dry what water is near to only through the rock: water reaches the corners of the faces that it touches, their
/// neighbours, and what is no farther from these than its influence along edges that are near water. Keeps its memory.
class wet_side {
public:
    /// `for_each_touched(visit)` visits the corners of each touched face; `square`: squared distance from water by vertex,
    /// which becomes infinite for those that are not reached. O(vertices + touched faces).
    template <class Touched>
    void keep(vertex_rings const& rings, std::span<vec3 const> positions, double influence, std::span<double> square,
              Touched const& for_each_touched) {
        std::size_t const n = positions.size();
        way_.assign(n, never);
        front_.clear();
        for_each_touched([&](std::uint32_t v) { reach(v, 0); });
        std::size_t const corners = front_.size();
        for (std::size_t k = 0; k < corners; ++k) {
            for (std::uint32_t const w : rings.neighbors(front_[k])) reach(w, 0);
        }
        double const near_by = influence * influence;
        std::size_t missing = 0;
        for (std::size_t v = 0; v < n; ++v) missing += square[v] <= near_by && way_[v] > 0 ? 1U : 0U;
        if (missing == 0) return;
        while (!front_.empty()) {
            next_.clear();
            std::swap(front_, next_);
            for (std::uint32_t const v : next_) {
                for (std::uint32_t const w : rings.neighbors(v)) {
                    if (!(way_[w] > way_[v]) || !(square[w] <= near_by)) continue;
                    double const way = way_[v] + length(positions[w] - positions[v]);
                    if (way <= influence) reach(w, way);
                }
            }
        }
        for (std::size_t v = 0; v < n; ++v) {
            if (way_[v] == never) square[v] = never;
        }
    }

private:
    static constexpr double never = std::numeric_limits<double>::infinity();

    void reach(std::uint32_t v, double way) {
        if (!(way < way_[v])) return;
        way_[v] = way;
        front_.push_back(v);
    }

    std::vector<double> way_{};  ///< along edges from the touched faces and their neighbours
    std::vector<std::uint32_t> front_{};
    std::vector<std::uint32_t> next_{};
};

}  // namespace tafoni::detail

#endif
