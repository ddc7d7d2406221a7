/// \file
/// Mean curvature from a quadric through the vertices around: robust on irregular meshes.
#ifndef TAFONI_CURVATURE_QUADRIC_FIT_HPP
#define TAFONI_CURVATURE_QUADRIC_FIT_HPP

#include <tafoni/curvature/concepts.hpp>
#include <tafoni/curvature/detail/corner_sums.hpp>
#include <tafoni/curvature/vertex_normals.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni {

namespace detail {

/// Height over a tangent plane, z = p x + q y + (r x^2 + 2 s x y + t y^2) / 2, fitted by least squares.
class height_fit {
public:
    /// Adds a point with x, y, z in units of the neighbourhood's size.
    void add(double x, double y, double z, double weight) noexcept {
        std::array<double, 5> const row{x, y, 0.5 * x * x, x * y, 0.5 * y * y};
        std::size_t at = 0;
        for (std::size_t i = 0; i < 5; ++i) {
            double const w = weight * row[i];
            for (std::size_t j = 0; j <= i; ++j) matrix_[at++] += w * row[j];
            right_[i] += w * z;
        }
    }

    /// Mean curvature of the graph at the origin, positive where it bends away from +z; by the sphere that fits
    /// best where the points do not settle a quadric (fewer than five directions, points on a line). O(1).
    [[nodiscard]] double mean_curvature() const noexcept {
        std::array<double, 15> l = matrix_;
        std::array<double, 5> f = right_;
        for (std::size_t i = 0; i < 5; ++i) {
            double* const row = &l[i * (i + 1) / 2];
            double const before = row[i];
            for (std::size_t j = 0; j <= i; ++j) {
                double const* const other = &l[j * (j + 1) / 2];
                double sum = row[j];
                for (std::size_t k = 0; k < j; ++k) sum -= row[k] * other[k];
                if (j < i) {
                    row[j] = sum * other[j];
                } else {
                    if (!(sum > singular * before)) return sphere();
                    row[i] = 1 / std::sqrt(sum);  // the inverse of the diagonal
                }
            }
            double sum = f[i];
            for (std::size_t k = 0; k < i; ++k) sum -= row[k] * f[k];
            f[i] = sum * row[i];
        }
        for (std::size_t i = 5; i-- > 0;) {
            for (std::size_t k = i + 1; k < 5; ++k) f[i] -= l[k * (k + 1) / 2 + i] * f[k];
            f[i] *= l[i * (i + 1) / 2 + i];
        }
        auto const [p, q, r, s, t] = f;
        double const g = 1 + p * p + q * q;
        return -((1 + q * q) * r - 2 * p * q * s + (1 + p * p) * t) / (2 * g * std::sqrt(g));
    }

private:
    static constexpr double singular = 1e-8;  ///< share of a column that is not explained by those before it

    /// z = h (x^2 + y^2) / 2.
    [[nodiscard]] double sphere() const noexcept {
        double const square = matrix_[5] + 2 * matrix_[12] + matrix_[14];
        return square > 0 ? -(right_[2] + right_[4]) / square : 0.0;
    }

    std::array<double, 15> matrix_{};  ///< lower triangle, row by row
    std::array<double, 5> right_{};
};

}  // namespace detail

/// The quadric that fits the vertices of two rings best in the plane across the vertex normal, and passes
/// through the vertex itself [after Goldfeather and Interrante 2004; weights fall off with the distance].
///
/// On a torus whose vertices are jittered by a quarter of a cell the error is about a tenth of that of the
/// methods of one ring: see the table in curvature/README.md. Works at the border of open meshes.
/// Models `curvature_estimator`.
struct quadric_fit {
    /// O(vertices x neighbours of two rings), about 0.6 us per vertex; 24 bytes of scratch memory per vertex. A neighbour
    /// of more than 256 neighbours leads to no second ring.
    /// \throws invalid_input  `attribute_length` for other than one number per vertex, `bad_parameter` for other rings.
    template <executor E>
    void operator()(surface_view const& s, std::span<double> mean, E const& executor) const {
        detail::require_one_per_vertex("quadric_fit", s, mean.size());
        std::vector<vec3> normal(s.positions.size());
        vertex_normals(s, normal, executor);
        executor.for_blocks(mean.size(), detail::vertex_grain, [&](std::size_t begin, std::size_t end) {
            neighborhood near_by(s.positions.size());
            for (std::size_t v = begin; v < end; ++v) mean[v] = at(s, normal[v], v, near_by);
        });
    }

private:
    /// Neighbours beyond which a vertex leads to no second ring, or the vertices around it would cost the square of them.
    static constexpr std::size_t hub = 256;

    /// The vertices of two rings, each once.
    struct neighborhood {
        explicit neighborhood(std::size_t vertices) : seen(vertices, 0) {}

        void collect(vertex_rings const& rings, std::uint32_t v) {
            around.clear();
            ++now;
            seen[v] = now;
            for (std::uint32_t const w : rings.neighbors(v)) {
                seen[w] = now;
                around.push_back(w);
            }
            std::size_t const first = around.size();
            for (std::size_t k = 0; k < first; ++k) {
                auto const ring = rings.neighbors(around[k]);
                if (ring.size() > hub) continue;
                for (std::uint32_t const w : ring) {
                    if (seen[w] == now) continue;
                    seen[w] = now;
                    around.push_back(w);
                }
            }
        }

        std::vector<std::uint32_t> seen;
        std::vector<std::uint32_t> around{};
        std::uint32_t now = 0;
    };

    [[nodiscard]] static double at(surface_view const& s, vec3 const& n, std::size_t v, neighborhood& near_by) {
        auto const ring = s.rings->neighbors(v);
        if (ring.empty() || !(squared_length(n) > 0)) return 0;
        near_by.collect(*s.rings, static_cast<std::uint32_t>(v));
        auto const& around = near_by.around;

        // A frame without a branch on the vertex's number [Duff et al. 2017, Building an orthonormal basis, revisited].
        double const sign = n[2] < 0 ? -1.0 : 1.0;
        double const a = -1 / (sign + n[2]);
        double const b = n[0] * n[1] * a;
        vec3 const e1{1 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]};
        vec3 const e2{b, sign + n[1] * n[1] * a, -n[1]};

        vec3 const& p = s.positions[v];
        double size = 0;
        for (std::uint32_t const w : around) size += squared_length(s.positions[w] - p);
        size = std::sqrt(size / static_cast<double>(around.size()));
        if (!(size > 0)) return 0;
        double const unit = 1 / size;
        detail::height_fit fit;
        for (std::uint32_t const w : around) {
            vec3 const d{s.positions[w] - p};
            double const x = dot(d, e1) * unit;
            double const y = dot(d, e2) * unit;
            double const z = dot(d, n) * unit;
            double const far = x * x + y * y + z * z;
            double const falling = 1 / (0.3 + far);
            fit.add(x, y, z, falling * falling);
        }
        return fit.mean_curvature() * unit;
    }
};

static_assert(curvature_estimator<quadric_fit>);

}  // namespace tafoni

#endif
