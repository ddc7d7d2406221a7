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

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace tafoni::detail {

/// Particles in the cells of a grid, for questions about one distance; keeps its memory from use to use.
///
/// A cell is twice the distance long, so that what is near a point lies in 2 x 2 x 2 of them: four rows, each a stretch of
/// the sorted particles. Looking at one too many changes nothing, so rows are read four particles at a time.
class near_water {
public:
    /// Squared distance to the nearest of `points` for each of `vertices`, or infinity where none is within `reach`.
    /// O(points + vertices + cells + pairs in neighbouring cells).
    template <executor E>
    void find(std::span<vec3 const> points, std::span<vec3 const> vertices, double reach, std::span<double> square,
              E const& threads) {
        if (points.empty() || !(reach > 0)) return std::fill(square.begin(), square.end(), std::numeric_limits<double>::infinity());
        sort(points, reach, 4 * static_cast<double>(points.size() + vertices.size()));
        double const most = reach * reach;
        threads.for_blocks(vertices.size(), 1024, [&](std::size_t from, std::size_t to) {
            for (std::size_t v = from; v < to; ++v) square[v] = nearest(vertices[v], most);
        });
    }

private:
    static constexpr std::size_t lanes = 4;

    void lay_out(std::span<vec3 const> points, double reach, double most) {
        box3 box;
        for (vec3 const& p : points) box.include(p);
        vec3 const e = box.extent();
        // A little longer than asked, and not lost beside the coordinates, so that rounding loses nothing.
        double largest = 0;
        for (int d = 0; d < 3; ++d) largest = std::max({largest, std::fabs(box.lo[d]), std::fabs(box.hi[d])});
        double cell = std::max(2.002 * reach, 1e-11 * largest);
        auto const along = [&](int d) { return std::floor(e[d] / cell) + 3; };
        while (along(0) * along(1) * along(2) > std::max(most, 64.0) || std::max({along(0), along(1), along(2)}) > 1e6) cell *= 1.25;
        inverse_ = 1 / cell;
        for (int d = 0; d < 3; ++d) {
            // An empty one on each side.
            lo_[d] = box.lo[d] - cell;
            top_[d] = along(d) - 0.5;
            size_[static_cast<std::size_t>(d)] = static_cast<std::size_t>(along(d));
        }
    }
    void sort(std::span<vec3 const> points, double reach, double most) {
        lay_out(points, reach, most);
        std::size_t const n = points.size();
        begin_.assign(size_[0] * size_[1] * size_[2] + 1, 0);
        cell_.resize(n);
        for (std::size_t i = 0; i < n; ++i) {
            vec3 const& p = points[i];
            std::array<std::size_t, 3> c{};
            for (int d = 0; d < 3; ++d) {
                auto const e = static_cast<std::size_t>(d);
                c[e] = std::min(static_cast<std::size_t>(static_cast<std::int64_t>((p[d] - lo_[d]) * inverse_)), size_[e] - 2);
            }
            cell_[i] = static_cast<std::uint32_t>(c[0] + size_[0] * (c[1] + size_[1] * c[2]));
            ++begin_[cell_[i]];
        }
        std::uint32_t total = 0;
        for (std::uint32_t& b : begin_) b = total += b;
        for (std::vector<double>* a : {&x_, &y_, &z_}) a->resize(n + lanes);
        for (std::size_t i = n; i-- > 0;) place(--begin_[cell_[i]], points[i]);
        for (std::size_t k = n; k < n + lanes; ++k) place(k, points[0]);
    }
    void place(std::size_t k, vec3 const& p) noexcept {
        x_[k] = p[0];
        y_[k] = p[1];
        z_[k] = p[2];
    }

    [[nodiscard]] double nearest(vec3 const& p, double most) const noexcept {
        double const x = (p[0] - lo_[0]) * inverse_;
        double const y = (p[1] - lo_[1]) * inverse_;
        double const z = (p[2] - lo_[2]) * inverse_;
        if (!(x >= 0.4 && y >= 0.4 && z >= 0.4 && x < top_[0] && y < top_[1] && z < top_[2])) return std::numeric_limits<double>::infinity();
        auto const low = [](double a) { return static_cast<std::size_t>(static_cast<std::int64_t>(a - 0.5)); };
        std::uint32_t const* const row = begin_.data() + low(x) + size_[0] * (low(y) + size_[1] * low(z));
        std::size_t const plane = size_[0] * size_[1];
        std::array<std::uint32_t const*, 4> const rows{row, row + size_[0], row + plane, row + plane + size_[0]};
        std::uint32_t any = 0;
        for (auto const* r : rows) any |= r[0] ^ r[2];
        if (any == 0) return std::numeric_limits<double>::infinity();
        double best;
#if defined(__x86_64__)
        __m128d const px = _mm_set1_pd(p[0]);
        __m128d const py = _mm_set1_pd(p[1]);
        __m128d const pz = _mm_set1_pd(p[2]);
        __m128d two = _mm_set1_pd(std::numeric_limits<double>::infinity());
        auto const look = [&](std::size_t k) {
            __m128d const u = _mm_sub_pd(_mm_loadu_pd(x_.data() + k), px);
            __m128d const v = _mm_sub_pd(_mm_loadu_pd(y_.data() + k), py);
            __m128d const w = _mm_sub_pd(_mm_loadu_pd(z_.data() + k), pz);
            two = _mm_min_pd(two, _mm_add_pd(_mm_add_pd(_mm_mul_pd(u, u), _mm_mul_pd(v, v)), _mm_mul_pd(w, w)));
        };
        for (auto const* r : rows) {
            std::uint32_t const end = r[2];
            std::uint32_t k = r[0];
            do {
                look(k);
                look(k + 2);
                k += lanes;
            } while (k < end);
        }
        best = std::min(_mm_cvtsd_f64(two), _mm_cvtsd_f64(_mm_unpackhi_pd(two, two)));
#else
        best = std::numeric_limits<double>::infinity();
        for (auto const* r : rows) {
            for (std::uint32_t k = r[0]; k < r[2]; ++k) {
                double const u = x_[k] - p[0];
                double const v = y_[k] - p[1];
                double const w = z_[k] - p[2];
                best = std::min(best, u * u + v * v + w * w);
            }
        }
#endif
        return best <= most ? best : std::numeric_limits<double>::infinity();
    }

    vec3 lo_{0, 0, 0};
    vec3 top_{0, 0, 0};
    double inverse_ = 1;
    std::array<std::size_t, 3> size_{};
    std::vector<std::uint32_t> begin_{};  ///< cell -> its first place
    std::vector<std::uint32_t> cell_{};
    std::vector<double> x_{};  ///< of points by cell, and of some more
    std::vector<double> y_{};
    std::vector<double> z_{};
};

}  // namespace tafoni::detail

#endif
