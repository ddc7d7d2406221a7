/// \file
/// Exact signs of 2x2 and 3x3 orientation determinants, for the headers of this folder.
#ifndef TAFONI_GEOMETRY_DETAIL_EXACT_SIGN_HPP
#define TAFONI_GEOMETRY_DETAIL_EXACT_SIGN_HPP

#include <tafoni/core/vector.hpp>

#include <array>
#include <cstddef>

namespace tafoni::detail {

/// A sum of doubles kept exactly, as components that do not overlap [Shewchuk 1997, section 2].
template <std::size_t Capacity>
class exact_sum {
public:
    /// Adds x without error (grow-expansion, zero components left out). O(size).
    void add(double x) noexcept {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < size_; ++i) {
            double const sum = x + part_[i];
            double const virtual_part = sum - x;
            double const error = (x - (sum - virtual_part)) + (part_[i] - virtual_part);
            x = sum;
            if (error != 0) part_[kept++] = error;
        }
        if (x != 0) part_[kept++] = x;
        size_ = kept;
    }

    /// Adds a b without error.
    void add_product(double a, double b) noexcept {
        double const high = a * b;
        add(product_error(a, b, high));
        add(high);
    }

    /// Adds a b c without error.
    void add_product(double a, double b, double c) noexcept {
        double const high = a * b;
        double const low = product_error(a, b, high);
        add_product(low, c);
        add_product(high, c);
    }

    [[nodiscard]] int sign() const noexcept {
        if (size_ == 0) return 0;
        return part_[size_ - 1] > 0 ? 1 : -1;
    }

private:
    /// The rounding error of `high` = fl(a b) [Dekker 1971]; no fused operation, so every target agrees.
    static double product_error(double a, double b, double high) noexcept {
        double const split_a = 134217729.0 * a;
        double const a_high = split_a - (split_a - a);
        double const a_low = a - a_high;
        double const split_b = 134217729.0 * b;
        double const b_high = split_b - (split_b - b);
        double const b_low = b - b_high;
        return a_low * b_low - (((high - a_high * b_high) - a_low * b_high) - a_high * b_low);
    }

    std::array<double, Capacity> part_{};
    std::size_t size_ = 0;
};

/// Sign of the turn a, b, c in the plane: 1 to the left, -1 to the right, 0 on a line. Exact while
/// products of two coordinates neither overflow nor lose bits to underflow.
[[nodiscard]] inline int turn_sign(double ax, double ay, double bx, double by, double cx, double cy) noexcept {
    double const left = (ax - cx) * (by - cy);
    double const right = (ay - cy) * (bx - cx);
    double const det = left - right;
    double const bound = 3.3306690738754716e-16 * (std::fabs(left) + std::fabs(right));
    if (det > bound) return 1;
    if (-det > bound) return -1;
    exact_sum<16> s;
    s.add_product(ax, by);
    s.add_product(-ay, bx);
    s.add_product(bx, cy);
    s.add_product(-by, cx);
    s.add_product(cx, ay);
    s.add_product(-cy, ax);
    return s.sign();
}

/// Sign of det(b - a, c - a, d - a): 1 when d lies on the side that the normal of a, b, c points
/// to. Exact under the same condition for products of three coordinates.
[[nodiscard]] inline int side_sign(vec3 const& a, vec3 const& b, vec3 const& c, vec3 const& d) noexcept {
    double const ux = a[0] - d[0], uy = a[1] - d[1], uz = a[2] - d[2];
    double const vx = b[0] - d[0], vy = b[1] - d[1], vz = b[2] - d[2];
    double const wx = c[0] - d[0], wy = c[1] - d[1], wz = c[2] - d[2];
    double const vw0 = vx * wy, vw1 = vy * wx;
    double const wu0 = wx * uy, wu1 = wy * ux;
    double const uv0 = ux * vy, uv1 = uy * vx;
    double const det = uz * (vw0 - vw1) + vz * (wu0 - wu1) + wz * (uv0 - uv1);
    double const size = std::fabs(uz) * (std::fabs(vw0) + std::fabs(vw1)) +
                        std::fabs(vz) * (std::fabs(wu0) + std::fabs(wu1)) +
                        std::fabs(wz) * (std::fabs(uv0) + std::fabs(uv1));
    double const bound = 7.7715611723761027e-16 * size;
    if (det > bound) return -1;
    if (-det > bound) return 1;
    std::array<vec3 const*, 4> const p{&a, &b, &c, &d};
    exact_sum<112> s;
    // The 4x4 determinant with a column of ones: four minors of three rows, six products each.
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
        std::array<vec3 const*, 3> row{};
        std::size_t n = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            if (i != left_out) row[n++] = p[i];
        }
        double const sign = left_out % 2 == 0 ? -1.0 : 1.0;
        vec3 const& x = *row[0];
        vec3 const& y = *row[1];
        vec3 const& z = *row[2];
        s.add_product(sign * x[0], y[1], z[2]);
        s.add_product(sign * x[1], y[2], z[0]);
        s.add_product(sign * x[2], y[0], z[1]);
        s.add_product(-sign * x[0], y[2], z[1]);
        s.add_product(-sign * x[1], y[0], z[2]);
        s.add_product(-sign * x[2], y[1], z[0]);
    }
    return -s.sign();
}

}  // namespace tafoni::detail

#endif
