/// \file
/// The distance from every vertex to the nearest particle that touches the surface.
#ifndef TAFONI_WEATHERING_DETAIL_NEAR_WATER_HPP
#define TAFONI_WEATHERING_DETAIL_NEAR_WATER_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/core/vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tafoni::detail {

/// Particles in the cells of a grid, for questions about one distance; keeps its memory from use to use.
class near_water {
public:
    /// Squared distance to the nearest of `points` for each of `vertices`, or infinity where none is within `reach`.
    /// O(points + vertices + cells + pairs in neighbouring cells).
    template <executor E>
    void find(std::span<vec3 const> points, std::span<vec3 const> vertices, double reach, std::span<double> square,
              E const& threads) {
        std::fill(square.begin(), square.end(), std::numeric_limits<double>::infinity());
        if (points.empty() || vertices.empty() || !(reach > 0)) return;
        box3 box;
        for (vec3 const& p : points) box.include(p);
        lay_out(box, reach, 4 * static_cast<double>(points.size() + vertices.size()));
        begin_.assign(size_[0] * size_[1] * size_[2] + 1, 0);
        cell_.resize(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            cell_[i] = static_cast<std::uint32_t>(cell_of(points[i]));
            ++begin_[cell_[i] + 1];
        }
        for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
        sorted_.resize(points.size());
        for (std::size_t i = points.size(); i-- > 0;) sorted_[--begin_[cell_[i] + 1]] = points[i];
        // begin_[c + 1] is now the first of cell c.
        double const most = reach * reach;
        threads.for_blocks(vertices.size(), 1024, [&](std::size_t from, std::size_t to) {
            for (std::size_t v = from; v < to; ++v) square[v] = nearest(vertices[v], most);
        });
    }

private:
    void lay_out(box3 const& box, double reach, double most) {
        double cell = reach;
        lo_ = box.lo;
        vec3 const e = box.extent();
        auto const along = [&](int d) { return std::floor(e[d] / cell) + 1; };
        while (along(0) * along(1) * along(2) > most) cell *= 1.25;
        inverse_ = 1 / cell;
        for (int d = 0; d < 3; ++d) size_[static_cast<std::size_t>(d)] = static_cast<std::size_t>(along(d));
    }
    [[nodiscard]] std::int64_t place(int d, double x) const noexcept {
        // Positive before it is cut to a whole number: this is faster than floor where that is a call.
        return static_cast<std::int64_t>(std::clamp((x - lo_[d]) * inverse_, -2.0, 0x1p40) + 2) - 2;
    }
    [[nodiscard]] std::size_t cell_of(vec3 const& p) const noexcept {
        std::array<std::size_t, 3> c{};
        for (int d = 0; d < 3; ++d) {
            auto const e = static_cast<std::size_t>(d);
            c[e] = std::min(static_cast<std::size_t>(place(d, p[d])), size_[e] - 1);
        }
        return c[0] + size_[0] * (c[1] + size_[1] * c[2]);
    }
    [[nodiscard]] double nearest(vec3 const& p, double most) const noexcept {
        std::array<std::int64_t, 3> low{};
        std::array<std::int64_t, 3> high{};
        for (int d = 0; d < 3; ++d) {
            auto const e = static_cast<std::size_t>(d);
            std::int64_t const c = place(d, p[d]);
            low[e] = std::max<std::int64_t>(c - 1, 0);
            high[e] = std::min<std::int64_t>(c + 1, static_cast<std::int64_t>(size_[e]) - 1);
            if (low[e] > high[e]) return std::numeric_limits<double>::infinity();
        }
        double best = std::numeric_limits<double>::infinity();
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
            for (std::int64_t y = low[1]; y <= high[1]; ++y) {
                std::size_t const row = size_[0] * (static_cast<std::size_t>(y) + size_[1] * static_cast<std::size_t>(z));
                std::size_t const first = row + static_cast<std::size_t>(low[0]);
                std::size_t const last = row + static_cast<std::size_t>(high[0]);
                std::uint32_t const end = last + 2 < begin_.size() ? begin_[last + 2] : static_cast<std::uint32_t>(sorted_.size());
                for (std::uint32_t k = begin_[first + 1]; k < end; ++k) {
                    vec3 const& q = sorted_[k];
                    double const x = q[0] - p[0];
                    double const u = q[1] - p[1];
                    double const w = q[2] - p[2];
                    best = std::min(best, x * x + u * u + w * w);
                }
            }
        }
        return best <= most ? best : std::numeric_limits<double>::infinity();
    }

    vec3 lo_{0, 0, 0};
    double inverse_ = 1;
    std::array<std::size_t, 3> size_{};
    std::vector<std::uint32_t> begin_{};
    std::vector<std::uint32_t> cell_{};
    std::vector<vec3> sorted_{};
};

}  // namespace tafoni::detail

#endif
