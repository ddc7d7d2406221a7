/// \file
/// The point that lies best on several planes.
#ifndef TAFONI_VOXEL_DETAIL_FEATURE_POINT_HPP
#define TAFONI_VOXEL_DETAIL_FEATURE_POINT_HPP

#include <tafoni/core/vector.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tafoni::detail {

/// Least squares over planes through points, as close as possible to the points' mean where the planes leave it free
/// [Lindstrom 2000]. Planes whose common direction weighs less than 1/100 of the heaviest count as parallel.
class feature_point {
public:
    void clear() noexcept {
        points_.clear();
        normals_.clear();
    }
    void add(vec3 const& point, vec3 const& unit_normal) {
        points_.push_back(point);
        normals_.push_back(unit_normal);
    }

    /// Within `reach` of the box; the points' mean where that has no solution, or no normal is known. O(points).
    [[nodiscard]] vec3 solve(vec3 const& lo, vec3 const& hi, vec3 const& reach) const {
        vec3 mean{0, 0, 0};
        for (vec3 const& p : points_) mean += p - lo;
        auto const n = static_cast<double>(points_.size());
        mean = vec3{lo[0] + mean[0] / n, lo[1] + mean[1] / n, lo[2] + mean[2] / n};
        std::array<std::array<double, 3>, 3> m{};
        std::array<double, 3> right{};
        for (std::size_t k = 0; k < points_.size(); ++k) {
            vec3 const& normal = normals_[k];
            double const distance = dot(normal, points_[k] - mean);
            for (std::size_t i = 0; i < 3; ++i) {
                right[i] += normal[static_cast<Eigen::Index>(i)] * distance;
                for (std::size_t j = 0; j < 3; ++j) m[i][j] += normal[static_cast<Eigen::Index>(i)] * normal[static_cast<Eigen::Index>(j)];
            }
        }
        std::array<std::array<double, 3>, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        diagonalize(m, axes);
        double const largest = std::fmax(m[0][0], std::fmax(m[1][1], m[2][2]));
        vec3 out = mean;
        for (std::size_t e = 0; e < 3; ++e) {
            if (!(m[e][e] > 0.01 * largest)) continue;
            double along = 0;
            for (std::size_t i = 0; i < 3; ++i) along += axes[i][e] * right[i];
            for (std::size_t i = 0; i < 3; ++i) out[static_cast<Eigen::Index>(i)] += axes[i][e] * (along / m[e][e]);
        }
        // An edge of the shape may pass by a cell that both its sides cross.
        for (Eigen::Index a = 0; a < 3; ++a) {
            if (!(out[a] >= lo[a] - reach[a] && out[a] <= hi[a] + reach[a])) return mean;
        }
        return out;
    }

private:
    /// Jacobi's rotations; columns of `axes` become the eigenvectors.
    static void diagonalize(std::array<std::array<double, 3>, 3>& m, std::array<std::array<double, 3>, 3>& axes) {
        for (int sweep = 0; sweep < 12; ++sweep) {
            for (std::size_t p = 0; p < 2; ++p) {
                for (std::size_t q = p + 1; q < 3; ++q) {
                    if (std::fabs(m[p][q]) <= 1e-18 * (std::fabs(m[p][p]) + std::fabs(m[q][q]))) continue;
                    double const theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
                    double const t = (theta < 0 ? -1.0 : 1.0) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
                    double const c = 1 / std::sqrt(t * t + 1);
                    double const s = t * c;
                    for (std::size_t k = 0; k < 3; ++k) {
                        double const a = m[k][p];
                        double const b = m[k][q];
                        m[k][p] = c * a - s * b;
                        m[k][q] = s * a + c * b;
                    }
                    for (std::size_t k = 0; k < 3; ++k) {
                        double const a = m[p][k];
                        double const b = m[q][k];
                        m[p][k] = c * a - s * b;
                        m[q][k] = s * a + c * b;
                    }
                    for (auto& row : axes) {
                        double const a = row[p];
                        double const b = row[q];
                        row[p] = c * a - s * b;
                        row[q] = s * a + c * b;
                    }
                }
            }
        }
    }

    std::vector<vec3> points_{};
    std::vector<vec3> normals_{};
};

}  // namespace tafoni::detail

#endif
